# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Start the bridge beside robot_state_publisher, each with frames of its own.

    ros2 launch sdf_pose_bridge beside_robot_state_publisher.launch.py \
        urdf_file:=robot.urdf sdf_file:=cell.sdf

robot_state_publisher publishes the robot: every link of the URDF but its root gets its parent from
there, on /tf_static or, once joint states arrive, on /tf. The bridge publishes what stands around
the robot: every frame of the SDFormat file gets its parent from here, and its id begins with
``cell/``, which no link of the URDF does. The two meet in ``root_frame``, a link of the URDF that
gets children from the bridge, but never a parent. So no frame has two parents, and all are in one
tree. Only for a floating joint robot_state_publisher publishes nothing: what hangs on it is a tree
of its own until localization, say, publishes where it is.

``root_frame`` is ``world``, for a URDF whose root link is called so. For another one, name the
link that the SDFormat world is measured from, such as ``root_frame:=base_link``; or any other
link, for example to hang a tool's file on ``tool0``.

Do not give both the same robot: under the prefix it would be a second one that stands still. If
the file holds the robot too, choose the part to publish with ``model:=table``. Mind that a link's
frame in URDF is that of the joint which moves it; in SDFormat a link has a pose of its own, so
frames of the same name need not be in the same place.

Needs the package robot_state_publisher.
"""

from __future__ import annotations

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import FileContent
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description() -> LaunchDescription:
    """
    Describe what to start.

    :return: the arguments and both nodes.
    """
    return LaunchDescription([
        DeclareLaunchArgument(
            'urdf_file', description='URDF file of the robot; of a xacro file, what it makes.'),
        DeclareLaunchArgument(
            'sdf_file', description='SDFormat file of what stands around the robot.'),
        DeclareLaunchArgument(
            'root_frame', default_value='world',
            description='Link of the URDF that stands for the SDF world.'),
        DeclareLaunchArgument(
            'frame_prefix', default_value='cell/',
            description='Stands before the frames of the SDFormat file, and before no link of '
            'the URDF.'),
        DeclareLaunchArgument(
            'model', default_value='',
            description='Publish this model of a world alone; everything if empty.'),
        Node(
            package='robot_state_publisher',
            executable='robot_state_publisher',
            parameters=[{
                'robot_description': _text(FileContent(LaunchConfiguration('urdf_file')))}],
            output='screen',
        ),
        Node(
            package='sdf_pose_bridge',
            executable='bridge',
            name='sdf_pose_bridge',
            parameters=[{
                name: _text(LaunchConfiguration(name))
                for name in ('sdf_file', 'root_frame', 'frame_prefix', 'model')}],
            output='screen',
        ),
    ])


def _text(value: FileContent | LaunchConfiguration) -> ParameterValue:
    # As text, whatever it looks like: a frame may be called 1 or yes.
    return ParameterValue(value, value_type=str)
