# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Which of several messages counts, and what it moves."""

from moving_models import Models
import pytest


@pytest.fixture
def models(make_node):
    return Models(make_node('bridge'))


@pytest.mark.parametrize(('stamps_ns', 'newest_ns'), [((4, 6, 5), 6), ((6, 0), 0)])
def test_the_newest_message_of_a_model_counts(models, stamps_ns, newest_ns):
    waiting = [models.read(stamp_ns=stamp_ns) for stamp_ns in reversed(stamps_ns)]
    models.source.messages = lambda _streams: waiting.pop() if waiting else None
    newest = {}
    while models.source.take(models.streams, newest):
        pass
    assert [each.stamp_ns for each in newest.values()] == [newest_ns]


def test_a_pose_moves_the_link_at_which_the_model_hangs(models):
    (message,) = models.read()
    models.positions.update(message.stream.selection, message.values, 5)
    frames = models.streams.rows(message.stream)
    assert len(frames) == 1
