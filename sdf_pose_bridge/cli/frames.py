# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Print the frames of files as a table, or as CSV or JSON for other programs."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Mapping, Sequence
import csv
from itertools import count
import shutil
import sys
from typing import Any, NamedTuple, TypeAlias

from sdf_pose_bridge.cli.input_files import load_file
from sdf_pose_bridge.cli.printing import BOLD, DIM, print_json, print_problems, styled
from sdf_pose_bridge.errors import SdfError, SdfWarning
from sdf_pose_bridge.geometry.poses import TOLERANCE
from sdf_pose_bridge.geometry.units import Units
from sdf_pose_bridge.printed_text import printable, shortened
from sdf_pose_bridge.scene.scene import Scene

MOST_MOVED = 20
"""Largest number of frames that a line names because they move with another one."""
_WIDEST_NAME, _NARROWEST_NAME = 80, 6
_USUAL_COLUMNS = 80
"""Only a narrower table has more digits, and only in a narrower terminal it has no kinds."""
_ROUNDING = 0.05
"""Largest error of the smallest length, relative to it."""
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
    remark: str = ''
    """The text behind the values."""


Frame: TypeAlias = tuple[Mapping[str, Any], TableRow]
"""The record of a frame for other programs, and its row in a table."""


def print_table(labels: Sequence[str], rows: Sequence[TableRow], remark: str = '') -> None:
    """
    Print a table of frames. On a terminal, names are shortened so that lines are not wrapped.

    :param labels: the labels of the columns behind the kinds, such as x, y and z.
    :param remark: the label of the remarks, if there are any.
    """
    rows, columns = _laid_out(labels, rows, remark), _columns()
    width = max(len(row.branches + row.name) for row in rows)
    if columns < _USUAL_COLUMNS:
        # In a narrow terminal, names and branches tell more than kinds.
        rows = [row._replace(kind='', branches=row.branches[::2]) for row in rows]
    room = columns - len(rows[0].kind + rows[0].values[0]) - 2
    longest_remark = max(len(f'  {row.remark}'.rstrip()) for row in rows)
    width = min(width, _WIDEST_NAME, max(
        room - min(longest_remark, columns // 3), 2 * _NARROWEST_NAME))
    taken: dict[str, str] = {}
    for name, kind, (values,), note, branches, is_bold, remark in rows:
        branches = branches[max(len(branches) - width + min(len(name), _NARROWEST_NAME), 0):]
        longest = width - len(branches)
        name = f'{_fitted(name, longest, taken):{longest}}'
        print((
            styled(branches, DIM, sys.stdout)
            + (styled(name, BOLD, sys.stdout) if is_bold else name)
            + f'  {styled(kind, _COLORS.get(kind.rstrip(), ""), sys.stdout) if kind else ""}'
            f'{values}  ' + shortened(remark, max(room - width - 2, _NARROWEST_NAME))).rstrip())
        if note:
            below = branches.translate(BELOW) + '  '
            note = shortened(printable(note), columns - len(below))
            print(styled(below + note, DIM, sys.stdout))


def _laid_out(labels: Sequence[str], rows: Sequence[TableRow], remark: str = '') -> list[TableRow]:
    """Return all rows with kinds of one width, and with one text for the values of each."""
    rows = TableRow('frame', 'kind', labels, remark=remark), *rows
    texts = [(_SHORT_KINDS.get(row.kind, row.kind) + '  ', *(row.values or ('',) * len(labels)))
             for row in rows]
    kind_width, *widths = (max(map(len, column)) for column in zip(*texts, strict=True))
    return [
        row._replace(
            name=printable(row.name[-2 * _WIDEST_NAME:]), kind=kind.ljust(kind_width),
            values=[' '.join(map(str.rjust, values, widths))],
            branches=_branches(row.branches), remark=printable(row.remark))
        for row, (kind, *values) in zip(rows, texts, strict=True)]


def _columns() -> int:
    return shutil.get_terminal_size().columns if sys.stdout.isatty() else 2 * _WIDEST_NAME


def _fitted(name: str, longest: int, taken: dict[str, str]) -> str:
    """Shorten a name in the middle, so that no other name of the table has the same text."""
    if len(name) <= longest:
        return taken.setdefault(name, name)
    # The end of a scoped name tells most.
    heads = sorted(range(longest - 2), key=lambda head: abs(head - longest // 3))
    texts = [f'{name[:head]}..{name[len(name) - longest + head + 2:]}' for head in heads]
    return next((text for text in texts if taken.setdefault(text, name) == name), texts[0])


def _branches(branches: str) -> str:
    """Return the branches of a tree in characters that can be printed."""
    try:
        branches.encode(sys.stdout.encoding or 'ascii')
    except UnicodeEncodeError:
        return branches.replace('├ ', '|-').replace('└ ', '`-').replace('│', '|')
    return branches


def print_frames(
    options: argparse.Namespace, member: str, columns: Sequence[str],
    frames_of_scene: Callable[[Scene, argparse.Namespace, list[SdfWarning]], Sequence[Frame]],
    pattern: str = '',
) -> int:
    """
    Print the frames of files; continue after an invalid file.

    :param member: the member of the JSON object that has the records.
    :param columns: the columns of CSV: ``file``, members of the records, and numbers of poses.
    :param frames_of_scene: returns the record of each frame, whose member ``pose`` is None if it
        has no pose, and its row in a table without the pose; adds warnings to those of the file.
    :param pattern: the pattern of names that the frames match, for a message if there are none.
    :return: exit code: 0 if all files are valid, else 1.
    """
    exit_code, units = 0, Units(options.length_unit, options.angle_unit)
    if options.format == 'csv':
        print(*columns, sep=',')
    for path in options.files:
        scene, errors, (*warnings,) = load_file(path, options)
        frames: Sequence[Frame] = ()
        if scene is not None:
            try:
                frames = frames_of_scene(scene, options, warnings)
            except SdfError as error:
                errors = error.errors
        exit_code |= bool(errors)
        if options.format == 'json':
            print_json(path, errors, warnings, **{member: [record for record, _ in frames]})
            continue
        print_problems(errors, warnings, sys.stderr)
        if options.format == 'csv':
            print_csv(columns, (
                {'file': path, **record, **(record['pose']._asdict() if record['pose'] else {})}
                for record, _ in frames))
        elif not errors:
            if len(options.files) > 1:
                print(printable(path))
            if pattern and not frames:
                print(f'sdf_pose {options.command}: no whole name in {printable(path)} matches '
                      f'"{printable(pattern)}"', file=sys.stderr)
                continue
            print_table(units.labels, _rows_with_poses(frames, units, options.digits))
    return exit_code


def _rows_with_poses(
    frames: Sequence[Frame], units: Units, given_digits: int | None,
) -> list[TableRow]:
    """Return rows with poses; where there is room, with the digits of the smallest length."""
    def rows(*digits: int) -> list[TableRow]:
        shown = Units(*(
            unit._replace(digits=each) for unit, each in zip(units, digits, strict=True)))
        return [row._replace(values=shown.texts(record['pose'])) if record['pose'] else row
                for record, row in frames]

    if given_digits is not None:
        return rows(given_digits, given_digits)
    least, angle_digits = units.length.digits - 1, units.angle.digits - 1
    lengths = [abs(value) * units.length.factor for record, _ in frames if record['pose']
               for value in record['pose'][:3] if abs(value) >= TOLERANCE]
    shortest = min(lengths, default=0.0)
    needed = next(digits for digits in count(least)
                  if abs(round(shortest, digits) - shortest) <= _ROUNDING * shortest)
    room = min(_columns(), _USUAL_COLUMNS) - 2 - max(
        len(''.join((row.branches, row.name, row.kind, *row.values)))
        for row in _laid_out(units.labels, rows(least, angle_digits)))
    return rows(min(needed, least + max(room // 3, 0)), angle_digits)


def print_csv(columns: Sequence[str], records: Iterable[Mapping[str, Any]]) -> None:
    """
    Print comma-separated values without a header.

    Numbers have all their digits. Characters that control a terminal are escaped.

    :param columns: keys of the records, in the order of printing; a missing value is left empty.
    """
    csv.writer(sys.stdout, lineterminator='\n').writerows(
        [printable(value) if isinstance(value, str) else value
         for value in map(record.get, columns)] for record in records)
