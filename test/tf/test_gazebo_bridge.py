# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Topics of a file in Gazebo and in ROS, and the parameters of the node for them."""

import pytest
from sdf_texts import joint, model_file, world_file

from sdf_pose_bridge import load_text, SdfError
from sdf_pose_bridge.sdformat.gazebo_topics import GROUPS, ROS_TYPES
from sdf_pose_bridge.tf.gazebo_bridge import bridged_topics, node_parameters

IMU = '<sensor name="s" type="imu">{}</sensor>'
JOINTS = '<plugin filename="gz-sim-joint-state-publisher-system" name=""/>'


def plugin(system, parameters=''):
    return f'<plugin filename="f" name="gz::sim::systems::{system}">{parameters}</plugin>'


def model(name, content):
    return f'<model name="{name}"><link name="l"/>{content}</model>'


def topics_in(text, groups=GROUPS, world='', name=''):
    scene = load_text(text, plugins=True).with_model_name(name)
    topics = bridged_topics(scene, groups, world)
    return topics, node_parameters(topics, scene, world)


def names_in(text, *arguments):
    """Return the names in Gazebo by those in ROS, without the clock."""
    (clock, *topics), _ = topics_in(text, *arguments)
    assert clock.ros_name == clock.gz_name == '/clock'
    return {each.ros_name: each.gz_name for each in topics}


def parameters_of(text, *arguments):
    """Return the topics of joint states and poses, and the frames of poses."""
    _, parameters = topics_in(text, *arguments)
    return [parameters[name] for name in (
        'joint_states_topics', 'model_pose_topics', 'model_pose_frames')]


@pytest.mark.parametrize(('content', 'owner'), [
    (JOINTS, 'the joint_states of model "m"'),
    (f'<link name="k">{IMU.format("")}</link>', 'the imu of sensor "m::k::s"'),
])
def test_without_the_name_of_the_world_one_error_says_so(content, owner):
    text = model_file(f'<link name="l"/>\n{content}')
    with pytest.raises(SdfError, match=owner) as error:
        topics_in(text)
    assert '--world-name' in error.value.message
    assert error.value.line > 0
    assert names_in(text, ('odometry',)) == {}
    assert topics_in(text, GROUPS, 'w')


def test_a_model_file_needs_no_world_for_topics_without_it():
    text = model_file(f'<link name="l">{IMU.format("<topic>imu</topic>")}</link>')
    assert names_in(text) == {'/m/l/s/imu': '/imu'}


def test_plugins_of_nobody_never_hurt():
    text = world_file(
        f'{plugin("DiffDrive")}{plugin("Unknown")}<plugin filename="any.so"/>'
        f'{plugin("Imu")}{model("a", plugin("Unknown") + plugin("Contact"))}')
    assert names_in(text) == {}


def test_robots_do_not_meet():
    content = plugin('DiffDrive') + JOINTS + f'<link name="k">{IMU.format("")}</link>'
    robots = range(30)
    text = world_file(''.join(model(f'r{i}', content) for i in robots))
    names = names_in(text)
    assert len(names) == len(set(names.values())) == 30 * 5
    assert [*names][4] == '/r0/k/s/imu'
    assert names['/r7/joint_states'] == '/world/w/model/r7/joint_state'
    assert names['/r7/k/s/imu'] == '/world/w/model/r7/link/k/sensor/s/imu'
    assert parameters_of(text) == [['/{model}/joint_states'], ['/{model}/odometry'], []]
    assert topics_in(text)[1]['model_name'] == ''


def test_a_topic_of_several_robots_keeps_its_name_and_is_told():
    text = world_file(''.join(
        model(name, f'<link name="k">{IMU.format("<topic>i</topic>")}</link>') for name in 'ab'))
    (_, topic), _ = topics_in(text)
    assert (topic.ros_name, topic.gz_name, topic.pattern) == ('/i', '/i', '/i')
    assert 'the topic /i belongs to "a::k::s", "b::k::s"' in topic.doubt.message


def test_names_that_ros_forbids_are_escaped_as_by_the_node():
    text = world_file(model('r 1', model('r 12', plugin('DiffDrive') + JOINTS) + JOINTS))
    assert names_in(text, ('joints', 'odometry')) == {
        '/r_x20_1/r_x20_12/odometry': '/model/r_12/odometry',
        '/r_x20_1/joint_states': '/world/w/model/r_1/joint_state',
        '/r_x20_1/r_x20_12/joint_states': '/world/w/model/r_1/model/r_12/joint_state'}
    assert parameters_of(text) == [
        ['/{model}/joint_states', '/{model}/r_x20_12/joint_states'], ['/{model}/odometry'], []]


