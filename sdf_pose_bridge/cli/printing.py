# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Print problems and messages, for people or other programs, and write texts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain
import json
import os
from pathlib import Path
import shutil
import sys
import textwrap
from typing import Any, TextIO, TypeVar

from sdf_pose_bridge.errors import SdfError, SdfWarning, UriLookupError
from sdf_pose_bridge.file_change import replace_file
from sdf_pose_bridge.printed_text import printable
from sdf_pose_bridge.problems import by_message

_Problem = TypeVar('_Problem', bound='SdfError | SdfWarning')

_RED, _YELLOW, BOLD, DIM = '\x1b[31m', '\x1b[33m', '\x1b[1m', '\x1b[2m'


def styled(text: str, style: str, stream: TextIO) -> str:
    """Add a style on a terminal, unless ``NO_COLOR`` is set (https://no-color.org)."""
    has_styles = stream.isatty() and not os.environ.get('NO_COLOR')
    return f'{style}{text}\x1b[0m' if has_styles else text


def print_problems(
    errors: Sequence[SdfError], warnings: Sequence[SdfWarning], stream: TextIO, *,
    for_gazebo: bool = False,
) -> None:
    """
    Print errors and warnings in the order of files and lines; in color on a terminal.

    :param for_gazebo: whether to print warnings that concern Gazebo only; else their number.
    """
    hidden = [each for each in warnings if each.is_for_gazebo and not for_gazebo]
    if hidden:
        count = f'{len(hidden)} warning{"s" if hidden[1:] else ""}'
        print(f'{printable(hidden[0].place.file)}: "sdf_pose check" has {count} about Gazebo',
              file=stream)
    # Earlier output comes first, also if both streams go to one place.
    sys.stdout.flush()
    shown = [each for each in warnings if each not in hidden]
    for problem, other_lines in by_message(in_order(errors, shown)):
        is_error = isinstance(problem, SdfError)
        kind = '' if is_error or problem.code == 'WARNING' else 'WARNING: '
        place, message = printable(str(problem.place)), printable(problem.message)
        hint = '; here -I adds to resource_paths' if 'resource_paths' in message else ''
        if isinstance(problem, UriLookupError):
            hint += '; --skip-missing leaves it out'
        code = styled(f'{kind}{problem.code}:', _RED if is_error else _YELLOW, stream)
        print(f'{styled(f"{place}:", BOLD, stream)} {code} {message}{hint}{other_lines}',
              file=stream)


def in_order(*problems: Sequence[_Problem]) -> tuple[_Problem, ...]:
    """
    Sort errors and warnings.

    :param problems: some of them.
    :return: all of them, by file as the first ones, and by line; of one line the first argument
        comes first.
    """
    files = [problem.place.file for problem in chain(*problems)]
    return (*sorted(chain(*problems), key=lambda problem: (
        files.index(problem.place.file), problem.place.line)),)


def discard_output() -> None:
    """Discard pending output, so that the end of the process does not fail again."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


class CommandError(Exception):
    """A command fails; the arguments are the reason and the exit code."""

    def __init__(self, reason: str, exit_code: int = 1) -> None:
        super().__init__(reason)
        self.exit_code = exit_code


def print_message(command: str | None, message: str) -> None:
    """Print a sentence of a command to standard error; on a terminal words are not cut."""
    text = f'{" ".join(filter(None, ("sdf_pose", command)))}: {printable(message)}'
    if sys.stderr.isatty():
        text = textwrap.fill(
            text, shutil.get_terminal_size().columns, subsequent_indent='  ',
            break_long_words=False, break_on_hyphens=False)
    print(text, file=sys.stderr)


def write_text(text: str, path: Path | None, inputs: Iterable[str]) -> None:
    """Write a file that is none of the inputs, or the standard output if there is no path."""
    if path is None:
        print(text, end='')
    else:
        replace_file(str(path), None, text.encode(), inputs)


def print_json(
    path: str, errors: Sequence[SdfError], warnings: Sequence[SdfWarning], **content: Any,
) -> None:
    """Print a line with a JSON object about a file, and its content."""
    print(json.dumps({
        'file': path, 'ok': not errors, 'errors': [*map(_problem, errors)],
        'warnings': [*map(_problem, warnings)], **content}))


def _problem(problem: SdfError | SdfWarning) -> dict[str, Any]:
    return {'code': problem.code, 'message': problem.message, **problem.place._asdict()}
