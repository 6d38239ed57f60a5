# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose convert``: convert poses and rotations from arguments or from standard input."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from functools import partial
import io
from itertools import islice
import sys
import textwrap
from typing import TypeAlias

import numpy as np

from sdf_pose_bridge.cli.printing import (
    add_unit_arguments,
    CommandError,
    DEGREES,
    METRES,
    MILLIMETRES,
    Unit,
)
from sdf_pose_bridge.geometry.formats import (
    converted_poses,
    converted_rotations,
    Format,
    POSE_FORMATS,
    PoseFormatError,
    ROTATION_FORMATS,
    without_rounding_errors,
)
from sdf_pose_bridge.names import printable, shortened

LINES_AT_A_TIME = 10_000
"""Number of lines that are converted together, so that memory is bounded for any input."""

_Convert: TypeAlias = Callable[[Sequence[str]], Sequence[str]]
"""Returns what to print for each text."""


def add_parser(subparsers: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    """Add the command."""
    parser = subparsers.add_parser(
        'convert',
        help='convert a pose or a rotation between formats',
        description=(
            'Convert poses or rotations between formats. Without numbers, lines are read\n'
            'from standard input, one pose each; blank lines and those that begin with #\n'
            'are skipped. Without --to, every format is printed. --degrees and --mm are\n'
            'the units of given numbers, and of those printed with --to.'
        ),
        epilog=formats_help(),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    names = (*ROTATION_FORMATS, *POSE_FORMATS)
    parser.add_argument(
        '--from', dest='from_format', metavar='FORMAT', choices=names, required=True,
        help='format of the numbers')
    parser.add_argument(
        '--to', dest='to_format', metavar='FORMAT', choices=names,
        help='format to print; by default all of them')
    add_unit_arguments(parser)
    parser.add_argument('numbers', nargs='*', metavar='NUMBER', help='one pose or rotation')
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Convert arguments or lines; return 0, 1 if one was not converted, 2 for wrong formats."""
    formats = POSE_FORMATS if options.from_format in POSE_FORMATS else ROTATION_FORMATS
    if options.to_format not in (None, *formats):
        kind, other = ('pose', 'rotation') if formats is POSE_FORMATS else ('rotation', 'pose')
        print(
            f'sdf_pose convert: --from {options.from_format} is a {kind} and'
            f' --to {options.to_format} a {other}; a {kind} converts to {", ".join(formats)}',
            file=sys.stderr)
        return 2
    source = format_with_unit(options.from_format, options.angle_unit)
    targets, printed_length = list(formats.values()), METRES
    if options.to_format:
        targets = [format_with_unit(options.to_format, options.angle_unit)]
        printed_length = options.length_unit
    convert = partial(_converted, source, targets, options.length_unit, printed_length)
    if options.numbers:
        print(*convert([' '.join(options.numbers)]))
        return 0
    if isinstance(sys.stdin, io.TextIOWrapper):
        # Invalid bytes are an error in their line only.
        sys.stdin.reconfigure(errors='backslashreplace')
    exit_code = 0
    lines = (
        (number, text) for number, text in enumerate(sys.stdin, start=1)
        if text.strip() and not text.lstrip().startswith('#'))
    at_a_time = 1 if sys.stdin.isatty() else LINES_AT_A_TIME
    while batch := list(islice(lines, at_a_time)):
        results = _converted_or_errors([text for _, text in batch], convert)
        for (number, _), result in zip(batch, results, strict=True):
            if isinstance(result, PoseFormatError):
                exit_code = 1
                print(f'sdf_pose convert: line {number}: {printable(str(result))}',
                      file=sys.stderr)
                # A comment keeps the numbers of lines of output and input equal.
                result = f'# line {number} is not converted'
            print(result, end='\n' if options.to_format else '\n\n')
    return exit_code


def formats_help() -> str:
    """Return the formats with their numbers, for the end of a help of 80 columns."""
    width = max(len(name) for name in (*ROTATION_FORMATS, *POSE_FORMATS))
    lines, indent = [], ' ' * (width + 4)
    for title, formats in (('rotations', ROTATION_FORMATS), ('poses', POSE_FORMATS)):
        lines.append(f'formats of {title}:')
        for entry in formats.values():
            lines += textwrap.wrap(
                f'  {entry.name:{width}}  {entry.meaning}', 78, subsequent_indent=indent)
    return '\n'.join(lines)


def format_with_unit(name: str, angle_unit: Unit) -> Format:
    """Return a format; for degrees the one that has them, or raise a CommandError."""
    formats = {**POSE_FORMATS, **ROTATION_FORMATS}
    if angle_unit is DEGREES and name == 'ur_pose':
        msg = 'ur_pose is always in radians, without --degrees'
        raise CommandError(msg)
    return (angle_unit is DEGREES and formats.get(f'{name}_degrees')) or formats[name]


def numbers_from_text(text: str, source: Format, length_unit: Unit) -> list[float]:
    """
    Read the numbers of a pose or a rotation.

    :param source: the format of the numbers.
    :param length_unit: the unit of lengths, if it is not the unit of the format.
    :return: the numbers in the units of the format.
    :raises PoseFormatError: if they are not numbers, or not as many as in the format.
    """
    values = []
    for word in text.split():
        try:
            if '_' in word or not word.isascii():
                # float() accepts 1_000 and digits of all scripts; other readers of poses do not.
                raise ValueError
            values.append(float(word))
        except ValueError:
            msg = f'{shortened(word)!r} is not a number'
            raise PoseFormatError(msg) from None
    if len(values) != source.row_length:
        msg = (
            f'{source.name} has {source.row_length} numbers ({source.meaning}), but {len(values)}'
            f' {"is" if len(values) == 1 else "are"} given')
        raise PoseFormatError(msg)
    if length_unit is MILLIMETRES:
        for index in source.position:
            values[index] *= source.metre / length_unit.factor
    return values


def question_about_unit(source: Format, numbers: Sequence[float]) -> str:
    """Return a question if numbers are probably in another unit; else an empty text."""
    doubt = source.doubt(numbers)
    return f'{doubt.reason}; did you mean --{doubt.likely_unit}?' if doubt else ''


def _converted(
    source: Format, targets: Sequence[Format], given_length: Unit, printed_length: Unit,
    texts: Sequence[str],
) -> list[str]:
    """Return, for each pose or rotation, a line for each format, with its name if several."""
    convert = converted_poses if source.name in POSE_FORMATS else converted_rotations
    rows = [numbers_from_text(text, source, given_length) for text in texts]
    width = max(len(target.name) for target in targets)
    values, columns = np.array(rows), []
    for target in targets:
        shown = without_rounding_errors(convert(values, source.name, target.name), source, target)
        if printed_length is MILLIMETRES:
            shown[:, list(target.position)] *= printed_length.factor / target.metre
        title = f'{target.name:{width}}  ' if targets[1:] else ''
        columns.append([title + ' '.join(map(repr, numbers)) for numbers in shown.tolist()])
    question = next(filter(None, (question_about_unit(source, row) for row in rows)), '')
    if question:
        print(f'sdf_pose convert: {question}', file=sys.stderr)
    return list(map('\n'.join, zip(*columns, strict=True)))


def _converted_or_errors(
    texts: Sequence[str], convert: _Convert,
) -> Sequence[str | PoseFormatError]:
    try:
        return convert(texts)
    except PoseFormatError as error:
        if len(texts) == 1:
            return [error]
        half = len(texts) // 2
        return [*_converted_or_errors(texts[:half], convert),
                *_converted_or_errors(texts[half:], convert)]
