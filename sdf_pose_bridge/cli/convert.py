# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose convert``: convert poses and rotations from arguments or from standard input."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from functools import partial
import io
from itertools import islice
import sys
import textwrap
from typing import Any, TypeAlias

import numpy as np

from sdf_pose_bridge.cli.printing import CommandError
from sdf_pose_bridge.geometry.formats import (
    converted_poses,
    converted_rotations,
    DEGREES,
    Format,
    format_from_name,
    MILLIMETRES,
    POSE_FORMATS,
    PoseFormatError,
    RADIANS,
    ROTATION_FORMATS,
    without_rounding_errors,
)
from sdf_pose_bridge.geometry.poses import Pose, pose_inverse, pose_products, relative_poses
from sdf_pose_bridge.geometry.rotations import Floats
from sdf_pose_bridge.geometry.sequences import ZYX
from sdf_pose_bridge.geometry.units import number_from_text, TEXT_FORMATS
from sdf_pose_bridge.names import printable

LINES_AT_A_TIME = 10_000
"""Number of lines that are converted together, so that memory is bounded for any input."""

FORMATS: Mapping[str, Format] = {**ROTATION_FORMATS, **POSE_FORMATS}
"""All formats of numbers."""

_NAMES = {name for each in FORMATS.values() for name in (each.name, *each.synonyms)}

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
            'are skipped. Without --to, every format is printed. --degrees, --radians and\n'
            '--mm say which units the given numbers have; those printed have the units of\n'
            'their format.'
        ),
        epilog=f'{formats_help()}\ntexts, for --to: {", ".join(TEXT_FORMATS)}',
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        '--from', dest='source', metavar='FORMAT', type=format_argument, choices=FORMATS,
        required=True, help='format of the numbers')
    parser.add_argument(
        '--to', dest='target', metavar='FORMAT', choices=(*FORMATS, *TEXT_FORMATS),
        type=lambda name: name if name in TEXT_FORMATS else format_argument(name),
        help='format to print, also one of a text; by default all formats of numbers')
    add_given_unit_arguments(parser)
    parser.add_argument(
        '--inverse', action='store_true',
        help='invert the pose: the pose of B in A becomes that of A in B')
    for option, text in (('--times', 'another pose'), ('--times-inverse', 'the inverse of one')):
        parser.add_argument(
            option, dest='factors', metavar=('FORMAT', 'NUMBER'), nargs='+', action=_Factor,
            default=(), help=f'multiply with {text}: the pose of B in A times that of C in B is '
            'that of C in A; by default in the format of --from')
    parser.add_argument('numbers', nargs='*', metavar='NUMBER', help='one pose or rotation')
    parser.set_defaults(run=run)


class _Factor(argparse.Action):
    """Keeps the factors of both options in their order, each with its option."""

    def __call__(
        self, _parser: object, namespace: argparse.Namespace, values: Any,
        option_string: str | None = None,
    ) -> None:
        """Add a factor."""
        namespace.factors = [*namespace.factors, (option_string, values)]


def format_argument(name: str) -> str:
    """Return the name of the format that an argument names, perhaps by a synonym."""
    try:
        return format_from_name(name, FORMATS, 'pose or rotation').name
    except PoseFormatError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def add_given_unit_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that say which units given numbers have instead of their format's."""
    for option, dest, unit in (
        ('degrees', 'half_turn', DEGREES), ('radians', 'half_turn', RADIANS),
        ('mm', 'metre', MILLIMETRES),
    ):
        what = 'lengths' if dest == 'metre' else 'angles'
        parser.add_argument(
            f'--{option}', dest=dest, action='store_const', const=unit,
            help=f'the given {what} are in {option}, whatever the format has')


def run(options: argparse.Namespace) -> int:
    """Convert arguments or lines; return 0, 1 if one was not converted, 2 for wrong formats."""
    source = FORMATS[options.source]
    formats = POSE_FORMATS if source.position else ROTATION_FORMATS
    numbers_of_text, text = TEXT_FORMATS.get(options.target, (options.target, ''))
    if numbers_of_text not in (None, *formats):
        kind, other = ('pose', 'rotation') if source.position else ('rotation', 'pose')
        print(
            f'sdf_pose convert: --from {source.name} is a {kind} and --to {options.target} a'
            f' {other}; a {kind} converts to {", ".join(formats)}', file=sys.stderr)
        return 2
    given = format_in_given_units(source, options)
    product = _product_from_options(options, given)
    targets = [formats[numbers_of_text]] if numbers_of_text else list(formats.values())
    convert = partial(_converted, given, targets, product, text)
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
            print(result, end='\n' if options.target else '\n\n')
    return exit_code


def formats_help() -> str:
    """Return the formats with their numbers, for the end of a help of 80 columns."""
    width = max(map(len, FORMATS))
    lines, indent = [], ' ' * (width + 4)
    for title, formats in (('rotations', ROTATION_FORMATS), ('poses', POSE_FORMATS)):
        lines.append(f'formats of {title}:')
        for entry in formats.values():
            also = f'; also {", ".join(entry.synonyms)}' if entry.synonyms else ''
            lines += textwrap.wrap(
                f'  {entry.name:{width}}  {entry.meaning}{also}', 78, subsequent_indent=indent)
    return '\n'.join(lines)


