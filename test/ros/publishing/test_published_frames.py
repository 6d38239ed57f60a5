# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Frames published by a real node: which topics there are, and which publishers stay."""

import threading

from deadline import wait_until
from geometry_msgs.msg import PoseStamped, TransformStamped
import numpy as np
import pytest
from rcl_interfaces.msg import SetParametersResult
from rclpy.qos import (
    DurabilityPolicy,
    qos_profile_sensor_data,
    QoSProfile,
    ReliabilityPolicy,
)
from tf2_msgs.msg import TFMessage
from tf_checks import tree_of

from sdf_pose_bridge import load_text
from sdf_pose_bridge.export.published_scene import LoadRequest
from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.ros.following.joint_states import JointStates
from sdf_pose_bridge.ros.parameters.given import settings_from_values
from sdf_pose_bridge.ros.publishing.published_frames import frames_from_scene, PublishedFrames
from sdf_pose_bridge.ros.publishing.publishers import Publishers
from sdf_pose_bridge.ros.publishing.topic_names import StateTopics
from sdf_pose_bridge.tf.joint_positions import JointPositions, UnreportedJoints
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

OTHERS = {'/tf_static', '/bridge/transforms'}
LATCHED = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
ARM = """<sdf version="1.11"><model name="arm"><link name="base"/><link name="upper"/>
<joint name="turn" type="revolute"><parent>base</parent><child>upper</child>
  <axis><xyz>0 0 1</xyz></axis></joint></model></sdf>"""
SETTINGS = settings_from_values({'sdf_file': 'arm.sdf'})
WORLD = '<sdf version="1.10"><world name="w">{}</world></sdf>'


def tree_of_frames(*names):
    return tree_of(WORLD.format(''.join(f'<frame name="{name}"/>' for name in names)))


@pytest.fixture
def publish(node):
    """Publishes frames and pose topics; ``publish(names, topics)``."""
    publishers = Publishers(node)

    def publish(names, topics=()):
        frames = PublishedFrames(
            publishers, tree_of_frames(*names), None, {name: f'topic_{name}' for name in topics})
        frames.open_topics()
        frames.publish_tf_static()
        frames.destroy_other_publishers()
        frames.publish_topics()

    return publish


def topics_of(node):
    topics = {publisher.topic_name for publisher in node.publishers}
    return topics - {'/rosout', '/parameter_events'}


def test_no_frames_can_be_published(publish, node):
    publish('')
    publish('a')
    publish('')
    assert topics_of(node) == OTHERS


def test_pose_topics_are_made_and_removed(publish, node):
    publish('abc', 'ab')
    assert topics_of(node) == OTHERS | {'/bridge/poses/topic_a', '/bridge/poses/topic_b'}
    publish('abc', 'bc')
    assert topics_of(node) == OTHERS | {'/bridge/poses/topic_b', '/bridge/poses/topic_c'}
    publish('abc')
    assert topics_of(node) == OTHERS


def test_publishers_of_topics_that_stay_are_kept(publish, node):
    publish('abc', 'ab')
    before = {id(publisher) for publisher in node.publishers}
    publish('abd', 'ab')
    assert {id(publisher) for publisher in node.publishers} == before
    publish('ab', 'ab')
    new, = (each for each in node.publishers if id(each) not in before)
    assert new.topic_name == '/bridge/transforms', 'which keeps another number of messages'


def test_a_frame_that_begins_to_move_has_another_publisher_without_its_last_pose(node):
    publishers, found = Publishers(node), []
    for frames in (
            PublishedFrames(publishers, tree_of(ARM), None, {'base': 'base', 'upper': 'upper'}),
            frames_of_arm(publishers)):
        frames.open_topics()
        frames.destroy_other_publishers()
        found.append({each.topic_name: each for each in node.publishers})
    assert {name for name, each in found[0].items() if each is not found[1].get(name)} == {
        '/bridge/poses/upper', '/bridge/transforms'}


