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
nested sequences; the result is an array with the same leading shape. All raise
:class:`RotationError` for a wrong shape, numbers that are not finite, a quaternion of zeros, a
rotation vector of 1e70 or longer, and a matrix that is not orthonormal or has determinant -1.

At gimbal lock, where pitch is a right angle, only roll - yaw (pitch up) or roll + yaw (pitch down)
is defined: yaw is then 0 and roll has all of it, as in gz-math. Near lock each angle alone is less
certain, but together they represent the given rotation. gz-math sets yaw to 0 there, which changes
the rotation by up to 4.5e-8 radians.

The rotation returned differs from the one given by at most 1.2e-15 radians, for every rotation and
every representation.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
from typing import Any, TypeAlias

import numpy as np

from sdf_pose_bridge.geometry import formulas
from sdf_pose_bridge.geometry.formulas import (
    check,
    Component,
    conversion,
    corrected,
    determinant,
    dot,
    FLOATS,
    LARGEST_SQUARE,
    NEARLY_UNIT,
    orthonormality,
    Representation,
    scaled,
    SMALLEST_SQUARE,
    square_of,
)

Floats: TypeAlias = formulas.Floats
RotationError = formulas.RotationError
Triple: TypeAlias = tuple[float, float, float]
Quaternion: TypeAlias = tuple[float, float, float, float]
Matrix: TypeAlias = tuple[Triple, Triple, Triple]
One: TypeAlias = Sequence[float]

_GIMBAL_LOCK = 1e-31
"""
Below this (1 - |sin(pitch)|) / 2, roll and yaw cannot be distinguished, and yaw becomes 0.

Pitch is then within 6.4e-16 of a right angle; rounding moves a quaternion at lock by up to 5e-16.
gz-math's tolerance allows 4.5e-8; yaw set to 0 there would change the rotation by as much.
"""

_MATRIX_TOLERANCE = 1e-5
"""Largest error of the norms and products of a matrix; libfranka allows its matrices as much."""

_NEAREST_STEPS = 3
"""Steps of the power iteration that reduce an error of 1e-5 to less than rounding."""


def _quaternion_message(quat_xyzw: Quaternion) -> str:
    if all(map(math.isfinite, quat_xyzw)):
        return f'quaternion {quat_xyzw} is zero, which is not a rotation'
    return f'quaternion {quat_xyzw} (x, y, z, w) is not finite'


def _matrix_message(matrix: Matrix) -> str:
    rows = tuple(map(tuple, matrix))
    if not np.isfinite(matrix).all():
        return f'rotation matrix {rows} is not finite'
    scale = float(np.cbrt(determinant(*matrix)))
    if scale > 0.0 and all(abs(value - expected) <= _MATRIX_TOLERANCE for value, expected, _ in (
            orthonormality(FLOATS, *(np.array(matrix) / scale).tolist()))):
        return f'rotation matrix {rows} has the scale {scale:.6g}; divide it by that'
    for value, expected, name in orthonormality(FLOATS, *matrix):
        if not abs(value - expected) <= _MATRIX_TOLERANCE:
            return (
                f'rotation matrix {rows} is not orthonormal: {name} {value!r}, which differs from'
                f' {expected:g} by more than {_MATRIX_TOLERANCE}')
    return (
        f'rotation matrix {rows} has determinant {determinant(*matrix):.6g}: it mirrors;'
        ' a rotation has determinant +1')


_RPY = Representation[One, Triple](
    'roll, pitch, yaw', (3,), 'roll, pitch, yaw {} are not finite'.format)
_QUATERNION = Representation[One, Quaternion]('quaternion', (4,), _quaternion_message)
_ROTATION_VECTOR = Representation[One, Triple](
    'rotation vector', (3,), 'rotation vector {} is not finite, or longer than 1e70'.format)
_MATRIX = Representation[Sequence[One], Matrix]('rotation matrix', (3, 3), _matrix_message)


