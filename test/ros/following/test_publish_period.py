# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What waits in a period, and whose messages do not."""

from types import SimpleNamespace

import numpy as np
import pytest

from sdf_pose_bridge.ros.following.publish_period import PublishPeriod

OLD, NEW = SimpleNamespace(last_ns=5), SimpleNamespace(last_ns=8)


@pytest.fixture
def period():
    period = PublishPeriod()
    period.end([OLD, NEW])
    period.begin(20, [OLD, NEW])
    return period


def test_at_first_there_is_no_period_and_nothing_waits():
    period = PublishPeriod()
    assert (period.has_begun, [*period.awaited]) == (False, [])
    assert period.end([]).tolist() == []


def test_transforms_wait_once_for_the_end_and_then_all_sources_are_awaited(period):
    period.begin(20, [OLD])
    period.add(np.array([3, 4]))
    period.add(np.array([1, 3]))
    assert period.end([OLD, NEW]).tolist() == [1, 3, 4]
    assert (period.has_begun, period.awaited) == (False, [OLD, NEW])
    assert period.end([]).tolist() == []


def test_a_source_that_moves_transforms_early_is_not_awaited_again(period):
    period.add(np.array([1, 3]))
    period.publish_early(np.array([3]), 8)
    assert period.awaited == [OLD]
    assert period.end([]).tolist() == [1]


def test_what_waits_can_be_forgotten(period):
    period.add(np.array([1]))
    period.forget()
    assert period.end([]).tolist() == []
