# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Convert one rotation between its representations, in plain floats.

Conventions, formulas and accuracy are told in :mod:`sdf_pose_bridge.geometry.rotation`, which
is what others import. The same formulas for arrays are in
:mod:`sdf_pose_bridge.geometry.rotation_of_many`.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
from typing import TypeAlias

from sdf_pose_bridge.geometry.rotation_checks import check_matrix
from sdf_pose_bridge.geometry.rotation_checks import check_quaternion
from sdf_pose_bridge.geometry.rotation_checks import check_rpy
from sdf_pose_bridge.geometry.rotation_checks import check_vector
from sdf_pose_bridge.geometry.rotation_checks import MATRIX_TOLERANCE

Triple: TypeAlias = tuple[float, float, float]
Quadruple: TypeAlias = tuple[float, float, float, float]
Rows: TypeAlias = tuple[Triple, Triple, Triple]

LOCK_TOLERANCE = 1e-15
"""gz-math's: at lock, the sine of pitch is nearer to 1 or -1 than this."""

LOST_TURN = 1.0e-31
"""
Below this (1 - |sin(pitch)|) / 2, roll and yaw have no numbers of their own, and yaw becomes 0.

Pitch is then nearer to a right angle than 6.4e-16; rounding moves a quaternion at lock by up to
5e-16. gz-math's tolerance allows 4.5e-8; yaw set to 0 there would turn the rotation by as much.
"""

SMALLEST_SQUARE = 1e-140
LARGEST_SQUARE = 1e140
"""Squared norms between these can be multiplied with each other and lose nothing."""

NEARLY_UNIT = 1e-9
"""Squared norms that differ from 1 by less need one linear correction to be 1."""

SPLITTER = 1.5 * 2.0 ** 26
"""Added to a number below 1 and taken away again, it leaves the nearest multiple of 2**-26."""

UNIT_TO_LAST_BIT = 2.25e-16
"""Squared norms differ from 1 by less where all four components are rounded as well as can be."""


SURE_TOLERANCE = 0.3 * MATRIX_TOLERANCE
"""Columns whose products differ from those of a rotation by less make rows that are fine, too."""

NEAREST_STEPS = 3
"""Steps of the power iteration that leave of a difference of 1e-5 less than rounding does."""


def quaternion_from_rpy(rpy_rad: Sequence[float]) -> Quadruple:
    """Return the quaternion x, y, z, w of roll, pitch, yaw."""
    try:
        roll, pitch, yaw = rpy_rad
        sin_r = math.sin(0.5 * roll)
        sin_p = math.sin(0.5 * pitch)
        sin_y = math.sin(0.5 * yaw)
    except (TypeError, ValueError):
        check_rpy(rpy_rad)
        raise
    cos_r = math.cos(0.5 * roll)
    cos_p = math.cos(0.5 * pitch)
    cos_y = math.cos(0.5 * yaw)
    cos_cos = cos_p * cos_y
    sin_sin = sin_p * sin_y
    cos_sin = cos_p * sin_y
    sin_cos = sin_p * cos_y
    w = cos_r * cos_cos + sin_r * sin_sin
    if w != w:
        check_rpy(rpy_rad)
    return _corrected(
        sin_r * cos_cos - cos_r * sin_sin,
        cos_r * sin_cos + sin_r * cos_sin,
        cos_r * cos_sin - sin_r * sin_cos,
        w,
    )


def rpy_from_quaternion(quat_xyzw: Sequence[float]) -> Triple:
    """Return roll, pitch, yaw of the quaternion x, y, z, w."""
    x, y, z, w = _components(quat_xyzw)
    # (a, b) is the norm times sqrt(1 + sin(pitch)) at the angle (roll - yaw) / 2,
    # (c, d) the norm times sqrt(1 - sin(pitch)) at the angle (roll + yaw) / 2.
    a = w + y
    b = x - z
    c = w - y
    d = x + z
    up = a * a + b * b
    down = c * c + d * d
    sin_pitch = 2.0 * (w * y - x * z)
    lost = LOST_TURN * (up + down)
    if down < lost:
        return (math.atan2(2.0 * a * b, a * a - b * b) + 0.0, 0.5 * math.pi, 0.0)
    if up < lost:
        return (math.atan2(2.0 * c * d, c * c - d * d) + 0.0, -0.5 * math.pi, 0.0)
    ad = a * d
    bc = b * c
    ac = a * c
    bd = b * d
    return (
        math.atan2(ad + bc + 0.0, ac - bd),
        math.atan2(sin_pitch, math.sqrt(up * down)) + 0.0,
        math.atan2(ad - bc + 0.0, ac + bd),
    )