def test_another_tree_gets_another_stamp(node):
    publishers = Publishers(node)
    first = PublishedFrames(publishers, tree_of_frames('a'), None, {})
    same = PublishedFrames(publishers, first.tree, None, {}, first)
    other = PublishedFrames(publishers, tree_of_frames('a'), None, {}, first)
    assert first.stamp_ns == same.stamp_ns < other.stamp_ns


def test_frames_are_made_by_another_thread_and_parameters_changed_by_the_executor(node, beside):
    threads = set()

    def remember(_parameters):
        threads.add(threading.current_thread())
        return SetParametersResult(successful=True)

    node.add_on_set_parameters_callback(remember)
    publishers = Publishers(node)
    before = PublishedFrames(publishers, tree_of_frames('a'), None, {})
    threads.clear()
    loaded = loaded_scene_from_request(LoadRequest(
        '', ARM, tf_options=TfOptions(use_joint_states=True)))
    frames = beside(node.executor, frames_from_scene, node, loaded, SETTINGS, before)
    assert frames.moving is not None
    assert threads == {threading.current_thread()}
    assert '/bridge/poses/upper' in topics_of(node)


def test_a_topic_that_cannot_be_made_leaves_the_publishers_as_they_were(
        node, beside, monkeypatch):
    publishers = Publishers(node)
    before = PublishedFrames(publishers, tree_of_frames('a'), None, {})
    topics = topics_of(node)
    opened = publishers.opened

    def fail_at_poses(topic):
        if topic.name == '~/poses/upper':
            raise RuntimeError
        return opened(topic)

    monkeypatch.setattr(publishers, 'opened', fail_at_poses)
    with pytest.raises(RuntimeError):
        beside(node.executor, frames_from_scene, node, loaded_scene_from_request(
            LoadRequest('', ARM)), SETTINGS, before)
    assert topics_of(node) == topics


def frames_of_arm(publishers, before=None, unreported=UnreportedJoints.ZERO, pose_frame=''):
    scene = load_text(ARM)
    tree = tf_tree_from_scene(scene, TfOptions(use_joint_states=True, pose_frame=pose_frame))
    return PublishedFrames(
        publishers, tree,
        JointPositions(scene, tree.moving.motion, unreported=unreported),
        {'upper': 'upper', 'base': 'base'}, before)


def report_position(frames):
    """Report the position of the joint, with the stamp (5, 6)."""
    positions = frames.moving.positions
    positions.update(positions.selection(['turn']), np.zeros(1), 5_000_000_006)


def seconds_of(message):
    """Return the seconds and nanoseconds of a stamp."""
    stamp = message.header.stamp
    return stamp.sec, stamp.nanosec


@pytest.fixture
def poses(node, make_node):
    """The names and stamps of the poses that arrive."""
    listener, found = make_node('listener'), []
    for name in ('upper', 'base'):
        listener.create_subscription(
            PoseStamped, f'/bridge/poses/{name}',
            lambda pose, name=name: found.append((name, seconds_of(pose))), LATCHED)
    node.executor.add_node(listener)
    return found


def publish_topics(frames):
    """Publish all frames on their topics; the moving ones as the thread of joint states does."""
    frames.open_topics()
    frames.publish_topics()
    frames.moving.publish_topics(only_listeners=False)


def spin_until(node, condition, found):
    wait_until(condition, lambda: node.executor.spin_once(timeout_sec=0.1), found)


def test_moving_frames_are_not_published_with_the_fixed_ones(node, poses):
    def count(wanted):
        return sum(name == wanted for name, _ in poses)

    frames = frames_of_arm(Publishers(node))
    publish_topics(frames)
    spin_until(node, lambda: count('upper') and count('base'), poses)
    for _ in range(2):
        frames.publish_fixed_again()
    spin_until(node, lambda: count('base') == 3, poses)
    assert count('upper') == 1


def test_poses_have_the_stamps_of_the_tree_and_of_the_joints(node, poses):
    publishers = Publishers(node)
    frames = frames_of_arm(publishers)
    report_position(frames)
    # The time of the node goes on before anything is published.
    assert frames.stamp_ns < publishers.now_ns()
    publish_topics(frames)
    spin_until(node, lambda: {'upper', 'base'} <= dict(poses).keys(), poses)
    assert dict(poses) == {'base': divmod(frames.stamp_ns, 10**9), 'upper': (5, 6)}


