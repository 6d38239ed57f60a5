# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Errors in messages are reported; those in all messages of several publishers are raised."""

import sys

import pytest

from sdf_pose_bridge.ros.following.message_failures import (
    AllMessagesFailError,
    LONGEST_S,
    MessageFailures,
)

DEFECT = ValueError('not a joint')


class Topic:
    def __init__(self, *publishers):
        self.name = '/joint_states'
        self.publishers = lambda: list(publishers)


class Turns:
    """Turns of a thread, at a time that the test sets."""

    def __init__(self):
        self.now, self.logged = 100.0, []
        self.failures = MessageFailures(
            lambda: self.logged.append(sys.exc_info()[1]), LookupError, clock=lambda: self.now)

    def fail(self, *topics, error=DEFECT):
        def turn():
            raise error

        assert self.failures.attempt(topics, 'nothing', turn) == 'nothing'


@pytest.fixture
def turns():
    return Turns()


BOTH, ARM, GRIPPER = Topic('/arm', '/gripper'), Topic('/arm'), Topic('/gripper')


def test_a_failure_is_logged_and_a_problem_for_a_time(turns):
    turns.fail(ARM)
    line = 'internal error in messages of /joint_states: not a joint'
    assert turns.failures.problems() == [line]
    assert turns.logged == [DEFECT]
    turns.now += LONGEST_S + 1
    assert turns.failures.problems() == []


def test_some_errors_are_always_raised(turns):
    with pytest.raises(KeyError):
        turns.fail(ARM, error=KeyError())
    assert turns.failures.problems() == []


@pytest.mark.parametrize('topics', [[BOTH], [ARM, GRIPPER]])
def test_when_all_messages_of_two_publishers_fail_for_a_time_the_node_ends(turns, topics):
    for _ in range(int(LONGEST_S)):
        turns.fail(*topics)
        turns.now += 1.0
    with pytest.raises(AllMessagesFailError, match='10 s'):
        turns.fail(topics[-1])


def succeed(turns):
    turns.failures.note_success([ARM])


def pause(turns):
    turns.now += 2 * LONGEST_S


@pytest.mark.parametrize(('topics', 'between'), [
    ([ARM], None), ([Topic('/arm', '/arm')], None), ([], None), ([BOTH], succeed), ([BOTH], pause),
], ids=['one publisher', 'one node', 'no message', 'others succeed', 'a pause'])
def test_otherwise_it_goes_on(turns, topics, between):
    for turn in range(3 * int(LONGEST_S)):
        if turn % int(LONGEST_S) == 9 and between:
            between(turns)
        turns.fail(*topics)
        turns.now += 1.0
