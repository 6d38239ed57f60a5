# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What is read of messages on one topic of several."""

import time

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from builtin_interfaces.msg import Time
from rclpy.serialization import serialize_message
from sdf_texts import joint, world_file
from sensor_msgs.msg import JointState
from std_msgs.msg import Header

from sdf_pose_bridge import load_text
from sdf_pose_bridge.ros.joint_names import Meanings
from sdf_pose_bridge.ros.joint_state_topic import JointStateTopic
from sdf_pose_bridge.ros.published_frames import PublishedFrames
from sdf_pose_bridge.ros.publishers import Publishers
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

ROBOT = f"""<model name="{{}}"><link name="base"/><link name="upper"/><link name="finger"/>
{joint('<parent>base</parent><child>upper</child><axis><xyz>0 0 1</xyz></axis>', 'turn',
       'revolute')}
{joint('<parent>base</parent><child>finger</child><axis><xyz>0 0 1</xyz></axis>', 'grip',
       'revolute')}
</model>"""


@pytest.fixture(name='read')
def make_read(make_node):
    """Reads a message on the topic of the robot ``a`` of two; ``read(data)``."""
    node = make_node('bridge')
    scene = load_text(world_file(ROBOT.format('a') + ROBOT.format('b')))
    tree = tf_tree_from_scene(scene, TfOptions(use_joint_states=True))
    positions = JointPositions(scene, tree.moving.dofs)
    meanings = Meanings(PublishedFrames(Publishers(node), tree, positions, {}).moving)
    topic = JointStateTopic(node, 'a/j', 'a')

    def read(data):
        message = topic.read(data, meanings)
        if message is None:
            return None
        names = [positions.names[dof] for dof in message.meaning.selection.dofs]
        return names, message.positions.tolist(), message.stamp_ns
    return read


def joint_state(sec=5, nanosec=0, **positions):
    return serialize_message(JointState(
        header=Header(stamp=Time(sec=sec, nanosec=nanosec)), name=list(positions),
        position=list(positions.values())))


@pytest.mark.parametrize(('data', 'line'), [
    (b'', 'not plain CDR'),
    (joint_state(turn=0.5)[:30], 'it ends too early'),
    (serialize_message(JointState(name=['turn'])), 'it has 1 names and 0 positions'),
    (joint_state(sec=-1, turn=0.5), 'it has the stamp sec=-1 nanosec=0, and sec must not be'),
    (joint_state(nanosec=10**9, turn=0.5), 'it has the stamp sec=5 nanosec=1000000000, and sec'),
], ids=['empty', 'short', 'positions', 'sec', 'nanosec'])
def test_a_message_that_cannot_be_used_is_reported(read, capfd, data, line):
    assert read(data) is None
    assert read(data) is None
    log = capfd.readouterr().err
    assert log.count(f'a message on /a/j is ignored: {line}' if line[0] == 'i' else line) == 1


def test_names_are_those_of_the_joints_of_the_model(read):
    assert read(joint_state(turn=0.5, grip=0.25)) == (
        ['a/turn', 'a/grip'], [0.5, 0.25], 5 * 10**9)


def test_a_name_of_another_model_is_reported_with_the_model(read, capfd):
    assert read(joint_state(**{'b/turn': 0.5, 'turn': 0.0}))[0] == ['a/turn']
    deadline, log = time.monotonic() + 20.0, ''
    while 'has "b/turn", not the name of one moving joint in model "a"' not in log:
        assert time.monotonic() < deadline, log
        log += capfd.readouterr().err


def test_the_same_names_are_looked_up_once_whatever_aligns_them(read):
    data = joint_state(turn=0.5, grip=0.25)
    begin = data.index(b'turn\0') + 5
    assert read(data) == read(data[:begin] + b'abc' + data[begin + 3:]) == read(data)
