# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose convert``: convert poses and rotations from arguments or from standard input."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import io
from itertools import groupby, islice
from operator import itemgetter
import re
import shutil
import sys
import textwrap
from typing import Any

import numpy as np

from sdf_pose_bridge.cli.arguments import argument_type
from sdf_pose_bridge.cli.given_poses import (
    add_given_unit_arguments,
    format_of_argument,
    formats_help,
    PoseReader,
    poses_from_rows,
)
from sdf_pose_bridge.cli.printing import CommandError, print_message
from sdf_pose_bridge.geometry.formats import (
    converted_poses,
    converted_rotations,
    Format,
    format_from_name,
    POSE_FORMATS,
    PoseFormatError,
    ROTATION_FORMATS,
)
from sdf_pose_bridge.geometry.pose_texts import (
    FORMATS,
    NAMES_OF_ARGUMENTS,
    TEXT_FORMATS,
    TextDivider,
)
from sdf_pose_bridge.geometry.poses import Pose, pose_inverse, pose_products, relative_poses
from sdf_pose_bridge.geometry.rotations import Floats
from sdf_pose_bridge.geometry.sequences import ZYX
from sdf_pose_bridge.printed_text import printable
from sdf_pose_bridge.process_limits import renew_limits

CHARACTERS_AT_A_TIME = 500_000
"""How much is converted together, so that memory is bounded for any input."""

_DIGITS_ON_TERMINAL = 12
"""Digits behind the decimal point; others are rounding errors, or not read by people."""

_NAMES = {*TEXT_FORMATS, *(
    name for each in FORMATS.values() for name in (each.name, *each.synonyms))}

