# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose poses``: print the poses of files."""

from __future__ import annotations

import argparse
import sys
from typing import Any

import numpy as np

from sdf_pose_bridge.cli.loading import (
    add_file_arguments,
    add_kinds_argument,
    load_file,
    LoadedFile,
    sdf_name,
)
from sdf_pose_bridge.cli.printing import (
    add_unit_arguments,
    DEGREES,
    print_problems,
    print_table,
    TableRow,
    Units,
)
from sdf_pose_bridge.cli.records import (
    add_format_argument,
    CSV,
    JSON,
    print_csv,
    print_csv_header,
    print_json,
)
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.joint_positions import scene_at_positions

_COLUMNS = ('file', 'world', 'kind', 'name', 'x', 'y', 'z', 'qx', 'qy', 'qz', 'qw')


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command."""
    parser = subparsers.add_parser(
        'poses', help='print the poses of files',
        description='Print the pose of every element of files, x y z roll pitch yaw, in the world '
                    'or in the implicit root of a model file; --format csv and json have all '
                    'digits and quaternions. The exit code is 1 if a file has an error.')
    add_file_arguments(parser)
    add_format_argument(parser, CSV, JSON)
    parser.add_argument(
        '--json', dest='format', action='store_const', const=JSON,
        help='the same as --format json')
    parser.add_argument(
        '--relative-to', metavar='FRAME', default='',
        help='print poses relative to this frame, by its name in SDF (robot::hand) or TF '
             '(robot/hand)')
    parser.add_argument(
        '--joint', metavar='NAME=VALUE', type=_position_from_text, action='append', default=[],
        dest='positions',
        help='position of a joint, in radians or metres; all others stay at zero. May be '
             'repeated. Names are as in joint_states: elbow, arm/elbow, wrist_axis2, ball_roll')
    add_kinds_argument(parser, 'print only')
    add_unit_arguments(parser, DEGREES)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """
    Print the poses of files; continue after an invalid file.

    :return: exit code: 0 if all files are valid, else 1.
    """
    are_valid, units = True, Units(options.length_unit, options.angle_unit)
    if options.format == CSV:
        print_csv_header(_COLUMNS)
    for path in options.files:
        loaded = load_file(path, options)
        elements: list[dict[str, Any]] = []
        if loaded.scene is not None:
            try:
                scene = scene_at_positions(loaded.scene, dict(options.positions)) if (
                    options.positions) else loaded.scene
                loaded = LoadedFile(scene, (), scene.warnings)
                elements = _elements(scene, options)
            except SdfError as error:
                loaded = LoadedFile(None, error.errors, loaded.warnings)
        are_valid = are_valid and loaded.scene is not None
        if options.format == JSON:
            print_json(path, loaded.errors, loaded.warnings, elements=elements)
            continue
        print_problems(loaded.errors, loaded.warnings, sys.stderr)
        if options.format == CSV:
            print_csv(_COLUMNS, (
                {'file': path, **element, **dict(zip(_COLUMNS[4:], element['pose'], strict=True))}
                for element in elements))
        elif not loaded.errors:
            if len(options.files) > 1:
                print(printable(path))
            has_worlds = len({element['world'] for element in elements}) > 1
            print_table(units.labels, [
                TableRow(
                    f'{element["world"]}: {element["name"]}' if has_worlds else element['name'],
                    element['kind'], units.texts(Pose(*element['pose']), fewer_digits=1))
                for element in elements])
    return 0 if are_valid else 1


def _position_from_text(text: str) -> tuple[str, float]:
    name, _, value = text.rpartition('=')
    try:
        return name, float(value)
    except ValueError:
        msg = f'"{text}" is not NAME=VALUE with a number, such as elbow=1.57'
        raise argparse.ArgumentTypeError(msg) from None


def _elements(scene: Scene, options: argparse.Namespace) -> list[dict[str, Any]]:
    elements = []
    reference = sdf_name(scene, options.relative_to)
    for index in np.flatnonzero(np.isin(scene.kinds, options.kinds)).tolist():
        world = scene.world_of(index)
        pose = scene.pose_of(index) if not reference else scene.relative_pose_of(
            index, scene.index(reference, world=world))
        elements.append({
            'kind': Kind(scene.kinds[index]).label, 'name': scene.names[index], 'world': world,
            'pose': list(pose)})
    return elements
