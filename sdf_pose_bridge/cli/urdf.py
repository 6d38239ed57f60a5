# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose urdf``: write a model as URDF."""

from __future__ import annotations

import argparse
import sys

from sdf_pose_bridge.cli.arguments import (
    add_file_arguments,
    add_frame_arguments,
    add_output_argument,
    argument_type,
)
from sdf_pose_bridge.cli.input_files import scene_of
from sdf_pose_bridge.cli.printing import print_problems, write_text
from sdf_pose_bridge.export.urdf_text import urdf_from_scene

HELP = 'write a model as URDF, whose links are the frames of TF'
DESCRIPTION = (
    'Write a model as URDF, for RViz, MoveIt, ros2_control and other readers of '
    'robot_description. Its links are the frames that the node publishes for the '
    'model, at every position of its joints. Elements that URDF cannot express '
    'are left out, with a warning.')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_file_arguments(parser, takes_many=False)
    add_output_argument(parser, (), 'the URDF, instead of the standard output')
    add_frame_arguments(parser, 'make links of', 'write')
    parser.add_argument(
        '--frame-separator', metavar='TEXT', default='/', type=argument_type(
            str, 'must have at least one character, or names run together', bool),
        help='the text instead of "::" in the names of links; by default /')
    parser.add_argument(
        '--capsules', action='store_true',
        help='write <capsule>, which URDF has since version 1.2, instead of a cylinder and two '
             'spheres')


def run(options: argparse.Namespace) -> int:
    """Write a model of a file as URDF; return 0."""
    scene = scene_of(options.files[0], options, shapes=True)
    urdf = urdf_from_scene(
        scene, model=options.model, kinds=options.kinds, frame_names=options.frame_names,
        frame_separator=options.frame_separator, resource_paths=options.resource_paths,
        has_capsules=options.capsules)
    print_problems((), urdf.warnings, sys.stderr)
    write_text(urdf.text, options.output, scene.files)
    return 0
