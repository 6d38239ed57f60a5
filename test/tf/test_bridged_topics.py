# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Topics of a file in Gazebo and in ROS."""

import pytest
from sdf_texts import JOINTS, model, model_file, plugin, world_file

from sdf_pose_bridge import load_text, SdfError
from sdf_pose_bridge.sdformat.gazebo_topics import GROUPS, ROS_TYPES
from sdf_pose_bridge.tf.bridged_topics import bridged_topics

IMU = '<sensor name="s" type="imu">{}</sensor>'


def topics_in(text, groups=GROUPS, world='', name=''):
    return bridged_topics(load_text(text, plugins=True).with_model_name(name), groups, world)


def names_in(text, *arguments):
    """Return the names in Gazebo by those in ROS, without the clock."""
    clock, *topics = topics_in(text, *arguments)
    assert clock.ros_name == clock.gz_name == '/clock'
    return {each.ros_name: each.gz_name for each in topics}


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


def test_a_topic_of_several_robots_keeps_its_name_and_is_told():
    text = world_file(''.join(
        model(name, f'<link name="k">{IMU.format("<topic>i</topic>")}</link>') for name in 'ab'))
    _, topic = topics_in(text)
    assert (topic.ros_name, topic.gz_name, topic.pattern) == ('/i', '/i', '/i')
    assert 'the topic /i belongs to "a::k::s", "b::k::s"' in topic.doubt.message


def test_names_that_ros_forbids_are_escaped_as_by_the_node():
    text = world_file(model('r 1', model('r 12', plugin('DiffDrive') + JOINTS) + JOINTS))
    assert names_in(text, ('joints', 'odometry')) == {
        '/r_x20_1/r_x20_12/odometry': '/model/r_12/odometry',
        '/r_x20_1/joint_states': '/world/w/model/r_1/joint_state',
        '/r_x20_1/r_x20_12/joint_states': '/world/w/model/r_1/model/r_12/joint_state'}


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
    topics = topics_in(world_file(model('a', content)))
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
    topics = topics_in(world_file(model('a', f'<link name="k">{sensors}</link>')))
    assert {each.topic.gz_type for each in topics if not each.topic.reason} <= ROS_TYPES.keys()
    assert len(topics) > 20