HELP = 'convert a pose or a rotation between formats'
DESCRIPTION = (
    'Convert poses or rotations between formats. Numbers may have commas and\n'
    'brackets, and what programs print is read too: see docs/pose_formats.md.\n'
    'Without numbers, poses are read from standard input; blank lines and those\n'
    'that begin with # are skipped. Without --to, every format is printed.\n'
    '--degrees, --radians, --mm and --metres say which units the given numbers\n'
    'have; those printed have the units of their format.')


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments of the command."""
    parser.epilog = formats_help()
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument(
        '--from', dest='source', metavar='FORMAT',
        help='format of the numbers; not needed for a text that names it')
    parser.add_argument(
        '--to', dest='target', metavar='FORMAT',
        help='format to print; by default all formats of numbers')
    add_given_unit_arguments(parser)
    parser.add_argument(
        '--digits', metavar='N', type=argument_type(
            int, 'must be a number from 0 to 15', lambda count: 0 <= count <= 15),
        help='round printed numbers to N digits behind the point; by default to '
        f'{_DIGITS_ON_TERMINAL} on a terminal, else all digits are printed')
    parser.add_argument(
        '--inverse', action='store_true',
        help='invert the pose: the pose of B in A becomes that of A in B')
    for option, text in (('--times', 'another pose'), ('--times-inverse', 'the inverse of one')):
        parser.add_argument(
            option, dest='factors', metavar=('FORMAT', 'NUMBER'), nargs='+', action=_Collect,
            default=(), help=f'multiply with {text}: the pose of B in A times that of C in B is '
            'that of C in A; by default in the format of --from')
    for option in NAMES_OF_ARGUMENTS:
        parser.add_argument(
            option, dest='named', nargs=1, action=_Collect, default=(), help=argparse.SUPPRESS)
    parser.add_argument('numbers', nargs='*', metavar='NUMBER', help='one pose or rotation')


class _Collect(argparse.Action):
    """Keeps the values of several options in their order, each with its option."""

    def __call__(
        self, _parser: object, namespace: argparse.Namespace, values: Any,
        option_string: str | None = None,
    ) -> None:
        """Add an option."""
        setattr(namespace, self.dest, [*getattr(namespace, self.dest), (option_string, values)])


def run(options: argparse.Namespace) -> int:
    """Convert arguments or texts; return 0, or 1 if one was not converted."""
    conversion = _Conversion(options)
    words = [*options.numbers, *(f'{option} {value}' for option, (value,) in options.named)]
    if words not in ([], ['-']):
        (result,) = conversion.results([' '.join(words)])
        if isinstance(result, PoseFormatError):
            raise result
        print(result)
        return 0
    if isinstance(sys.stdin, io.TextIOWrapper):
        # Invalid bytes are an error in their text only.
        sys.stdin.reconfigure(errors='backslashreplace')
    exit_code, end = 0, '\n' if options.target else '\n\n'
    divider, lines, is_terminal = conversion.divider(), [''], sys.stdin.isatty()
    while lines:
        lines = [*islice(sys.stdin, 1)] if is_terminal else sys.stdin.readlines(
            CHARACTERS_AT_A_TIME)
        # The text has limits, and not how many there are.
        renew_limits()
        texts = divider.divided(lines, is_end=not lines)
        results = conversion.results([text for _, text in texts])
        for index, ((number, _), result) in enumerate(zip(texts, results, strict=True)):
            if isinstance(result, PoseFormatError):
                exit_code = 1
                print_message(options.command, f'line {number}: {result}')
                # A comment keeps the numbers of lines of output and input equal.
                results[index] = f'# line {number} is not converted'
        if results:
            print(*results, sep=end, end=end)
    return exit_code


class _Conversion:
    """Reads and converts poses by the options of the command, and says how it reads them."""

    def __init__(self, options: argparse.Namespace) -> None:
        self._options, self._told = options, set[str]()
        self._reader = PoseReader(options.source, options)
        self._form = TEXT_FORMATS.get(options.target)
        self._target = self._form.format if self._form else options.target and (
            format_of_argument(options.target))
        source = self._reader.source
        if source is not None and source.name in FORMATS:
            try:
                self._targets(source)
            except PoseFormatError as error:
                raise CommandError(str(error), 2) from error
        self._factors = [self._factor(option, words) for option, words in options.factors]

    def divider(self) -> TextDivider:
        """Return what divides lines into texts."""
        return TextDivider(self._reader.source)

    def results(self, texts: Sequence[str | list[float]]) -> list[str | PoseFormatError]:
        """Return, for each text, the lines to print, or the reason why it is not converted."""
        results: list[str | PoseFormatError] = []
        for source, group in groupby(map(self._read, texts), itemgetter(0)):
            found = [each for _, each in group]
            results += found if source is None else self._results(source, found)
        return results

    def _read(self, text: str | list[float]) -> tuple[Format | None, Any]:
        """Return the format and the numbers of a text; or None and the error, or the result."""
        if not isinstance(text, str):
            return self._reader.row_format, text
        try:
            poses = self._reader.read_all(text)
            self._tell(*(note for pose in poses for note in pose.notes))
            if len(poses) == 1:
                return poses[0].format, poses[0].numbers
            lines = self._converted(poses[0].format, [pose.numbers for pose in poses])
        except PoseFormatError as error:
            return None, error
        return None, '\n'.join(
            f'# {printable(pose.name)}\n{line}' if pose.name else line
            for pose, line in zip(poses, lines, strict=True))

    def _results(
        self, source: Format, rows: Sequence[Sequence[float]],
    ) -> Sequence[str | PoseFormatError]:
        try:
            return self._converted(source, rows)
        except PoseFormatError as error:
            if len(rows) == 1:
                return [error]
            half = len(rows) // 2
            return [*self._results(source, rows[:half]), *self._results(source, rows[half:])]

    def _converted(self, source: Format, rows: Sequence[Sequence[float]]) -> list[str]:
        """Return, for each pose or rotation, a line for each format, with its name if several."""
        values, targets = np.array(rows), self._targets(source)
        poses = poses_from_rows(values, source)
        self._tell(source.doubt(values, dashes='--'))
        for _, other in self._factors:
            if bool(other.position) != bool(source.position):
                msg = f'{source.name} cannot be multiplied with {other.name}: one is a rotation'
                raise PoseFormatError(msg)
        if self._options.inverse or self._factors:
            poses = self._product(poses)
            source = FORMATS['sdf_quat_xyzw' if source.position else 'quaternion']
            values = poses[:, -source.row_length:]
        convert = converted_poses if source.position else converted_rotations
        width, columns = max(len(target.name) for target in targets), []
        for target in targets:
            shown = without_rounding_errors(convert(values, source, target), source, target)
            title = f'{target.name:{width}}  ' if targets[1:] else ''
            columns.append([self._line(title, numbers) for numbers in shown.tolist()])
        self._tell_lock(poses, targets)
        return list(map('\n'.join, zip(*columns, strict=True)))

    def _targets(self, source: Format) -> list[Format]:
        formats = POSE_FORMATS if source.position else ROTATION_FORMATS
        if self._target is None:
            return list(formats.values())
        if self._target.name not in FORMATS:  # a sequence of axes
            return [format_from_name(self._target.name, formats)]
        if self._target.name not in formats:
            kind, other = ('pose', 'rotation') if source.position else ('rotation', 'pose')
            msg = f'{source.name} is a {kind} and {self._options.target} a {other}'
            raise PoseFormatError(msg)
        return [self._target]

    def _factor(self, option: str, words: Sequence[str]) -> tuple[Pose, Format]:
        """Read a pose to multiply with, in the format of ``--from`` if it has none of its own."""
        reader = PoseReader(None, self._options, self._reader.source)
        if words[0] in _NAMES or re.fullmatch('[sr][xyz]{3}', words[0]):
            # The options of units are about the numbers of --from.
            no_units = argparse.Namespace(given_angle=None, given_length=None)
            reader, words = PoseReader(words[0], no_units), words[1:]
        typed = reader.read(' '.join(words))
        pose = Pose(*poses_from_rows([typed.numbers], typed.format)[0].tolist())
        self._tell(*typed.notes, typed.format.doubt(typed.numbers, dashes='--'))
        return (pose_inverse(pose) if option == '--times-inverse' else pose), typed.format

    def _product(self, poses: Floats) -> Floats:
        if self._options.inverse:
            poses = relative_poses(poses, np.tile(Pose(), (len(poses), 1)))
        for factor, _ in self._factors:
            poses = pose_products(poses, np.tile(factor, (len(poses), 1)))
        return poses

    def _line(self, title: str, numbers: Sequence[float]) -> str:
        digits = self._options.digits
        if digits is None and sys.stdout.isatty():
            digits = _DIGITS_ON_TERMINAL
        words = [
            # Adding zero removes negative zeros.
            repr(number) if digits is None else f'{round(number, digits) + 0.0:.15g}'
            for number in numbers]
        if self._form:
            return self._form.template.format(*words)
        line = title + ' '.join(words)
        return '\n'.join(textwrap.wrap(
            line, shutil.get_terminal_size().columns, subsequent_indent=' ' * len(title),
        )) if title and sys.stdout.isatty() else line

    def _tell_lock(self, poses: Floats, targets: Sequence[Format]) -> None:
        """Say that angles are near gimbal lock; of all formats, only of roll, pitch and yaw."""
        sequence = targets[0].sequence if len(targets) == 1 else ZYX
        if sequence is not None and sequence.near_lock(poses[:, 3:]).any():
            self._tell(
                'near gimbal lock, where the first and the last angle '
                f'({sequence.name}) turn about the same axis: each alone is uncertain, all three '
                'together are the rotation')

    def _tell(self, *sentences: str) -> None:
        for sentence in filter(None, sentences):
            # What differs in numbers only is told once.
            if (kind := re.sub(r'[-+.\d]+', '', sentence)) not in self._told:
                self._told.add(kind)
                print_message(self._options.command, sentence)


def without_rounding_errors(values: Floats, source: Format, target: Format) -> Floats:
    """
    Replace rounding errors of a conversion by zero, for people who read the numbers.

    :param values: rows in the target format, shape (n, row_length).
    :return: a copy in which numbers of a rotation are zero that are below four units of rounding
        of the largest number; between formats with the same sequence of rotations, which are
        exact, a copy.
    """
    shown: Floats = values.copy()
    is_same_sequence = source.sequence is not None and source.sequence is target.sequence
    if source is not target and not is_same_sequence:
        largest = target.half_turn
        is_error = np.abs(values) < 4.0 * np.finfo(float).eps * largest
        is_error[:, list(target.position)] = False
        shown[is_error] = 0.0
    return shown
