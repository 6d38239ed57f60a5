# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What messages on one topic of several change: which positions, with which stamp."""

import time

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from builtin_interfaces.msg import Time
from rclpy.serialization import deserialize_message, serialize_message
from sdf_texts import joint, world_file
from sensor_msgs.msg import JointState
from std_msgs.msg import Header

from sdf_pose_bridge import load_text
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


@pytest.fixture
def frames(make_node):
    """Return the moving frames of a world with the robots ``a`` and ``b``."""
    tree = tf_tree_from_scene(
        scene := load_text(world_file(ROBOT.format('a') + ROBOT.format('b'))),
        TfOptions(use_joint_states=True))
    positions = JointPositions(scene, tree.moving.dofs)
    return PublishedFrames(Publishers(make_node('bridge')), tree, positions, {}).moving


@pytest.fixture(name='topics')
def joint_state_topics(frames):
    """Return the topics of all joints and of each robot, by the names of the robots."""
    return {
        model: JointStateTopic(
            frames._publishers._node, f'{model}joint_states', model, number, waits=False,
            receive=None)
        for number, model in enumerate(['', 'a', 'b'])}


@pytest.fixture(name='update')
def make_update(frames, topics):
    """Has a message taken; ``update(model, sent_ns, **positions)`` returns what it changes."""
    def update(model, sent_ns, **positions):
        message = JointState(
            header=Header(stamp=Time(sec=sent_ns)), name=[*positions],
            position=[*positions.values()])
        change = topics[model].update(frames, serialize_message(message), sent_ns)
        if change is None:
            return None
        rows = frames.frames.indices[change.rows]
        return {frames._tree.frame_ids[row] for row in rows}, change.stamp_ns // 10**9
    return update


def values_of(frames):
    return dict(zip(frames.positions.names, frames.positions.values.tolist(), strict=True))


def test_names_on_the_topic_of_a_model_are_of_its_joints(update, frames):
    assert update('a', 5, turn=0.5) == ({'a/upper'}, 5)
    assert update('b', 6, turn=0.25, grip=0.75) == ({'b/upper', 'b/finger'}, 6)
    assert values_of(frames) == {'a/turn': 0.5, 'a/grip': 0.0, 'b/turn': 0.25, 'b/grip': 0.75}


def test_a_name_of_another_model_is_reported_with_the_model(update, capfd):
    assert update('a', 5, **{'b/turn': 0.5, 'turn': 0.0}) == ({'a/upper'}, 5)
    deadline, log = time.monotonic() + 20.0, ''
    while 'has "b/turn", not the name of one moving joint in model "a"' not in log:
        assert time.monotonic() < deadline, log
        log += capfd.readouterr().err


def test_each_model_has_its_own_stamp(update, frames):
    update('a', 5, turn=0.5)
    update('b', 6, turn=0.5)
    update('a', 7, grip=0.5)
    seconds = (frames.positions.stamps_ns // 10**9).tolist()
    assert dict(zip(frames.positions.names, seconds, strict=True)) == {
        'a/turn': 7, 'a/grip': 7, 'b/turn': 6, 'b/grip': 6}


def test_of_two_topics_that_name_a_joint_the_newer_message_counts(update, frames):
    assert update('a', 5, turn=0.5) == ({'a/upper'}, 5)
    assert update('', 4, **{'a/turn': 0.25, 'a/grip': 0.25}) == ({'a/finger'}, 4)
    assert update('', 4, **{'a/turn': 0.25}) is None
    assert values_of(frames)['a/turn'] == 0.5
    assert update('', 6, **{'a/turn': 0.75, 'a/grip': 0.75}) == ({'a/upper', 'a/finger'}, 6)
    assert values_of(frames)['a/turn'] == 0.75


def test_frames_are_found_again_when_more_joints_are_reported(update, frames):
    assert update('a', 5, turn=float('nan'), grip=0.5) == ({'a/finger'}, 5)
    assert update('a', 6, turn=0.5, grip=0.5) == ({'a/upper', 'a/finger'}, 6)


def test_other_names_in_each_message_are_not_kept(update, topics):
    for number in range(100):
        update('a', number + 1, **{f'x{number}': 0.0})
    assert len(topics['a']._plans) <= 20


def test_messages_wait_in_a_subscription_that_is_closed(topics, make_node, make_executor):
    topic, received = topics['a'], []
    topic._take = lambda data, info: received.append((data, info['source_timestamp']))
    topic.is_open = False
    executor = make_executor(topic._node)
    publisher = make_node('joints').create_publisher(JointState, topic.name, 10)
    deadline = time.monotonic() + 20.0
    while not topic.take_one():
        assert time.monotonic() < deadline
        publisher.publish(JointState(name=['turn'], position=[0.5]))
        executor.spin_once(timeout_sec=0.05)
    ((data, sent_ns),) = received
    assert deserialize_message(data, JointState).name == ['turn']
    assert 0 < sent_ns <= time.time_ns()
