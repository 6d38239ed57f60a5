# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Convert poses and rotations between the formats of robots and files.

A format is one entry of a table, with its names, units, and the order and meaning of its numbers.
It converts to one common representation and back, so every format converts to every other:

- poses: x, y, z in metres and the canonical quaternion x, y, z, w; shape (n, 7),
- rotations: the same quaternion alone; shape (n, 4).

All poses are poses of a child in its parent.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
import difflib
import re
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.formulas import degrees_from_radians, radians_from_degrees
from sdf_pose_bridge.geometry.rotations import (
    canonical_quaternion,
    Floats,
    matrix_from_quaternion,
    quaternion_from_matrix,
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
    RotationError,
)
from sdf_pose_bridge.geometry.sequences import angle_sequence, AngleSequence, ZYX
from sdf_pose_bridge.geometry.units import (
    are_unlikely,
    DEGREES,
    METRES,
    MILLIMETRES,
    RADIANS,
    Unit,
    UNLIKELY,
)
from sdf_pose_bridge.printed_text import shortened

LAST_ROW = (0.0, 0.0, 0.0, 1.0)
"""Last row of the 4 x 4 matrix of a pose, exactly; libfranka compares without a tolerance."""

_LONGEST_NAME, _MOST_NAMES = 40, 3
_SEQUENCE = re.compile('[sr]?(?!.?xx|.?yy|.?zz)[xyz]{3}')
_ORDER_OR_UNIT = re.compile('[wxyz]{3,4}|rpy|ypr|row|col|deg|rad|mm')

NORM_TOLERANCE = 0.01
"""A quaternion that is written into a file has the length 1 within this."""


class PoseFormatError(ValueError):
    """The values are not poses in the format; the message names the value and the rule."""


class Numbers(NamedTuple):
    """How numbers other than angles about axes represent a rotation."""

    quaternions_from_numbers: Callable[[Floats], Floats]
    """Converts finite numbers, angles in radians; raises RotationError."""
    numbers_from_quaternions: Callable[[Floats], Floats]


class Format(NamedTuple):
    """A format of a pose or a rotation as a row of numbers."""

    name: str
    """Name for users."""
    text: str
    """The values in their order, for people; with ``{length}`` and ``{angle}`` for units."""
    rotation: AngleSequence | Numbers
    """How the numbers of the rotation represent it."""
    columns: tuple[int, ...]
    """The indices of these numbers: angles in the order of the sequence, x y z w, or row after row
    of a matrix."""
    angle: Unit | None = None
    """The unit of angles; None if there are none."""
    position: tuple[int, ...] = ()
    """The indices of x, y and z of a pose."""
    length: Unit = METRES
    """The unit of the position."""
    last_row: tuple[int, ...] = ()
    """The indices of the last row of a matrix."""
    synonyms: tuple[str, ...] = ()
    """Other names."""
    said_units: tuple[Unit | None, ...] = ()
    """The units that somebody said, which are not doubted."""

    @property
    def row_length(self) -> int:
        """Number of values of a pose or rotation."""
        return len(self.position) + len(self.columns) + len(self.last_row)

    @property
    def meaning(self) -> str:
        """The values in their order, with units, for people."""
        return self.text.format(length=self.length.text, angle=self.angle and self.angle.text)

    @property
    def half_turn(self) -> float:
        """A half turn in the unit of angles; 1 if there are none."""
        return self.angle.half_turn if self.angle else 1.0

    @property
    def sequence(self) -> AngleSequence | None:
        """The sequence of rotations; None if the numbers are not their angles."""
        return self.rotation if isinstance(self.rotation, AngleSequence) else None

    def common_from_rows(self, rows: Floats) -> Floats:
        """
        Convert finite rows, shape (n, row_length), to the common representation.

        :raises RotationError: if they are not rotations, or no matrices of poses.
        """
        numbers = rows[:, self.columns]
        if self.angle == DEGREES:
            numbers = radians_from_degrees(numbers) if self.sequence else np.radians(numbers)
        quats = self.rotation.quaternions_from_numbers(numbers)
        is_exact = rows[:, self.last_row] == LAST_ROW[:len(self.last_row)]
        if not is_exact.all():
            row = int(np.argmin(is_exact.all(axis=1)))
            msg = (
                f'row {row}: last row of the matrix is {tuple(rows[row, self.last_row].tolist())},'
                f' and must be exactly {LAST_ROW}')
            raise RotationError(msg)
        return np.concatenate((rows[:, self.position] / self.length.factor, quats), axis=1)

    def rows_from_common(self, common: Floats) -> Floats:
        """Convert the common representation to rows, shape (n, row_length)."""
        rows = np.empty((len(common), self.row_length))
        numbers = self.rotation.numbers_from_quaternions(common[:, -4:])
        rows[:, self.columns] = (
            degrees_from_radians(numbers) if self.angle == DEGREES else numbers)
        if self.position:
            rows[:, self.position] = common[:, :3] * self.length.factor
            rows[:, self.last_row] = LAST_ROW[:len(self.last_row)]
        return rows

    @np.errstate(all='ignore')  # what overflows is neither round nor of unit length
    def doubt(
        self, values: Sequence[float] | Floats, *, is_written: bool = False, dashes: str = '',
    ) -> str:
        """
        Ask about rows that probably mean something else than this format says; empty for others.

        :param values: finite numbers, shape (n * row_length,) or (n, row_length).
        :param is_written: whether a file gets them, so that quaternions must be of unit length.
        :param dashes: before the names of units that are options of a command.
        """
        rows = np.reshape(values, (-1, self.row_length))
        numbers = rows[:, sorted(self.columns)]
        reasons, likely_units = [], []
        for clause, unit, part in (
            ('the angles {} are {}', self.angle, numbers),
            ('the position {} is in {}', self.length, rows[:, self.position]),
        ):
            if unit and unit not in self.said_units and (
                    unlikely := part[are_unlikely(part, unit)]).size:
                reasons.append(clause.format(_shown(unlikely[0]), unit.text))
                likely_units.append(dashes + UNLIKELY[unit][-1].text)
        if is_written and self.rotation is _QUATERNION:
            norms = np.linalg.norm(numbers, axis=1)
            far = np.flatnonzero(np.abs(norms - 1.0) > NORM_TOLERANCE).tolist()
            reasons += [f'the quaternion {_shown(numbers[row])} has the length {norms[row]:g},'
                        ' not 1' for row in far[:1]]
        question = f'; did you mean {" ".join(likely_units)}?' if likely_units else ''
        return ' and '.join(reasons) + question