def matrix_from_quaternion(quat_xyzw: Sequence[float]) -> Rows:
    """Return the three rows of the quaternion's matrix."""
    x, y, z, w = canonical_quaternion(quat_xyzw)
    xx = x * x
    yy = y * y
    zz = z * z
    ww = w * w
    xy = x * y
    xz = x * z
    yz = y * z
    wx = w * x
    wy = w * y
    wz = w * z
    return (
        ((ww + xx) - (yy + zz), 2.0 * (xy - wz), 2.0 * (xz + wy)),
        (2.0 * (xy + wz), (ww + yy) - (xx + zz), 2.0 * (yz - wx)),
        (2.0 * (xz - wy), 2.0 * (yz + wx), (ww + zz) - (xx + yy)),
    )


def quaternion_from_matrix(matrix: Sequence[Sequence[float]]) -> Quadruple:
    """Return the quaternion x, y, z, w of the rotation nearest to the matrix."""
    try:
        (m00, m01, m02), (m10, m11, m12), (m20, m21, m22) = matrix
        surely_rotation = (
            abs(m00 * m00 + m10 * m10 + m20 * m20 - 1.0) < SURE_TOLERANCE
            and abs(m01 * m01 + m11 * m11 + m21 * m21 - 1.0) < SURE_TOLERANCE
            and abs(m02 * m02 + m12 * m12 + m22 * m22 - 1.0) < SURE_TOLERANCE
            and abs(m00 * m01 + m10 * m11 + m20 * m21) < SURE_TOLERANCE
            and abs(m00 * m02 + m10 * m12 + m20 * m22) < SURE_TOLERANCE
            and abs(m01 * m02 + m11 * m12 + m21 * m22) < SURE_TOLERANCE
            and m00 * (m11 * m22 - m12 * m21) + m01 * (m12 * m20 - m10 * m22)
            + m02 * (m10 * m21 - m11 * m20) > 0.0
        )
    except (TypeError, ValueError):
        check_matrix(matrix)
        raise
    if not surely_rotation:
        check_matrix(matrix)
    # 4 q q^T of a rotation: any row is the quaternion times four times one of its components.
    xx = 1.0 + m00 - m11 - m22
    yy = 1.0 - m00 + m11 - m22
    zz = 1.0 - m00 - m11 + m22
    ww = 1.0 + m00 + m11 + m22
    xy = m01 + m10
    xz = m02 + m20
    yz = m12 + m21
    wx = m21 - m12
    wy = m02 - m20
    wz = m10 - m01
    largest = max(xx, yy, zz, ww)
    if largest == ww:
        x, y, z, w = wx, wy, wz, ww
    elif largest == xx:
        x, y, z, w = xx, xy, xz, wx
    elif largest == yy:
        x, y, z, w = xy, yy, yz, wy
    else:
        x, y, z, w = xz, yz, zz, wz
    # Of a matrix that is not quite a rotation, the nearest one is the eigenvector of the largest
    # eigenvalue (Bar-Itzhack 2000). The others are 1e-5 of it, so each step gains five digits.
    for _ in range(NEAREST_STEPS):
        x, y, z, w = (
            0.25 * (xx * x + xy * y + xz * z + wx * w),
            0.25 * (xy * x + yy * y + yz * z + wy * w),
            0.25 * (xz * x + yz * y + zz * z + wz * w),
            0.25 * (wx * x + wy * y + wz * z + ww * w),
        )
    return canonical_quaternion((x, y, z, w))


def matrix_from_rpy(rpy_rad: Sequence[float]) -> Rows:
    """Return the three rows of Rz(yaw) Ry(pitch) Rx(roll)."""
    try:
        roll, pitch, yaw = rpy_rad
        sin_r = math.sin(roll)
        sin_p = math.sin(pitch)
        sin_y = math.sin(yaw)
    except (TypeError, ValueError):
        check_rpy(rpy_rad)
        raise
    cos_r = math.cos(roll)
    cos_p = math.cos(pitch)
    cos_y = math.cos(yaw)
    if sin_r + sin_p + sin_y != sin_r + sin_p + sin_y:
        check_rpy(rpy_rad)
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
        (0.0 - sin_p, cos_p * sin_r + 0.0, cos_p * cos_r + 0.0),
    )


