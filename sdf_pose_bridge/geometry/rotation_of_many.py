# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Convert arrays of rotations between their representations.

Conventions, formulas and accuracy are told in :mod:`sdf_pose_bridge.geometry.rotation`, which
is what others import. The same formulas for one rotation are in
:mod:`sdf_pose_bridge.geometry.rotation_of_one`.

Everything is computed in blocks of rows whose intermediate results stay in the processor's cache,
on contiguous columns: memory traffic would else take longer than the arithmetic.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from sdf_pose_bridge.geometry.rotation_checks import check_shape
from sdf_pose_bridge.geometry.rotation_checks import Floats
from sdf_pose_bridge.geometry.rotation_checks import matrix_fault
from sdf_pose_bridge.geometry.rotation_checks import MATRIX_TOLERANCE
from sdf_pose_bridge.geometry.rotation_checks import quaternion_fault
from sdf_pose_bridge.geometry.rotation_checks import RotationError
from sdf_pose_bridge.geometry.rotation_checks import rpy_fault
from sdf_pose_bridge.geometry.rotation_of_one import LARGEST_SQUARE
from sdf_pose_bridge.geometry.rotation_of_one import LOCK_TOLERANCE
from sdf_pose_bridge.geometry.rotation_of_one import LOST_TURN
from sdf_pose_bridge.geometry.rotation_of_one import NEAREST_STEPS
from sdf_pose_bridge.geometry.rotation_of_one import NEARLY_UNIT
from sdf_pose_bridge.geometry.rotation_of_one import SMALLEST_SQUARE
from sdf_pose_bridge.geometry.rotation_of_one import SPLITTER
from sdf_pose_bridge.geometry.rotation_of_one import UNIT_TO_LAST_BIT

BLOCK = 4096
"""Rows at a time: some 20 columns of them fit in the second-level cache of any processor."""

Kernel: TypeAlias = Callable[[Floats, Floats], None]
"""Fills the columns of one block, shape (m, rows), from those of another, shape (k, rows)."""


def quaternion_from_rpy(rpy_rad: Floats) -> Floats:
    """Return quaternions (..., 4) of roll, pitch, yaw (..., 3)."""
    return _in_blocks(_quaternion_columns_from_rpy, rpy_rad, (3,), (4,), rpy_fault)


def rpy_from_quaternion(quat_xyzw: Floats) -> Floats:
    """Return roll, pitch, yaw (..., 3) of quaternions (..., 4)."""
    return _in_blocks(_rpy_columns_from_quaternion, quat_xyzw, (4,), (3,), quaternion_fault)


def matrix_from_quaternion(quat_xyzw: Floats) -> Floats:
    """Return matrices (..., 3, 3) of quaternions (..., 4)."""
    return _in_blocks(_matrix_columns_from_quaternion, quat_xyzw, (4,), (3, 3), quaternion_fault)


def quaternion_from_matrix(matrix: Floats) -> Floats:
    """Return quaternions (..., 4) of matrices (..., 3, 3)."""
    return _in_blocks(_quaternion_columns_from_matrix, matrix, (3, 3), (4,), matrix_fault)


def matrix_from_rpy(rpy_rad: Floats) -> Floats:
    """Return matrices (..., 3, 3) of roll, pitch, yaw (..., 3)."""
    return _in_blocks(_matrix_columns_from_rpy, rpy_rad, (3,), (3, 3), rpy_fault)


def rpy_from_matrix(matrix: Floats) -> Floats:
    """Return roll, pitch, yaw (..., 3) of matrices (..., 3, 3)."""
    return _in_blocks(_rpy_columns_from_matrix, matrix, (3, 3), (3,), matrix_fault)


def canonical_quaternion(quat_xyzw: Floats) -> Floats:
    """Return unit quaternions (..., 4) with w >= 0 of any quaternions (..., 4)."""
    return _in_blocks(_canonical_columns, quat_xyzw, (4,), (4,), quaternion_fault)


def quaternion_inverse(quat_xyzw: Floats) -> Floats:
    """Return the quaternions (..., 4) that turn back."""
    return _in_blocks(_inverse_columns, quat_xyzw, (4,), (4,), quaternion_fault)


def quaternion_product(a_xyzw: Floats, b_xyzw: Floats) -> Floats:
    """Return the quaternions (..., 4) that first turn by b, then by a; shapes broadcast."""
    a, b = np.broadcast_arrays(canonical_quaternion(a_xyzw), canonical_quaternion(b_xyzw))
    pairs = np.concatenate((a, b), axis=-1)
    return _in_blocks(_product_columns, pairs, (8,), (4,), lambda _: '')


