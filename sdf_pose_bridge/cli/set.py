# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose set``: write a measured pose into the file that places a frame."""

from __future__ import annotations

import argparse
import re
import sys

from sdf_pose_bridge.cli.arguments import add_file_arguments
from sdf_pose_bridge.cli.frames import MOST_MOVED
from sdf_pose_bridge.cli.given_poses import (
    add_given_unit_arguments,
    formats_help,
    PoseReader,
    poses_from_rows,
)
from sdf_pose_bridge.cli.input_files import loader, scene_of, STANDARD_INPUT, told_on_terminal
from sdf_pose_bridge.cli.printing import CommandError, print_message
from sdf_pose_bridge.export.pose_setting import are_close, pose_change
from sdf_pose_bridge.geometry.pose_texts import FORMATS
from sdf_pose_bridge.geometry.poses import Pose, pose_product
from sdf_pose_bridge.names import scoped_name
from sdf_pose_bridge.printed_text import listed, printable
from sdf_pose_bridge.tf.comparison import names_of_moved
from sdf_pose_bridge.tf.lookup import lookup_from_scene

HELP = 'write a measured pose into a file'
DESCRIPTION = (
    'Change the numbers of the <pose> that places a frame to a measured pose.\n'
    'Nothing else in the file changes. The change, and the other frames that move\n'
    'with it, are printed.')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = formats_help()
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    add_file_arguments(parser, takes_many=False)
    parser.add_argument(
        'frame', metavar='FRAME', help='a name as in SDF (robot::camera) or TF (robot/camera)')
    parser.add_argument('numbers', metavar='NUMBER', nargs='+', help='the pose')
    parser.add_argument(
        '--by', metavar='PART', default='',
        help='the pose of another frame was measured, which moves with FRAME, such as a nest of a '
             'fixture: the name of that frame, also without the name of FRAME')
    parser.add_argument(
        '--relative-to', metavar='OTHER', default='',
        help='the frame in which the pose was measured; by default the world, or the implicit '
             'root of a model file')
    parser.add_argument(
        '--format', metavar='FORMAT',
        help='format of the numbers; by default the one that the text names, or sdf_rpy: x y z '
             'roll pitch yaw in metres and radians. With a format of rotations the position '
             'stays, with three numbers and no format the rotation')
    add_given_unit_arguments(parser)
    parser.add_argument(
        '--force', action='store_true',
        help='write a quaternion whose length is not 1')
    parser.add_argument(
        '--dry-run', action='store_true', help='print the change without writing it')
    parser.add_argument(
        '--all-instances', action='store_true',
        help='accept that all instances of a file that is included more than once move')


def run(options: argparse.Namespace) -> int:
    """Write a pose into the file that places a frame; return 0."""
    if options.files[0] == STANDARD_INPUT:
        msg = 'the standard input cannot be changed; name a file'
        raise CommandError(msg)
    reader = PoseReader(options.format, options, FORMATS['sdf_rpy'])
    text = ' '.join(options.numbers)
    is_position = not options.format and len(re.findall(r'[^\s,;()\[\]{}]+', text)) == 3
    if is_position:
        if options.given_angle:
            msg = f'three numbers are a position, so leave out --{options.given_angle.text}'
            raise CommandError(msg)
        text += ', 0, 0, 0' if ',' in text else ' 0 0 0'
    numbers, source, notes, _ = reader.read(text)
    for note in notes:
        print_message(options.command, note)
    given = Pose(*poses_from_rows([numbers], source)[0].tolist())
    if doubt := source.doubt(numbers, is_written=not options.force, dashes='--'):
        units = (not is_position and source.angle, source.position and source.length)
        keep = ' '.join(f'--{unit.text}' for unit in units if unit) if '?' in doubt else '--force'
        msg = f'{doubt} ({keep} writes them as they are)'
        raise CommandError(msg)
    scene = scene_of(options.files[0], options)
    lookup = lookup_from_scene(scene)
    element, _ = lookup.element(options.frame)
    own_name = scene.names[element]
    part = options.by or options.frame
    if options.by and scene.has(scoped_name(own_name, options.by)):
        part = scoped_name(own_name, options.by)
    current = lookup.pose(part, options.relative_to).pose
    asked = Pose(*(given if source.position else current)[:3],
                 *(current if is_position else given)[3:])
    with told_on_terminal(options.files[0]):
        change = pose_change(
            scene, element, pose_product(asked, lookup.pose_of_element(element, part)),
            lookup_from_scene, loader(options.files[0], options), relative_to=options.relative_to,
            all_instances=options.all_instances)
    if options.by and not are_close(
            lookup_from_scene(change.scene).pose(part, options.relative_to).pose, asked):
        msg = f'"{part}" does not move with "{printable(own_name)}"'
        raise CommandError(msg)
    moved = [name for name in names_of_moved(scene, change.scene) if name != own_name]
    if change.file.path != scene.files[0]:
        print(f'the pose is in {printable(change.file.path)}')
    print(change.file.diff or (
        f'"{printable(own_name)}" has this pose already; the file stays as it is\n'), end='')
    if b'autogenerated by xacro' in change.file.before:
        msg = 'xacro wrote this file, and overwrites it when it runs again'
        print_message(options.command, msg)
    if moved:
        print(f'moved with it: {listed([*map(printable, moved)], MOST_MOVED)}')
    # If the change cannot be printed, nothing is written.
    sys.stdout.flush()
    if not options.dry_run:
        change.file.write()
    return 0
