# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Convert poses and rotations between the formats of robots and files.

A format is one entry of a registry. It converts to one common representation and back, so every
format converts to every other:

- poses: x, y, z in metres and the canonical quaternion x, y, z, w; shape (n, 7),
- rotations: the same quaternion alone; shape (n, 4).

All poses are poses of a child in its parent.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
import math
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.formulas import degrees_from_radians, radians_from_degrees
from sdf_pose_bridge.geometry.rotations import (
    canonical_quaternion,
    Floats,
    matrix_from_quaternion,
    quaternion_from_matrix,
    quaternion_from_rotation_vector,
    quaternion_from_rpy,
    rotation_vector_from_quaternion,
    RotationError,
    rpy_from_quaternion,
)

LAST_ROW = (0.0, 0.0, 0.0, 1.0)
"""Last row of the 4 x 4 matrix of a pose, exactly; libfranka compares without a tolerance."""

LARGEST_ANGLE_RAD = 2.5 * math.pi
"""A larger angle is probably in degrees; one of a little more than a turn may be meant."""

FAR_M = 100.0
"""A position that is at least this far away is probably in millimetres."""


class PoseFormatError(ValueError):
    """The values are not poses in the format; the message names the value and the rule."""


class UnitDoubt(NamedTuple):
    """Numbers are probably in another unit than their format has."""

    reason: str
    """A clause with the numbers and the unit of the format."""
    likely_unit: str
    """``degrees`` or ``mm``."""


class Format(NamedTuple):
    """A format of a pose or a rotation as a row of numbers."""

    name: str
    """Name for users."""
    row_length: int
    """Number of values of a pose or rotation."""
    meaning: str
    """The values in their order, with units, for the help of the command line."""
    to_common: Callable[[Floats], Floats]
    """Converts finite rows (n, row_length) to the common representation; raises RotationError."""
    from_common: Callable[[Floats], Floats]
    """Converts the common representation to rows (n, row_length)."""
    largest: float = 1.0
    """The largest number of a rotation in the format; of angles half a turn."""
    has_rpy: bool = False
    """Whether the last three numbers are roll, pitch and yaw."""
    position: tuple[int, ...] = ()
    """The indices of x, y and z of a pose."""
    metre: float = 1.0
    """A metre in the unit of the position."""

    def doubt(self, numbers: Sequence[float]) -> UnitDoubt | None:
        """Return why numbers are probably in another unit than the format has, or None."""
        angles, xyz = numbers[-3:], [numbers[index] for index in self.position]
        if self.largest == math.pi and max(map(abs, angles)) > LARGEST_ANGLE_RAD:
            return UnitDoubt(f'the angles {_shown(angles)} are radians', 'degrees')
        if self.metre == 1.0 and max(map(abs, xyz), default=0.0) >= FAR_M:
            return UnitDoubt(f'the position {_shown(xyz)} is in metres', 'mm')
        return None


def converted_poses(
    values: Sequence[float] | Sequence[Sequence[float]] | Floats,
    from_format: str,
    to_format: str,
) -> Floats:
    """
    Convert poses from one format to another.

    :param values: any number of poses one after another, shape (n * row_length,), or one in each
        row, shape (n, row_length).
    :param from_format: format of the values, a name in :data:`POSE_FORMATS`.
    :param to_format: format of the result; if it is the same, the poses become canonical.
    :return: the poses, shape (n * row_length,) or (n, row_length) like the values; new memory.
        Roll and yaw are within a half turn, pitch within a right angle, and yaw is 0 at gimbal
        lock. Angles in these ranges keep their digits between formats that have angles.
    :raises PoseFormatError: an unknown format, a wrong length, values that are not finite, a
        quaternion of zeros, or a matrix that is not a rotation to within 1e-5.
    """
    return _converted(values, from_format, to_format, POSE_FORMATS, 'pose')


def converted_rotations(
    values: Sequence[float] | Sequence[Sequence[float]] | Floats,
    from_format: str,
    to_format: str,
) -> Floats:
    """
    Convert rotations as :func:`converted_poses` does poses, between :data:`ROTATION_FORMATS`.

    :raises PoseFormatError: as :func:`converted_poses`.
    """
    return _converted(values, from_format, to_format, ROTATION_FORMATS, 'rotation')


