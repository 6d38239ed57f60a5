# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Publishers of one joint or model that send at once."""

from deadline import wait_until
from geometry_msgs.msg import PoseStamped
from moving_models import Models, POSE
import pytest

from sdf_pose_bridge.ros.cdr import StampedPose
from sdf_pose_bridge.ros.following.message_problems import MessageProblems
from sdf_pose_bridge.ros.following.model_poses import messages_from_poses
from sdf_pose_bridge.ros.following.state_messages import StateSource


@pytest.fixture
def look(make_node):
    """
    Sends messages and returns the lines about publishers; ``look(*periods)``.

    A period has messages, each as a source, the number of its publisher and a model.
    """
    models, other = Models(make_node('bridge')), make_node('other')
    publishers = [other.create_publisher(PoseStamped, '/poses', 10) for _ in range(2)]
    sources = {'poses': models.source, 'alone': StateSource(models.source._node, '/alone')}
    publishers.append(other.create_publisher(PoseStamped, '/alone', 10))
    wait_until(lambda: [len(each.publishers()) for each in sources.values()] == [2, 1])

    problems = MessageProblems(models.frames)

    def look(*periods):
        for period in periods:
            for name, number, child in period:
                source = sources[name]
                source.number = number
                source.messages = lambda streams, source=source, child=child: (
                    messages_from_poses(
                        [StampedPose(5, '', child, POSE)], source, streams))
                source.take(models.streams, {})
            problems.look_at_publishers(models.streams.known)
        return problems.lines([])
    return look


BOTH = [('poses', 1, 'a'), ('alone', 1, 'a')]
TURNS = [('poses', number, 'a') for number in (7, 1, 8, 2, 9, 3)]


def test_publishers_of_one_model_on_two_topics_are_reported_as_long_as_it_lasts(look, capfd):
    line = 'messages about model "a" come from several publishers at once on /alone and /poses; '
    assert not look(BOTH)
    found = look(BOTH)
    assert len(found) == 1
    assert found[0].startswith(line)
    assert not look(BOTH[:1])
    look(BOTH, BOTH)
    assert capfd.readouterr().err.count(line) == 1


def test_publishers_of_one_model_on_one_topic_are_reported(look):
    line = 'messages about model "a" come from several publishers at once on /poses, among "/'
    found = look(TURNS)
    assert len(found) == 1
    assert found[0].startswith(line)
    assert not look([])


@pytest.mark.parametrize('periods', [
    [BOTH[:1], BOTH, BOTH[1:]],
    [[('alone', number, 'a') for _, number, _ in TURNS]],
    [[('poses', None, 'a')] * 6] * 2,
    [[('poses', number, 'a') for number in (7, 8, 1, 2, 3)]] * 2,
    [[(*each, ('a', 'a::b')[row % 2]) for row, (*each, _) in enumerate(TURNS)]],
], ids=['replaced', 'one publisher', 'no numbers', 'restarted', 'different models'])
def test_publishers_that_are_not_several_at_once_are_not_reported(look, periods):
    for period in periods:
        assert not look(period)
