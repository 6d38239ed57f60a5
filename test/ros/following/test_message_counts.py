# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Messages that one publisher cannot have sent, with and without numbers."""

import math
import random

import numpy as np
import pytest

from sdf_pose_bridge.ros.following.message_counts import MessageCounts


def counts_of(*messages):
    counts = MessageCounts()
    for stamp_ns, value, number in messages:
        counts.add(stamp_ns, np.array([0.5, value]), number)
    return counts


def of_arm(second):
    """The position of a joint that swings."""
    return math.sin(second)


TIMES = [second / 50 for second in range(150)]
NOISE = random.Random(1)
BY_TURNS = [of_arm(second) if turn % 2 else 0.0 for turn, second in enumerate(TIMES)]
ONE_OF_TEN = [0.0 if turn % 10 else 1.0 for turn, _ in enumerate(TIMES)]


@pytest.mark.parametrize('messages', [
    [(0, 0.0, number) for number in (7, 1, 8, 2, 9, 3)],
    [(0, 0.0, number) for number in (1, 1, 2, 2, 3, 3)],
    [(stamp, 0.0, None) for stamp in (9, 7, 10, 8, 11, 9, 12, 10)],
    [(turn, value, None) for turn, value in enumerate(BY_TURNS)],
    [(0, value, None) for value in ONE_OF_TEN],
], ids=['numbers', 'equal numbers', 'stamps', 'by turns', 'one of ten'])
def test_messages_of_two_publishers(messages):
    assert counts_of(*messages).have_several_publishers


@pytest.mark.parametrize('messages', [
    [(0, 0.0, number) for number in (7, 8, 1, 2, 3)],
    [(stamp, 0.0, None) for stamp in (7, 8, 1, 2, 3)],
    [(0, of_arm(second), None) for second in TIMES],
    [(turn, NOISE.gauss(0.0, 2e-4), None) for turn, _ in enumerate(TIMES)],
    [(turn, 0.2 * turn + 0.8 * (turn % 2), None) for turn in range(20)],
    [(stamp, 0.0, None) for stamp in (5, 0, 6, 0, 7, 0, 8, 0)],
    [(5, 1.0, None)] * 10,
    [(0, value, None) for value in (math.nan, math.inf, -math.inf, 1e308, -1e308) * 5],
], ids=['started again', 'stamps once', 'a swing', 'noise', 'steps', 'no stamps', 'at rest',
        'not finite'])
def test_messages_of_one_publisher(messages, recwarn):
    assert not counts_of(*messages).have_several_publishers
    assert not recwarn.list


def test_each_period_is_counted_by_itself():
    counts = counts_of(*((0, 0.0, number) for number in (7, 1, 8, 2, 9, 3)))
    counts.end_period()
    assert (counts.periods, counts.have_several_publishers) == (1, False)
    counts.end_period()
    assert counts.periods == 0
