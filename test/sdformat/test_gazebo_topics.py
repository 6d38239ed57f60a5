# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Topics of plugins and sensors of Gazebo, by their parameters."""

import pytest

from sdf_pose_bridge.sdformat.gazebo_topics import ROS_TYPES, topics_of

VALUES = {'W': 'w', 'P': 'a/model/b', 'M': 'b', 'N': 'b', 'C': 'link/l', 'S': 's'}
SENSOR = '/world/w/model/a/model/b/link/l/sensor/s'


def names_of(owner, **parameters):
    values = {**VALUES, **parameters}
    return [name for each in topics_of(owner, values) if (name := each.name(values))]


@pytest.mark.parametrize('owner', ['', 'MyPlugin', 'my_sensor', 'Physics'])
def test_an_unknown_plugin_or_sensor_has_no_topics(owner):
    assert topics_of(owner, VALUES) == []


@pytest.mark.parametrize(('topic', 'name'), [
    ('@', '/model/b/cmd_vel'),
    ('~', '/model/b/cmd_vel'),
    ('/', '/model/b/cmd_vel'),
    ('drive', '/drive'),
    ('/drive/', '/drive'),
    ('my drive', '/my_drive'),
    ('a//b:=c', '/abc'),
])
def test_names_are_cleaned_as_by_gazebo(topic, name):
    assert names_of('MecanumDrive', topic=topic)[1] == name


@pytest.mark.parametrize(('owner', 'parameters', 'names'), [
    ('JointStatePublisher', {}, ['/world/w/model/a/model/b/joint_state']),
    ('jointstatepublisher', {'topic': 'js'}, ['/js']),
    ('DiffDrive', {}, ['/model/b/odometry', '/model/b/cmd_vel', '/model/b/enable']),
    ('AckermannSteering', {'sub_topic': 'x', 'odom_topic': 'o'}, ['/o', '/model/b/x']),
    ('AckermannSteering', {'steering_only': 'true'}, ['/model/b/steer_angle']),
    ('OdometryPublisher', {}, ['/model/b/odometry', '/model/b/odometry_with_covariance']),
    ('PosePublisher', {}, ['/model/a/model/b/pose']),
    ('PosePublisher', {'topic': 'p', 'static_publisher': '1'}, ['/p_static', '/p']),
    ('JointPositionController', {'joint_name': 'j', 'joint_index': '1'},
     ['/model/b/joint/j/1/cmd_pos']),
    ('JointPositionController', {'joint_name': 'j', 'use_actuator_msg': 'true'}, ['/actuators']),
    ('JointController', {}, []),
    ('Thruster', {'joint_name': 'j'}, ['/model/b/joint/j/cmd_thrust']),
    ('Thruster', {'topic': '/t', 'use_angvel_cmd': 'true'}, ['/bt']),
    ('LinearBatteryPlugin', {'battery_name': 'x'}, ['/model/b/battery/x/state']),
    ('camera', {}, [f'{SENSOR}/image', f'{SENSOR}/camera_info']),
    ('camera', {'topic': 'c'}, ['/c', '/camera_info']),
    ('camera', {'topic': 'c/raw', 'camera/camera_info_topic': 'i', 'camera/triggered': 'true'},
     ['/c/raw', '/i', '/c/raw/trigger']),
    ('depth_camera', {}, [
        f'{SENSOR}/camera_info', f'{SENSOR}/depth_image', f'{SENSOR}/depth_image/points']),
    ('wideanglecamera', {'topic': 'a/w'}, ['/a/w', '/a/camera_info']),
    ('rgbd_camera', {'topic': 'r'}, ['/r/image', '/r/depth_image', '/r/points', '/r/camera_info']),
    ('gpu_lidar', {}, [f'{SENSOR}/scan', f'{SENSOR}/scan/points']),
    ('contact', {'topic': 'no', 'contact/topic': 'yes'}, ['/yes']),
    ('force_torque', {}, [f'{SENSOR}/forcetorque']),
])
def test_names(owner, parameters, names):
    assert names_of(owner, **parameters) == names


@pytest.mark.parametrize(('parameter', 'gz_type'), [
    ('', 'Pose'), ('false', 'Pose'), ('true', 'Pose_V'), ('1', 'Pose_V')])
def test_parameters_decide_on_types(parameter, gz_type):
    topic, = topics_of('PosePublisher', {'use_pose_vector_msg': parameter})
    assert topic.gz_type == gz_type


@pytest.mark.parametrize('owner', [
    'lidar', 'ray', 'air_speed', 'logical_camera', 'SceneBroadcaster'])
def test_topics_that_cannot_be_bridged_have_a_reason(owner):
    assert all(each.reason for each in topics_of(owner, VALUES))


def test_types_in_ros_are_complete_names():
    assert ROS_TYPES['Model'] == 'sensor_msgs/msg/JointState'
    assert ROS_TYPES['Twist'] == 'geometry_msgs/msg/Twist'
    assert all(each.split('/')[1] == 'msg' for each in ROS_TYPES.values())
