# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose convert``: convert poses and rotations from arguments or from standard input."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import io
from itertools import islice
import sys
import textwrap
from typing import NamedTuple, TypeAlias

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

_Result: TypeAlias = tuple[list[float], ...]
"""The numbers of a pose or a rotation in several formats."""


class _Conversion(NamedTuple):
    source: Format
    targets: Sequence[Format]
    given_length: Unit
    printed_length: Unit


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
    """
    Convert the numbers of the arguments or the lines of standard input.

    :return: exit code: 0; 1 if a line was not converted; 2 for a pose and a rotation format.
    """
    formats = POSE_FORMATS if options.from_format in POSE_FORMATS else ROTATION_FORMATS
    if options.to_format not in (None, *formats):
        kind, other = ('pose', 'rotation') if formats is POSE_FORMATS else ('rotation', 'pose')
        print(
            f'sdf_pose convert: --from {options.from_format} is a {kind} and'
            f' --to {options.to_format} a {other}; a {kind} converts to {", ".join(formats)}',
            file=sys.stderr)
        return 2
    conversion = _Conversion(
        format_with_unit(options.from_format, options.angle_unit), list(formats.values()),
        options.length_unit, METRES)
    if options.to_format:
        conversion = conversion._replace(
            targets=[format_with_unit(options.to_format, options.angle_unit)],
            printed_length=options.length_unit)
    if options.numbers:
        (result,) = _converted([' '.join(options.numbers)], conversion)
        print(*_texts(result, conversion.targets), sep='\n')
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
        exit_code |= _print_lines(batch, conversion)
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
    """
    Return a format; for degrees the one that has them instead of radians.

    :raises CommandError: for degrees, if there is only one with radians.
    """
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


def _print_lines(lines: Sequence[tuple[int, str]], conversion: _Conversion) -> int:
    """Print the result or the error of each line, with its number, and return the exit code."""
    exit_code = 0
    output = []
    results = _converted_or_errors([text for _, text in lines], conversion)
    for (number, _), result in zip(lines, results, strict=True):
        if isinstance(result, str):
            exit_code = 1
            print(f'sdf_pose convert: line {number}: {printable(result)}', file=sys.stderr)
            # A comment keeps the numbers of lines of output and input equal.
            output.append(f'# line {number} is not converted')
        else:
            output += _texts(result, conversion.targets)
        if len(conversion.targets) > 1:
            output.append('')
    sys.stdout.write(''.join(f'{text}\n' for text in output))
    return exit_code


def _texts(result: _Result, targets: Sequence[Format]) -> list[str]:
    """Return a line for each format, with its name if there are several."""
    width = max(len(target.name) for target in targets)
    return [
        (f'{target.name:{width}}  ' if len(targets) > 1 else '') + ' '.join(map(repr, numbers))
        for target, numbers in zip(targets, result, strict=True)]


def _converted(texts: Sequence[str], conversion: _Conversion) -> list[_Result]:
    source, targets, given_length, printed_length = conversion
    convert = converted_poses if source.name in POSE_FORMATS else converted_rotations
    rows = [numbers_from_text(text, source, given_length) for text in texts]
    values, columns = np.array(rows), []
    for target in targets:
        shown = without_rounding_errors(convert(values, source.name, target.name), source, target)
        if printed_length is MILLIMETRES:
            shown[:, list(target.position)] *= printed_length.factor / target.metre
        columns.append(shown.tolist())
    question = next(filter(None, (question_about_unit(source, row) for row in rows)), '')
    if question:
        print(f'sdf_pose convert: {question}', file=sys.stderr)
    return list(zip(*columns, strict=True))


def _converted_or_errors(
    texts: Sequence[str], conversion: _Conversion,
) -> Sequence[_Result | str]:
    try:
        return _converted(texts, conversion)
    except PoseFormatError as error:
        if len(texts) == 1:
            return [str(error)]
        half = len(texts) // 2
        return [*_converted_or_errors(texts[:half], conversion),
                *_converted_or_errors(texts[half:], conversion)]