def rpy_from_matrix(matrix: Sequence[Sequence[float]]) -> Triple:
    """Return roll, pitch, yaw of the rotation nearest to the matrix."""
    return rpy_from_quaternion(quaternion_from_matrix(matrix))


def quaternion_product(a_xyzw: Sequence[float], b_xyzw: Sequence[float]) -> Quadruple:
    """Return the rotation that first turns by b, then by a."""
    ax, ay, az, aw = _components(a_xyzw)
    bx, by, bz, bw = _components(b_xyzw)
    return canonical_quaternion((
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    ))


def quaternion_inverse(quat_xyzw: Sequence[float]) -> Quadruple:
    """Return the rotation that turns back."""
    x, y, z, w = canonical_quaternion(quat_xyzw)
    # A half turn is its own inverse, and canonical already.
    return (0.0 - x, 0.0 - y, 0.0 - z, w) if w else (x, y, z, w)


def rotated_vector(quat_xyzw: Sequence[float], vector: Sequence[float]) -> Triple:
    """Return the vector turned by the quaternion."""
    (m00, m01, m02), (m10, m11, m12), (m20, m21, m22) = matrix_from_quaternion(quat_xyzw)
    try:
        x, y, z = vector
        return (
            m00 * x + m01 * y + m02 * z + 0.0,
            m10 * x + m11 * y + m12 * z + 0.0,
            m20 * x + m21 * y + m22 * z + 0.0,
        )
    except (TypeError, ValueError):
        check_vector(vector)
        raise


def canonical_quaternion(quat_xyzw: Sequence[float]) -> Quadruple:
    """Return the unit quaternion of the same rotation with w >= 0."""
    x, y, z, w = _components(quat_xyzw)
    square = x * x + y * y + z * z + w * w
    if not -NEARLY_UNIT < square - 1.0 < NEARLY_UNIT:
        norm = math.sqrt(square)
        x /= norm
        y /= norm
        z /= norm
        w /= norm
    return _corrected(x, y, z, w)


def near_gimbal_lock(quat_xyzw: Sequence[float]) -> bool:
    """Tell whether gz-math would set yaw to 0."""
    x, y, z, w = canonical_quaternion(quat_xyzw)
    return abs(abs(2.0 * (w * y - x * z)) - 1.0) < LOCK_TOLERANCE


def _components(quat_xyzw: Sequence[float]) -> Quadruple:
    """Return the quaternion, scaled by a power of two if its square would not fit in a float."""
    try:
        x, y, z, w = quat_xyzw
        if SMALLEST_SQUARE < x * x + y * y + z * z + w * w < LARGEST_SQUARE:
            return (x, y, z, w)
    except (TypeError, ValueError):
        check_quaternion(quat_xyzw)
        raise
    x, y, z, w = check_quaternion(quat_xyzw).tolist()
    exponent = -math.frexp(max(abs(x), abs(y), abs(z), abs(w)))[1]
    return (
        math.ldexp(x, exponent), math.ldexp(y, exponent),
        math.ldexp(z, exponent), math.ldexp(w, exponent),
    )


def _corrected(x: float, y: float, z: float, w: float) -> Quadruple:
    """Return the canonical quaternion for one whose squared norm is 1 to NEARLY_UNIT."""
    # Squares of the high parts and their sum are exact, so that what is left of |q|^2 - 1 is too.
    x_high = (x + SPLITTER) - SPLITTER
    y_high = (y + SPLITTER) - SPLITTER
    z_high = (z + SPLITTER) - SPLITTER
    w_high = (w + SPLITTER) - SPLITTER
    excess = (x_high * x_high + y_high * y_high + z_high * z_high + w_high * w_high - 1.0) + (
        (x + x_high) * (x - x_high) + (y + y_high) * (y - y_high)
        + (z + z_high) * (z - z_high) + (w + w_high) * (w - w_high)
    )
    if not -UNIT_TO_LAST_BIT < excess < UNIT_TO_LAST_BIT:
        excess *= -0.5
        x += x * excess
        y += y * excess
        z += z * excess
        w += w * excess
    if w < 0.0 or (w == 0.0 and (x, y, z) < (0.0, 0.0, 0.0)):
        return (0.0 - x, 0.0 - y, 0.0 - z, 0.0 - w)
    return (x + 0.0, y + 0.0, z + 0.0, w + 0.0)