def format_in_given_units(source: Format, options: argparse.Namespace) -> Format:
    """Return a format in the units of the options; raise a CommandError if it has no such unit."""
    if options.half_turn and not source.half_turn:
        option = 'degrees' if options.half_turn == DEGREES else 'radians'
        msg = (f'{source.name} has no angles that could be in {option}, so leave out --{option}; '
               'the option is about the given numbers')
        raise CommandError(msg)
    if options.metre and not source.position:
        msg = f'{source.name} has no lengths, so leave out --mm'
        raise CommandError(msg)
    return source._replace(
        half_turn=options.half_turn or source.half_turn, metre=options.metre or source.metre)


def numbers_from_text(text: str, source: Format) -> list[float]:
    """
    Read the numbers of a pose or a rotation.

    :param source: the format of the numbers.
    :return: the numbers.
    :raises PoseFormatError: if they are not numbers, or not as many as in the format.
    """
    values = list(map(number_from_text, text.split()))
    if len(values) != source.row_length:
        msg = (
            f'{source.name} has {source.row_length} numbers ({source.meaning}), but {len(values)}'
            f' {"is" if len(values) == 1 else "are"} given')
        raise PoseFormatError(msg)
    return values


def question_about_unit(source: Format, numbers: Sequence[float] | Floats) -> str:
    """Return a question if numbers are probably in another unit; else an empty text."""
    doubt = source.doubt(numbers)
    return f'{doubt.reason}; did you mean --{doubt.likely_unit}?' if doubt else ''


def _product_from_options(
    options: argparse.Namespace, given: Format,
) -> Callable[[Floats], Floats] | None:
    """Return what inverts and multiplies poses in the common representation; None for nothing."""
    if not options.inverse and not options.factors:
        return None
    factors = []
    for option, words in options.factors:
        source = given
        if words[0] in _NAMES:
            source, words = FORMATS[format_argument(words[0])], words[1:]
        if bool(source.position) != bool(given.position):
            msg = f'{given.name} cannot be multiplied with {source.name}: one is a rotation'
            raise CommandError(msg)
        numbers = numbers_from_text(' '.join(words), source)
        _print_question(question_about_unit(source, numbers))
        factor = Pose(*_poses_from_common(_common([numbers], source))[0].tolist())
        factors.append(pose_inverse(factor) if option == '--times-inverse' else factor)

    def product(common: Floats) -> Floats:
        poses = _poses_from_common(common)
        if options.inverse:
            poses = relative_poses(poses, np.tile(Pose(), (len(poses), 1)))
        for factor in factors:
            poses = pose_products(poses, np.tile(factor, (len(poses), 1)))
        return poses[:, -common.shape[1]:]
    return product


def _poses_from_common(common: Floats) -> Floats:
    """Return poses; those of rotations are at the origin."""
    return np.pad(common, ((0, 0), (7 - common.shape[1], 0)))


def _common(rows: Sequence[Sequence[float]] | Floats, source: Format) -> Floats:
    if source.position:
        return converted_poses(rows, source, 'sdf_quat_xyzw')
    return converted_rotations(rows, source, 'quaternion')


def _converted(
    source: Format, targets: Sequence[Format], product: Callable[[Floats], Floats] | None,
    text: str, texts: Sequence[str],
) -> list[str]:
    """Return, for each pose or rotation, a line for each format, with its name if several."""
    convert = converted_poses if source.position else converted_rotations
    values = np.array([numbers_from_text(each, source) for each in texts])
    question = question_about_unit(source, values)
    if product is not None:
        values = product(_common(values, source))
        source = FORMATS['sdf_quat_xyzw' if source.position else 'quaternion']
    width, columns = max(len(target.name) for target in targets), []
    for target in targets:
        shown = without_rounding_errors(convert(values, source, target), source, target)
        title = f'{target.name:{width}}  ' if targets[1:] else ''
        columns.append([
            text.format(*numbers) if text else title + ' '.join(map(repr, numbers))
            for numbers in shown.tolist()])
    _print_question(question)
    _print_lock(_common(values, source), targets)
    return list(map('\n'.join, zip(*columns, strict=True)))


def _print_question(question: str) -> None:
    if question:
        print(f'sdf_pose convert: {question}', file=sys.stderr)


def _print_lock(common: Floats, targets: Sequence[Format]) -> None:
    """Say that angles are near gimbal lock; of all formats, only that of roll, pitch and yaw."""
    sequence = targets[0].sequence if len(targets) == 1 else ZYX
    if sequence is not None and sequence.near_lock(common[:, -4:]).any():
        print('sdf_pose convert: near gimbal lock, where the first and the last angle '
              f'({sequence.name}) turn about the same axis: each alone is uncertain, all three '
              'together are the rotation', file=sys.stderr)


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
