# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters that override the quality of service of topics."""

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, qos_profile_sensor_data, ReliabilityPolicy

from sdf_pose_bridge import load_text
from sdf_pose_bridge.ros.given_parameters import settings_from_node
from sdf_pose_bridge.ros.joint_states import JointStates
from sdf_pose_bridge.ros.parameters import Settings, SettingsError
from sdf_pose_bridge.ros.published_frames import PublishedFrames
from sdf_pose_bridge.ros.publishers import Publishers
from sdf_pose_bridge.ros.qos_overrides import sentences_about_overrides
from sdf_pose_bridge.ros.topic_names import JointStateTopics
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

MODEL = '<sdf version="1.11"><model name="m"><link name="l"/></model></sdf>'


def qualities(node):
    """Publish the frames of a model; return the quality of service of each topic."""
    scene = load_text(MODEL)
    tree = tf_tree_from_scene(scene, TfOptions(use_joint_states=True))
    frames = PublishedFrames(
        Publishers(node), tree, JointPositions(scene, tree.moving.dofs), {})
    states = JointStates(
        node, frames.moving, JointStateTopics({'joint_states': ''}),
        Settings({'publish_frequency': 0.0, 'ignore_timestamp': False}))
    found = {
        each.topic_name: each.qos_profile for each in [*node.publishers, *node.subscriptions]}
    states.end()
    return found


def test_policies_are_declared_with_their_defaults(make_node):
    node = make_node('bridge')
    found = qualities(node)
    assert found['/tf'].depth == 100
    assert found['/joint_states'].reliability is ReliabilityPolicy.BEST_EFFORT
    assert node.get_parameter('qos_overrides./tf.publisher.depth').value == 100
    assert node.get_parameter(
        'qos_overrides./joint_states.subscription.reliability').value == 'best_effort'


def test_policies_are_overridden_under_the_remapped_name(make_node):
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


@pytest.mark.parametrize(('policy', 'value', 'rule'), [
    ('reliability', 'sometimes', 'it must be one of system_default, reliable, best_effort'),
    ('durability', 3, 'it must be one of system_default, transient_local, volatile'),
    ('history', 'all', 'it must be one of system_default, keep_last, keep_all'),
    ('depth', '7', 'it must be an integer from 0 to 2147483647'),
    ('depth', -1, 'it must be an integer from 0 to 2147483647'),
    ('depth', 2**31, 'it must be an integer from 0 to 2147483647'),
])
def test_a_value_that_no_policy_has_is_refused(policy, value, rule):
    name = f'qos_overrides./tf.publisher.{policy}'
    sentence, = sentences_about_overrides({name: Parameter(name, value=value)})
    assert sentence.startswith(f'parameter {name} is {value}; {rule}')


def test_a_refused_value_ends_the_start(make_node):
    node = make_node(
        'bridge', '-p', 'sdf_file:=a.sdf', '-p', 'qos_overrides./tf.publisher.depth:=many')
    with pytest.raises(SettingsError, match=r'tf\.publisher\.depth is many'):
        settings_from_node(node)