def rotated_vectors(quat_xyzw: Floats, vectors: Floats) -> Floats:
    """Return vectors (..., 3) turned by quaternions (..., 4); shapes broadcast."""
    given = check_shape(vectors, (3,), 'vectors')
    matrix = matrix_from_quaternion(quat_xyzw)
    turned = given @ matrix.T if matrix.ndim == 2 else (matrix @ given[..., None])[..., 0]
    turned += 0.0
    return turned


def near_gimbal_lock(quat_xyzw: Floats) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    """Tell for each quaternion (..., 4) whether gz-math would set yaw to 0."""
    x, y, z, w = np.moveaxis(canonical_quaternion(quat_xyzw), -1, 0)
    near = np.abs(np.abs(2.0 * (w * y - x * z)) - 1.0) < LOCK_TOLERANCE
    return np.asarray(near)


def _in_blocks(
    kernel: Kernel,
    values: Floats,
    given: tuple[int, ...],
    wanted: tuple[int, ...],
    fault_of: Callable[[Floats], str],
) -> Floats:
    """
    Convert all rows of an array, a block at a time.

    :param kernel: converts the columns of one block; raises _BadRow for what it cannot convert.
    :param values: shape (..., *given).
    :param given: shape of one row of the values.
    :param wanted: shape of one row of the result.
    :param fault_of: says what is wrong with a row.
    :return: shape (..., *wanted), contiguous.
    :raises RotationError: wrong shape or a bad row; names the first one.
    """
    array = check_shape(values, given, 'array')
    shape = array.shape[: array.ndim - len(given)]
    rows = array.reshape(-1, _length(given))
    result = np.empty((len(rows), _length(wanted)))
    for start in range(0, len(rows), BLOCK):
        stop = start + BLOCK
        try:
            kernel(rows[start:stop].T, result[start:stop].T)
        except _BadRowError as error:
            row = start + error.row
            fault = fault_of(rows[row].reshape(given))
            msg = f'row {row}: {fault}' if shape else fault
            raise RotationError(msg) from error
    return result.reshape(shape + wanted)


def _length(shape: tuple[int, ...]) -> int:
    return shape[0] if len(shape) == 1 else shape[0] * shape[1]


class _BadRowError(Exception):
    """A kernel's first row that is no rotation."""

    def __init__(self, bad: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]) -> None:
        super().__init__()
        self.row = int(np.argmax(bad))


def _refuse_not_finite(columns: Floats) -> None:
    finite = np.isfinite(columns)
    if not finite.all():
        raise _BadRowError(np.asarray(~finite.all(axis=0)))


def _quaternion_columns_from_rpy(rpy: Floats, quat: Floats) -> None:
    half = np.ascontiguousarray(rpy)
    _refuse_not_finite(half)
    half = half * 0.5
    sin_r, sin_p, sin_y = np.sin(half)
    cos_r, cos_p, cos_y = np.cos(half)
    cos_cos = cos_p * cos_y
    sin_sin = sin_p * sin_y
    cos_sin = cos_p * sin_y
    sin_cos = sin_p * cos_y
    product = np.empty((4, half.shape[1]))
    np.subtract(sin_r * cos_cos, cos_r * sin_sin, out=product[0])
    np.add(cos_r * sin_cos, sin_r * cos_sin, out=product[1])
    np.subtract(cos_r * cos_sin, sin_r * sin_cos, out=product[2])
    np.add(cos_r * cos_cos, sin_r * sin_sin, out=product[3])
    _write_corrected(product, quat)


def _rpy_columns_from_quaternion(quat: Floats, rpy: Floats) -> None:
    x, y, z, w = _components(quat)[0]
    # (a, b) is the norm times sqrt(1 + sin(pitch)) at the angle (roll - yaw) / 2,
    # (c, d) the norm times sqrt(1 - sin(pitch)) at the angle (roll + yaw) / 2.
    a = w + y
    b = x - z
    c = w - y
    d = x + z
    up = a * a + b * b
    down = c * c + d * d
    ad = a * d
    bc = b * c
    ac = a * c
    bd = b * d
    sin_pitch = w * y - x * z
    sin_pitch += sin_pitch
    sum_sine = ad + bc
    sum_sine += 0.0
    difference_sine = ad - bc
    difference_sine += 0.0
    np.arctan2(sum_sine, ac - bd, out=rpy[0])
    np.add(np.arctan2(sin_pitch, np.sqrt(up * down)), 0.0, out=rpy[1])
    np.arctan2(difference_sine, ac + bd, out=rpy[2])
    lost = np.minimum(up, down) < LOST_TURN * (up + down)
    if lost.any():
        at_top = lost & (down < up)
        a, b = np.where(at_top, a, c)[lost], np.where(at_top, b, d)[lost]
        rpy[0, lost] = np.arctan2(2.0 * a * b, a * a - b * b) + 0.0
        rpy[1, lost] = np.where(at_top[lost], 0.5 * np.pi, -0.5 * np.pi)
        rpy[2, lost] = 0.0