@conversion(_QUATERNION, _QUATERNION)
def canonical_quaternion(xp: Any, *quat: Component) -> Any:
    """
    Return the canonical one of the two unit quaternions of a rotation.

    A canonical quaternion is returned bit for bit.

    :param values: x, y, z, w.
    :return: x, y, z, w.
    """
    is_nearly_unit = abs(square_of(quat) - 1.0) < NEARLY_UNIT
    if not xp.all(is_nearly_unit):
        quat, square = scaled(xp, quat)
        norm = xp.where(is_nearly_unit, 1.0, xp.sqrt(square))
        quat = tuple([component / norm for component in quat])
    return corrected(xp, quat)


@conversion(_RPY, _QUATERNION)
def quaternion_from_rpy(xp: Any, *rpy: Component) -> Any:
    """
    Convert roll, pitch, yaw to a quaternion.

    :param values: roll, pitch, yaw in radians, of any size.
    :return: x, y, z, w.
    """
    (sin_r, cos_r), (sin_p, cos_p), (sin_y, cos_y) = (
        (xp.sin(0.5 * angle), xp.cos(0.5 * angle)) for angle in rpy)
    # Sines of angles that are not finite are not numbers.
    check(xp, xp.isfinite(sin_r + sin_p + sin_y))
    cos_cos = cos_p * cos_y
    sin_sin = sin_p * sin_y
    cos_sin = cos_p * sin_y
    sin_cos = sin_p * cos_y
    return corrected(xp, (
        sin_r * cos_cos - cos_r * sin_sin,
        cos_r * sin_cos + sin_r * cos_sin,
        cos_r * cos_sin - sin_r * sin_cos,
        cos_r * cos_cos + sin_r * sin_sin))


@conversion(_QUATERNION, _RPY)
def rpy_from_quaternion(xp: Any, *quat: Component) -> Any:
    """
    Convert a quaternion to roll, pitch, yaw.

    :param values: x, y, z, w.
    :return: roll, pitch, yaw in radians.
    """
    # gz-math takes pitch from an arc sine, which loses half of the digits near a right angle. Here
    # all angles are arc tangents of numbers that are exact to the last digits everywhere: (a, b)
    # is the norm times sqrt(1 + sin(pitch)) times the cosine and sine of (roll - yaw) / 2, and
    # (c, d) the norm times sqrt(1 - sin(pitch)) times those of (roll + yaw) / 2. The products of
    # the two pairs are proportional to the cosines and sines of roll and yaw.
    (x, y, z, w), _ = scaled(xp, quat)
    a, b = w + y, x - z
    c, d = w - y, x + z
    up = a * a + b * b
    down = c * c + d * d
    ac, ad, bc, bd = a * c, a * d, b * c, b * d
    # Adding zero makes -0.0 positive; the arc tangent would be -pi instead of pi.
    roll = xp.arctan2(ad + bc + 0.0, ac - bd)
    pitch = xp.arctan2(2.0 * (w * y - x * z), xp.sqrt(up * down)) + 0.0
    yaw = xp.arctan2(ad - bc + 0.0, ac + bd)
    is_locked = xp.minimum(up, down) < _GIMBAL_LOCK * (up + down)
    if xp.any(is_locked):
        is_up = down < up
        cosine, sine = xp.where(is_up, a, c), xp.where(is_up, b, d)
        total = xp.arctan2(2.0 * cosine * sine, cosine * cosine - sine * sine) + 0.0
        roll = xp.where(is_locked, total, roll)
        pitch = xp.where(is_locked, xp.copysign(0.5 * math.pi, up - down), pitch)
        yaw = xp.where(is_locked, 0.0, yaw)
    return roll, pitch, yaw


