# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of the node for the topics of a file in Gazebo."""

import pytest
from sdf_texts import joint, JOINTS, model, model_file, plugin, world_file

from sdf_pose_bridge import load_text
from sdf_pose_bridge.export.gazebo_bridge import followed_topics
from sdf_pose_bridge.sdformat.gazebo_topics import GROUPS
from sdf_pose_bridge.tf.bridged_topics import bridged_topics


def parameters_of(text, world='', name=''):
    """Return the topics of joint states and poses, and the frames of poses."""
    scene = load_text(text, plugins=True).with_model_name(name)
    followed = followed_topics(scene, bridged_topics(scene, GROUPS, world), world)
    assert followed.pop('use_joint_states') is bool(followed['joint_states_topics'])
    return [*followed.values()]


def test_one_pattern_is_for_all_robots():
    content = plugin('DiffDrive') + JOINTS
    text = world_file(''.join(model(f'r{i}', content) for i in range(30)))
    assert parameters_of(text) == [['/{model}/joint_states'], ['/{model}/odometry'], []]


def test_patterns_have_names_that_ros_forbids_escaped():
    text = world_file(model('r 1', model('r 12', plugin('DiffDrive') + JOINTS) + JOINTS))
    assert parameters_of(text) == [
        ['/{model}/joint_states', '/{model}/r_x20_12/joint_states'],
        ['/r_x20_1/r_x20_12/odometry'], []]


@pytest.mark.parametrize(('contents', 'poses'), [
    ({'a': 'OdometryPublisher'}, ['/{model}/odometry']),
    ({'a': 'DiffDrive OdometryPublisher'}, ['/{model}/odometry_1']),
    ({'a': 'DiffDrive OdometryPublisher', 'b': 'DiffDrive'},
     ['/a/odometry_1', '/b/odometry']),
    ({'a': 'DiffDrive PosePublisher'}, ['/{model}/odometry']),
    ({'a': 'DiffDrive PosePublisher publish_model_pose'}, ['/{model}/pose']),
    ({'a': 'DiffDrive OdometryPublisher PosePublisher publish_model_pose'},
     ['/{model}/odometry_1']),
    ({'a': 'OdometryPublisher PosePublisher publish_nested_model_pose'}, ['/{model}/pose']),
    ({'a': 'PosePublisher publish_nested_model_pose use_pose_vector_msg'}, ['/{model}/pose']),
    ({'a': 'PosePublisher publish_model_pose static_publisher'}, ['/{model}/pose_static']),
    ({'a': 'AckermannSteering steering_only'}, []),
    ({'a': 'JointTrajectoryController publish_model_pose'}, []),
])
def test_the_node_follows_the_best_source_of_each_model(contents, poses):
    def plugins(name, words):
        flags = ''.join(f'<{each}>true</{each}>' for each in words.split() if each.islower())
        return ''.join(
            plugin(each, f'{flags}<odom_topic>{each}{name}</odom_topic>')
            for each in words.split() if not each.islower())
    text = world_file(''.join(model(each[0], plugins(*each)) for each in contents.items()))
    assert parameters_of(text)[1:] == [poses, []]


def test_the_node_follows_a_plugin_in_a_nested_model_for_the_free_one_around_it():
    pose = plugin('PosePublisher', '<publish_model_pose>true</publish_model_pose>')
    bot = model('bot', plugin('DiffDrive') + pose)
    joined = joint('<parent>l</parent><child>bot::l</child>', joint_type='fixed')
    for text in f'<model name="c">{bot}</model>', model('a', bot + joined):
        assert parameters_of(world_file(text)) == [[], ['/{model}/bot/odometry'], []]
    # Without a joint, it moves by itself in the model around it.
    assert parameters_of(world_file(model('a', bot)))[1] == ['/a/bot/pose']


def test_of_plugins_in_two_models_of_one_body_the_true_one_is_followed():
    inner = model('one', plugin('DiffDrive')) + model('two', plugin('OdometryPublisher')) + joint(
        '<parent>one::l</parent><child>two::l</child>', joint_type='fixed')
    assert parameters_of(world_file(f'<model name="a">{inner}</model>'))[1] == [
        '/{model}/two/odometry']


@pytest.mark.parametrize('systems', ['DiffDrive OdometryPublisher', 'OdometryPublisher DiffDrive'])
def test_a_topic_of_two_plugins_is_not_followed_if_the_true_one_has_another(systems):
    text = world_file(model('a', ''.join(map(plugin, systems.split()))))
    assert parameters_of(text)[1] == ['/{model}/odometry_with_covariance']


def test_nobody_follows_the_odometry_of_what_cannot_move():
    static = f'<model name="a"><static>true</static><link name="l"/>{plugin("DiffDrive")}</model>'
    assert parameters_of(world_file(static))[1] == []


def test_a_spawned_model():
    text = model_file('<link name="l"/>' + plugin(
        'PosePublisher', '<publish_model_pose>true</publish_model_pose>') + JOINTS)
    assert parameters_of(text, 'shop', 'm_2') == [
        ['/{model}/joint_states'], ['/{model}/pose'], ['shop']]
    assert parameters_of(text.replace('true', 'false'), 'shop')[1:] == [[], []]


POSES = plugin('PosePublisher', '<publish_nested_model_pose>true</publish_nested_model_pose>')
HINGE = '<link name="k"/>' + joint(
    '<parent>l</parent><child>k</child>', joint_type='revolute')


@pytest.mark.parametrize(('contents', 'joints', 'poses'), [
    ({'a': JOINTS + HINGE, 'b c': ''}, ['/{model}/joint_states'], []),
    ({'a': JOINTS + HINGE, 'b c': HINGE + plugin('DiffDrive')},
     ['/a/joint_states'], ['/b_x20_c/odometry']),
    ({'a': POSES, 'b': '', 'c': plugin('DiffDrive')}, [], ['/a/pose', '/c/odometry']),
    # The poses of a model that moves in another one are on the topic of this.
    ({'a': POSES + model('b', ''), 'c': POSES}, [], ['/a/pose', '/c/pose']),
    ({'a': POSES + '<static>true</static>', 'c': POSES}, [], ['/{model}/pose']),
])
def test_topics_are_named_if_not_all_models_have_them(contents, joints, poses):
    text = world_file(''.join(model(*each) for each in contents.items()))
    assert parameters_of(text)[:2] == [joints, poses]