def _matrix_columns_from_quaternion(quat: Floats, matrix: Floats) -> None:
    unit = np.empty(quat.shape)
    _canonical_columns(quat, unit)
    x, y, z, w = unit
    xx, yy, zz, ww = unit * unit
    np.subtract(ww + xx, yy + zz, out=matrix[0])
    np.subtract(ww + yy, xx + zz, out=matrix[4])
    np.subtract(ww + zz, xx + yy, out=matrix[8])
    double_x = x + x
    double_z = z + z
    xy = double_x * y
    wz = double_z * w
    np.subtract(xy, wz, out=matrix[1])
    np.add(xy, wz, out=matrix[3])
    xz = double_x * z
    wy = w * y
    wy += wy
    np.add(xz, wy, out=matrix[2])
    np.subtract(xz, wy, out=matrix[6])
    yz = double_z * y
    wx = double_x * w
    np.subtract(yz, wx, out=matrix[5])
    np.add(yz, wx, out=matrix[7])


def _quaternion_columns_from_matrix(matrix: Floats, quat: Floats) -> None:
    rows = np.ascontiguousarray(matrix)
    _refuse_not_rotations(rows)
    m00, m01, m02, m10, m11, m12, m20, m21, m22 = rows
    # 4 q q^T of a rotation: any row is the quaternion times four times one of its components.
    four = np.empty((4, 4, rows.shape[1]))
    four[0, 0] = 1.0 + m00 - m11 - m22
    four[1, 1] = 1.0 - m00 + m11 - m22
    four[2, 2] = 1.0 - m00 - m11 + m22
    four[3, 3] = 1.0 + m00 + m11 + m22
    four[0, 1] = four[1, 0] = m01 + m10
    four[0, 2] = four[2, 0] = m02 + m20
    four[1, 2] = four[2, 1] = m12 + m21
    four[0, 3] = four[3, 0] = m21 - m12
    four[1, 3] = four[3, 1] = m02 - m20
    four[2, 3] = four[3, 2] = m10 - m01
    q, largest = four[3], four[3, 3]
    for row in range(3):
        larger = four[row, row] > largest
        q = np.where(larger, four[row], q)
        largest = np.maximum(four[row, row], largest)
    # As for one matrix: the nearest rotation is the eigenvector of the largest eigenvalue.
    for _ in range(NEAREST_STEPS):
        q = np.add.reduce(four * q, axis=1)
        q *= 0.25
    _canonical_columns(q, quat)


def _matrix_columns_from_rpy(rpy: Floats, matrix: Floats) -> None:
    angles = np.ascontiguousarray(rpy)
    _refuse_not_finite(angles)
    sin_r, sin_p, sin_y = np.sin(angles) + 0.0
    cos_r, cos_p, cos_y = np.cos(angles)
    cos_sin = cos_y * sin_p
    sin_sin = sin_y * sin_p
    np.multiply(cos_y, cos_p, out=matrix[0])
    np.subtract(cos_sin * sin_r, sin_y * cos_r, out=matrix[1])
    np.add(cos_sin * cos_r, sin_y * sin_r, out=matrix[2])
    np.multiply(sin_y, cos_p, out=matrix[3])
    np.add(sin_sin * sin_r, cos_y * cos_r, out=matrix[4])
    np.subtract(sin_sin * cos_r, cos_y * sin_r, out=matrix[5])
    np.subtract(0.0, sin_p, out=matrix[6])
    np.multiply(cos_p, sin_r, out=matrix[7])
    np.multiply(cos_p, cos_r, out=matrix[8])
    matrix += 0.0


def _rpy_columns_from_matrix(matrix: Floats, rpy: Floats) -> None:
    quat = np.empty((4, matrix.shape[1]))
    _quaternion_columns_from_matrix(matrix, quat)
    _rpy_columns_from_quaternion(quat, rpy)