def without_rounding_errors(values: Floats, source: Format, target: Format) -> Floats:
    """
    Replace rounding errors of a conversion by zero, for people who read the numbers.

    :param values: rows in the target format, shape (n, row_length).
    :return: a copy in which numbers of a rotation are zero that are below four units of rounding
        of the largest number; between formats with roll, pitch and yaw, which are exact, a copy.
    """
    shown: Floats = values.copy()
    if source is not target and not (source.has_rpy and target.has_rpy):
        is_error = np.abs(values) < 4.0 * np.finfo(float).eps * target.largest
        is_error[:, list(target.position)] = False
        shown[is_error] = 0.0
    return shown


def are_canonical_angles(rpy: Any, half_turn: float) -> Any:
    """Return whether angles are in their ranges and not near gimbal lock; floats or arrays."""
    roll, pitch, yaw = rpy
    return (
        (abs(roll) <= half_turn) & (abs(yaw) <= half_turn)
        & (abs(pitch) * (2.0 + 1e-7) <= half_turn))


def _converted(
    values: object,
    from_format: str,
    to_format: str,
    formats: Mapping[str, Format],
    what: str,
) -> Floats:
    source = _format_from_name(from_format, formats, what)
    target = _format_from_name(to_format, formats, what)
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
        common = source.to_common(rows)
    except RotationError as error:
        message = str(error).removeprefix('row 0: ' if len(rows) == 1 else '')
        msg = f'{source.name}: {message}'
        raise PoseFormatError(msg) from error
    with np.errstate(over='ignore'):
        result = target.from_common(common)
    if source.has_rpy and target.has_rpy:
        # Rounding must not change angles that are already canonical.
        are_canonical = are_canonical_angles(rows[:, -3:].T, source.largest)
        angles = rows[are_canonical, -3:]
        if target.largest != source.largest:
            angles = angles * target.largest / source.largest
        result[are_canonical, -3:] = angles
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


def _format_from_name(name: str, formats: Mapping[str, Format], what: str) -> Format:
    try:
        return formats[name]
    except (KeyError, TypeError):
        msg = f'there is no {what} format {name!r}; known are {", ".join(formats)}'
        raise PoseFormatError(msg) from None


def _array(values: object, source: Format, what: str) -> Floats:
    """Return the values with shape (n * row_length,) or (n, row_length)."""
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        msg = f'{source.name}: values must be numbers: {error}'
        raise PoseFormatError(msg) from error
    if array.ndim == 1:
        if array.size % source.row_length:
            msg = (
                f'{array.size} values are not a whole number of {what}s: each {source.name} has'
                f' {source.row_length} ({source.meaning})')
            raise PoseFormatError(msg)
    elif array.ndim != 2 or array.shape[1] != source.row_length:
        msg = (
            f'values have shape {array.shape}: each {source.name} has {source.row_length}'
            f' ({source.meaning}), so they must be flat or have shape (n, {source.row_length})')
        raise PoseFormatError(msg)
    return array


def _shown(numbers: Sequence[float]) -> str:
    return ' '.join(f'{number:g}' for number in numbers)


def _pose_format(
    name: str, meaning: str, rotation: Format, metre: float = 1.0, *,
    position: tuple[int, ...] = (0, 1, 2), rest: Sequence[int] = (), last_row: Sequence[int] = (),
) -> Format:
    """
    Return a format with a position and a rotation.

    :param position: the indices of x, y and z.
    :param rest: the indices of the numbers of the rotation, if they do not follow the position.
    :param last_row: the indices of the last row of a matrix.
    """
    rotated = list(rest or range(3, 3 + rotation.row_length))
    constant, constants = list(last_row), LAST_ROW[:len(last_row)]
    row_length = 3 + len(rotated) + len(constant)

    def poses_from_rows(rows: Floats) -> Floats:
        is_exact = rows[:, constant] == constants
        if not is_exact.all():
            row = int(np.argmin(is_exact.all(axis=1)))
            msg = (
                f'row {row}: last row of the matrix is {tuple(rows[row, constant].tolist())}, and'
                f' must be exactly {LAST_ROW}')
            raise RotationError(msg)
        return np.concatenate(
            (rows[:, position] / metre, rotation.to_common(rows[:, rotated])), axis=1)

    def rows_from_poses(poses: Floats) -> Floats:
        rows = np.empty((len(poses), row_length))
        rows[:, position] = poses[:, :3] * metre
        rows[:, rotated] = rotation.from_common(poses[:, 3:])
        rows[:, constant] = constants
        return rows

    return rotation._replace(
        name=name, row_length=row_length, meaning=meaning, to_common=poses_from_rows,
        from_common=rows_from_poses, position=position, metre=metre)