@conversion(_QUATERNION, _MATRIX)
def matrix_from_quaternion(xp: Any, *quat: Component) -> Any:
    """
    Convert a quaternion to a rotation matrix.

    :param values: x, y, z, w.
    :return: the three rows.
    """
    x, y, z, w = canonical_quaternion.formula(xp, *quat)
    xx, yy, zz, ww = x * x, y * y, z * z, w * w
    xy, xz, yz = x * y + 0.0, x * z + 0.0, y * z + 0.0  # not -0.0
    wx, wy, wz = w * x, w * y, w * z
    return (
        ((ww + xx) - (yy + zz), 2.0 * (xy - wz), 2.0 * (xz + wy)),
        (2.0 * (xy + wz), (ww + yy) - (xx + zz), 2.0 * (yz - wx)),
        (2.0 * (xz - wy), 2.0 * (yz + wx), (ww + zz) - (xx + yy)))


@conversion(_MATRIX, _QUATERNION)
def quaternion_from_matrix(xp: Any, *matrix: Sequence[Component]) -> Any:
    """
    Convert a rotation matrix to a quaternion.

    :param values: the three rows.
    :return: x, y, z, w.
    """
    is_valid = determinant(*matrix) > 0.0
    for value, expected, _ in orthonormality(xp, *matrix):
        is_valid = is_valid & (abs(value - expected) <= _MATRIX_TOLERANCE)
    check(xp, is_valid)
    # The elements of a rotation matrix determine four times the products of the components of its
    # quaternion. Each row of these products is the quaternion times a factor; the row with the
    # largest diagonal element is exact for every rotation, half turns included.
    (m00, m01, m02), (m10, m11, m12), (m20, m21, m22) = matrix
    xy, xz, yz = m01 + m10, m02 + m20, m12 + m21
    wx, wy, wz = m21 - m12, m02 - m20, m10 - m01
    products = (
        (1.0 + m00 - m11 - m22, xy, xz, wx),
        (xy, 1.0 - m00 + m11 - m22, yz, wy),
        (xz, yz, 1.0 - m00 - m11 + m22, wz),
        (wx, wy, wz, 1.0 + m00 + m11 + m22))
    quat, largest = products[3], products[3][3]
    for index in range(3):
        diagonal = products[index][index]
        quat = xp.where(diagonal > largest, products[index], quat)
        largest = xp.maximum(diagonal, largest)
    # For a matrix that is not quite a rotation, the nearest rotation is the eigenvector of the
    # largest eigenvalue (Bar-Itzhack, "New method for extracting the quaternion from a rotation
    # matrix", 2000). The other eigenvalues are up to 1e-5 of it, so each step of the power
    # iteration gains five digits.
    for _ in range(_NEAREST_STEPS):
        quat = tuple(dot(row, quat) for row in products)
    return canonical_quaternion.formula(xp, *quat)


@conversion(_ROTATION_VECTOR, _QUATERNION)
def quaternion_from_rotation_vector(xp: Any, *vector: Component) -> Any:
    """
    Convert a rotation vector, an axis times an angle, to a quaternion.

    :param values: x, y, z; its length is the angle in radians.
    :return: x, y, z, w.
    """
    square = dot(vector, vector)
    check(xp, square < LARGEST_SQUARE)
    is_usual = square > SMALLEST_SQUARE
    angle = xp.where(is_usual, xp.sqrt(square), 1.0)
    # The sine of half a tiny angle is this half.
    factor = xp.where(is_usual, xp.sin(0.5 * angle) / angle, 0.5)
    cosine = xp.where(is_usual, xp.cos(0.5 * angle), 1.0)
    return corrected(xp, (*(component * factor for component in vector), cosine))


@conversion(_QUATERNION, _ROTATION_VECTOR)
def rotation_vector_from_quaternion(xp: Any, *quat: Component) -> Any:
    """
    Convert a quaternion to a rotation vector, an axis times an angle.

    :param values: x, y, z, w.
    :return: x, y, z; its length is the angle in radians, in [0, pi]; of half a turn the first
        component that is not 0 is positive.
    """
    x, y, z, w = canonical_quaternion.formula(xp, *quat)
    square = x * x + y * y + z * z
    is_usual = square > SMALLEST_SQUARE
    sine = xp.where(is_usual, xp.sqrt(square), 1.0)
    factor = xp.where(is_usual, 2.0 * xp.arctan2(sine, w) / sine, 2.0)
    return x * factor, y * factor, z * factor
