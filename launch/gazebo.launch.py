# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Start ros_gz_bridge and the node with the topics of a world or a spawned robot.

    ros2 launch sdf_pose_bridge gazebo.launch.py sdf_file:=world.sdf gazebo:=true rviz:=true

``sdf_pose gz_bridge`` writes the configuration of the bridge and the parameters of the node. For
the file of a robot that is spawned, add its name and that of the world:

    ros2 launch sdf_pose_bridge gazebo.launch.py sdf_file:=model.sdf \
        model_name:=x500_0 world_name:=default

xacro expands a file whose name ends with ``.xacro`` first, with ``xacro_arguments``.

Needs the package ros_gz_bridge.
"""

from __future__ import annotations

from pathlib import Path
import shlex
import shutil
import subprocess
import sys
import tempfile

from ament_index_python.packages import get_packages_with_prefixes
from launch import LaunchContext, LaunchDescription
from launch.actions import (
    DeclareLaunchArgument,
    ExecuteProcess,
    IncludeLaunchDescription,
    OpaqueFunction,
)
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution, ThisLaunchFileDir
from launch_ros.actions import Node

from sdf_pose_bridge.sdformat.include.uris import resource_finder

OPTIONS = {
    'model_name': 'Name under which the model of a model file is spawned; empty for a world.',
    'world_name': 'World in which it is spawned; empty for a world.',
    'only': 'Groups of topics, such as joints,sensors; all if empty.',
}
"""Arguments that are options of ``sdf_pose gz_bridge``."""


def generate_launch_description() -> LaunchDescription:
    """
    Describe the bridge and the node.

    :return: the arguments, the bridge and the node.
    """
    return LaunchDescription([
        DeclareLaunchArgument(
            'sdf_file', description='SDFormat file of the world, or of a robot that is spawned: a '
            'path, or a file://, package:// or model:// URI.'),
        *(DeclareLaunchArgument(name, default_value='', description=description)
          for name, description in OPTIONS.items()),
        DeclareLaunchArgument(
            'xacro_arguments', default_value='', description='Arguments for xacro, such as '
            'name:=value; for a file that ends with .xacro.'),
        DeclareLaunchArgument(
            'gazebo', default_value='false', description='Whether to start Gazebo with the file.'),
        DeclareLaunchArgument(
            'rviz', default_value='false',
            description='Whether to start RViz too; needs the package rviz2.'),
        OpaqueFunction(function=_actions),
    ])


def _actions(context: LaunchContext) -> list[ExecuteProcess | IncludeLaunchDescription]:
    if 'ros_gz_bridge' not in get_packages_with_prefixes():
        msg = ('gazebo.launch.py needs the package ros_gz_bridge, which is not installed: '
               'sudo apt install ros-$ROS_DISTRO-ros-gz-bridge')
        raise RuntimeError(msg)
    with_gazebo = IfCondition(LaunchConfiguration('gazebo')).evaluate(context)
    if with_gazebo and shutil.which('gz') is None:
        msg = 'gazebo:=true needs the program gz of Gazebo, which is not installed'
        raise RuntimeError(msg)
    given = {name: LaunchConfiguration(name).perform(context) for name in OPTIONS}
    path = str(resource_finder(()).path_from_address(
        LaunchConfiguration('sdf_file').perform(context)))
    options = [f'--{name.replace("_", "-")}={value}' for name, value in given.items() if value]
    folder = Path(tempfile.mkdtemp(prefix='sdf_pose_bridge_'))
    if path.endswith('.xacro'):
        # Files that it names are beside the original.
        options += ['-I', str(Path(path).absolute().parent)]
        expanded = str(folder / Path(path).name.removesuffix('.xacro'))
        arguments = shlex.split(LaunchConfiguration('xacro_arguments').perform(context))
        _run(['xacro', path, *arguments, '-o', expanded])
        path = expanded
    for name, further in ('bridge.yaml', ()), ('node.yaml', ('--node',)):
        warnings = _run([
            sys.executable, '-m', 'sdf_pose_bridge', 'gz_bridge', path, *options, *further,
            '-o', str(folder / name)])
    sys.stderr.write(warnings)
    return [
        *([ExecuteProcess(cmd=['gz', 'sim', '-r', path], output='screen')] if with_gazebo else []),
        Node(
            package='ros_gz_bridge',
            executable='parameter_bridge',
            parameters=[{'config_file': str(folder / 'bridge.yaml')}],
            output='screen',
        ),
        IncludeLaunchDescription(
            PathJoinSubstitution([ThisLaunchFileDir(), 'bridge.launch.py']),
            launch_arguments={
                'sdf_file': '', 'params_file': str(folder / 'node.yaml'),
                'rviz': LaunchConfiguration('rviz')}.items()),
    ]


def _run(command: list[str]) -> str:
    """Run a program; return its warnings."""
    written = subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False)
    if written.returncode:
        raise RuntimeError(written.stderr)
    return written.stderr