def test_plugins_in_one_model():
    namespace = '<robotNamespace>r</robotNamespace><namespace>n</namespace>'
    thrusters = ''.join(
        plugin('Thruster', f'<topic>{topic}</topic><joint_name>{name}</joint_name>{namespace}')
        for topic, name in ('xj', 'yj', 'yk'))
    others = (
        plugin('JointTrajectoryController', '<topic>n/x</topic><topic>z</topic><model>z</model>')
        + plugin('JointPositionController', '<joint_name>i</joint_name>'))
    assert names_in(world_file(model('a', thrusters + others))) == {
        '/a/j/cmd_thrust': '/n/x', '/a/j/cmd_thrust_1': '/n/y', '/a/joint_trajectory': '/n/x',
        '/a/i/cmd_pos': '/model/a/joint/i/0/cmd_pos'}


@pytest.mark.parametrize(('contents', 'poses'), [
    ({'a': 'OdometryPublisher'}, ['/{model}/odometry']),
    ({'a': 'DiffDrive OdometryPublisher'}, ['/{model}/odometry_1']),
    ({'a': 'DiffDrive OdometryPublisher', 'b': 'DiffDrive'},
     ['/b/odometry', '/{model}/odometry_1']),
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
    assert parameters_of(world_file(model('a', bot)))[1] == ['/{model}/pose']


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


@pytest.mark.parametrize(('content', 'doubts'), [
    (plugin('OdometryPublisher') + plugin('DiffDrive'), [
        ('/model/a/odometry belongs to OdometryPublisher, DiffDrive', 'by <odom_topic>')]),
    (JOINTS * 2, [
        ('/world/w/model/a/joint_state belongs to JointStatePublisher, JointStatePublisher',
         'by <topic>')]),
    # All of them follow one command.
    (plugin('VelocityControl') + plugin('DiffDrive'), []),
])
def test_plugins_of_one_model_on_one_topic_are_told(content, doubts):
    topics, _ = topics_in(world_file(model('a', content)))
    assert [each.doubt.message for each in topics if each.doubt] == [
        f'the topic {whose} of "a", so it has messages of all; give each a topic of its own in '
        f'the file, {cure}' for whose, cure in doubts]
    assert {each.gz_name: each.ros_name for each in topics}.get(
        '/model/a/odometry', '/a/odometry') == '/a/odometry'


def test_a_spawned_model():
    text = model_file('<link name="l"/>' + plugin(
        'PosePublisher', '<publish_model_pose>true</publish_model_pose>') + JOINTS)
    assert names_in(text, GROUPS, 'shop', 'm_2') == {
        '/m_2/pose': '/model/m_2/pose', '/m_2/joint_states': '/world/shop/model/m_2/joint_state'}
    assert parameters_of(text, GROUPS, 'shop', 'm_2') == [
        ['/{model}/joint_states'], ['/{model}/pose'], ['shop']]
    assert topics_in(text, GROUPS, 'shop', 'm_2')[1]['model_name'] == 'm_2'
    assert parameters_of(text.replace('true', 'false'), GROUPS, 'shop')[1:] == [[], []]


def test_only_the_first_world_counts():
    text = '<sdf version="1.10">' + ''.join(
        f'<world name="{world}">{model("a", JOINTS)}</world>' for world in 'vw') + '</sdf>'
    assert names_in(text) == {'/a/joint_states': '/world/v/model/a/joint_state'}


def test_each_bridged_topic_has_a_type_in_ros():
    sensors = ''.join(
        f'<sensor name="{each}" type="{each}"/>' for each in (
            'camera depth rgbd_camera segmentation boundingbox_camera thermal gpu_lidar imu '
            'navsat altimeter air_pressure magnetometer force_torque contact lidar '
            'logical_camera air_speed').split())
    topics, _ = topics_in(world_file(model('a', f'<link name="k">{sensors}</link>')))
    assert {each.topic.gz_type for each in topics if not each.topic.reason} <= ROS_TYPES.keys()
    assert len(topics) > 20
