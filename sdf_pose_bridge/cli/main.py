# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The command line ``sdf_pose``: a parser with one subcommand for each module of this room."""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
import contextlib
import importlib
import io
import os
import re
import signal
import sys
import time
from typing import Any, NoReturn

import sdf_pose_bridge
from sdf_pose_bridge.cli import check, convert, diff, graph, gz_bridge, poses, tree, urdf, view
from sdf_pose_bridge.cli import set as set_command
from sdf_pose_bridge.cli.printing import (
    CommandError,
    discard_output,
    print_message,
    print_problems,
)
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.geometry.formats import PoseFormatError
from sdf_pose_bridge.nearest_names import hint_from_names, NameIndex
from sdf_pose_bridge.process_limits import FOR_FILES, limited, LimitExceededError, open_streams

_NEGATIVE_NUMBER = re.compile(r'^-(\.?\d|inf|nan)', re.IGNORECASE)
_INVALID_CHOICE = re.compile(r"invalid choice: '(.*)' \(choose from (.*)\)")


def main(arguments: Sequence[str] | None = None) -> int:
    """
    Run a command.

    :param arguments: the arguments after the name of the program; by default from ``sys.argv``.
    :return: exit code: 0 for success, 1 if a file or a value is wrong, 2 if the arguments are.
    """
    parser = new_parser()
    options = parser.parse_args(arguments)
    open_streams()
    if isinstance(sys.stdout, io.TextIOWrapper):
        # A character that the terminal does not have must not end the command.
        sys.stdout.reconfigure(errors='backslashreplace')
    code = 0
    try:
        if options.version:
            print(f'sdf_pose {sdf_pose_bridge.__version__}')
        elif options.command is None:
            parser.print_help()
        else:
            # View calls a limited process instead, as its server needs threads and time.
            with contextlib.nullcontext() if options.run is view.run else _limited():
                code = options.run(options)
        sys.stdout.flush()
    except BrokenPipeError:
        # The reader, such as head, has closed the pipe.
        discard_output()
        return 1
    except OSError as error:
        if error.filename is not None:
            raise
        discard_output()
        reason = f'the output cannot be written: {(error.strerror or str(error)).lower()}'
    except (CommandError, PoseFormatError) as error:
        code, reason = getattr(error, 'exit_code', 1), str(error)
    except SdfError as error:
        print_problems(error.errors, error.warnings, sys.stderr)
        return 1
    except LimitExceededError as error:
        reason = f'this needs {error}'
    except MemoryError:
        reason = 'there is not enough memory'
    else:
        return code
    print_message(options.command, reason)
    return code or 1


@contextlib.contextmanager
def _limited() -> Iterator[None]:
    """Limit processor time and memory while the block runs; raise LimitExceededError."""
    def end(_number: int, _frame: object) -> NoReturn:
        msg = f'more than {time.process_time():.0f} s of processor time'
        raise LimitExceededError(msg)

    before = signal.signal(signal.SIGXCPU, end)
    try:
        with limited(FOR_FILES):
            yield
    finally:
        signal.signal(signal.SIGXCPU, before)


class _Parser(argparse.ArgumentParser):
    """Parses whole options only, and negative numbers such as -1e-3, as numbers."""

    def __init__(self, **arguments: Any) -> None:
        super().__init__(**arguments, allow_abbrev=False)
        self._negative_number_matcher = _NEGATIVE_NUMBER

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse arguments, all of which must be known: a command prints its own usage."""
        found, unknown = super().parse_known_args(args, namespace)
        if unknown:
            # The dashes would make short names look alike.
            names = [option.removeprefix('--') for option in self._option_string_actions]
            option = unknown[0].partition('=')[0].removeprefix('--')
            nearest = NameIndex({*names} - {'force'}).nearest(option)
            hint = f'; did you mean "--{nearest}"?' if nearest else ''
            if option == 'format' and '-o' in names:
                hint = '; -o writes the format of the ending of a file'
            self.error(f'unrecognized arguments: {" ".join(unknown)}{hint}')
        return found, unknown

    def error(self, message: str) -> NoReturn:
        """Print the error with the nearest choice, and end the process."""
        if wrong := _INVALID_CHOICE.search(message):
            choices = re.findall(r'\w+', wrong[2])
            is_file = 'check' in choices and os.path.isfile(wrong[1])  # noqa: PTH113 - of any length
            message += f'; did you mean "{self.prog} check {wrong[1]}"?' if is_file else (
                hint_from_names(wrong[1], choices))
        super().error(message)


def new_parser() -> argparse.ArgumentParser:
    """Return the parser of all commands."""
    parser = _Parser(
        prog='sdf_pose',
        description='Poses and frames of SDFormat files, exactly as libsdformat resolves them.')
    # The short name also makes the column of names wide enough for those of all commands.
    parser.add_argument('-V', '--version', action='store_true', help='show the version and exit')
    subparsers = parser.add_subparsers(dest='command', metavar='COMMAND', title='commands')
    for command in (check, poses, tree, graph, view, urdf, gz_bridge, convert, diff, set_command):
        name = command.__name__.rpartition('.')[2]
        subparser = subparsers.add_parser(name, help=command.HELP, description=command.DESCRIPTION)
        command.add_arguments(subparser)
        subparser.set_defaults(run=command.run)
    if '_ARGCOMPLETE' in os.environ:
        # The shell completes a command line. As for ros2, this needs argcomplete.
        with contextlib.suppress(ImportError):
            importlib.import_module('argcomplete').autocomplete(parser, exclude=['-h', '--help'])
    return parser
