# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Compose and invert poses, one or many.

A pose places a child frame in a parent frame: x y z of the child's origin in metres and the unit
quaternion x y z w of its axes, both expressed in the parent. Poses chain as
``pose of C in A = product(pose of B in A, pose of C in B)``.

The formulas for one pose are elementwise, so they also take poses whose components are arrays;
this is how the functions for many poses use them.
"""

from collections.abc import Callable
from typing import NamedTuple, TypeAlias

import numpy as np

from sdf_pose_bridge.geometry.formulas import row_blocks
from sdf_pose_bridge.geometry.rotations import canonical_quaternion, Floats

PoseArray: TypeAlias = Floats
"""Poses as rows: shape (n, 7), x y z in metres, unit quaternion x y z w."""


class Pose(NamedTuple):
    """
    Pose of a child frame in a parent frame: metres, and a unit quaternion.

    ``Pose()`` is the identity.
    """

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
    :return: pose of frame C in frame A; the norm of its quaternion is the product of their norms.
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
    Invert a pose.

    :param a: pose of frame B in frame A.
    :return: pose of frame A in frame B.
    """
    x, y, z, qx, qy, qz, qw = a
    ux = 2.0 * (qy * z - qz * y)
    uy = 2.0 * (qz * x - qx * z)
    uz = 2.0 * (qx * y - qy * x)
    return Pose(
        -x + qw * ux - qy * uz + qz * uy,
        -y + qw * uy - qz * ux + qx * uz,
        -z + qw * uz - qx * uy + qy * ux,
        -qx, -qy, -qz, qw)


def relative_pose(reference: Pose, pose: Pose) -> Pose:
    """
    Return a pose in another frame.

    :param reference: pose of frame B in frame A.
    :param pose: pose of frame C in frame A.
    :return: pose of frame C in frame B.
    """
    return pose_product(pose_inverse(reference), pose)


def canonical_relative_pose(reference: Pose, pose: Pose) -> Pose:
    """
    Return a pose in another frame, in the form in which poses are shown and published.

    :param reference: pose of frame B in frame A.
    :param pose: pose of frame C in frame A.
    :return: pose of frame C in frame B; its quaternion is canonical, as from
        :func:`~sdf_pose_bridge.geometry.rotations.canonical_quaternion`, and no zero is negative.
    """
    x, y, z, qx, qy, qz, qw = relative_pose(reference, pose)
    return Pose(x + 0.0, y + 0.0, z + 0.0, *canonical_quaternion((qx, qy, qz, qw)))


def pose_products(a: PoseArray, b: PoseArray) -> PoseArray:
    """
    Chain many pairs of poses with :func:`pose_product`.

    :param a: poses of frames B in frames A, shape (n, 7), or (7,) if it is one for all.
    :param b: poses of frames C in frames B, shape (n, 7).
    :return: poses of frames C in frames A, shape (n, 7).
    """
    return _in_blocks(pose_product, a, b)


def relative_poses(references: PoseArray, poses: PoseArray) -> PoseArray:
    """
    Return many poses in other frames with :func:`relative_pose`.

    :param references: poses of frames B in frames A, shape (n, 7), or (7,) if it is one for all.
    :param poses: poses of frames C in frames A, shape (n, 7).
    :return: poses of frames C in frames B, shape (n, 7).
    """
    return _in_blocks(relative_pose, references, poses)


def canonical_relative_poses(references: PoseArray, poses: PoseArray) -> PoseArray:
    """
    Return poses as :func:`relative_poses`, in the canonical form in which poses are published.

    :return: poses of frames C in frames B, shape (n, 7), canonical.
    """
    return canonical_poses(relative_poses(references, poses))


def canonical_poses(poses: PoseArray) -> PoseArray:
    """
    Return poses in the form in which they are shown and published.

    :param poses: shape (n, 7); the quaternions may have any norm but zero.
    :return: shape (n, 7), with canonical quaternions and without negative zeros.
    """
    return np.concatenate([poses[:, :3] + 0.0, canonical_quaternion(poses[:, 3:])], axis=1)


def transformed_points(poses: PoseArray, points: Floats) -> Floats:
    """
    Return points in other frames.

    :param poses: poses of frames B in frames A, shape (n, 7).
    :param points: points in frames B, shape (n, 3), in metres.
    :return: the points in frames A, shape (n, 3).
    """
    translations = np.tile(Pose(), (len(points), 1))
    translations[:, :3] = points
    return pose_products(poses, translations)[:, :3]


def _in_blocks(formula: Callable[[Pose, Pose], Pose], a: PoseArray, b: PoseArray) -> PoseArray:
    a, results = np.broadcast_to(a, b.shape), np.empty(b.shape)
    for block in row_blocks(len(b)):
        results[block] = np.transpose(formula(_columns(a[block]), _columns(b[block])))
    return results


def _columns(poses: PoseArray) -> Pose:
    """Return a pose whose components are arrays."""
    return Pose(*np.ascontiguousarray(poses.T))
