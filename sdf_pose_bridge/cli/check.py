# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose check``: print the errors and warnings of files."""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Iterable, Sequence
from functools import cache
import re
import sys

from sdf_pose_bridge.cli.arguments import add_file_arguments, add_format_argument
from sdf_pose_bridge.cli.input_files import doubts_about_frames, load_file
from sdf_pose_bridge.cli.printing import in_order, print_json, print_problems
from sdf_pose_bridge.errors import Place, SdfError, SdfWarning
from sdf_pose_bridge.printed_text import printable, shortened
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.include.uris import resource_finder

_END_OF_FOLDER = re.compile('(?<=[^/:])/')
"""The end of a package, model or folder in a URI."""

_MOST_MISSING = 50
"""Largest number of missing meshes, or folders of them, after which no more are looked for."""

_ESCAPES = str.maketrans({'%': '%25', '\r': '%0D', '\n': '%0A'})
_ESCAPES_OF_PROPERTIES = {**_ESCAPES, **str.maketrans({':': '%3A', ',': '%2C'})}

HELP = 'print the errors and warnings of files'
DESCRIPTION = (
    'Print every error and warning of files, one per line: FILE:LINE: CODE: '
    'MESSAGE. The exit code is 1 if a file has an error.')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    add_file_arguments(parser)
    add_format_argument(parser, 'json', 'github')
    parser.add_argument(
        '--strict', action='store_true', help='the exit code is 1 for a warning too')


def run(options: argparse.Namespace) -> int:
    """Check files; return 0 if all are valid, else 1; if strict, 1 for warnings too."""
    exit_code = 0
    for path in options.files:
        scene, errors, warnings = load_file(path, options, shapes=True)
        if scene is not None:
            warnings = in_order(
                warnings, doubts_about_frames(scene),
                _doubts_about_shapes(scene, options.resource_paths))
        if options.format == 'json':
            print_json(path, errors, warnings)
        elif options.format == 'github':
            _print_annotations(in_order(errors, warnings))
        else:
            print_problems(errors, warnings, sys.stdout, for_gazebo=True)
        if errors or (options.strict and warnings):
            exit_code = 1
    return exit_code


def _doubts_about_shapes(scene: Scene, resource_paths: Sequence[str]) -> tuple[SdfWarning, ...]:
    # A shape of a file that is included often has one warning, as all meshes of a missing package.
    finder = resource_finder(resource_paths)
    problems = Problems(scene.files)
    places: dict[tuple[str, str], Place] = {}
    for element, shape in scene.shapes.items():
        place = scene.place(element)
        if not shape.has_extent:
            sizes = ' '.join(f'{size:g}' for size in shape.sizes_m or shape.mesh_scale)
            msg = f'a size or the scale of the {shape.type} is not a positive number ({sizes})'
            problems.warning(msg, place)
        elif shape.mesh_uri:
            key = shape.mesh_uri, place.file
            places[key] = min(place, places.get(key, place), key=lambda each: each.line)
    missing: defaultdict[tuple[str, str], list[str]] = defaultdict(list)
    path_from_uri = cache(finder.path_from_uri)
    waiting = iter(sorted(places, key=lambda key: places[key].line))
    for uri, file in waiting:
        # Most missing files are in missing folders, of which there are fewer. Each model of Fuel
        # is fetched by itself.
        folders = [uri.partition('/files/')[0]] if uri.lower().startswith('http') else [
            uri[:end.start()] for end in _END_OF_FOLDER.finditer(uri)]
        part = next((each for each in folders if path_from_uri(each, file) is None), uri)
        if part != uri or finder.file_from_uri(uri, file) is None:
            missing[part, file].append(uri)
        if len(missing) == _MOST_MISSING:
            break
    for (folder, file), uris in missing.items():
        others = f', like {len(uris) - 1} more of "{shortened(folder)}"' if uris[1:] else ''
        problems.warning(
            f'the mesh "{shortened(uris[0])}" is not found{others}: '
            f'{finder.reason_not_found(uris[0], file)}', places[uris[0], file])
    if rest := list(waiting):
        problems.warning(
            f'this mesh and those that follow, {len(rest)} in all, are not looked for, as '
            f'{_MOST_MISSING} are missing', places[rest[0]])
    return problems.warnings


def _print_annotations(problems: Iterable[SdfError | SdfWarning]) -> None:
    # Source of the syntax and the escapes: "Workflow commands for GitHub Actions" of its
    # documentation, and ``command.ts`` of its toolkit.
    for problem in problems:
        level = 'error' if isinstance(problem, SdfError) else 'warning'
        place = problem.place
        line = f',line={place.line}' if place.line else ''
        print(f'::{level} file={printable(place.file).translate(_ESCAPES_OF_PROPERTIES)}{line},'
              f'title={problem.code}::{printable(problem.message).translate(_ESCAPES)}')
