# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose poses``: print the poses of files."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import math

import numpy as np

from sdf_pose_bridge.cli.arguments import (
    add_digits_argument,
    add_file_arguments,
    add_format_argument,
    add_kinds_argument,
    add_reference_argument,
    add_unit_arguments,
    argument_type,
)
from sdf_pose_bridge.cli.frames import Frame, print_frames, TableRow
from sdf_pose_bridge.cli.input_files import sdf_name
from sdf_pose_bridge.errors import JointPositionError, SdfWarning
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.joint_motion import JointMotion
from sdf_pose_bridge.tf.joint_positions import JointPositions, scene_at_positions
from sdf_pose_bridge.tf.parents import tf_parents_from_scene

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
            _position_from_text, 'is not NAME=VALUE with a number, such as elbow=90deg'),
        help='position of a joint, such as 90deg, 1.57rad, 5mm or 0.005m, by default in radians '
             'or metres; all others stay at zero. May be repeated. Names are as in joint_states: '
             'elbow, arm/elbow, wrist_axis2, ball_roll')
    add_kinds_argument(parser, 'print only')
    add_unit_arguments(parser)
    add_digits_argument(parser)


def run(options: argparse.Namespace) -> int:
    """Print the poses of files; return 0 if all files are valid, else 1."""
    return print_frames(
        options, 'elements', ('file', 'world', 'kind', 'name', *Pose._fields), _elements)


def _position_from_text(text: str) -> tuple[str, float, str]:
    """Return a name, a number, and a unit or an empty text."""
    name, _, value = text.rpartition('=')
    unit = next((unit for unit in ('rad', 'deg', 'mm', 'm') if value.endswith(unit)), '')
    return name, float(value.removesuffix(unit)), unit


def _at_positions(
    scene: Scene, given: Sequence[tuple[str, float, str]], warnings: list[SdfWarning],
) -> Scene:
    """Return the scene with its joints at given positions; warn of doubtful units."""
    motion = JointMotion(scene, tf_parents_from_scene(scene))
    values = {name: value for name, value, _ in given}
    selection = JointPositions(scene, motion).selection([name for name, *_ in given])
    doubts, names = [], dict[int, str]()
    for row, index in zip(selection.rows.tolist(), selection.dofs.tolist(), strict=True):
        (name, value, unit), dof = given[row], motion.dofs[index]
        place, lower, upper = scene.place(dof.joint.element), dof.axis.lower, dof.axis.upper
        units = {'rad': 1.0, 'deg': math.radians(1.0)} if dof.rad_per_unit else {
            'm': 1.0, 'mm': 1e-3}
        msg = ''
        if index in names:
            msg = f'"{names[index]}" and "{name}" are one joint, which has one position'
        elif unit and unit not in units:
            msg = f'the position of "{name}" is in {" or ".join(units)}, not in {unit}'
        if msg:
            raise JointPositionError(msg, place)
        names[index], values[name] = name, value * units.get(unit, 1.0)
        is_doubtful = abs(value) > 2.0 * math.pi if math.isinf(upper - lower) else (
            not lower <= value <= upper and lower <= math.radians(value) <= upper)
        if dof.rad_per_unit and not unit and is_doubtful:
            doubts.append(SdfWarning('WARNING', (
                f'the position {value:g} of "{name}" is {value:g} rad, which are '
                f'{math.degrees(value):g} degrees; did you mean {name}={value:g}deg? '
                f'{name}={value:g}rad confirms the unit'), place))
    moved = scene_at_positions(scene, values)
    warnings[:] = *moved.warnings, *doubts
    return moved


def _elements(
    scene: Scene, options: argparse.Namespace, warnings: list[SdfWarning],
) -> list[Frame]:
    if options.positions:
        scene = _at_positions(scene, options.positions, warnings)
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
