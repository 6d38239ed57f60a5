# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Convert poses and rotations between the formats that robots and files write them in.

A format is one entry of a registry. It knows the way to one common representation and back, so
that any format converts to any other:

- poses: x, y, z in metres and the unit quaternion x, y, z, w with w >= 0; shape (n, 7),
- rotations: the same quaternion alone; shape (n, 4).

All poses are those of a child in its parent.
"""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Iterable
from collections.abc import Mapping
from collections.abc import Sequence
import math
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.angles import degrees_from_radians
from sdf_pose_bridge.geometry.angles import radians_from_degrees
from sdf_pose_bridge.geometry.rotation import canonical_quaternion
from sdf_pose_bridge.geometry.rotation import matrix_from_quaternion
from sdf_pose_bridge.geometry.rotation import quaternion_from_matrix
from sdf_pose_bridge.geometry.rotation import quaternion_from_rpy
from sdf_pose_bridge.geometry.rotation import RotationError
from sdf_pose_bridge.geometry.rotation import rpy_from_quaternion
from sdf_pose_bridge.geometry.rotation_checks import Floats
from sdf_pose_bridge.geometry.rotation_checks import listed

LAST_ROW = (0.0, 0.0, 0.0, 1.0)
"""Of every 4 x 4 matrix of a pose, exactly; libfranka compares without a tolerance."""


class PoseFormatError(ValueError):
    """Values that are no poses in the format named; the message says which rule they break."""


class PoseFormat(NamedTuple):
    """How one kind of row of numbers says a pose or a rotation."""

    name: str
    """What users call it."""
    row_length: int
    """Numbers of one pose."""
    meaning: str
    """The numbers in their order, with units, for people."""
    to_common: Callable[[Floats], Floats]
    """Converts finite rows (n, row_length) to the common representation; raises RotationError."""
    from_common: Callable[[Floats], Floats]
    """Converts the common representation to rows (n, row_length)."""
    half_turn: float | None = None
    """What half a turn is in the last three numbers, if these are roll, pitch and yaw."""


def converted_poses(
    values: Sequence[float] | Sequence[Sequence[float]] | Floats,
    from_format: str,
    to_format: str,
) -> Floats:
    """
    Convert poses from one format to another.

    :param values: poses after one another, shape (n * row,), or one in each row, shape (n, row);
        any number of them, none too.
    :param from_format: what they are in, a name in :data:`POSE_FORMATS`.
    :param to_format: what they shall be in; the same is allowed, and makes them canonical.
    :return: the same poses, shape (n * row,) or (n, row) as they were given; new memory. Roll and
        yaw are within a half turn, pitch within a right angle, and yaw is 0 at gimbal lock; angles
        given so keep their digits between formats that have angles.
    :raises PoseFormatError: an unknown format, a wrong length, values that are not finite, a
        quaternion of zeros, or a matrix that is no rotation to within 1e-5.
    """
    return _converted(values, from_format, to_format, POSE_FORMATS, 'pose')


def converted_rotations(
    values: Sequence[float] | Sequence[Sequence[float]] | Floats,
    from_format: str,
    to_format: str,
) -> Floats:
    """
    Convert rotations from one format to another.

    :param values: rotations after one another, shape (n * row,), or one in each row, shape
        (n, row).
    :param from_format: what they are in, a name in :data:`ROTATION_FORMATS`.
    :param to_format: what they shall be in; the same is allowed, and makes them canonical.
    :return: the same rotations, shape (n * row,) or (n, row) as they were given; new memory.
    :raises PoseFormatError: as :func:`converted_poses`.
    """
    return _converted(values, from_format, to_format, ROTATION_FORMATS, 'rotation')


def _converted(
    values: object,
    from_format: str,
    to_format: str,
    formats: Mapping[str, PoseFormat],
    what: str,
) -> Floats:
    source = _format_named(from_format, formats, what)
    target = _format_named(to_format, formats, what)
    rows, is_flat = _rows(values, source, what)
    _refuse_not_finite(rows, source)
    try:
        common = source.to_common(rows)
    except RotationError as error:
        msg = f'{source.name}: {_without_only_row(str(error), len(rows))}'
        raise PoseFormatError(msg) from error
    with np.errstate(over='ignore'):
        result = target.from_common(common)
    if source.half_turn and target.half_turn:
        _keep_angles_in_range(rows[:, -3:], source.half_turn, result[:, -3:], target.half_turn)
    result += 0.0  # makes 0 of what is -0 in the values given
    finite = np.isfinite(result)
    if not finite.all():
        row = int(np.argmin(finite.all(axis=1)))
        msg = (
            f'{source.name}: {_without_only_row(f"row {row}: ", len(rows))}{listed(rows[row])} is'
            f' too large a number for {target.name}'
        )
        raise PoseFormatError(msg)
    return result.reshape(-1) if is_flat else result


def _keep_angles_in_range(
    given: Floats, given_half_turn: float, result: Floats, half_turn: float
) -> None:
    """Put angles that are canonical as they are given in place of those that rounding moved."""
    angles = np.abs(given)
    # Not near lock, where yaw may have to be 0.
    angles[:, 1] *= 2.0 + 1e-7
    canonical = (angles <= given_half_turn).all(axis=1, keepdims=True)
    scaled = given if half_turn == given_half_turn else given * half_turn / given_half_turn
    np.copyto(result, scaled, where=canonical)


def _format_named(name: str, formats: Mapping[str, PoseFormat], what: str) -> PoseFormat:
    try:
        return formats[name]
    except (KeyError, TypeError):
        known = ', '.join(formats)
        msg = f'there is no {what} format {name!r}; known are {known}'
        raise PoseFormatError(msg) from None


def _rows(values: object, source: PoseFormat, what: str) -> tuple[Floats, bool]:
    """Return the values as (n, row) and whether they were given flat."""
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        msg = f'{source.name}: values must be numbers: {error}'
        raise PoseFormatError(msg) from error
    if array.ndim == 1:
        if array.size % source.row_length:
            msg = (
                f'{array.size} values are no whole number of {what}s: each {source.name} has'
                f' {source.row_length} ({source.meaning})'
            )
            raise PoseFormatError(msg)
        return array.reshape(-1, source.row_length), True
    if array.ndim != 2 or array.shape[1] != source.row_length:
        msg = (
            f'values have shape {array.shape}: each {source.name} has {source.row_length}'
            f' ({source.meaning}), so they must be flat or have shape (n, {source.row_length})'
        )
        raise PoseFormatError(msg)
    return array, False


def _refuse_not_finite(rows: Floats, source: PoseFormat) -> None:
    finite = np.isfinite(rows)
    if not finite.all():
        row = int(np.argmin(finite.all(axis=1)))
        column = int(np.argmin(finite[row]))
        place = f'row {row}, value {column}' if len(rows) > 1 else f'value {column}'
        msg = f'{source.name}: {place} is {float(rows[row, column])!r}; it must be a finite number'
        raise PoseFormatError(msg)


def _without_only_row(message: str, count: int) -> str:
    return message.removeprefix('row 0: ') if count == 1 else message


def _pose(xyz_m: Floats, quat_xyzw: Floats) -> Floats:
    return np.concatenate((xyz_m, quat_xyzw), axis=1)


def _rows_of_matrices(matrices: Floats) -> Floats:
    """Return poses (n, 7) of matrices (n, 4, 4)."""
    last = matrices[:, 3]
    good = last == LAST_ROW
    if not good.all():
        row = int(np.argmin(good.all(axis=1)))
        msg = (
            f'row {row}: last row of the matrix is {listed(last[row])}, and must be exactly'
            f' {listed(LAST_ROW)}'
        )
        raise RotationError(msg)
    return _pose(matrices[:, :3, 3], quaternion_from_matrix(matrices[:, :3, :3]))


def _matrices_of_rows(pose: Floats) -> Floats:
    """Return matrices (n, 4, 4) of poses (n, 7)."""
    matrices = np.empty((len(pose), 4, 4))
    matrices[:, :3, :3] = matrix_from_quaternion(pose[:, 3:])
    matrices[:, :3, 3] = pose[:, :3]
    matrices[:, 3] = LAST_ROW
    return matrices


def _transposed(matrices: Floats) -> Floats:
    return np.swapaxes(matrices, 1, 2)


_POSE_FORMATS: Iterable[PoseFormat] = (
    PoseFormat(
        'sdf_rpy', 6, 'x y z in metres, roll pitch yaw in radians',
        lambda row: _pose(row[:, :3], quaternion_from_rpy(row[:, 3:])),
        lambda pose: _pose(pose[:, :3], rpy_from_quaternion(pose[:, 3:])),
        half_turn=math.pi,
    ),
    PoseFormat(
        'sdf_rpy_degrees', 6, 'x y z in metres, roll pitch yaw in degrees',
        lambda row: _pose(row[:, :3], quaternion_from_rpy(radians_from_degrees(row[:, 3:]))),
        lambda pose: _pose(
            pose[:, :3], degrees_from_radians(rpy_from_quaternion(pose[:, 3:]))
        ),
        half_turn=180.0,
    ),
    PoseFormat(
        'sdf_quat_xyzw', 7, 'x y z in metres, quaternion x y z w of any norm but 0',
        lambda row: _pose(row[:, :3], canonical_quaternion(row[:, 3:])),
        np.copy,
    ),
    PoseFormat(
        'matrix_row_major', 16, '4 x 4 matrix row after row, in metres',
        lambda row: _rows_of_matrices(row.reshape(-1, 4, 4)),
        lambda pose: _matrices_of_rows(pose).reshape(-1, 16),
    ),
    PoseFormat(
        'franka_matrix', 16, '4 x 4 matrix column after column, in metres',
        lambda row: _rows_of_matrices(_transposed(row.reshape(-1, 4, 4))),
        lambda pose: _transposed(_matrices_of_rows(pose)).reshape(-1, 16),
    ),
    PoseFormat(
        'franka_measured', 6,
        "x y z in millimetres, rotations x y z in degrees (z-y'-x'': x is roll, z is yaw)",
        lambda row: _pose(
            row[:, :3] / 1000.0, quaternion_from_rpy(radians_from_degrees(row[:, 3:]))
        ),
        lambda pose: _pose(
            pose[:, :3] * 1000.0, degrees_from_radians(rpy_from_quaternion(pose[:, 3:]))
        ),
        half_turn=180.0,
    ),
)

POSE_FORMATS: Mapping[str, PoseFormat] = MappingProxyType(
    {entry.name: entry for entry in _POSE_FORMATS}
)
"""All formats of poses by name; their common representation has shape (n, 7)."""

_ROTATION_FORMATS: Iterable[PoseFormat] = (
    PoseFormat(
        'rpy', 3, 'roll pitch yaw in radians', quaternion_from_rpy, rpy_from_quaternion,
        half_turn=math.pi,
    ),
    PoseFormat(
        'rpy_degrees', 3, 'roll pitch yaw in degrees',
        lambda row: quaternion_from_rpy(radians_from_degrees(row)),
        lambda quat: degrees_from_radians(rpy_from_quaternion(quat)),
        half_turn=180.0,
    ),
    PoseFormat(
        'quaternion', 4, 'x y z w of any norm but 0', canonical_quaternion, np.copy
    ),
    PoseFormat(
        'quaternion_wxyz', 4, 'w x y z of any norm but 0',
        lambda row: canonical_quaternion(row[:, [1, 2, 3, 0]]),
        lambda quat: quat[:, [3, 0, 1, 2]],
    ),
    PoseFormat(
        'matrix', 9, '3 x 3 matrix row after row',
        lambda row: quaternion_from_matrix(row.reshape(-1, 3, 3)),
        lambda quat: matrix_from_quaternion(quat).reshape(-1, 9),
    ),
)

ROTATION_FORMATS: Mapping[str, PoseFormat] = MappingProxyType(
    {entry.name: entry for entry in _ROTATION_FORMATS}
)
"""All formats of rotations by name; their common representation has shape (n, 4)."""
