# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Print problems and poses: colors, units and output files."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from itertools import chain
import math
import os
from pathlib import Path
import sys
from typing import NamedTuple, TextIO, TypeVar

from sdf_pose_bridge.errors import SdfError, SdfWarning, UriLookupError
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.rotations import rpy_from_quaternion
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.tree import TfTree

_Problem = TypeVar('_Problem', bound='SdfError | SdfWarning')

_RED, _YELLOW, _BOLD, _PLAIN = '\x1b[31m', '\x1b[33m', '\x1b[1m', '\x1b[0m'


def is_colored(stream: TextIO) -> bool:
    """
    Return whether to print colors.

    :param stream: the stream to print to.
    :return: True for a terminal, unless the variable ``NO_COLOR`` is set (https://no-color.org).
    """
    return stream.isatty() and not os.environ.get('NO_COLOR')


def print_problems(
    errors: tuple[SdfError, ...], warnings: tuple[SdfWarning, ...], stream: TextIO,
) -> None:
    """Print errors and warnings in the order of files and lines; in color on a terminal."""
    # Earlier output comes first, also if both streams go to one place.
    sys.stdout.flush()
    has_colors = is_colored(stream)
    bold, plain = (_BOLD, _PLAIN) if has_colors else ('', '')
    for problem in in_order(errors, warnings):
        is_error = isinstance(problem, SdfError)
        color = '' if not has_colors else _RED if is_error else _YELLOW
        kind = '' if is_error or problem.code == 'WARNING' else 'WARNING: '
        place, message = printable(str(problem.place)), printable(problem.message)
        hint = '; --skip-missing leaves it out' if isinstance(problem, UriLookupError) else ''
        print(f'{bold}{place}:{plain} {color}{kind}{problem.code}:{plain} {message}{hint}',
              file=stream)


def in_order(*problems: tuple[_Problem, ...]) -> tuple[_Problem, ...]:
    """
    Sort errors and warnings.

    :param problems: some of them.
    :return: all of them, by file as the first ones, and by line; of one line the first argument
        comes first.
    """
    files = [problem.place.file for some in problems for problem in some]
    ranks = {file: rank for rank, file in reversed([*enumerate(files)])}
    return (*sorted(chain(*problems), key=lambda problem: (
        ranks[problem.place.file], problem.place.line)),)


def discard_output() -> None:
    """Discard pending output, so that the end of the process does not fail again."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


class CommandError(Exception):
    """A command fails; the text is the reason."""


def write_text(text: str, path: Path) -> None:
    """
    Write a file.

    :raises CommandError: if it cannot be written.
    """
    try:
        path.write_text(text, encoding='utf-8')
    except OSError as error:
        msg = f'cannot write {path}: {error.strerror}'
        raise CommandError(msg) from error


class Unit(NamedTuple):
    """A unit of lengths or angles, with the number of digits to show."""

    name: str
    factor: float
    """A metre or a radian in this unit."""
    digits: int


METRES, MILLIMETRES = Unit('m', 1.0, 4), Unit('mm', 1000.0, 1)
RADIANS, DEGREES = Unit('rad', 1.0, 4), Unit('deg', math.degrees(1.0), 2)


POSE_LABELS = ('x', 'y', 'z', 'roll', 'pitch', 'yaw')
"""Labels of the numbers of a pose."""


class Units(NamedTuple):
    """Units of the poses that a command shows."""

    length: Unit = METRES
    angle: Unit = RADIANS

    @property
    def of_pose(self) -> list[Unit]:
        """The units of x, y, z, roll, pitch and yaw."""
        return 3 * [self.length] + 3 * [self.angle]

    def texts(self, pose: Pose) -> list[str]:
        """
        Write a pose in these units.

        :return: x, y, z, roll, pitch and yaw, rounded.
        """
        values = (*pose[:3], *rpy_from_quaternion(pose[3:]))
        # Adding zero removes negative zeros.
        return [
            f'{round(value * unit.factor, unit.digits) + 0.0:.{unit.digits}f}'
            for value, unit in zip(values, self.of_pose, strict=True)]


def add_unit_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments ``--degrees`` and ``--mm``."""
    parser.add_argument(
        '--degrees', dest='angle_unit', action='store_const', const=DEGREES, default=RADIANS,
        help='angles in degrees, not radians')
    parser.add_argument(
        '--mm', dest='length_unit', action='store_const', const=MILLIMETRES, default=METRES,
        help='lengths in millimetres, not metres')


def add_output_argument(
    parser: argparse.ArgumentParser, formats: Sequence[str], what: str,
) -> None:
    """
    Add the argument ``-o``, a path whose ending gives the format.

    :param formats: the endings, such as ``.svg``.
    :param what: the content of the file.
    """
    def path_from_text(text: str) -> Path:
        path = Path(text)
        if path.suffix.lower() not in formats:
            msg = f'"{text}" must end with one of {", ".join(formats)}'
            raise argparse.ArgumentTypeError(msg)
        return path

    parser.add_argument(
        '-o', dest='output', metavar='PATH', type=path_from_text, help=f'where to write {what}')


def kind_labels_of(scene: Scene, tree: TfTree) -> list[str]:
    """
    Return the kind of each frame in words.

    :return: the labels of their kinds; ``optical frame`` for those of cameras.
    """
    return [
        'optical frame' if element < 0 else Kind(scene.kinds[element]).label
        for element in tree.elements.tolist()]
