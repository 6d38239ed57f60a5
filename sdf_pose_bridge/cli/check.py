# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose check``: print the errors and warnings of files."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import os
import sys

from sdf_pose_bridge.cli.loading import add_file_arguments
from sdf_pose_bridge.cli.loading import load_file
from sdf_pose_bridge.cli.printing import in_order
from sdf_pose_bridge.cli.printing import print_problems
from sdf_pose_bridge.cli.records import add_format_argument
from sdf_pose_bridge.cli.records import GITHUB
from sdf_pose_bridge.cli.records import JSON
from sdf_pose_bridge.cli.records import print_annotations
from sdf_pose_bridge.cli.records import print_json
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.names import shortened
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.include.uris import resource_finder


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command."""
    parser = subparsers.add_parser(
        'check', help='print the errors and warnings of files',
        description='Print every error and warning of files, one per line: FILE:LINE: CODE: '
                    'MESSAGE. The exit code is 1 if a file has an error.')
    add_file_arguments(parser)
    add_format_argument(parser, JSON, GITHUB)
    parser.add_argument(
        '--strict', action='store_true', help='the exit code is 1 for a warning too')
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """
    Check files.

    :return: exit code: 0 if all files are valid, else 1; if strict, 1 for warnings too.
    """
    exit_code = 0
    for path in options.files:
        loaded = load_file(path, options, shapes=True)
        if loaded.scene is not None:
            loaded = loaded._replace(warnings=in_order(
                loaded.warnings, _doubts_about_shapes(loaded.scene, options.resource_paths)))
        if options.format == JSON:
            print_json(path, loaded.errors, loaded.warnings)
        elif options.format == GITHUB:
            print_annotations(in_order(loaded.errors, loaded.warnings))
        else:
            print_problems(loaded.errors, loaded.warnings, sys.stdout)
        if loaded.errors or (options.strict and loaded.warnings):
            exit_code = 1
    return exit_code


def _doubts_about_shapes(scene: Scene, resource_paths: Sequence[str]) -> tuple[SdfWarning, ...]:
    """Return a warning for each shape without extent, and for each mesh that is not found."""
    finder = resource_finder(resource_paths, os.environ)
    reasons: dict[tuple[str, str], str] = {}
    doubts = []
    for element, shape in scene.shapes.items():
        place = scene.place(element)
        if not shape.has_extent:
            sizes = ' '.join(f'{size:g}' for size in shape.sizes_m or shape.mesh_scale)
            reason = f'a size or the scale of the {shape.type} is not a positive number ({sizes})'
        elif shape.mesh_uri:
            key = shape.mesh_uri, place.file
            if key not in reasons:
                is_found = finder.file_from_uri(*key) is not None
                reasons[key] = '' if is_found else (
                    f'the mesh "{shortened(shape.mesh_uri)}" is not found: '
                    f'{finder.reason_not_found(*key)}')
            reason = reasons[key]
        else:
            reason = ''
        if reason:
            doubts.append(SdfWarning('WARNING', reason, place))
    return tuple(doubts)
