# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Judge numbers that are said to be a rotation, and say which rule the wrong ones break."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Sequence
from typing import TYPE_CHECKING
from typing import TypeAlias

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

Floats: TypeAlias = 'NDArray[np.float64]'

MATRIX_TOLERANCE = 1e-5
"""How far a given matrix may be from a rotation; libfranka allows its matrices as much."""


class RotationError(ValueError):
    """Numbers given as a rotation are none; the message names the value and the rule."""


def listed(values: Sequence[float] | Floats) -> str:
    """
    Write numbers as people read them in a message.

    :param values: shape (k,).
    :return: the numbers between parentheses, as short as they can be read back.
    """
    return '(' + ', '.join(repr(float(value)) for value in values) + ')'


def quaternion_fault(quat_xyzw: Sequence[float] | Floats) -> str:
    """
    Say what keeps four numbers from being a rotation.

    :param quat_xyzw: x, y, z, w; of any norm.
    :return: the broken rule with the values, or an empty text where there is none.
    """
    if not np.all(np.isfinite(quat_xyzw)):
        return f'quaternion {listed(quat_xyzw)} (x, y, z, w) is not finite'
    if not np.any(quat_xyzw):
        return f'quaternion {listed(quat_xyzw)} is zero, which is no rotation'
    return ''


def rpy_fault(rpy: Sequence[float] | Floats) -> str:
    """
    Say what keeps three numbers from being roll, pitch and yaw.

    :param rpy: roll, pitch, yaw; any unit, any size.
    :return: the broken rule with the values, or an empty text where there is none.
    """
    if not np.all(np.isfinite(rpy)):
        return f'roll, pitch, yaw {listed(rpy)} are not finite'
    return ''


def matrix_fault(matrix: Floats, tolerance: float = MATRIX_TOLERANCE) -> str:
    """
    Say what keeps nine numbers from being a rotation matrix.

    :param matrix: shape (3, 3).
    :param tolerance: largest difference from 1 of a row's or column's norm and of the
        determinant, and from 0 of the product of two columns.
    :return: the broken rule with the values, or an empty text where there is none.
    """
    if not np.all(np.isfinite(matrix)):
        return f'rotation matrix {_rows(matrix)} is not finite'
    with np.errstate(over='ignore', invalid='ignore'):
        for axis, name in ((0, 'column'), (1, 'row')):
            norms = np.sqrt(np.sum(matrix * matrix, axis=axis))
            worst = int(np.argmax(np.abs(norms - 1.0)))
            if abs(norms[worst] - 1.0) > tolerance:
                return (
                    f'rotation matrix {_rows(matrix)} is not orthonormal: {name} {worst} has'
                    f' norm {float(norms[worst])!r}, and only {tolerance} from 1 is allowed'
                )
    for first, second in ((0, 1), (0, 2), (1, 2)):
        product = float(matrix[:, first] @ matrix[:, second])
        if abs(product) > tolerance:
            return (
                f'rotation matrix {_rows(matrix)} is not orthonormal: columns {first} and'
                f' {second} have scalar product {product!r}, and only {tolerance} from 0 is'
                ' allowed'
            )
    # Columns that passed so far leave nothing but +1 and -1, to the tolerance.
    determinant = float(np.linalg.det(matrix))
    if determinant < 0.0:
        return (
            f'rotation matrix {_rows(matrix)} has determinant {determinant:.6g}: it mirrors;'
            ' a rotation has determinant +1'
        )
    return ''


def check_quaternion(quat_xyzw: Sequence[float] | Floats) -> Floats:
    """
    Take four numbers as a rotation, or refuse them.

    :param quat_xyzw: x, y, z, w; any norm but zero.
    :return: the same numbers, shape (4,).
    :raises RotationError: wrong count, not finite, or all zero.
    """
    return _checked(quat_xyzw, (4,), 'quaternion', quaternion_fault)


def check_rpy(rpy: Sequence[float] | Floats) -> Floats:
    """
    Take three numbers as roll, pitch and yaw, or refuse them.

    :param rpy: roll, pitch, yaw; any unit, any size.
    :return: the same numbers, shape (3,).
    :raises RotationError: wrong count or not finite.
    """
    return _checked(rpy, (3,), 'roll, pitch, yaw', rpy_fault)


def check_matrix(matrix: Sequence[Sequence[float]] | Floats) -> Floats:
    """
    Take a matrix as a rotation, or refuse it.

    :param matrix: shape (3, 3), a rotation to :data:`MATRIX_TOLERANCE`.
    :return: the same numbers, shape (3, 3); not made orthonormal.
    :raises RotationError: wrong shape, not finite, not orthonormal, or determinant -1.
    """
    return _checked(matrix, (3, 3), 'rotation matrix', matrix_fault)


def check_vector(vector: Sequence[float] | Floats) -> Floats:
    """
    Take three numbers as a vector, or refuse them.

    :param vector: x, y, z.
    :return: the same numbers, shape (3,).
    :raises RotationError: wrong count or no numbers.
    """
    return _checked(vector, (3,), 'vector', lambda _: '')


def check_shape(values: object, row: tuple[int, ...], name: str) -> Floats:
    """
    Take an array of rows, or refuse it.

    :param values: numbers of shape (..., *row).
    :param row: shape of one row.
    :param name: what the message calls the values.
    :return: the numbers as floats.
    :raises RotationError: another shape, or no numbers.
    """
    array = _array(values, name)
    if array.shape[-len(row):] != row:
        wanted = ', '.join(str(length) for length in row)
        msg = f'{name} must have shape (..., {wanted}), but has {array.shape}'
        raise RotationError(msg)
    return array


def _array(values: object, name: str) -> Floats:
    try:
        return np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        msg = f'{name} must be numbers, but is {values!r}'
        raise RotationError(msg) from error


def _checked(
    values: object, shape: tuple[int, ...], name: str, fault_of: Callable[[Floats], str]
) -> Floats:
    array = _array(values, name)
    if array.shape != shape:
        msg = f'{name} must have shape {shape}, but has {array.shape}'
        raise RotationError(msg)
    fault = fault_of(array)
    if fault:
        raise RotationError(fault)
    return array


def _rows(matrix: Floats) -> str:
    return '(' + ', '.join(listed(row) for row in matrix) + ')'
