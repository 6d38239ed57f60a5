# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose set``: write a measured pose into the file that places a frame."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
import sys

from sdf_pose_bridge.cli.convert import NEGATIVE_NUMBER, numbers_from_text
from sdf_pose_bridge.cli.loading import (
    add_file_arguments,
    pose_lookup,
    scene_from_file,
    scene_of,
    STANDARD_INPUT,
)
from sdf_pose_bridge.cli.printing import CommandError, discard_output
from sdf_pose_bridge.geometry.formats import (
    converted_poses,
    converted_rotations,
    POSE_FORMATS,
    ROTATION_FORMATS,
)
from sdf_pose_bridge.geometry.poses import Pose, pose_inverse, pose_product
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.scene.comparison import names_of_moved
from sdf_pose_bridge.scene.pose_setting import Measure, pose_change, PoseChange
from sdf_pose_bridge.scene.scene import Scene


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command."""
    parser = subparsers.add_parser(
        'set', help='write a measured pose into a file',
        description='Change the numbers of the <pose> that places a frame to a measured pose. '
                    'Nothing else in the file changes. The change, and the other frames that move '
                    'with it, are printed.')
    # By default argparse parses -1e-3 as an option.
    parser._negative_number_matcher = NEGATIVE_NUMBER  # noqa: SLF001
    add_file_arguments(parser, takes_many=False)
    parser.add_argument(
        'frame', metavar='FRAME', help='a name as in SDF (robot::camera) or TF (robot/camera)')
    parser.add_argument('numbers', metavar='NUMBER', nargs='+', help='the pose')
    parser.add_argument(
        '--relative-to', metavar='OTHER', default='',
        help='the frame in which the pose was measured; by default the world, or the implicit '
             'root of a model file')
    parser.add_argument(
        '--format', choices=(*POSE_FORMATS, *ROTATION_FORMATS), default='sdf_rpy',
        help='format of the numbers, as of "sdf_pose convert"; by default sdf_rpy: x y z roll '
             'pitch yaw in metres and radians. With a format of rotations the position stays')
    parser.add_argument(
        '--dry-run', action='store_true', help='print the change without writing it')
    parser.add_argument(
        '--all-instances', action='store_true',
        help='accept that all instances of a file that is included more than once move')
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """
    Set a pose.

    :return: exit code: 0.
    :raises CommandError: for the standard input.
    :raises PoseFormatError: if the numbers are wrong.
    :raises SdfError: if the pose cannot be written into the file.
    """
    if options.files[0] == STANDARD_INPUT:
        msg = 'the standard input cannot be changed; name a file'
        raise CommandError(msg)
    numbers = numbers_from_text(
        ' '.join(options.numbers), {**POSE_FORMATS, **ROTATION_FORMATS}[options.format])
    scene = scene_of(options.files[0], options)

    def measured(scene: Scene, element: int) -> Pose:
        return pose_lookup(scene).pose_of_element(element, options.relative_to)

    lookup = pose_lookup(scene)
    element, in_element = lookup.element(options.frame)
    if options.format in POSE_FORMATS:
        asked = Pose(*converted_poses(numbers, options.format, 'sdf_quat_xyzw').tolist())
    else:
        quat_xyzw = converted_rotations(numbers, options.format, 'quaternion').tolist()
        position = lookup.pose(options.frame, options.relative_to).pose[:3]
        asked = Pose(*position, *quat_xyzw)
    change = set_pose(
        scene, element, pose_product(asked, pose_inverse(in_element)), measured, options,
        all_instances=options.all_instances, dry_run=options.dry_run)
    moved = [
        printable(name) for name in names_of_moved(scene, change.scene)
        if name != scene.names[element]]
    try:
        if change.file.path != scene.files[0]:
            print(f'the pose is in {printable(change.file.path)}')
        print(change.file.diff, end='')
        if moved:
            print(f'moved with it: {", ".join(moved)}')
        sys.stdout.flush()
    except OSError as error:
        if options.dry_run:
            raise
        discard_output()
        print(f'sdf_pose set: {printable(change.file.path)} has the new pose, but the change '
              f'cannot be printed: {(error.strerror or str(error)).lower()}', file=sys.stderr)
    return 0


def set_pose(
    scene: Scene, element: int, asked: Pose, measure: Measure, options: argparse.Namespace, *,
    all_instances: bool = False, dry_run: bool = False,
) -> PoseChange:
    """
    Write the pose of an element into its file.

    :param asked: the pose, as ``measure`` shall return it.
    :param options: the arguments with which the scene was loaded.
    :param all_instances: whether other elements that the same ``<pose>`` places may move too.
    :param dry_run: whether nothing is written.
    :return: the change of the file.
    :raises SdfError: if the pose cannot be written into the file.
    """
    def loaded(texts: Mapping[str, bytes]) -> Scene:
        return scene_from_file(options.files[0], options, texts=texts)

    change = pose_change(scene, element, asked, measure, loaded, all_instances=all_instances)
    if not dry_run:
        change.file.write()
    return change
