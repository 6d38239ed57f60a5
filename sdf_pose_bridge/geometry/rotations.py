# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Convert rotations between roll-pitch-yaw, quaternions, rotation vectors and matrices.

Conventions:

- Roll, pitch and yaw are rotations about the fixed axes x, y, z, in this order and in radians:
  ``R = Rz(yaw) Ry(pitch) Rx(roll)``, as in SDFormat and URDF.
- Quaternions are x, y, z, w, with the real part last. Input may have any norm but zero. Output is
  unit to the last bit and canonical: w >= 0, and if w is 0, the first of x, y, z that is not 0 is
  positive.
- Matrices rotate column vectors: ``v_parent = R v_child``. Input may differ from a rotation by
  1e-5; the nearest rotation is used.
- Roll and yaw of output are in [-pi, pi], pitch is in [-pi/2, pi/2].

Every function takes one rotation or many. One is a tuple or list of floats; the result is a tuple
and takes a few microseconds. Many are an array of shape (..., 3), (..., 4) or (..., 3, 3), or
nested sequences; the result is an array with the same leading shape.

At gimbal lock, where pitch is a right angle, only roll - yaw (pitch up) or roll + yaw (pitch down)
is defined: yaw is then 0 and roll has all of it, as in gz-math. Near lock each angle alone is less
certain, but together they represent the given rotation. :func:`near_gimbal_lock` returns whether
gz-math would set yaw to 0, which changes the rotation by up to 4.5e-8 radians.

The rotation returned differs from the one given by at most 1.2e-15 radians, for every rotation and
every representation.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
import math
from typing import NamedTuple, overload, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.geometry import floats, formulas

Floats: TypeAlias = NDArray[np.float64]
Triple: TypeAlias = tuple[float, float, float]
Quaternion: TypeAlias = tuple[float, float, float, float]
Matrix: TypeAlias = tuple[Triple, Triple, Triple]
One: TypeAlias = Sequence[float]
OneMatrix: TypeAlias = Sequence[Sequence[float]]
Many: TypeAlias = Floats | Sequence[Sequence[float]]
ManyMatrices: TypeAlias = Floats | Sequence[Sequence[Sequence[float]]]

_Values: TypeAlias = One | OneMatrix | Many | ManyMatrices
_Result = TypeVar('_Result', Triple, Quaternion, Matrix)

LOCK_TOLERANCE = 1e-15
"""Of gz-math: at gimbal lock the sine of pitch differs from 1 or -1 by less than this."""


class RotationError(ValueError):
    """The numbers are not a rotation; the message names the value and the rule."""


@overload
def quaternion_from_rpy(rpy_rad: One) -> Quaternion: ...
@overload
def quaternion_from_rpy(rpy_rad: Many) -> Floats: ...
def quaternion_from_rpy(rpy_rad: One | Many) -> Quaternion | Floats:
    """
    Convert roll, pitch, yaw to a quaternion.

    :param rpy_rad: roll, pitch, yaw in radians, of any size; shape (3,) or (..., 3).
    :return: x, y, z, w; unit, w >= 0; shape (4,) or (..., 4).
    :raises RotationError: wrong shape or not finite.
    """
    return _converted(formulas.quaternion_from_rpy, rpy_rad, _RPY, (4,))


@overload
def rpy_from_quaternion(quat_xyzw: One) -> Triple: ...
@overload
def rpy_from_quaternion(quat_xyzw: Many) -> Floats: ...
def rpy_from_quaternion(quat_xyzw: One | Many) -> Triple | Floats:
    """
    Convert a quaternion to roll, pitch, yaw.

    :param quat_xyzw: x, y, z, w of any norm but zero; shape (4,) or (..., 4).
    :return: roll, pitch, yaw in radians; roll and yaw in [-pi, pi], pitch in [-pi/2, pi/2], yaw 0
        at gimbal lock; shape (3,) or (..., 3).
    :raises RotationError: wrong shape, not finite or zero.
    """
    return _converted(formulas.rpy_from_quaternion, quat_xyzw, _QUATERNION, (3,))


@overload
def matrix_from_quaternion(quat_xyzw: One) -> Matrix: ...
@overload
def matrix_from_quaternion(quat_xyzw: Many) -> Floats: ...
def matrix_from_quaternion(quat_xyzw: One | Many) -> Matrix | Floats:
    """
    Convert a quaternion to a rotation matrix.

    :param quat_xyzw: x, y, z, w of any norm but zero; shape (4,) or (..., 4).
    :return: a tuple of the three rows, or an array of shape (..., 3, 3).
    :raises RotationError: wrong shape, not finite or zero.
    """
    return _converted(formulas.matrix_from_quaternion, quat_xyzw, _QUATERNION, (3, 3))


