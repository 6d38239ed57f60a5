# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Start the bridge beside robot_state_publisher, each with frames of its own.

    ros2 launch sdf_pose_bridge beside_robot_state_publisher.launch.py \
        urdf_file:=robot.urdf sdf_file:=cell.sdf

robot_state_publisher publishes the robot: it publishes the parent of every link of the URDF but
the root, on /tf_static or, once joint states arrive, on /tf. The bridge publishes the surroundings
of the robot: it publishes the parent of every frame of the SDFormat file. The ids of these frames
begin with ``cell/``, so no link of the URDF has the same id. The two trees meet in ``root_frame``,
a link of the URDF that gets children from the bridge, but never a parent. So no frame has two
parents, and all frames are in one tree. Only for a floating joint does robot_state_publisher
publish nothing: its child starts a tree of its own until something else, such as localization,
publishes its pose.

``root_frame`` is ``world`` by default, for a URDF whose root link has that name. For another URDF,
set the link that is the origin of the SDFormat world, such as ``root_frame:=base_link``; or any
other link, for example ``tool0`` for the file of a tool.

Do not give both the same robot: the bridge would publish a second one, which does not move. If the
file contains the robot too, choose what to publish with ``model:=table``. Note that a link's frame
in URDF is that of the joint that moves it; in SDFormat a link has a pose of its own, so frames
with the same name can be in different places.

Needs the package robot_state_publisher.
"""

from __future__ import annotations

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import FileContent, LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue


def generate_launch_description() -> LaunchDescription:
    """
    Describe both nodes.

    :return: the arguments and both nodes.
    """
    return LaunchDescription([
        DeclareLaunchArgument(
            'urdf_file', description='URDF file of the robot; not a xacro file, but its output.'),
        DeclareLaunchArgument(
            'sdf_file', description='SDFormat file of the surroundings of the robot.'),
        DeclareLaunchArgument(
            'root_frame', default_value='world',
            description='Link of the URDF that is the SDF world.'),
        DeclareLaunchArgument(
            'frame_prefix', default_value='cell/',
            description='Precedes the ids of all frames of the SDFormat file, and of no link '
            'of the URDF.'),
        DeclareLaunchArgument(
            'model', default_value='',
            description='Publish only this model of a world; everything if empty.'),
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
                **{name: _text(LaunchConfiguration(name))
                   for name in ('sdf_file', 'root_frame', 'frame_prefix', 'model')},
                # The surroundings stand still in root_frame, also if they are a model file. The
                # topic is robot_state_publisher's.
                'anchor_models': 'all', 'publish_robot_description': False}],
            output='screen',
        ),
    ])


def _text(value: FileContent | LaunchConfiguration) -> ParameterValue:
    # As a string, even if it looks like a number: a frame may be called 1 or yes.
    return ParameterValue(value, value_type=str)
