# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Start the bridge on one file.

    ros2 launch sdf_pose_bridge bridge.launch.py sdf_file:=cell.sdf

A parameter whose argument is not given comes from the params file, or else is the default of the
node. ``config/bridge.yaml`` of this package is a params file that explains every parameter.

If the name of the file ends with ``.xacro``, xacro expands it first, with ``xacro_arguments``, and
the node gets the text as ``robot_description``:

    ros2 launch sdf_pose_bridge bridge.launch.py sdf_file:=robot.urdf.xacro \
        xacro_arguments:='prefix:=left_ gripper:=true'

With ``rviz:=true`` RViz shows the frames and the visuals of the links, from ``rviz/bridge.rviz``.
Its fixed frame is the root of the tree that the node publishes.
"""

from __future__ import annotations

from pathlib import Path
import shlex

from ament_index_python.packages import get_packages_with_prefixes
from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.conditions import IfCondition
from launch.substitutions import (
    Command,
    LaunchConfiguration,
    PathJoinSubstitution,
    ThisLaunchFileDir,
)
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterFile, ParameterValue
import yaml

from sdf_pose_bridge.errors import AddressError, SdfError
from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.ros.parameters.declarations import SettingsError
from sdf_pose_bridge.ros.parameters.given import settings_from_values

PARAMETERS = {
    'sdf_file': 'SDFormat file to publish: a path, or a file://, package:// or model:// URI.',
    'frame_prefix': 'Precedes every frame id but that of root_frame, such as robot1/.',
    'root_frame': "TF frame of the SDF world, or of a model file's root.",
    'anchor_models': 'Which models get a transform from root_frame: auto, all, static, none, or '
                     'patterns of their names such as table*,fence.',
}
"""Arguments that set the parameter of the same name."""

VISUALS = '/sdf_pose_bridge/visuals'
"""The topic in ``rviz/bridge.rviz``."""


def generate_launch_description() -> LaunchDescription:
    """
    Describe the node.

    :return: the arguments and the node.
    """
    return LaunchDescription([
        *(DeclareLaunchArgument(
            name, default_value='',
            description=f'{description} If empty, params_file decides.')
          for name, description in PARAMETERS.items()),
        DeclareLaunchArgument(
            'xacro_arguments', default_value='',
            description='Arguments for xacro, such as name:=value; for a file that ends with '
            '.xacro.'),
        DeclareLaunchArgument(
            'namespace', default_value='',
            description='Namespace of the node, its topics and services; not of /tf_static.'),
        DeclareLaunchArgument(
            'params_file', default_value='',
            description='YAML file with parameters of the node; none if empty.'),
        DeclareLaunchArgument(
            'rviz', default_value='false',
            description='Whether to start RViz too; needs the package rviz2.'),
        OpaqueFunction(function=_nodes),
    ])


def _nodes(context: LaunchContext) -> list[Node]:
    with_rviz = IfCondition(LaunchConfiguration('rviz')).evaluate(context)
    if with_rviz and 'rviz2' not in get_packages_with_prefixes():
        # Said before the node starts, which would run on when launch ends with an error.
        msg = 'rviz:=true needs the package rviz2, which is not installed'
        raise RuntimeError(msg)
    given = {name: LaunchConfiguration(name).perform(context) for name in PARAMETERS}
    params_file = LaunchConfiguration('params_file').perform(context)
    bridge = Node(
        package='sdf_pose_bridge',
        executable='bridge',
        # With the full name of the node the values below override those of any params file.
        name='sdf_pose_bridge',
        namespace=LaunchConfiguration('namespace'),
        parameters=[
            *([ParameterFile(params_file)] if params_file else []),
            # As a string, even if it looks like a number: a frame may be called 1 or yes.
            {name: ParameterValue(value, value_type=str)
             for name, value in _parameters(given).items()},
        ],
        output='screen',
    )
    if not with_rviz:
        return [bridge]
    return [bridge, _rviz(context, _fixed_frame(context, given, params_file))]


def _parameters(given: dict[str, str]) -> dict[str, str | Command]:
    parameters: dict[str, str | Command] = {name: value for name, value in given.items() if value}
    file = given['sdf_file']
    if file.endswith('.xacro'):
        # The file of a params file must not be set, too.
        parameters['sdf_file'] = ''
        parameters['robot_description'] = Command(
            ['xacro ', shlex.quote(file), ' ', LaunchConfiguration('xacro_arguments')],
            on_stderr='warn')
    return parameters


def _fixed_frame(context: LaunchContext, given: dict[str, str], params_file: str) -> str:
    """Return the root of the tree that the node will publish, or '' if it is not known."""
    values: dict[str, object] = {}
    if params_file:
        nodes = yaml.safe_load(Path(params_file).read_text(encoding='utf-8')) or {}
        for entries in nodes.values():
            values.update(entries.get('ros__parameters', {}))
    values.update({
        name: value if isinstance(value, str) else value.perform(context)
        for name, value in _parameters(given).items()})
    try:
        tree = loaded_scene_from_request(settings_from_values(values).load_request).tree
    except (SdfError, SettingsError, AddressError):
        # The node prints the error.
        return given['root_frame']
    return tree.fixed_frame


def _rviz(context: LaunchContext, fixed_frame: str) -> Node:
    namespace = LaunchConfiguration('namespace').perform(context).strip('/')
    return Node(
        package='rviz2',
        executable='rviz2',
        arguments=[
            '-d', PathJoinSubstitution([ThisLaunchFileDir(), '..', 'rviz', 'bridge.rviz']),
            *(['-f', fixed_frame] if fixed_frame else [])],
        remappings=[(VISUALS, f'/{namespace}{VISUALS}')] if namespace else [],
        output='screen',
    )
