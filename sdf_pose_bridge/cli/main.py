# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The command line ``sdf_pose``: one subcommand for each thing to be known of a file."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import os
import sys

from sdf_pose_bridge.cli import check as check_command
from sdf_pose_bridge.cli import convert as convert_command
from sdf_pose_bridge.cli import poses as poses_command


def main(arguments: Sequence[str] | None = None) -> int:
    """
    Run a subcommand.

    :param arguments: the words after the program's name; None for those it was called with.
    :return: the exit code: 0 if all went well, 1 if a file or a value was wrong, 2 if the call
        was.
    """
    parser = argparse.ArgumentParser(
        prog='sdf_pose',
        description='Poses and frames of SDFormat files, exactly as libsdformat resolves them.')
    subparsers = parser.add_subparsers(
        dest='command', required=True, metavar='COMMAND', title='commands')
    for command in (check_command, poses_command, convert_command):
        command.add_parser(subparsers)
    options = parser.parse_args(arguments)
    try:
        code: int = options.run(options)
        sys.stdout.flush()
    except BrokenPipeError:
        # The reader, such as head, has what it wanted; there is no one left to tell anything.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except KeyboardInterrupt:
        return 130
    return code
