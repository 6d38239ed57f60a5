# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Which of several messages counts, what it moves, and what is reported about it."""

from functools import partial

from moving_models import Models
import pytest

from sdf_pose_bridge.ros.following.state_messages import (
    MOST_REPORTED,
    StateSource,
    WARNING_PERIOD_S,
)


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


def test_warnings_about_the_same_are_rare_and_about_new_names_only(
        make_node, monkeypatch, capfd):
    source, now = StateSource(make_node('test'), '/poses'), 0.0
    monkeypatch.setattr('time.monotonic', lambda: now)
    many = [str(number) for number in range(MOST_REPORTED)]
    for now, about, names in (
            (0.0, 'a', ['x']), (1.0, 'a', ['y']), (1.0, 'b', ['y']),
            (WARNING_PERIOD_S, 'a', ['x', 'y']), (2 * WARNING_PERIOD_S, 'a', ['z', *many]),
            (3 * WARNING_PERIOD_S, 'a', many)):
        source.warn_once(about, names, partial('{} about {}'.format, now, about))
    assert [line.split('[test]: ')[1] for line in capfd.readouterr().err.splitlines()] == [
        '0.0 about a', '1.0 about b', '20.0 about a', '30.0 about a']
