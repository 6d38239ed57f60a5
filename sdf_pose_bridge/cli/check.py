# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose check``: print errors and warnings of files; other commands load files like it."""

from __future__ import annotations

import argparse
import os
import sys
from typing import NamedTuple
from typing import TextIO

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.scene.loading import MissingInclude
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.limits import Usage
from sdf_pose_bridge.sdformat.xml_file import bytes_from_file

_RED, _YELLOW, _BOLD, _PLAIN = '\x1b[31m', '\x1b[33m', '\x1b[1m', '\x1b[0m'


class LoadedFile(NamedTuple):
    """Result of loading a file."""

    scene: Scene | None
    """None if the file is not valid."""
    errors: tuple[SdfError, ...]
    warnings: tuple[SdfWarning, ...]


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command."""
    parser = subparsers.add_parser(
        'check', help='print the errors and warnings of files',
        description='Print every error and warning of files, one per line: FILE:LINE: CODE: '
                    'MESSAGE. The exit code is 1 if a file has an error.')
    add_file_arguments(parser)
    parser.add_argument(
        '--strict', action='store_true', help='the exit code is 1 for a warning too')
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """
    Check files.

    :return: exit code: 0 if all files are valid, else 1; if strict, 1 for warnings too.
    """
    are_valid = True
    for path in options.files:
        loaded = load_file(path, options)
        print_problems(loaded.errors, loaded.warnings, sys.stdout)
        are_valid = are_valid and loaded.scene is not None and not (
            options.strict and loaded.warnings)
    return 0 if are_valid else 1


def add_file_arguments(parser: argparse.ArgumentParser, *, takes_many: bool = True) -> None:
    """
    Add the arguments of :func:`load_file`.

    :param takes_many: whether the command takes several files.
    """
    parser.add_argument(
        'files', metavar='FILE', nargs='+' if takes_many else 1, help='an SDFormat file')
    parser.add_argument(
        '-I', dest='resource_paths', metavar='DIR', action='append', default=[],
        help='a directory to search for included models, before those of GZ_SIM_RESOURCE_PATH '
             'and SDF_PATH; may be given more than once')
    parser.add_argument(
        '--skip-missing', action='store_true',
        help='leave out includes that are not found, with a warning')


def load_file(path: str, options: argparse.Namespace, *, shapes: bool = False) -> LoadedFile:
    """
    Load a file, or what a pipe such as that of the shell's ``<(command)`` holds.

    :return: the scene with its warnings, or the errors of the file.
    """
    missing = MissingInclude.SKIP if options.skip_missing else MissingInclude.ERROR
    try:
        text = bytes_from_file(path, Usage(), allows_pipe=True)
        scene = load_text(
            text, path, resource_paths=options.resource_paths, on_missing_include=missing,
            shapes=shapes)
    except SdfError as error:
        return LoadedFile(None, error.errors, error.warnings)
    return LoadedFile(scene, (), scene.warnings)


def is_colored(stream: TextIO) -> bool:
    """
    Return whether to print colors.

    :param stream: where they would be printed.
    :return: True for a terminal, unless the variable ``NO_COLOR`` is set (https://no-color.org).
    """
    return stream.isatty() and not os.environ.get('NO_COLOR')


def print_problems(
    errors: tuple[SdfError, ...], warnings: tuple[SdfWarning, ...], stream: TextIO,
) -> None:
    """Print errors and warnings, one per line; in color on a terminal."""
    has_colors = is_colored(stream)
    bold, plain = (_BOLD, _PLAIN) if has_colors else ('', '')
    problems: list[SdfError | SdfWarning] = [*errors, *warnings]
    for problem in problems:
        is_error = isinstance(problem, SdfError)
        color = '' if not has_colors else _RED if is_error else _YELLOW
        kind = '' if is_error or problem.code == 'WARNING' else 'WARNING: '
        place, message = printable(str(problem.place)), printable(problem.message)
        print(f'{bold}{place}:{plain} {color}{kind}{problem.code}:{plain} {message}', file=stream)
