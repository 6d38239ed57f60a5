# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose check``: print the errors and warnings of files."""

from __future__ import annotations

import argparse
import sys

from sdf_pose_bridge.cli.loading import add_file_arguments
from sdf_pose_bridge.cli.loading import load_file
from sdf_pose_bridge.cli.printing import print_problems
from sdf_pose_bridge.cli.printing import problems_in_order
from sdf_pose_bridge.cli.records import add_format_argument
from sdf_pose_bridge.cli.records import GITHUB
from sdf_pose_bridge.cli.records import JSON
from sdf_pose_bridge.cli.records import print_annotations
from sdf_pose_bridge.cli.records import print_json


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
        loaded = load_file(path, options)
        if options.format == JSON:
            print_json(path, loaded.errors, loaded.warnings)
        elif options.format == GITHUB:
            print_annotations(problems_in_order(loaded.errors, loaded.warnings))
        else:
            print_problems(loaded.errors, loaded.warnings, sys.stdout)
        if loaded.errors or (options.strict and loaded.warnings):
            exit_code = 1
    return exit_code
