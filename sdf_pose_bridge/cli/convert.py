# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose convert``: convert poses and rotations given on the command line or line by line."""

from __future__ import annotations

import argparse
from collections.abc import Iterable
from collections.abc import Iterator
import io
from itertools import islice
import re
import sys
from typing import NamedTuple
from typing import TYPE_CHECKING

import numpy as np

from sdf_pose_bridge.geometry.formats import converted_poses
from sdf_pose_bridge.geometry.formats import converted_rotations
from sdf_pose_bridge.geometry.formats import POSE_FORMATS
from sdf_pose_bridge.geometry.formats import PoseFormat
from sdf_pose_bridge.geometry.formats import PoseFormatError
from sdf_pose_bridge.geometry.formats import ROTATION_FORMATS
from sdf_pose_bridge.geometry.rotation_checks import Floats

if TYPE_CHECKING:
    # Only the stubs know the class by this name with its parameter.
    Subparsers = argparse._SubParsersAction[argparse.ArgumentParser]  # noqa: SLF001

LINES_AT_A_TIME = 10_000
"""Lines converted in one go: enough for speed, and memory stays small however long the input."""

NEGATIVE_NUMBER = re.compile(r'^-(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?$|^-(inf|nan)', re.IGNORECASE)


class _Line(NamedTuple):
    number: int
    row: list[float]
    fault: str