def _registry(*formats: Format) -> Mapping[str, Format]:
    return MappingProxyType({entry.name: entry for entry in formats})


ROTATION_FORMATS = _registry(
    Format(
        'rpy', 3, 'roll pitch yaw in radians', quaternion_from_rpy, rpy_from_quaternion,
        largest=math.pi, has_rpy=True,
    ),
    Format(
        'rpy_degrees', 3, 'roll pitch yaw in degrees',
        lambda row: quaternion_from_rpy(radians_from_degrees(row)),
        lambda quat: degrees_from_radians(rpy_from_quaternion(quat)),
        largest=180.0, has_rpy=True,
    ),
    Format('quaternion', 4, 'x y z w of any norm but 0', canonical_quaternion, np.copy),
    Format(
        'quaternion_wxyz', 4, 'w x y z of any norm but 0',
        lambda row: canonical_quaternion(row[:, [1, 2, 3, 0]]),
        lambda quat: quat[:, [3, 0, 1, 2]],
    ),
    Format(
        'matrix', 9, '3 x 3 matrix row after row',
        lambda row: quaternion_from_matrix(row.reshape(-1, 3, 3)),
        lambda quat: matrix_from_quaternion(quat).reshape(-1, 9),
    ),
    Format(
        'rotation_vector', 3, 'axis times angle in radians',
        quaternion_from_rotation_vector, rotation_vector_from_quaternion, largest=math.pi,
    ),
    Format(
        'rotation_vector_degrees', 3, 'axis times angle in degrees',
        lambda row: quaternion_from_rotation_vector(np.radians(row)),
        lambda quat: degrees_from_radians(rotation_vector_from_quaternion(quat)), largest=180.0,
    ),
)
"""All formats of rotations by name; their common representation has shape (n, 4)."""

POSE_FORMATS = _registry(
    _pose_format(
        'sdf_rpy', 'x y z in metres, roll pitch yaw in radians', ROTATION_FORMATS['rpy']),
    _pose_format(
        'sdf_rpy_degrees', 'x y z in metres, roll pitch yaw in degrees',
        ROTATION_FORMATS['rpy_degrees']),
    _pose_format(
        'sdf_quat_xyzw', 'x y z in metres, quaternion x y z w of any norm but 0',
        ROTATION_FORMATS['quaternion']),
    _pose_format(
        'matrix_row_major', '4 x 4 matrix row after row, in metres', ROTATION_FORMATS['matrix'],
        position=(3, 7, 11), rest=(0, 1, 2, 4, 5, 6, 8, 9, 10), last_row=(12, 13, 14, 15)),
    _pose_format(
        'franka_matrix', '4 x 4 matrix column after column, in metres', ROTATION_FORMATS['matrix'],
        position=(12, 13, 14), rest=(0, 4, 8, 1, 5, 9, 2, 6, 10), last_row=(3, 7, 11, 15)),
    _pose_format(
        'franka_measured',
        "x y z in millimetres, rotations x y z in degrees (z-y'-x'': x is roll, z is yaw)",
        ROTATION_FORMATS['rpy_degrees'], metre=1000.0),
    _pose_format(
        'ur_pose', 'x y z in metres, rotation vector (axis times angle) in radians',
        ROTATION_FORMATS['rotation_vector']),
)
"""All formats of poses by name; their common representation has shape (n, 7)."""
