# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Convert rotations between roll-pitch-yaw, quaternions and matrices, one or many at a time.

Conventions:

- Roll, pitch and yaw are turns about the fixed axes x, y, z, in this order and in radians:
  ``R = Rz(yaw) Ry(pitch) Rx(roll)``, as in SDFormat and URDF.
- Quaternions are x, y, z, w, with the real part last. Any norm but zero is taken, however large
  or small. Those returned are unit, to the last bit, and canonical: w >= 0, and where w is 0 the
  first of x, y, z that is not 0 is positive.
- Matrices turn column vectors: ``v_parent = R v_child``. They are taken to within 1e-5 of a
  rotation, and the nearest rotation is used.
- Roll and yaw returned are in [-pi, pi], pitch is in [-pi/2, pi/2].

Every function takes one rotation or many. One is a tuple or list of floats: the answer is a tuple,
and takes about a microsecond. Many are an array of shape (..., 3), (..., 4) or (..., 3, 3), or
nested sequences: the answer is an array with the same leading shape, also where that is empty.

At gimbal lock, with pitch at a right angle, only roll - yaw (pitch up) or roll + yaw (pitch down)
has a meaning: yaw is then 0 and roll has all of it, as in gz-math. Near lock the angles are less
and less certain one by one, but together always are the rotation given; :func:`near_gimbal_lock`
tells where gz-math would set yaw to 0 and lose up to 4.5e-8 radians.

The rotation returned differs from the one given by a turn of 1.2e-15 at most, whatever the
rotation and the representations.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any
from typing import overload
from typing import TYPE_CHECKING
from typing import TypeAlias

import numpy as np

from sdf_pose_bridge.geometry import rotation_of_many
from sdf_pose_bridge.geometry import rotation_of_one
from sdf_pose_bridge.geometry.rotation_checks import Floats
from sdf_pose_bridge.geometry.rotation_checks import RotationError
from sdf_pose_bridge.geometry.rotation_of_one import Quadruple
from sdf_pose_bridge.geometry.rotation_of_one import Rows
from sdf_pose_bridge.geometry.rotation_of_one import Triple

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = [
    'RotationError',
    'canonical_quaternion',
    'matrix_from_quaternion',
    'matrix_from_rpy',
    'near_gimbal_lock',
    'quaternion_from_matrix',
    'quaternion_from_rpy',
    'quaternion_inverse',
    'quaternion_product',
    'rotated_vectors',
    'rpy_from_matrix',
    'rpy_from_quaternion',
]

One: TypeAlias = Sequence[float]
OneMatrix: TypeAlias = Sequence[Sequence[float]]
Many: TypeAlias = 'Floats | Sequence[Sequence[float]]'
ManyMatrices: TypeAlias = 'Floats | Sequence[Sequence[Sequence[float]]]'


@overload
def quaternion_from_rpy(rpy_rad: One) -> Quadruple: ...
@overload
def quaternion_from_rpy(rpy_rad: Many) -> Floats: ...
def quaternion_from_rpy(rpy_rad: Any) -> Any:
    """
    Convert roll, pitch, yaw to a quaternion.

    :param rpy_rad: roll, pitch, yaw in radians, of any size; shape (3,) or (..., 3).
    :return: x, y, z, w; unit, w >= 0; shape (4,) or (..., 4).
    :raises RotationError: wrong shape or not finite.
    """
    if _is_many(rpy_rad):
        return rotation_of_many.quaternion_from_rpy(rpy_rad)
    return rotation_of_one.quaternion_from_rpy(rpy_rad)


@overload
def rpy_from_quaternion(quat_xyzw: One) -> Triple: ...
@overload
def rpy_from_quaternion(quat_xyzw: Many) -> Floats: ...
def rpy_from_quaternion(quat_xyzw: Any) -> Any:
    """
    Convert a quaternion to roll, pitch, yaw.

    Where gz-math takes pitch from an arc sine, which near a right angle has half the digits, here
    all three angles come from arc tangents of numbers that are exact to the last digits
    everywhere: ``(w + y, x - z)`` is ``sqrt(1 + sin(pitch))`` times the cosine and sine of
    ``(roll - yaw) / 2``, and ``(w - y, x + z)`` is ``sqrt(1 - sin(pitch))`` times those of
    ``(roll + yaw) / 2``; the products of the two pairs are the sines and cosines of roll and yaw.

    :param quat_xyzw: x, y, z, w of any norm but zero; shape (4,) or (..., 4).
    :return: roll, pitch, yaw in radians; roll and yaw in [-pi, pi], pitch in [-pi/2, pi/2], yaw 0
        at gimbal lock; shape (3,) or (..., 3).
    :raises RotationError: wrong shape, not finite or zero.
    """
    if _is_many(quat_xyzw):
        return rotation_of_many.rpy_from_quaternion(quat_xyzw)
    return rotation_of_one.rpy_from_quaternion(quat_xyzw)


