# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What is read of messages on one topic of several, and what their names mean."""

from builtin_interfaces.msg import Time
from deadline import wait_until
import pytest
from rclpy.serialization import serialize_message
from sdf_texts import fixed_joint, joint, world_file
from sensor_msgs.msg import JointState
from std_msgs.msg import Header

from sdf_pose_bridge import load_text
from sdf_pose_bridge.ros.cdr import JOINT_STATE, SerializedNames
from sdf_pose_bridge.ros.following.state_messages import BYTES_OF_OBJECTS, KnownStreams, MOST_BYTES
from sdf_pose_bridge.ros.following.state_topic import StateTopic, TopicKey
from sdf_pose_bridge.ros.publishing.published_frames import PublishedFrames
from sdf_pose_bridge.ros.publishing.publishers import Publishers
from sdf_pose_bridge.tf.joint_positions import JointPositions, UnreportedJoints
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

ROBOT = f"""<model name="{{}}"><link name="base"/><link name="upper"/><link name="finger"/>
<link name="plate"/>{fixed_joint('glue', 'base', 'plate')}
{joint('<parent>base</parent><child>upper</child><axis><xyz>0 0 1</xyz></axis>', 'turn',
       'revolute')}
{joint('<parent>base</parent><child>finger</child><axis><xyz>0 0 1</xyz></axis>', 'grip',
       'revolute')}
</model>"""


class Robots:
    """Two robots, ``a`` and ``b``, and what messages about them mean."""

    def __init__(self, node, unreported):
        scene = load_text(world_file(ROBOT.format('a') + ROBOT.format('b')))
        tree = tf_tree_from_scene(scene, TfOptions(use_joint_states=True))
        self._node = node
        self.positions = JointPositions(scene, tree.moving.motion, unreported=unreported)
        self.streams = KnownStreams(
            PublishedFrames(Publishers(node), tree, self.positions, {}).moving,
            PoseLookup(scene, tree, self.positions))

    def topic(self, name='a/j', model='a'):
        return StateTopic(self._node, TopicKey(name, model, JOINT_STATE))


@pytest.fixture
def robots(make_node):
    return Robots(make_node('bridge'), UnreportedJoints.NONE)


@pytest.fixture
def read(robots):
    """Reads a message on the topic of the robot ``a`` of two; ``read(data)``."""
    topic = robots.topic()

    def read(data):
        messages = topic.read(data, robots.streams)
        if not messages:
            return None
        (message,) = messages
        names = [robots.positions.names[dof] for dof in message.stream.selection.dofs]
        return names, message.values.tolist(), message.stamp_ns
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


def test_a_fixed_joint_is_no_unknown_name(read, capfd):
    assert read(joint_state(turn=0.5, glue=0.0, other=0.5))[0] == ['a/turn']
    line = 'has "other", not the name of one moving joint in model "a"'
    wait_until(lambda: line in capfd.readouterr().err)


def test_a_name_of_another_model_is_reported_with_the_model(read, capfd):
    assert read(joint_state(**{'b/turn': 0.5, 'turn': 0.0}))[0] == ['a/turn']
    line = 'has "b/turn", not the name of one moving joint in model "a"'
    wait_until(lambda: line in capfd.readouterr().err)


def test_names_are_kept_for_a_topic_whatever_aligns_them(robots):
    first, second = robots.topic(), robots.topic('a/k')
    data = joint_state(turn=0.5, grip=0.25)
    begin = data.index(b'turn\0') + 5
    streams = [
        topic.read(each, robots.streams)[0].stream for topic, each in (
            (first, data), (first, data[:begin] + b'abc' + data[begin + 3:]),
            (first, joint_state(turn=0.5)), (first, data), (second, data))]
    kept = streams[0]
    assert [each is kept for each in streams] == [True, True, False, True, False]


@pytest.mark.parametrize('unreported', list(UnreportedJoints))
def test_names_move_their_transforms_and_those_of_joints_at_zero(make_node, unreported):
    robots = Robots(make_node('bridge'), unreported)
    topic = robots.topic('j', '')

    def rows(*names):
        data = joint_state(**dict.fromkeys(names, 0.0))
        (message,) = topic.read(data, robots.streams)
        robots.positions.update(message.stream.selection, message.values, 5)
        return robots.streams.rows(message.stream).tolist()

    at_zero = unreported is UnreportedJoints.ZERO
    assert rows('a/turn', 'x') == ([0, 1, 2, 3] if at_zero else [0])
    assert rows('b/turn', 'b/grip') == ([1, 2, 3] if at_zero else [2, 3])
    assert rows('a/grip') == [1]
    assert rows('a/turn', 'x') == [0]
    assert rows('x') == []


@pytest.mark.parametrize('size', [MOST_BYTES // 10, 1])
def test_all_names_together_take_a_limited_number_of_bytes(robots, size):
    topic, streams = robots.topic(), set()
    count = 2 * MOST_BYTES // (size + BYTES_OF_OBJECTS)
    robots.streams.of_joints(SerializedNames(('turn',), b''), robots.topic('a/k'))
    for _ in range(2):
        for number in range(count):
            names = SerializedNames((str(number) * size,), b'x' * size)
            streams.add(robots.streams.of_joints(names, topic))
            assert robots.streams.last[topic].names is names
    assert len(streams) > 1.5 * count
    assert set(robots.streams.last.values()) <= set(robots.streams.known)
