# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Start the bridge on one file.

    ros2 launch sdf_pose_bridge bridge.launch.py sdf_file:=cell.sdf

An argument that is not given leaves its parameter to the params file, and without that to the
node's own default. ``config/bridge.yaml`` of this package is such a file, with every parameter
explained.
"""

from __future__ import annotations

from launch import LaunchContext
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.actions import OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterFile
from launch_ros.parameter_descriptions import ParameterValue

PARAMETERS = {
    'sdf_file': 'SDFormat file to publish: a path, or a file://, package:// or model:// URI.',
    'frame_prefix': 'Stands before every frame id but that of root_frame, such as robot1/.',
    'root_frame': "TF frame that stands for the SDF world, or for a model file's root.",
}
"""Arguments that set the parameter of the same name."""


def generate_launch_description() -> LaunchDescription:
    """
    Describe what to start.

    :return: the arguments and the node.
    """
    return LaunchDescription([
        *(DeclareLaunchArgument(
            name, default_value='',
            description=f'{description} Left to params_file if empty.')
          for name, description in PARAMETERS.items()),
        DeclareLaunchArgument(
            'namespace', default_value='',
            description='Namespace of the node, for its topics and services; /tf_static stays.'),
        DeclareLaunchArgument(
            'params_file', default_value='',
            description='YAML file with parameters of the node; none if empty.'),
        OpaqueFunction(function=_nodes),
    ])


def _nodes(context: LaunchContext) -> list[Node]:
    given = {name: LaunchConfiguration(name).perform(context) for name in PARAMETERS}
    params_file = LaunchConfiguration('params_file').perform(context)
    return [Node(
        package='sdf_pose_bridge',
        executable='bridge',
        # With its full name the values below win over whatever a params file calls the node.
        name='sdf_pose_bridge',
        namespace=LaunchConfiguration('namespace'),
        parameters=[
            *([ParameterFile(params_file)] if params_file else []),
            # As text, whatever it looks like: a frame may be called 1 or yes.
            {name: ParameterValue(value, value_type=str) for name, value in given.items()
             if value},
        ],
        output='screen',
    )]