def converted_poses(
    values: Sequence[float] | Sequence[Sequence[float]] | Floats,
    from_format: str | Format,
    to_format: str | Format,
) -> Floats:
    """
    Convert poses from one format to another.

    :param values: any number of poses one after another, shape (n * row_length,), or one in each
        row, shape (n, row_length).
    :param from_format: format of the values, a name as for :func:`format_from_name`.
    :param to_format: format of the result; if it is the same, the poses become canonical.
    :return: the poses, shape (n * row_length,) or (n, row_length) like the values; new memory.
        The first and the last angle are within a half turn, the middle one (pitch) within a right
        angle, or from 0 to a half turn if the first and the last axis are the same. At gimbal lock
        the first one (yaw) is 0. Angles in these ranges keep their digits between formats with the
        same sequence.
    :raises PoseFormatError: an unknown format, a wrong length, values that are not finite, a
        quaternion of zeros, or a matrix that is not a rotation to within 1e-5.
    """
    return _converted(values, from_format, to_format, POSE_FORMATS, 'pose')


def converted_rotations(
    values: Sequence[float] | Sequence[Sequence[float]] | Floats,
    from_format: str | Format,
    to_format: str | Format,
) -> Floats:
    """
    Convert rotations as :func:`converted_poses` does poses, between :data:`ROTATION_FORMATS`.

    :raises PoseFormatError: as :func:`converted_poses`.
    """
    return _converted(values, from_format, to_format, ROTATION_FORMATS, 'rotation')


def format_from_name(
    name: str, formats: Mapping[str, Format], what: str = 'pose format',
    all_names: str = 'docs/pose_formats.md',
) -> Format:
    """
    Return the format with a name, a synonym, or the axes of Euler angles as in transforms3d.

    :param what: ``pose format`` or ``rotation format``, for the message.
    :param all_names: the place of the list of formats, for the message.
    :raises PoseFormatError: if there is none; the message has the nearest names.
    """
    names = {synonym: each for each in formats.values() for synonym in (each.name, *each.synonyms)}
    if str(name) in names:
        return names[str(name)]
    if _SEQUENCE.fullmatch(axes := str(name).lower()):
        if len(axes) == 3:
            msg = f'no {what} "{name}"; with fixed axes it is s{axes}, with turning ones r{axes}'
            raise PoseFormatError(msg)
        turned = _turned('angles', axes, RADIANS)._replace(name=axes)
        return _pose(axes, METRES, turned) if [*formats.values()][-1].position else turned
    msg = f'no {what} {shortened(repr(name))}; {_nearest(str(name), names)}all: {all_names}'
    raise PoseFormatError(msg)