@overload
def matrix_from_quaternion(quat_xyzw: One) -> Rows: ...
@overload
def matrix_from_quaternion(quat_xyzw: Many) -> Floats: ...
def matrix_from_quaternion(quat_xyzw: Any) -> Any:
    """
    Convert a quaternion to a rotation matrix.

    :param quat_xyzw: x, y, z, w of any norm but zero; shape (4,) or (..., 4).
    :return: a tuple of the three rows, or an array of shape (..., 3, 3).
    :raises RotationError: wrong shape, not finite or zero.
    """
    if _is_many(quat_xyzw):
        return rotation_of_many.matrix_from_quaternion(quat_xyzw)
    return rotation_of_one.matrix_from_quaternion(quat_xyzw)


@overload
def quaternion_from_matrix(matrix: OneMatrix) -> Quadruple: ...
@overload
def quaternion_from_matrix(matrix: ManyMatrices) -> Floats: ...
def quaternion_from_matrix(matrix: Any) -> Any:
    """
    Convert a rotation matrix to a quaternion.

    The component with the largest square is taken from the matrix and the others from it, so that
    half turns keep their signs.

    :param matrix: three rows, or shape (..., 3, 3); a rotation to within 1e-5, of which the
        nearest rotation is used.
    :return: x, y, z, w; unit, w >= 0; shape (4,) or (..., 4).
    :raises RotationError: wrong shape, not finite, not orthonormal or with determinant -1.
    """
    if _is_many_matrices(matrix):
        return rotation_of_many.quaternion_from_matrix(matrix)
    return rotation_of_one.quaternion_from_matrix(matrix)


@overload
def matrix_from_rpy(rpy_rad: One) -> Rows: ...
@overload
def matrix_from_rpy(rpy_rad: Many) -> Floats: ...
def matrix_from_rpy(rpy_rad: Any) -> Any:
    """
    Convert roll, pitch, yaw to a rotation matrix.

    :param rpy_rad: roll, pitch, yaw in radians, of any size; shape (3,) or (..., 3).
    :return: a tuple of the three rows, or an array of shape (..., 3, 3).
    :raises RotationError: wrong shape or not finite.
    """
    if _is_many(rpy_rad):
        return rotation_of_many.matrix_from_rpy(rpy_rad)
    return rotation_of_one.matrix_from_rpy(rpy_rad)


@overload
def rpy_from_matrix(matrix: OneMatrix) -> Triple: ...
@overload
def rpy_from_matrix(matrix: ManyMatrices) -> Floats: ...
def rpy_from_matrix(matrix: Any) -> Any:
    """
    Convert a rotation matrix to roll, pitch, yaw.

    :param matrix: three rows, or shape (..., 3, 3); a rotation to within 1e-5, of which the
        nearest rotation is used.
    :return: roll, pitch, yaw in radians; roll and yaw in [-pi, pi], pitch in [-pi/2, pi/2], yaw 0
        at gimbal lock; shape (3,) or (..., 3).
    :raises RotationError: wrong shape, not finite, not orthonormal or with determinant -1.
    """
    if _is_many_matrices(matrix):
        return rotation_of_many.rpy_from_matrix(matrix)
    return rotation_of_one.rpy_from_matrix(matrix)


@overload
def quaternion_product(a_xyzw: One, b_xyzw: One) -> Quadruple: ...
@overload
def quaternion_product(a_xyzw: Many, b_xyzw: One | Many) -> Floats: ...
@overload
def quaternion_product(a_xyzw: One, b_xyzw: Many) -> Floats: ...
def quaternion_product(a_xyzw: Any, b_xyzw: Any) -> Any:
    """
    Compose two rotations: the product first turns by b, then by a.

    With a the rotation of B in A and b that of C in B, the product is that of C in A.

    :param a_xyzw: x, y, z, w of any norm but zero; shape (4,) or (..., 4).
    :param b_xyzw: the same; leading shapes broadcast.
    :return: x, y, z, w; unit, w >= 0; shape (4,) or (..., 4).
    :raises RotationError: wrong shape, not finite or zero.
    """
    if _is_many(a_xyzw) or _is_many(b_xyzw):
        return rotation_of_many.quaternion_product(np.asarray(a_xyzw), np.asarray(b_xyzw))
    return rotation_of_one.quaternion_product(a_xyzw, b_xyzw)


