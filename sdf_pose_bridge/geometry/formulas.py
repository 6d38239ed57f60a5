# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Formulas of rotations, each written once for one rotation and for many.

The formulas are elementwise: a component is a float, or an array with an element for each
rotation. Their argument ``xp`` is the module whose functions they call: numpy for arrays, and
:mod:`sdf_pose_bridge.geometry.floats` for floats. Where only a few rotations need another formula,
``if xp.any(...)`` skips it when there are none.

Conventions, ranges and accuracy are described in :mod:`sdf_pose_bridge.geometry.rotations`.
"""

from __future__ import annotations

from collections.abc import Iterator
import functools
import math
from typing import Any, TypeAlias

Component: TypeAlias = Any
"""A float, or an array of floats."""
Triple: TypeAlias = tuple[Component, Component, Component]
Quaternion: TypeAlias = tuple[Component, Component, Component, Component]
Matrix: TypeAlias = tuple[Triple, Triple, Triple]

BLOCK = 8192
"""Rows in a block. Its columns and the intermediate results of a formula fit in cache."""

GIMBAL_LOCK = 1e-31
"""
Below this (1 - |sin(pitch)|) / 2, roll and yaw cannot be distinguished, and yaw becomes 0.

Pitch is then within 6.4e-16 of a right angle; rounding moves a quaternion at lock by up to 5e-16.
gz-math's tolerance allows 4.5e-8; yaw set to 0 there would change the rotation by as much.
"""

SMALLEST_SQUARE = 1e-140
LARGEST_SQUARE = 1e140
"""Squared norms between these can be multiplied with each other without overflow or underflow."""

NEARLY_UNIT = 1e-9
"""A squared norm that differs from 1 by less needs one linear correction to be 1."""

UNIT_TO_LAST_BIT = 2.25e-16
"""A squared norm differs from 1 by less where all four components are rounded correctly."""

SPLITTER = 1.5 * 2.0 ** 26
"""Adding and subtracting this rounds a number below 1 to a multiple of 2**-26."""

MATRIX_TOLERANCE = 1e-5
"""Largest error of the norms and products of a matrix; libfranka allows its matrices as much."""

NEAREST_STEPS = 3
"""Steps of the power iteration that reduce an error of 1e-5 to less than rounding."""


class InvalidRotationError(ValueError):
    """The components of a rotation are not valid."""

    def __init__(self, is_valid: Component) -> None:
        super().__init__(is_valid)
        self.is_valid = is_valid
        """False, or an array with False for each rotation that is not valid."""


def row_blocks(count: int) -> Iterator[slice]:
    """Divide the rows of an array into blocks; large arrays then take half the time."""
    for start in range(0, count, BLOCK):
        yield slice(start, start + BLOCK)


def radians_from_degrees(xp: Any, angle_deg: Component) -> Component:
    """
    Return radians as libsdformat does, ``deg * pi / 180``, after removing multiples of 360.

    These are exact in degrees but not in radians.
    """
    return xp.fmod(angle_deg, 360.0) * math.pi / 180.0


def degrees_from_radians(angle_rad: Component) -> Component:
    """Return degrees; a right angle is exactly 90."""
    return angle_rad * 180.0 / math.pi


def orthonormality(xp: Any, *matrix: Triple) -> Iterator[tuple[Component, float, str]]:
    """Yield value, expected value and description of each property of an orthonormal matrix."""
    (m00, m01, m02), (m10, m11, m12), (m20, m21, m22) = matrix
    yield xp.sqrt(m00 * m00 + m10 * m10 + m20 * m20), 1.0, 'column 0 has norm'
    yield xp.sqrt(m01 * m01 + m11 * m11 + m21 * m21), 1.0, 'column 1 has norm'
    yield xp.sqrt(m02 * m02 + m12 * m12 + m22 * m22), 1.0, 'column 2 has norm'
    yield xp.sqrt(m00 * m00 + m01 * m01 + m02 * m02), 1.0, 'row 0 has norm'
    yield xp.sqrt(m10 * m10 + m11 * m11 + m12 * m12), 1.0, 'row 1 has norm'
    yield xp.sqrt(m20 * m20 + m21 * m21 + m22 * m22), 1.0, 'row 2 has norm'
    yield m00 * m01 + m10 * m11 + m20 * m21, 0.0, 'columns 0 and 1 have scalar product'
    yield m00 * m02 + m10 * m12 + m20 * m22, 0.0, 'columns 0 and 2 have scalar product'
    yield m01 * m02 + m11 * m12 + m21 * m22, 0.0, 'columns 1 and 2 have scalar product'


def determinant(*matrix: Triple) -> Component:
    """Return the determinant of three rows."""
    (m00, m01, m02), (m10, m11, m12), (m20, m21, m22) = matrix
    return (
        m00 * (m11 * m22 - m12 * m21)
        + m01 * (m12 * m20 - m10 * m22)
        + m02 * (m10 * m21 - m11 * m20))


def quaternion_from_rpy(
    xp: Any, roll: Component, pitch: Component, yaw: Component,
) -> Quaternion:
    """Return the canonical quaternion of roll, pitch, yaw."""
    _check(xp, xp.isfinite(roll) & xp.isfinite(pitch) & xp.isfinite(yaw))
    sin_r, cos_r = xp.sin(0.5 * roll), xp.cos(0.5 * roll)
    sin_p, cos_p = xp.sin(0.5 * pitch), xp.cos(0.5 * pitch)
    sin_y, cos_y = xp.sin(0.5 * yaw), xp.cos(0.5 * yaw)
    cos_cos = cos_p * cos_y
    sin_sin = sin_p * sin_y
    cos_sin = cos_p * sin_y
    sin_cos = sin_p * cos_y
    return _corrected(
        xp,
        sin_r * cos_cos - cos_r * sin_sin,
        cos_r * sin_cos + sin_r * cos_sin,
        cos_r * cos_sin - sin_r * sin_cos,
        cos_r * cos_cos + sin_r * sin_sin)


def rpy_from_quaternion(
    xp: Any, x: Component, y: Component, z: Component, w: Component,
) -> Triple:
    """
    Return roll, pitch, yaw of a quaternion.

    gz-math takes pitch from an arc sine, which loses half of the digits near a right angle. Here
    all angles are arc tangents of numbers that are exact to the last digits everywhere: (a, b) is
    the norm times sqrt(1 + sin(pitch)) times the cosine and sine of (roll - yaw) / 2, and (c, d)
    the norm times sqrt(1 - sin(pitch)) times those of (roll + yaw) / 2. The products of the two
    pairs are proportional to the cosines and sines of roll and yaw.
    """
    x, y, z, w, _ = _scaled(xp, x, y, z, w)
    a, b = w + y, x - z
    c, d = w - y, x + z
    up = a * a + b * b
    down = c * c + d * d
    ac, ad, bc, bd = a * c, a * d, b * c, b * d
    # Adding zero makes -0.0 positive; the arc tangent would be -pi instead of pi.
    roll = xp.arctan2(ad + bc + 0.0, ac - bd)
    pitch = xp.arctan2(2.0 * (w * y - x * z), xp.sqrt(up * down)) + 0.0
    yaw = xp.arctan2(ad - bc + 0.0, ac + bd)
    is_locked = xp.minimum(up, down) < GIMBAL_LOCK * (up + down)
    if xp.any(is_locked):
        is_up = down < up
        cosine, sine = xp.where(is_up, a, c), xp.where(is_up, b, d)
        total = xp.arctan2(2.0 * cosine * sine, cosine * cosine - sine * sine) + 0.0
        roll = xp.where(is_locked, total, roll)
        pitch = xp.where(is_locked, xp.copysign(0.5 * math.pi, up - down), pitch)
        yaw = xp.where(is_locked, 0.0, yaw)
    return roll, pitch, yaw


def matrix_from_quaternion(
    xp: Any, x: Component, y: Component, z: Component, w: Component,
) -> Matrix:
    """Return the rows of the matrix of a quaternion."""
    x, y, z, w = canonical_quaternion(xp, x, y, z, w)
    xx, yy, zz, ww = x * x, y * y, z * z, w * w
    xy, xz, yz = x * y, x * z, y * z
    wx, wy, wz = w * x, w * y, w * z
    return (
        ((ww + xx) - (yy + zz), 2.0 * (xy - wz), 2.0 * (xz + wy)),
        (2.0 * (xy + wz), (ww + yy) - (xx + zz), 2.0 * (yz - wx)),
        (2.0 * (xz - wy), 2.0 * (yz + wx), (ww + zz) - (xx + yy)))


def quaternion_from_matrix(xp: Any, *matrix: Triple) -> Quaternion:
    """
    Return the canonical quaternion of the rotation nearest to a matrix of three rows.

    The elements of a rotation matrix determine four times the products of the components of its
    quaternion. Each row of these products is the quaternion times a factor; the row with the
    largest diagonal element is exact for every rotation, half turns included.

    For a matrix that is not quite a rotation, the nearest rotation is the eigenvector of the
    largest eigenvalue (Bar-Itzhack, "New method for extracting the quaternion from a rotation
    matrix", 2000). The other eigenvalues are up to 1e-5 of it, so each step of the power iteration
    gains five digits.
    """
    is_valid = determinant(*matrix) > 0.0
    for value, expected, _ in orthonormality(xp, *matrix):
        is_valid = is_valid & (abs(value - expected) <= MATRIX_TOLERANCE)
    _check(xp, is_valid)
    (m00, m01, m02), (m10, m11, m12), (m20, m21, m22) = matrix
    xx = 1.0 + m00 - m11 - m22
    yy = 1.0 - m00 + m11 - m22
    zz = 1.0 - m00 - m11 + m22
    ww = 1.0 + m00 + m11 + m22
    xy, xz, yz = m01 + m10, m02 + m20, m12 + m21
    wx, wy, wz = m21 - m12, m02 - m20, m10 - m01
    row, largest = (wx, wy, wz, ww), ww
    for diagonal, other in (
        (xx, (xx, xy, xz, wx)), (yy, (xy, yy, yz, wy)), (zz, (xz, yz, zz, wz)),
    ):
        row = xp.where(diagonal > largest, other, row)
        largest = xp.maximum(diagonal, largest)
    x, y, z, w = row
    for _ in range(NEAREST_STEPS):
        x, y, z, w = (
            xx * x + xy * y + xz * z + wx * w,
            xy * x + yy * y + yz * z + wy * w,
            xz * x + yz * y + zz * z + wz * w,
            wx * x + wy * y + wz * z + ww * w)
    return canonical_quaternion(xp, x, y, z, w)


def matrix_from_rpy(xp: Any, roll: Component, pitch: Component, yaw: Component) -> Matrix:
    """
    Return the rows of Rz(yaw) Ry(pitch) Rx(roll).

    The elements at gimbal lock are exact, unlike those computed from the quaternion.
    """
    _check(xp, xp.isfinite(roll) & xp.isfinite(pitch) & xp.isfinite(yaw))
    sin_r, cos_r = xp.sin(roll), xp.cos(roll)
    sin_p, cos_p = xp.sin(pitch), xp.cos(pitch)
    sin_y, cos_y = xp.sin(yaw), xp.cos(yaw)
    # Adding zero makes -0.0 positive.
    return (
        (
            cos_y * cos_p + 0.0,
            cos_y * sin_p * sin_r - sin_y * cos_r + 0.0,
            cos_y * sin_p * cos_r + sin_y * sin_r + 0.0,
        ),
        (
            sin_y * cos_p + 0.0,
            sin_y * sin_p * sin_r + cos_y * cos_r + 0.0,
            sin_y * sin_p * cos_r - cos_y * sin_r + 0.0,
        ),
        (0.0 - sin_p, cos_p * sin_r + 0.0, cos_p * cos_r + 0.0))


def quaternion_from_rotation_vector(
    xp: Any, x: Component, y: Component, z: Component,
) -> Quaternion:
    """Return the canonical quaternion of an axis times an angle in radians."""
    square = x * x + y * y + z * z
    _check(xp, square < LARGEST_SQUARE)
    is_usual = square > SMALLEST_SQUARE
    angle = xp.where(is_usual, xp.sqrt(square), 1.0)
    # Of a tiny angle, the sine of its half is its half.
    factor = xp.where(is_usual, xp.sin(0.5 * angle) / angle, 0.5)
    cosine = xp.where(is_usual, xp.cos(0.5 * angle), 1.0)
    return _corrected(xp, x * factor, y * factor, z * factor, cosine)


def rotation_vector_from_quaternion(
    xp: Any, x: Component, y: Component, z: Component, w: Component,
) -> Triple:
    """Return the axis times the angle of a quaternion, which is at most half a turn."""
    x, y, z, w = canonical_quaternion(xp, x, y, z, w)
    square = x * x + y * y + z * z
    is_usual = square > SMALLEST_SQUARE
    sine = xp.where(is_usual, xp.sqrt(square), 1.0)
    factor = xp.where(is_usual, 2.0 * xp.arctan2(sine, w) / sine, 2.0)
    return x * factor, y * factor, z * factor


def canonical_quaternion(
    xp: Any, x: Component, y: Component, z: Component, w: Component,
) -> Quaternion:
    """Return the unit quaternion in which the first of w, x, y, z that is not zero is positive."""
    is_nearly_unit = abs(x * x + y * y + z * z + w * w - 1.0) < NEARLY_UNIT
    if not xp.all(is_nearly_unit):
        x, y, z, w, square = _scaled(xp, x, y, z, w)
        norm = xp.where(is_nearly_unit, 1.0, xp.sqrt(square))
        x, y, z, w = x / norm, y / norm, z / norm, w / norm
    return _corrected(xp, x, y, z, w)


def _scaled(
    xp: Any, x: Component, y: Component, z: Component, w: Component,
) -> tuple[Component, Component, Component, Component, Component]:
    """Return the components and the square, scaled by a power of two if it is extreme."""
    square = x * x + y * y + z * z + w * w
    is_usual = (square > SMALLEST_SQUARE) & (square < LARGEST_SQUARE)
    if not xp.all(is_usual):
        largest = functools.reduce(xp.maximum, (abs(x), abs(y), abs(z), abs(w)))
        is_finite = xp.isfinite(x) & xp.isfinite(y) & xp.isfinite(z) & xp.isfinite(w)
        _check(xp, is_finite & (largest > 0.0))
        exponent = xp.where(is_usual, 0, -xp.frexp(largest)[1])
        x, y, z, w = (xp.ldexp(component, exponent) for component in (x, y, z, w))
        square = x * x + y * y + z * z + w * w
    return x, y, z, w, square


def _corrected(
    xp: Any, x: Component, y: Component, z: Component, w: Component,
) -> Quaternion:
    """
    Return the canonical form of a quaternion whose square is within NEARLY_UNIT of 1.

    The error of the square is computed from components that are split in two (Dekker, "A
    floating-point technique for extending the available precision", 1971): the squares of the
    high parts and their sum are exact.
    """
    x_high = x + SPLITTER - SPLITTER
    y_high = y + SPLITTER - SPLITTER
    z_high = z + SPLITTER - SPLITTER
    w_high = w + SPLITTER - SPLITTER
    error = x_high * x_high + y_high * y_high + z_high * z_high + w_high * w_high - 1.0 + (
        (x - x_high) * (x + x_high) + (y - y_high) * (y + y_high)
        + (z - z_high) * (z + z_high) + (w - w_high) * (w + w_high))
    correction = error * (abs(error) >= UNIT_TO_LAST_BIT) * -0.5
    x, y, z, w = x + x * correction, y + y * correction, z + z * correction, w + w * correction
    sign = xp.copysign(1.0, w)
    is_half_turn = w == 0.0
    if xp.any(is_half_turn):
        first = xp.where(x != 0.0, x, xp.where(y != 0.0, y, z))
        sign = xp.where(is_half_turn, xp.copysign(1.0, first), sign)
    # Adding zero makes -0.0 positive.
    return x * sign + 0.0, y * sign + 0.0, z * sign + 0.0, w * sign + 0.0


def _check(xp: Any, is_valid: Component) -> None:
    """Raise InvalidRotationError unless all of these are true."""
    if not xp.all(is_valid):
        raise InvalidRotationError(is_valid)