def _nearest(wanted: str, names: Mapping[str, Format]) -> str:
    """Return a part of a message with the nearest names, none of another order, unit or maker."""
    wanted = wanted.lower()[:_LONGEST_NAME]
    orders_and_units = _ORDER_OR_UNIT.findall(wanted)
    makers = {*wanted.split('_')} & {name.split('_')[0] for name in names}
    alike = [name for name in names if makers <= {*name.split('_')} and all(
        any(each.startswith(part) for each in _ORDER_OR_UNIT.findall(name))
        for part in orders_and_units)]
    near = [name for name in alike if makers or wanted in name]
    near += difflib.get_close_matches(wanted, alike)
    shown: dict[str, str] = {}
    for name in near or (() if makers or orders_and_units else alike):
        shown.setdefault(names[name].name, name)
    word = 'near' if near else 'some'
    return f'{word}: {", ".join([*shown.values()][:_MOST_NAMES])}; ' if shown else ''


@np.errstate(over='ignore')  # numbers that overflow are an error
def _converted(
    values: object,
    from_format: str | Format,
    to_format: str | Format,
    formats: Mapping[str, Format],
    what: str,
) -> Floats:
    source, target = (
        each if isinstance(each, Format) else format_from_name(each, formats, f'{what} format')
        for each in (from_format, to_format))
    array = _array(values, source, what)
    rows = array.reshape(-1, source.row_length)
    is_finite = np.isfinite(rows)
    if not is_finite.all():
        row, column = np.argwhere(~is_finite)[0].tolist()
        place = f'row {row}, ' if len(rows) > 1 else ''
        msg = (f'{source.name}: {place}value {column} is {float(rows[row, column])!r};'
               ' it must be a finite number')
        raise PoseFormatError(msg)
    try:
        common = source.common_from_rows(rows)
    except RotationError as error:
        message = str(error).removeprefix('row 0: ' if len(rows) == 1 else '')
        msg = f'{source.name}: {message}'
        raise PoseFormatError(msg) from error
    result = target.rows_from_common(common)
    if source.sequence is not None and source.sequence is target.sequence:
        # Rounding must not change angles that are already canonical.
        angles = rows[:, source.columns]
        kept = np.flatnonzero(source.sequence.are_canonical(angles.T, source.half_turn))
        angles = angles[kept]
        result[kept[:, np.newaxis], target.columns] = (
            angles if target.angle == source.angle
            else angles * target.half_turn / source.half_turn)
    result += 0.0  # no negative zeros
    is_finite = np.isfinite(result)
    if not is_finite.all():
        row = int(np.argmin(is_finite.all(axis=1)))
        place = f'row {row}: ' if len(rows) > 1 else ''
        msg = (
            f'{source.name}: {place}{tuple(rows[row].tolist())} has too large a number for'
            f' {target.name}')
        raise PoseFormatError(msg)
    return result.reshape(-1) if array.ndim == 1 else result


def _array(values: object, source: Format, what: str) -> Floats:
    """Return the values with shape (n * row_length,) or (n, row_length)."""
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        msg = f'{source.name}: values must be numbers: {error}'
        raise PoseFormatError(msg) from error
    if array.ndim not in (1, 2) or array.shape[-1] % source.row_length or (
            array.ndim == 2 and array.shape[1] != source.row_length):
        what = (
            f'{array.size} values are not a whole number of {what}s' if array.ndim == 1 else
            f'values with shape {array.shape} are neither flat nor have one {what} in each row')
        msg = f'{what}: each {source.name} has {source.row_length} ({source.meaning})'
        raise PoseFormatError(msg)
    return array


def _shown(numbers: Floats) -> str:
    return ' '.join(f'{number:g}' for number in numbers.tolist())


# The table

_QUATERNION = Numbers(canonical_quaternion, np.copy)
_ROTATION_VECTOR = Numbers(quaternion_from_rotation_vector, rotation_vector_from_quaternion)
_MATRIX = Numbers(
    lambda rows: quaternion_from_matrix(rows.reshape(-1, 3, 3)),
    lambda quats: matrix_from_quaternion(quats).reshape(-1, 9))


def _turned(numbers: str, sequence: str, angle: Unit = DEGREES) -> Format:
    """Return angles in the order of the numbers; the sequence is named as by transforms3d."""
    letters = sequence[1:]
    if sequence[0] == 's':  # the same as about rotating axes in reverse
        text = f'{numbers} in {{angle}} about the fixed axes {", ".join(letters)}'
        return Format('', text, angle_sequence(letters[::-1]), (2, 1, 0), angle)
    turns = angle_sequence(letters)
    return Format('', f'{numbers} in {{angle}} ({turns.name})', turns, (0, 1, 2), angle)


def _pose(name: str, length: Unit, rotation: Format, *synonyms: str) -> Format:
    """Return a format with the numbers x y z of the position, and then those of a rotation."""
    return rotation._replace(
        name=name, text=f'x y z in {{length}}, {rotation.text}', position=(0, 1, 2), length=length,
        columns=tuple(3 + column for column in rotation.columns), synonyms=synonyms)


