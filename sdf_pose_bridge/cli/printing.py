# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Print problems and tables, for people or other programs: colors, formats and files."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Mapping, Sequence
import contextlib
import csv
from itertools import chain
import json
import os
from pathlib import Path
import shutil
import sys
import textwrap
from typing import Any, NamedTuple, TextIO, TypeAlias, TypeVar

from sdf_pose_bridge.errors import SdfError, SdfWarning, UriLookupError
from sdf_pose_bridge.geometry.units import DEGREES, METRES, MILLIMETRES, RADIANS
from sdf_pose_bridge.names import printable, shortened
from sdf_pose_bridge.problems import by_message

_FORMATS = {
    'text': 'for people, the default',
    'csv': 'comma-separated values with a header, in metres and radians',
    'json': 'one object per file and line, in metres and radians',
    'github': 'annotations that GitHub shows in a review',
}

_Problem = TypeVar('_Problem', bound='SdfError | SdfWarning')

_RED, _YELLOW, _BOLD, _DIM = '\x1b[31m', '\x1b[33m', '\x1b[1m', '\x1b[2m'


def _styled(text: str, style: str, stream: TextIO) -> str:
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
        code = _styled(f'{kind}{problem.code}:', _RED if is_error else _YELLOW, stream)
        print(f'{_styled(f"{place}:", _BOLD, stream)} {code} {message}{hint}{other_lines}',
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


def write_text(text: str, path: Path | None) -> None:
    """Write a file, or the standard output if there is no path; may raise a CommandError."""
    if path is None:
        print(text, end='')
        return
    try:
        path.write_text(text, encoding='utf-8')
    except OSError as error:
        msg = f'cannot write {path}: {error.strerror}'
        raise CommandError(msg) from error


_WIDEST_NAME, _NARROWEST_NAME = 80, 8
_SHORT_KINDS = {'optical frame': 'optical', 'particle_emitter': 'emitter'}
BELOW = str.maketrans('├└`-', '│   ')
"""Translates the branches of a line into those below it."""

_COLORS = {
    'model': '\x1b[35m', 'link': '\x1b[32m', 'joint': '\x1b[33m', 'frame': '\x1b[36m',
    'sensor': '\x1b[34m', 'optical': '\x1b[34m'}


class TableRow(NamedTuple):
    """A row of a table of frames."""

    name: str
    kind: str
    values: Sequence[str] = ()
    """The texts of the other columns; none if they are blank."""
    note: str = ''
    """The text of the line below."""
    branches: str = ''
    """The branches of a tree that are before the name, each with a space."""
    is_bold: bool = False


Frame: TypeAlias = tuple[Mapping[str, Any], TableRow]
"""The record of a frame for other programs, and its row in a table."""


def print_table(labels: Sequence[str], rows: Sequence[TableRow]) -> None:
    """
    Print a table of frames. On a terminal, names are shortened so that lines are not wrapped.

    :param labels: the labels of the columns behind the kinds, such as x, y and z.
    """
    rows = [
        row._replace(
            name=printable(row.name[-2 * _WIDEST_NAME:]),
            kind=_SHORT_KINDS.get(row.kind, row.kind), branches=_branches(row.branches),
            values=row.values or ('',) * len(labels))
        for row in (TableRow('frame', 'kind', labels), *rows)]
    widths = [max(map(len, column)) for column in zip(*(row.values for row in rows), strict=True)]
    kind_width = max(len(row.kind) for row in rows)
    columns = shutil.get_terminal_size().columns if sys.stdout.isatty() else 2 * _WIDEST_NAME
    width = min(
        max(len(row.branches + row.name) for row in rows), _WIDEST_NAME,
        max(columns - kind_width - sum(widths) - len(widths) - 3, _NARROWEST_NAME))
    for name, kind, values, note, branches, is_bold in rows:
        room = width - min(len(name), _NARROWEST_NAME)
        branches = branches[max(len(branches) - room, 0):]
        longest = width - len(branches)
        # The end of a scoped name tells most.
        name = name if len(name) <= longest else f'...{name[3 - longest:]}'
        name = f'{name:{longest}}'
        print(
            _styled(branches, _DIM, sys.stdout)
            + (_styled(name, _BOLD, sys.stdout) if is_bold else name)
            + f'  {_styled(f"{kind:{kind_width}}", _COLORS.get(kind, ""), sys.stdout)}  '
            f'{" ".join(map(str.rjust, values, widths))}'.rstrip())
        if note:
            below = branches.translate(BELOW) + '  '
            note = shortened(printable(note), columns - len(below))
            print(_styled(below + note, _DIM, sys.stdout))


def _branches(branches: str) -> str:
    """Return the branches of a tree in characters that can be printed."""
    try:
        branches.encode(sys.stdout.encoding or 'ascii')
    except UnicodeEncodeError:
        return branches.replace('├ ', '|-').replace('└ ', '`-').replace('│', '|')
    return branches


def argument_type(
    convert: Callable[[str], Any], is_valid: Callable[[Any], bool], rule: str,
) -> Callable[[str], Any]:
    """
    Return a type of an argument.

    :param convert: returns the value of a text; may raise a ValueError.
    :param is_valid: whether a value is valid.
    :param rule: the end of the message about another text, behind the text.
    """
    def value_from_text(text: str) -> Any:
        with contextlib.suppress(ValueError):
            value = convert(text)
            if is_valid(value):
                return value
        msg = f'"{text}" {rule}'
        raise argparse.ArgumentTypeError(msg)
    return value_from_text


def add_unit_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments ``--degrees``, the default, ``--radians`` and ``--mm``."""
    angles = parser.add_mutually_exclusive_group()
    for unit in (DEGREES, RADIANS):
        angles.add_argument(
            f'--{unit.text}', dest='angle_unit', action='store_const', const=unit, default=DEGREES,
            help=f'angles in {unit.text}{", the default" if unit == DEGREES else ""}')
    parser.add_argument(
        '--mm', dest='length_unit', action='store_const', const=MILLIMETRES, default=METRES,
        help='lengths in millimetres, not metres')


def add_format_argument(parser: argparse.ArgumentParser, *formats: str) -> None:
    """Add the argument ``--format`` with formats besides ``text``."""
    choices = ('text', *formats)
    meanings = ', '.join(f'{name}: {_FORMATS[name]}' for name in choices)
    parser.add_argument(
        '--format', choices=choices, default='text', help=f'output format: {meanings}')


def add_output_argument(
    parser: argparse.ArgumentParser, formats: Sequence[str], what: str,
) -> None:
    """Add the argument ``-o``, a path whose ending, such as ``.svg``, gives the format."""
    parser.add_argument(
        '-o', dest='output', metavar='PATH', help=f'where to write {what}', type=argument_type(
            Path, lambda path: path.suffix.lower() in formats,
            f'must end with one of {", ".join(formats)}'))


def print_json(
    path: str, errors: Sequence[SdfError], warnings: Sequence[SdfWarning], **content: Any,
) -> None:
    """Print a line with a JSON object about a file, and its content."""
    print(json.dumps({
        'file': path, 'ok': not errors, 'errors': [*map(_problem, errors)],
        'warnings': [*map(_problem, warnings)], **content}))


def print_csv(columns: Sequence[str], records: Iterable[Mapping[str, Any]]) -> None:
    """
    Print comma-separated values without a header.

    Numbers have all their digits. Characters that control a terminal are escaped.

    :param columns: keys of the records, in the order of printing; a missing value is left empty.
    """
    csv.writer(sys.stdout, lineterminator='\n').writerows(
        [printable(value) if isinstance(value, str) else value
         for value in map(record.get, columns)] for record in records)


def _problem(problem: SdfError | SdfWarning) -> dict[str, Any]:
    return {'code': problem.code, 'message': problem.message, **problem.place._asdict()}