def add_parser(subparsers: Subparsers) -> argparse.ArgumentParser:
    """
    Add the command to a command line.

    :param subparsers: what ``ArgumentParser.add_subparsers`` returned.
    :return: the command's parser; the arguments it makes are for :func:`run`.
    """
    parser = subparsers.add_parser(
        'convert',
        help='convert a pose or a rotation between formats',
        description=(
            'Convert poses or rotations between formats. Without numbers, lines are read from\n'
            'standard input, one pose each; blank lines and those that begin with # are skipped.\n'
            'Without --to, every format is printed.'
        ),
        epilog=_formats_help(),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    # argparse takes -1e-3 for an option unless it is told what a negative number looks like.
    parser._negative_number_matcher = NEGATIVE_NUMBER  # noqa: SLF001
    names = (*ROTATION_FORMATS, *POSE_FORMATS)
    parser.add_argument(
        '--from', dest='from_format', metavar='FORMAT', choices=names, required=True,
        help='format of the numbers given',
    )
    parser.add_argument(
        '--to', dest='to_format', metavar='FORMAT', choices=names,
        help='format to print; all of them if not given',
    )
    parser.add_argument('numbers', nargs='*', metavar='NUMBER', help='one pose or rotation')
    parser.set_defaults(run=run)
    return parser


def run(args: argparse.Namespace) -> int:
    """
    Convert what the arguments say, or the lines of standard input.

    :param args: ``from_format``, ``to_format`` (or None) and ``numbers``, a list of text.
    :return: exit code: 0, 1 if anything was not converted, 2 if the formats do not go together.
    """
    formats = POSE_FORMATS if args.from_format in POSE_FORMATS else ROTATION_FORMATS
    if args.to_format is None:
        targets = list(formats.values())
    elif args.to_format in formats:
        targets = [formats[args.to_format]]
    else:
        kind, other = ('pose', 'rotation') if formats is POSE_FORMATS else ('rotation', 'pose')
        print(
            f'sdf_pose convert: --from {args.from_format} is a {kind} and --to {args.to_format}'
            f' a {other}; a {kind} converts to {", ".join(formats)}',
            file=sys.stderr,
        )
        return 2
    source = formats[args.from_format]
    labelled = args.to_format is None
    if args.numbers:
        line = _parsed_line(0, ' '.join(args.numbers), source)
        return _printed([line], source, targets, labelled=labelled)
    exit_code = 0
    if isinstance(sys.stdin, io.TextIOWrapper):
        # Bytes that are no text make a bad line; they should not end the program.
        sys.stdin.reconfigure(errors='backslashreplace')
    lines = _parsed_lines(sys.stdin, source)
    at_a_time = 1 if sys.stdin.isatty() else LINES_AT_A_TIME
    while batch := list(islice(lines, at_a_time)):
        exit_code |= _printed(batch, source, targets, labelled=labelled)
    return exit_code


def _formats_help() -> str:
    width = max(len(name) for name in (*ROTATION_FORMATS, *POSE_FORMATS))
    lines = []
    for title, formats in (('rotations', ROTATION_FORMATS), ('poses', POSE_FORMATS)):
        lines.append(f'formats of {title}:')
        lines += [f'  {entry.name:{width}}  {entry.meaning}' for entry in formats.values()]
    return '\n'.join(lines)


def _parsed_lines(texts: Iterable[str], source: PoseFormat) -> Iterator[_Line]:
    for number, text in enumerate(texts, start=1):
        stripped = text.strip()
        if stripped and not stripped.startswith('#'):
            yield _parsed_line(number, stripped, source)


def _parsed_line(number: int, text: str, source: PoseFormat) -> _Line:
    words = text.split()
    row = []
    for word in words:
        try:
            # float() reads 1_000 as Python does, which no other reader of poses would.
            row.append(float(word if '_' not in word else 'no number'))
        except ValueError:
            return _Line(number, [], f'{word!r} is no number')
    if len(row) != source.row_length:
        fault = (
            f'{source.name} has {source.row_length} numbers ({source.meaning}), but {len(row)}'
            f' {"is" if len(row) == 1 else "are"} given'
        )
        return _Line(number, [], fault)
    return _Line(number, row, '')


def _printed(
    lines: list[_Line], source: PoseFormat, targets: list[PoseFormat], *, labelled: bool
) -> int:
    """Print one answer for each line and complain about those without; return the exit code."""
    faults = {line.number: line.fault for line in lines if line.fault}
    good = [line for line in lines if not line.fault]
    columns = []
    for target in targets:
        answers: dict[int, list[float]] = {}
        _convert(good, source, target, answers, faults)
        columns.append(answers)
    out = []
    width = max(len(target.name) for target in targets)
    for line in lines:
        if line.number in faults:
            # What follows stays beside what was given, and other readers skip a comment.
            where = f'line {line.number}: ' if line.number else ''
            if where:
                out.append(f'# line {line.number} is not converted')
            print(f'sdf_pose convert: {where}{faults[line.number]}', file=sys.stderr)
        elif labelled:
            out += [
                f'{target.name:{width}}  {_text(answers[line.number])}'
                for target, answers in zip(targets, columns, strict=True)
            ]
        else:
            out.append(_text(columns[0][line.number]))
        if labelled and line.number:
            out.append('')
    sys.stdout.write(''.join(f'{text}\n' for text in out))
    return 1 if faults else 0


def _convert(
    lines: list[_Line],
    source: PoseFormat,
    target: PoseFormat,
    answers: dict[int, list[float]],
    faults: dict[int, str],
) -> None:
    """Convert all lines at once, and by halves where one of them is wrong."""
    if not lines:
        return
    convert = converted_poses if source.name in POSE_FORMATS else converted_rotations
    try:
        rows = convert(_array([line.row for line in lines]), source.name, target.name)
    except PoseFormatError as error:
        if len(lines) == 1:
            faults[lines[0].number] = str(error)
            return
        half = len(lines) // 2
        _convert(lines[:half], source, target, answers, faults)
        _convert(lines[half:], source, target, answers, faults)
    else:
        answers.update(
            (line.number, row) for line, row in zip(lines, rows.tolist(), strict=True)
        )


def _array(rows: list[list[float]]) -> Floats:
    return np.array(rows, dtype=np.float64)


def _text(row: list[float]) -> str:
    return ' '.join(map(repr, row))
