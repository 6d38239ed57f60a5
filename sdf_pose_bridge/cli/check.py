# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose check``: say what is wrong with files."""

from __future__ import annotations

import argparse
import os
import sys
from typing import TextIO

from sdf_pose_bridge.cli.files import add_file_arguments
from sdf_pose_bridge.cli.files import load_file
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.errors import SdfWarning

_RED, _YELLOW, _BOLD, _PLAIN = '\x1b[31m', '\x1b[33m', '\x1b[1m', '\x1b[0m'


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """
    Declare the command.

    :param subparsers: where the commands are declared.
    """
    parser = subparsers.add_parser(
        'check', help='say what is wrong with files',
        description='Read files and print every error and warning in them, a line each: '
                    'FILE:LINE: CODE: what is wrong. The exit code is 1 if a file has an error.')
    add_file_arguments(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """
    Check files.

    :param options: what was parsed.
    :return: 0 if all are valid, else 1.
    """
    is_valid = True
    for path in options.files:
        loaded = load_file(path, options)
        print_problems(loaded.errors, loaded.warnings, sys.stdout)
        is_valid = is_valid and loaded.scene is not None
    return 0 if is_valid else 1


def print_problems(
    errors: tuple[SdfError, ...], warnings: tuple[SdfWarning, ...], stream: TextIO,
) -> None:
    """
    Print errors and warnings, a line each, in colour on a terminal.

    :param errors: the errors of a file.
    :param warnings: its warnings.
    :param stream: where to print them.
    """
    is_coloured = stream.isatty() and not os.environ.get('NO_COLOR')
    bold, plain = (_BOLD, _PLAIN) if is_coloured else ('', '')
    problems: list[SdfError | SdfWarning] = [*errors, *warnings]
    for problem in problems:
        is_error = isinstance(problem, SdfError)
        colour = '' if not is_coloured else _RED if is_error else _YELLOW
        kind = '' if is_error or problem.code == 'WARNING' else 'WARNING: '
        print(f'{bold}{problem.place}:{plain} {colour}{kind}{problem.code}:{plain} '
              f'{problem.message}', file=stream)