def test_poses_in_a_frame_that_moves_have_the_stamp_of_its_joints(node, poses):
    frames = frames_of_arm(Publishers(node), pose_frame='upper')
    report_position(frames)
    publish_topics(frames)
    spin_until(node, lambda: 'base' in dict(poses), poses)
    assert dict(poses)['base'] == (5, 6)


def test_what_waits_for_tf_keeps_its_stamp_while_topics_are_published(node, poses):
    frames, found = frames_of_arm(Publishers(node)), []
    report_position(frames)
    node.create_subscription(TFMessage, '/tf', found.append, 10)
    rows = frames.moving.stamp(np.array([0]), 7_000_000_008)
    publish_topics(frames)
    spin_until(node, lambda: 'upper' in dict(poses), poses)
    frames.moving.publish_tf(rows)
    spin_until(node, lambda: found, found)
    assert seconds_of(found[0].transforms[0]) == (7, 8)


def test_what_a_joint_without_a_position_moves_is_not_published(node, poses):
    publishers, transforms = Publishers(node), []
    node.create_subscription(TransformStamped, '/bridge/transforms', transforms.append, LATCHED)
    before = frames_of_arm(publishers, unreported=UnreportedJoints.NONE)
    publish_topics(before)
    spin_until(node, lambda: 'base' in dict(poses), poses)
    assert 'upper' not in dict(poses)
    report_position(before)
    before.moving.publish_topics(only_listeners=False)
    spin_until(
        node, lambda: 'upper' in dict(poses)
        and 'upper' in [each.child_frame_id for each in transforms], poses)
    assert [each.child_frame_id for each in transforms].count('upper') == 1


@pytest.fixture
def qualities(make_executor, beside):
    """Publishes the frames of an arm; returns the quality of service of each topic."""
    def publish(node):
        frames = frames_of_arm(Publishers(node))
        states = beside(
            make_executor(node), JointStates, node, frames.moving,
            PoseLookup(load_text(ARM), frames.tree, frames.moving.positions),
            StateTopics({'joint_states': ''}), settings_from_values({'robot_description': ARM}))
        found = {
            each.topic_name: each.qos_profile for each in [*node.publishers, *node.subscriptions]}
        states.end()
        return found
    return publish


def test_policies_are_those_of_tf2_ros_and_declared(make_node, qualities):
    node = make_node('bridge')
    found = qualities(node)
    assert (found['/tf'].depth, found['/tf'].durability) == (100, DurabilityPolicy.VOLATILE)
    assert (found['/tf_static'].depth, found['/tf_static'].durability) == (
        1, DurabilityPolicy.TRANSIENT_LOCAL)
    assert found['/joint_states'].reliability is ReliabilityPolicy.BEST_EFFORT
    assert node.get_parameter('qos_overrides./tf.publisher.depth').value == 100
    assert node.get_parameter(
        'qos_overrides./joint_states.subscription.reliability').value == 'best_effort'


def test_policies_are_overridden_under_the_remapped_name(make_node, qualities):
    node = make_node(
        'bridge', '-r', '/tf:=/r1/tf', '-p', 'qos_overrides./r1/tf.publisher.depth:=7',
        '-p', 'qos_overrides./tf_static.publisher.reliability:=best_effort',
        '-p', 'qos_overrides./joint_states.subscription.reliability:=reliable',
        '-p', 'qos_overrides./joint_states.subscription.durability:=transient_local')
    found = qualities(node)
    assert found['/r1/tf'].depth == 7
    assert found['/tf_static'].reliability is ReliabilityPolicy.BEST_EFFORT
    assert found['/joint_states'].reliability is ReliabilityPolicy.RELIABLE
    assert found['/joint_states'].durability is DurabilityPolicy.TRANSIENT_LOCAL
    assert qos_profile_sensor_data.reliability is ReliabilityPolicy.BEST_EFFORT, 'for others'