@overload
def quaternion_inverse(quat_xyzw: One) -> Quadruple: ...
@overload
def quaternion_inverse(quat_xyzw: Many) -> Floats: ...
def quaternion_inverse(quat_xyzw: Any) -> Any:
    """
    Return the rotation that turns back.

    :param quat_xyzw: x, y, z, w of any norm but zero; shape (4,) or (..., 4).
    :return: x, y, z, w; unit, w >= 0; shape (4,) or (..., 4).
    :raises RotationError: wrong shape, not finite or zero.
    """
    if _is_many(quat_xyzw):
        return rotation_of_many.quaternion_inverse(quat_xyzw)
    return rotation_of_one.quaternion_inverse(quat_xyzw)


@overload
def rotated_vectors(quat_xyzw: One, vectors: One) -> Triple: ...
@overload
def rotated_vectors(quat_xyzw: Many, vectors: One | Many) -> Floats: ...
@overload
def rotated_vectors(quat_xyzw: One, vectors: Many) -> Floats: ...
def rotated_vectors(quat_xyzw: Any, vectors: Any) -> Any:
    """
    Turn vectors.

    :param quat_xyzw: x, y, z, w of any norm but zero; shape (4,) or (..., 4).
    :param vectors: x, y, z; shape (3,) or (..., 3). Leading shapes broadcast.
    :return: the vectors turned; shape (3,) or (..., 3).
    :raises RotationError: wrong shape, or a quaternion not finite or zero.
    """
    if _is_many(quat_xyzw) or _is_many(vectors):
        return rotation_of_many.rotated_vectors(np.asarray(quat_xyzw), np.asarray(vectors))
    return rotation_of_one.rotated_vector(quat_xyzw, vectors)


@overload
def canonical_quaternion(quat_xyzw: One) -> Quadruple: ...
@overload
def canonical_quaternion(quat_xyzw: Many) -> Floats: ...
def canonical_quaternion(quat_xyzw: Any) -> Any:
    """
    Return the one quaternion that stands for a rotation.

    :param quat_xyzw: x, y, z, w of any norm but zero; shape (4,) or (..., 4).
    :return: x, y, z, w; unit; w >= 0, and where w is 0 the first of x, y, z that is not 0 is
        positive; shape (4,) or (..., 4). One that is so already comes back bit for bit.
    :raises RotationError: wrong shape, not finite or zero.
    """
    if _is_many(quat_xyzw):
        return rotation_of_many.canonical_quaternion(quat_xyzw)
    return rotation_of_one.canonical_quaternion(quat_xyzw)


@overload
def near_gimbal_lock(quat_xyzw: One) -> bool: ...
@overload
def near_gimbal_lock(quat_xyzw: Many) -> NDArray[np.bool_]: ...
def near_gimbal_lock(quat_xyzw: Any) -> Any:
    """
    Tell whether roll and yaw are as good as undefined one without the other.

    The rule is gz-math's: the sine of pitch is nearer to 1 or -1 than 1e-15, so that pitch is
    within 4.5e-8 radians of a right angle.

    :param quat_xyzw: x, y, z, w of any norm but zero; shape (4,) or (..., 4).
    :return: true or false, or an array of them of shape (...).
    :raises RotationError: wrong shape, not finite or zero.
    """
    if _is_many(quat_xyzw):
        return rotation_of_many.near_gimbal_lock(quat_xyzw)
    return rotation_of_one.near_gimbal_lock(quat_xyzw)


def _is_many(values: Any) -> bool:
    """Tell an array or nested sequences from one flat sequence of numbers."""
    return isinstance(values, np.ndarray) or (len(values) > 0 and hasattr(values[0], '__len__'))


def _is_many_matrices(values: Any) -> bool:
    """Tell an array or a sequence of matrices from one sequence of three rows."""
    return isinstance(values, np.ndarray) or (len(values) > 0 and _is_many(values[0]))
