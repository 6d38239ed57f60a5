# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The executables: one node with two names and two tables of defaults."""

from __future__ import annotations

from collections.abc import Container, Mapping
from typing import NamedTuple

from sdf_pose_bridge.ros.parameters import Value
from sdf_pose_bridge.ros.setting_rules import AUTO_KINDS


class Program(NamedTuple):
    """An executable."""

    node_name: str
    defaults: Mapping[str, Value]
    """The defaults of parameters that differ from the declared defaults."""
    usage: str
    takes_file: bool = False
    """Whether the command line may name a file, before the arguments of ROS."""
    known_elsewhere: Container[str] = ()
    """Names of parameters of older releases, which cause no warning. If there are any, files of
    parameters may be for other nodes too."""


BRIDGE = Program(
    'sdf_pose_bridge', {}, """\
Publish every frame of an SDFormat file on TF and on topics.

usage: ros2 run sdf_pose_bridge bridge --ros-args -p sdf_file:=cell.sdf [-p name:=value ...]

"ros2 param describe /sdf_pose_bridge <name>" explains each parameter of the running node.""")

ROBOT_STATE_PUBLISHER = Program(
    'robot_state_publisher',
    {
        'use_joint_states': True,
        'joint_states_topics': ['joint_states'],
        'publish_frequency': 20.0,
        'kinds': [AUTO_KINDS],
        'pose_topics': [],
        'publish_transforms': False,
        'publish_visuals': False,
        'publish_diagnostics': False,
    }, """\
Publish the frames of a robot in URDF or SDFormat, as the package robot_state_publisher does.

usage: ros2 run sdf_pose_bridge robot_state_publisher [robot.urdf] [--ros-args -p name:=value ...]

The text is the parameter robot_description. Without it, the file is robot.urdf or the parameter
sdf_file. "ros2 param describe /robot_state_publisher <name>" explains each parameter of
the running node.""", takes_file=True, known_elsewhere=('use_tf_static',))

PROGRAMS = {'bridge': BRIDGE, 'robot_state_publisher': ROBOT_STATE_PUBLISHER}
"""The executables by their names."""
