# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Compose and invert poses, one or many.

A pose is that of a child frame in a parent frame: x y z of the child's origin in metres and the
unit quaternion x y z w of its axes, both expressed in the parent. Poses chain as
``pose of c in a = product(pose of b in a, pose of c in b)``.
"""

from collections.abc import Iterator
from typing import Any
from typing import NamedTuple
from typing import TypeAlias

import numpy as np

PoseArray: TypeAlias = np.ndarray[Any, np.dtype[np.float64]]
"""Poses as rows: shape (n, 7), x y z in metres, unit quaternion x y z w."""

_BLOCK = 4096
"""How many rows are worked on at a time."""


class Pose(NamedTuple):
    """Pose of a child frame in a parent frame: metres, and a unit quaternion."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    qx: float = 0.0
    qy: float = 0.0
    qz: float = 0.0
    qw: float = 1.0


def pose_product(a: Pose, b: Pose) -> Pose:
    """
    Chain two poses.

    :param a: pose of frame B in frame A.
    :param b: pose of frame C in frame B.
    :return: pose of frame C in frame A; its quaternion is as long as the product of theirs.
    """
    ax, ay, az, aqx, aqy, aqz, aqw = a
    bx, by, bz, bqx, bqy, bqz, bqw = b
    ux = 2.0 * (aqy * bz - aqz * by)
    uy = 2.0 * (aqz * bx - aqx * bz)
    uz = 2.0 * (aqx * by - aqy * bx)
    return Pose(
        ax + bx + aqw * ux + aqy * uz - aqz * uy,
        ay + by + aqw * uy + aqz * ux - aqx * uz,
        az + bz + aqw * uz + aqx * uy - aqy * ux,
        aqw * bqx + aqx * bqw + aqy * bqz - aqz * bqy,
        aqw * bqy - aqx * bqz + aqy * bqw + aqz * bqx,
        aqw * bqz + aqx * bqy - aqy * bqx + aqz * bqw,
        aqw * bqw - aqx * bqx - aqy * bqy - aqz * bqz)


def pose_inverse(a: Pose) -> Pose:
    """
    Turn a pose around.

    :param a: pose of frame B in frame A.
    :return: pose of frame A in frame B.
    """
    x, y, z, qx, qy, qz, qw = a
    return pose_product(Pose(0.0, 0.0, 0.0, -qx, -qy, -qz, qw), Pose(-x, -y, -z))


def pose_products(a: PoseArray, b: PoseArray) -> PoseArray:
    """
    Chain many pairs of poses.

    :param a: poses of frames B in frames A, shape (n, 7) or (1, 7).
    :param b: poses of frames C in frames B, shape (n, 7).
    :return: poses of frames C in frames A, shape (n, 7); quaternions are as long as the products
        of theirs.
    """
    product = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for rows in _blocks(len(product)):
        # The same formula serves columns: every operation is between arrays of as many.
        columns = pose_product(Pose(*(a if len(a) == 1 else a[rows]).T), Pose(*b[rows].T))
        for target, column in zip(product[rows].T, columns, strict=True):
            target[:] = column
    return product


def relative_poses(references: PoseArray, poses: PoseArray) -> PoseArray:
    """
    Return poses in other frames.

    :param references: poses of frames B in frames A, shape (n, 7).
    :param poses: poses of frames C in frames A, shape (n, 7).
    :return: poses of frames C in frames B, shape (n, 7): to the last bit the products of
        :func:`pose_inverse` and the poses.
    """
    relative = np.empty(poses.shape)
    for rows in _blocks(len(relative)):
        x, y, z, qx, qy, qz, qw = np.ascontiguousarray(references[rows].T)
        # As in pose_inverse and pose_product, on columns.
        inverses = pose_product(_columns(0.0, 0.0, 0.0, -qx, -qy, -qz, qw), _columns(-x, -y, -z))
        np.stack(
            pose_product(inverses, Pose(*np.ascontiguousarray(poses[rows].T))), axis=1,
            out=relative[rows])
    return relative


def _blocks(count: int) -> Iterator[slice]:
    """Divide rows, so that what is worked out between stays near to the processor."""
    for start in range(0, count, _BLOCK):
        yield slice(start, start + _BLOCK)


def _columns(*columns: Any) -> Pose:
    return Pose(*columns)