@overload
def quaternion_from_matrix(matrix: OneMatrix) -> Quaternion: ...
@overload
def quaternion_from_matrix(matrix: ManyMatrices) -> Floats: ...
def quaternion_from_matrix(matrix: OneMatrix | ManyMatrices) -> Quaternion | Floats:
    """
    Convert a rotation matrix to a quaternion.

    :param matrix: three rows, or shape (..., 3, 3); a rotation to within 1e-5, of which the
        nearest rotation is used.
    :return: x, y, z, w; unit, w >= 0; shape (4,) or (..., 4).
    :raises RotationError: wrong shape, not finite, not orthonormal or with determinant -1.
    """
    return _converted(formulas.quaternion_from_matrix, matrix, _MATRIX, (4,))


@overload
def quaternion_from_rotation_vector(rotation_vector_rad: One) -> Quaternion: ...
@overload
def quaternion_from_rotation_vector(rotation_vector_rad: Many) -> Floats: ...
def quaternion_from_rotation_vector(rotation_vector_rad: One | Many) -> Quaternion | Floats:
    """
    Convert a rotation vector, an axis times an angle, to a quaternion.

    :param rotation_vector_rad: x, y, z; its length is the angle in radians, below 1e70; shape
        (3,) or (..., 3).
    :return: x, y, z, w; unit, w >= 0; shape (4,) or (..., 4).
    :raises RotationError: wrong shape, not finite or too long.
    """
    return _converted(
        formulas.quaternion_from_rotation_vector, rotation_vector_rad, _ROTATION_VECTOR, (4,))


@overload
def rotation_vector_from_quaternion(quat_xyzw: One) -> Triple: ...
@overload
def rotation_vector_from_quaternion(quat_xyzw: Many) -> Floats: ...
def rotation_vector_from_quaternion(quat_xyzw: One | Many) -> Triple | Floats:
    """
    Convert a quaternion to a rotation vector, an axis times an angle.

    :param quat_xyzw: x, y, z, w of any norm but zero; shape (4,) or (..., 4).
    :return: x, y, z; its length is the angle in radians, in [0, pi]; of half a turn the first
        component that is not 0 is positive; shape (3,) or (..., 3).
    :raises RotationError: wrong shape, not finite or zero.
    """
    return _converted(
        formulas.rotation_vector_from_quaternion, quat_xyzw, _QUATERNION, (3,))


@overload
def matrix_from_rpy(rpy_rad: One) -> Matrix: ...
@overload
def matrix_from_rpy(rpy_rad: Many) -> Floats: ...
def matrix_from_rpy(rpy_rad: One | Many) -> Matrix | Floats:
    """
    Convert roll, pitch, yaw to a rotation matrix.

    :param rpy_rad: roll, pitch, yaw in radians, of any size; shape (3,) or (..., 3).
    :return: a tuple of the three rows, or an array of shape (..., 3, 3).
    :raises RotationError: wrong shape or not finite.
    """
    return _converted(formulas.matrix_from_rpy, rpy_rad, _RPY, (3, 3))


@overload
def rpy_from_matrix(matrix: OneMatrix) -> Triple: ...
@overload
def rpy_from_matrix(matrix: ManyMatrices) -> Floats: ...
def rpy_from_matrix(matrix: OneMatrix | ManyMatrices) -> Triple | Floats:
    """
    Convert a rotation matrix to roll, pitch, yaw.

    :param matrix: three rows, or shape (..., 3, 3); a rotation to within 1e-5, of which the
        nearest rotation is used.
    :return: roll, pitch, yaw in radians; roll and yaw in [-pi, pi], pitch in [-pi/2, pi/2], yaw 0
        at gimbal lock; shape (3,) or (..., 3).
    :raises RotationError: wrong shape, not finite, not orthonormal or with determinant -1.
    """
    return rpy_from_quaternion(quaternion_from_matrix(matrix))


@overload
def canonical_quaternion(quat_xyzw: One) -> Quaternion: ...
@overload
def canonical_quaternion(quat_xyzw: Many) -> Floats: ...
def canonical_quaternion(quat_xyzw: One | Many) -> Quaternion | Floats:
    """
    Return the canonical one of the two unit quaternions of a rotation.

    :param quat_xyzw: x, y, z, w of any norm but zero; shape (4,) or (..., 4).
    :return: x, y, z, w; unit; w >= 0, and if w is 0, the first of x, y, z that is not 0 is
        positive; shape (4,) or (..., 4). A canonical quaternion is returned bit for bit.
    :raises RotationError: wrong shape, not finite or zero.
    """
    return _converted(formulas.canonical_quaternion, quat_xyzw, _QUATERNION, (4,))