_RPY = Format('rpy', 'roll pitch yaw in {angle}', ZYX, (2, 1, 0), RADIANS)
_YPR = Format('ypr', 'yaw pitch roll in {angle}', ZYX, (0, 1, 2), RADIANS)
_XYZW = Format('quaternion', 'quaternion x y z w of any norm but 0', _QUATERNION, (0, 1, 2, 3))
_WXYZ = _XYZW._replace(
    name='quaternion_wxyz', text='quaternion w x y z of any norm but 0', columns=(1, 2, 3, 0))
_VECTOR = Format(
    'rotation_vector', 'rotation vector (axis times angle) in {angle}', _ROTATION_VECTOR,
    (0, 1, 2), RADIANS)

ROTATION_FORMATS: Mapping[str, Format] = {each.name: each for each in (
    _RPY._replace(synonyms=('rpy_radians',)),
    _RPY._replace(name='rpy_degrees', angle=DEGREES, synonyms=('rpy_deg',)),
    _YPR._replace(synonyms=('ypr_radians',)),
    _YPR._replace(name='ypr_degrees', angle=DEGREES, synonyms=('ypr_deg',)),
    _XYZW._replace(synonyms=('quaternion_xyzw', 'quat', 'quat_xyzw')),
    _WXYZ._replace(synonyms=('quat_wxyz',)),
    Format('matrix', '3 x 3 matrix row after row', _MATRIX, tuple(range(9))),
    _VECTOR._replace(synonyms=('rotvec', 'axis_angle')),
    _VECTOR._replace(
        name='rotation_vector_degrees', angle=DEGREES, synonyms=('rotvec_degrees',)),
)}
"""All formats of rotations by name; their common representation has shape (n, 4)."""

POSE_FORMATS: Mapping[str, Format] = {each.name: each for each in (
    _pose('sdf_rpy', METRES, _RPY, 'sdf_rpy_radians'),
    _pose('sdf_rpy_degrees', METRES, _RPY._replace(angle=DEGREES), 'sdf_rpy_deg'),
    _pose('sdf_quat_xyzw', METRES, _XYZW, 'sdf_quat'),
    Format(
        'matrix_row_major', '4 x 4 matrix row after row, in {length}', _MATRIX,
        (0, 1, 2, 4, 5, 6, 8, 9, 10), position=(3, 7, 11), last_row=(12, 13, 14, 15)),
    Format(
        'franka_matrix', '4 x 4 matrix column after column, in {length}', _MATRIX,
        (0, 4, 8, 1, 5, 9, 2, 6, 10), position=(12, 13, 14), last_row=(3, 7, 11, 15),
        synonyms=('matrix_column_major', 'matrix_col_major')),
    _pose('franka_measured', MILLIMETRES, _turned('rotations x y z', 'sxyz')),
    _pose('ur_pose', METRES, _VECTOR),
    _pose('ur_pendant', MILLIMETRES, _VECTOR),
    _pose('kuka_abc', MILLIMETRES, _turned('A B C', 'rzyx'), 'kuka'),
    _pose('abb', MILLIMETRES, _WXYZ, 'abb_quaternion'),
    _pose('fanuc_wpr', MILLIMETRES, _turned('W P R', 'sxyz'), 'fanuc'),
    _pose('yaskawa', MILLIMETRES, _turned('Rx Ry Rz', 'sxyz'), 'motoman'),
    _pose('staubli', MILLIMETRES, _turned('Rx Ry Rz', 'rxyz')),
    _pose('kawasaki_oat', MILLIMETRES, _turned('O A T', 'rzyz'), 'kawasaki'),
    _pose('doosan', MILLIMETRES, _turned('A B C', 'rzyz')),
    _pose('kinova_gen3', METRES, _turned('theta_x theta_y theta_z', 'sxyz'), 'kinova'),
    _pose('kinova_jaco', METRES, _turned('ThetaX ThetaY ThetaZ', 'rxyz'), 'kinova_mico'),
    _pose('mujoco', METRES, _WXYZ, 'sdf_quat_wxyz'),
    _pose('mitsubishi', MILLIMETRES, _turned('A B C', 'sxyz'), 'melfa'),
    _pose('denso', MILLIMETRES, _turned('RX RY RZ', 'sxyz')),
    _pose('epson_uvw', MILLIMETRES, _turned('U V W', 'rzyx'), 'epson'),
    _pose('ufactory', MILLIMETRES, _turned('roll pitch yaw', 'sxyz'), 'xarm'),
)}
"""All formats of poses by name; their common representation has shape (n, 7)."""
