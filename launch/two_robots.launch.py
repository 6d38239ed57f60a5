# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Start two robots of one file, side by side in one world.

    ros2 launch sdf_pose_bridge two_robots.launch.py

Each robot has a node of its own. The namespace separates their topics and services
(``/left/sdf_pose_bridge/...``), the prefix their frames (``left/chassis``). A model file does not
say where in the world the robot is, so each robot has its own root frame, ``left_start`` and
``right_start``; a third node publishes the poses of these in ``world``, from
``examples/starting_places.sdf``. For robots that drive, leave that node and ``anchor_models`` out
and let odometry or localization publish the pose of each chassis.
"""

from __future__ import annotations

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, ThisLaunchFileDir

EXAMPLES = 'package://sdf_pose_bridge/examples'


def generate_launch_description() -> LaunchDescription:
    """
    Describe the three nodes.

    :return: the arguments and three nodes.
    """
    return LaunchDescription([
        DeclareLaunchArgument(
            'sdf_file', default_value=f'{EXAMPLES}/mobile_robot.sdf',
            description='Model file of both robots.'),
        DeclareLaunchArgument(
            'places_file', default_value=f'{EXAMPLES}/starting_places.sdf',
            description='World file with the frames left_start and right_start.'),
        _bridge(
            sdf_file=LaunchConfiguration('places_file'), namespace='places', root_frame='world',
            frame_prefix=''),
        *(_bridge(
            sdf_file=LaunchConfiguration('sdf_file'), namespace=robot,
            root_frame=f'{robot}_start', frame_prefix=f'{robot}/', anchor_models='all')
          for robot in ('left', 'right')),
    ])


def _bridge(**arguments: str | LaunchConfiguration) -> GroupAction:
    # In a group, or the arguments would also apply to the next included file.
    return GroupAction([IncludeLaunchDescription(
        PathJoinSubstitution([ThisLaunchFileDir(), 'bridge.launch.py']),
        launch_arguments=arguments.items())])