@overload
def near_gimbal_lock(quat_xyzw: One) -> bool: ...
@overload
def near_gimbal_lock(quat_xyzw: Many) -> NDArray[np.bool_]: ...
def near_gimbal_lock(quat_xyzw: One | Many) -> bool | NDArray[np.bool_]:
    """
    Return whether roll and yaw alone are practically undefined.

    The rule is gz-math's: the sine of pitch differs from 1 or -1 by less than 1e-15, so pitch is
    within 4.5e-8 radians of a right angle.

    :param quat_xyzw: x, y, z, w of any norm but zero; shape (4,) or (..., 4).
    :return: a bool, or an array of bool of shape (...).
    :raises RotationError: wrong shape, not finite or zero.
    """
    unit = canonical_quaternion(quat_xyzw)
    x, y, z, w = unit if isinstance(unit, tuple) else np.moveaxis(unit, -1, 0)
    return abs(abs(2.0 * (w * y - x * z)) - 1.0) < LOCK_TOLERANCE


def _rpy_message(*rpy: float) -> str:
    return f'roll, pitch, yaw {rpy} are not finite'


def _rotation_vector_message(*rotation_vector_rad: float) -> str:
    return f'rotation vector {rotation_vector_rad} is not finite, or longer than 1e70'


def _quaternion_message(*quat_xyzw: float) -> str:
    if all(map(math.isfinite, quat_xyzw)):
        return f'quaternion {quat_xyzw} is zero, which is not a rotation'
    return f'quaternion {quat_xyzw} (x, y, z, w) is not finite'


def _matrix_message(*matrix: Triple) -> str:
    rows = tuple(map(tuple, matrix))
    if not np.isfinite(matrix).all():
        return f'rotation matrix {rows} is not finite'
    for value, expected, name in formulas.orthonormality(floats, *matrix):
        if not abs(value - expected) <= formulas.MATRIX_TOLERANCE:
            return (
                f'rotation matrix {rows} is not orthonormal: {name} {value!r}, which differs from'
                f' {expected:g} by more than {formulas.MATRIX_TOLERANCE}')
    return (
        f'rotation matrix {rows} has determinant {formulas.determinant(*matrix):.6g}: it mirrors;'
        ' a rotation has determinant +1')


class _Representation(NamedTuple):
    """A representation of rotations by numbers."""

    name: str
    shape: tuple[int, ...]
    message: Callable[..., str]
    """Returns the error message for invalid numbers."""


_RPY = _Representation('roll, pitch, yaw', (3,), _rpy_message)
_QUATERNION = _Representation('quaternion', (4,), _quaternion_message)
_ROTATION_VECTOR = _Representation('rotation vector', (3,), _rotation_vector_message)
_MATRIX = _Representation('rotation matrix', (3, 3), _matrix_message)


def _converted(
    formula: Callable[..., _Result], values: _Values, given: _Representation,
    shape: tuple[int, ...],
) -> _Result | Floats:
    """
    Evaluate a formula for one rotation, or for all of an array.

    :param formula: takes numpy or floats, and the components of a rotation.
    :param values: one rotation as a tuple or list, or an array of shape (..., *given.shape).
    :return: the result of the formula, or an array of shape (..., *shape).
    :raises RotationError: wrong shape or invalid numbers; names the first row that has them.
    """
    if not isinstance(values, np.ndarray):
        try:
            return formula(floats, *values)
        except (TypeError, ValueError, OverflowError):
            pass  # not one valid rotation
    array = _array(values, given)
    leading = array.shape[:array.ndim - len(given.shape)]
    rows = array.reshape(-1, math.prod(given.shape))
    results = np.empty((len(rows), math.prod(shape)))
    with np.errstate(all='ignore'):
        for block in formulas.row_blocks(len(rows)):
            columns = np.ascontiguousarray(rows[block].T).reshape(*given.shape, -1)
            try:
                components = formula(np, *columns)
            except formulas.InvalidRotationError as error:
                row = block.start + int(np.argmin(error.is_valid))
                message = given.message(*rows[row].reshape(given.shape).tolist())
                raise RotationError(f'row {row}: {message}' if leading else message) from error
            results[block] = np.reshape(components, (results.shape[1], -1)).T
    return results.reshape(leading + shape)


def _array(values: _Values, given: _Representation) -> Floats:
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        msg = f'{given.name} must be numbers, but is {values!r}'
        raise RotationError(msg) from error
    if array.shape[-len(given.shape):] != given.shape:
        expected = ', '.join(map(str, given.shape))
        msg = f'{given.name} must have shape (..., {expected}), but has {array.shape}'
        raise RotationError(msg)
    return array
