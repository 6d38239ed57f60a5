# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Arguments of commands that read poses, and the poses that are typed or pasted."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
import textwrap

import numpy as np

from sdf_pose_bridge.cli.printing import CommandError
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
    NoFormatError,
    only_pose,
    TEXT_FORMATS,
    typed_poses_from_text,
    TypedPose,
)
from sdf_pose_bridge.geometry.poses import PoseArray
from sdf_pose_bridge.geometry.rotations import Floats
from sdf_pose_bridge.geometry.units import DEGREES, METRES, MILLIMETRES, RADIANS


class PoseReader:
    """
    Reads poses in the format and the units that the options of a command say.

    :param name: the name of a format or of a text; None if nobody said it.
    :param default: the format of numbers that nobody has said.
    """

    def __init__(
        self, name: str | None, options: argparse.Namespace, default: Format | None = None,
    ) -> None:
        self._form_name = name if name in TEXT_FORMATS else ''
        self.source = format_of_argument(name) if name and not self._form_name else None
        self._options, self._default = options, default
        self.row_format = None if self.source is None else self._in_given_units(self.source)
        """The format of rows, in the units of the options."""

    def read(self, text: str) -> TypedPose:
        """Read a pose or a rotation; raise a PoseFormatError or a CommandError."""
        return only_pose(self.read_all(text))

    def read_all(self, text: str) -> Sequence[TypedPose]:
        """Read a pose or a rotation, or a list of them; raise errors as :meth:`read`."""
        try:
            typed = typed_poses_from_text(text, self.row_format, self._default, self._form_name)
        except NoFormatError as error:
            msg = f'{error}; add --from FORMAT, and see --help'
            raise CommandError(msg, 2) from error
        return [each._replace(format=self._in_given_units(each.format)) for each in typed]

    def _in_given_units(self, source: Format) -> Format:
        """Return a format in the units of the options."""
        angle, length = self._options.given_angle, self._options.given_length
        if not (angle or length):
            return source
        for unit, has_unit, what in (
            (angle, source.angle, 'angles'), (length, source.position, 'lengths'),
        ):
            if unit and not has_unit:
                msg = f'{source.name} has no {what}, so leave out --{unit.text}'
                raise CommandError(msg)
        return source._replace(
            angle=angle or source.angle, length=length or source.length,
            said_units=(angle, length))


def poses_from_rows(rows: Sequence[Sequence[float]] | Floats, source: Format) -> PoseArray:
    """Convert rows to poses, those of rotations at the origin; may raise a PoseFormatError."""
    if source.position:
        return converted_poses(rows, source, 'sdf_quat_xyzw')
    return np.pad(converted_rotations(rows, source, 'quaternion'), ((0, 0), (3, 0)))


def format_of_argument(name: str) -> Format:
    """Return the format with a name or synonym; raise a CommandError with the nearest ones."""
    try:
        return format_from_name(name, FORMATS, 'format', '--help')
    except PoseFormatError as error:
        raise CommandError(str(error), 2) from error


def add_given_unit_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that say which units given numbers have instead of their format's."""
    for what, dest, units in (
        ('angles', 'given_angle', (DEGREES, RADIANS)),
        ('lengths', 'given_length', (MILLIMETRES, METRES)),
    ):
        group = parser.add_mutually_exclusive_group()
        for unit in units:
            group.add_argument(
                f'--{unit.text}', dest=dest, action='store_const', const=unit,
                help=f'the given {what} are in {unit.text}, whatever the format has')


def formats_help() -> str:
    """Return the formats with their numbers, and texts, for the end of a help of 80 columns."""
    width = max(map(len, FORMATS))
    lines, indent = [], ' ' * (width + 4)
    for title, formats in (('rotations', ROTATION_FORMATS), ('poses', POSE_FORMATS)):
        lines.append(f'formats of {title}:')
        for entry in formats.values():
            also = f'; also {", ".join(entry.synonyms)}' if entry.synonyms else ''
            lines += textwrap.wrap(
                f'  {entry.name:{width}}  {entry.meaning}{also}', 78, subsequent_indent=indent)
    lines += ['texts, which are formats too:', f'  {", ".join(TEXT_FORMATS)}']
    return '\n'.join(lines)