def _product_columns(pairs: Floats, product: Floats) -> None:
    ax, ay, az, aw, bx, by, bz, bw = np.ascontiguousarray(pairs)
    q = np.empty((4, pairs.shape[1]))
    np.add(aw * bx + ax * bw, ay * bz - az * by, out=q[0])
    np.add(aw * by + ay * bw, az * bx - ax * bz, out=q[1])
    np.add(aw * bz + az * bw, ax * by - ay * bx, out=q[2])
    np.subtract(aw * bw - ax * bx, ay * by + az * bz, out=q[3])
    _write_corrected(q, product)


def _inverse_columns(quat: Floats, inverse: Floats) -> None:
    conjugate = np.array(quat, order='C')
    np.negative(conjugate[:3], out=conjugate[:3])
    _canonical_columns(conjugate, inverse)


def _canonical_columns(quat: Floats, unit: Floats) -> None:
    q, square = _components(quat)
    defect = square - 1.0
    if np.abs(defect, out=defect).max(initial=0.0) >= NEARLY_UNIT:
        q = q / np.where(defect < NEARLY_UNIT, 1.0, np.sqrt(square))
    _write_corrected(q, unit)


def _components(quat: Floats) -> tuple[Floats, Floats]:
    """Return contiguous components, scaled where their square does not fit, and the square."""
    q = np.ascontiguousarray(quat)
    with np.errstate(over='ignore', under='ignore', invalid='ignore'):
        square = np.add.reduce(q * q, axis=0)
    fits = (square > SMALLEST_SQUARE) & (square < LARGEST_SQUARE)
    if not fits.all():
        bad = ~(np.isfinite(q).all(axis=0) & (q != 0.0).any(axis=0))
        if bad.any():
            raise _BadRowError(bad)
        exponent = np.frexp(np.abs(q).max(axis=0))[1]
        q = np.where(fits, q, np.ldexp(q, -exponent))
        square = np.add.reduce(q * q, axis=0)
    return q, square


def _write_corrected(q: Floats, unit: Floats) -> None:
    """Write canonical quaternions for those whose squared norm is 1 to NEARLY_UNIT."""
    # Squares of the high parts and their sum are exact, so that what is left of |q|^2 - 1 is too.
    high = q + SPLITTER
    high -= SPLITTER
    low_square = q - high
    low_square *= q + high
    high *= high
    excess = np.add.reduce(high, axis=0)
    excess -= 1.0
    excess += np.add.reduce(low_square, axis=0)
    excess *= np.abs(excess) >= UNIT_TO_LAST_BIT
    excess *= -0.5
    corrected = q * excess
    corrected += q
    w = corrected[3]
    corrected *= np.copysign(1.0, w)
    half_turns = w == 0.0
    if half_turns.any():
        _choose_sign_of_half_turns(corrected, half_turns)
    np.add(corrected, 0.0, out=unit)


def _choose_sign_of_half_turns(
    q: Floats, half_turns: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
) -> None:
    axes = q[:3, half_turns]
    first = np.argmax(axes != 0.0, axis=0)
    q[:, half_turns] *= np.copysign(1.0, np.take_along_axis(axes, first[None], axis=0)[0])


def _refuse_not_rotations(rows: Floats) -> None:
    """Refuse matrices, as columns (9, rows), that are not within tolerance of a rotation."""
    _refuse_not_finite(rows)
    matrix = rows.reshape(3, 3, -1)
    with np.errstate(over='ignore', invalid='ignore'):
        square = matrix * matrix
        norms = np.sqrt(np.concatenate((np.add.reduce(square, 0), np.add.reduce(square, 1))))
        norms -= 1.0
        good = (np.abs(norms, out=norms) <= MATRIX_TOLERANCE).all(axis=0)
        for first, second in ((0, 1), (0, 2), (1, 2)):
            product = np.add.reduce(matrix[:, first] * matrix[:, second], 0)
            good &= np.abs(product, out=product) <= MATRIX_TOLERANCE
        m00, m01, m02, m10, m11, m12, m20, m21, m22 = rows
        determinant = m00 * (m11 * m22 - m12 * m21)
        determinant += m01 * (m12 * m20 - m10 * m22)
        determinant += m02 * (m10 * m21 - m11 * m20)
        good &= determinant > 0.0
    if not good.all():
        raise _BadRowError(~good)
