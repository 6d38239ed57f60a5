# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose poses``: print the poses of files."""

from __future__ import annotations

import argparse

import numpy as np

from sdf_pose_bridge.cli.arguments import (
    add_file_arguments,
    add_format_argument,
    add_kinds_argument,
    add_reference_argument,
    add_unit_arguments,
    argument_type,
)
from sdf_pose_bridge.cli.frames import Frame, print_frames, TableRow
from sdf_pose_bridge.cli.loading import sdf_name
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.joint_positions import scene_at_positions

HELP = 'print the poses of files'
DESCRIPTION = (
    'Print the pose of every element of files, x y z roll pitch yaw, in the world '
    'or in the implicit root of a model file; --format csv and json have all '
    'digits and quaternions. The exit code is 1 if a file has an error.')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_file_arguments(parser)
    add_format_argument(parser, 'csv', 'json')
    parser.add_argument(
        '--json', dest='format', action='store_const', const='json',
        help='the same as --format json')
    add_reference_argument(parser, 'print')
    parser.add_argument(
        '--joint', metavar='NAME=VALUE', action='append', default=[], dest='positions',
        type=argument_type(
            _position_from_text, 'is not NAME=VALUE with a number, such as elbow=1.57'),
        help='position of a joint, in radians or metres; all others stay at zero. May be '
             'repeated. Names are as in joint_states: elbow, arm/elbow, wrist_axis2, ball_roll')
    add_kinds_argument(parser, 'print only')
    add_unit_arguments(parser)


def run(options: argparse.Namespace) -> int:
    """Print the poses of files; return 0 if all files are valid, else 1."""
    return print_frames(
        options, 'elements', ('file', 'world', 'kind', 'name', *Pose._fields), _elements)


def _position_from_text(text: str) -> tuple[str, float]:
    name, _, value = text.rpartition('=')
    return name, float(value)


def _elements(
    scene: Scene, options: argparse.Namespace, warnings: list[SdfWarning],
) -> list[Frame]:
    if options.positions:
        scene = scene_at_positions(scene, dict(options.positions))
        warnings[:] = scene.warnings
    elements: list[Frame] = []
    reference = sdf_name(scene, options.relative_to)
    chosen = np.flatnonzero(np.isin(scene.kinds, options.kinds)).tolist()
    has_worlds = len(set(map(scene.world_of, chosen))) > 1
    for index in chosen:
        name, kind, world = (
            scene.names[index], Kind(scene.kinds[index]).label, scene.world_of(index))
        pose = scene.pose_of(index) if not reference else scene.relative_pose_of(
            index, scene.index(reference, world=world))
        elements.append((
            {'kind': kind, 'name': name, 'world': world, 'pose': pose},
            TableRow(f'{world}: {name}' if has_worlds else name, kind)))
    return elements
