# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Compose and invert poses, one or many; and poses of bodies that rotate about axes.

A pose places a child frame in a parent frame: x y z of the child's origin in metres and the unit
quaternion x y z w of its axes, both expressed in the parent. Poses chain as
``pose of C in A = product(pose of B in A, pose of C in B)``.

The formulas for one pose are elementwise, so they also take poses whose components are arrays;
this is how the functions for many poses use them.
"""

from collections.abc import Callable
import math
from typing import NamedTuple, TypeAlias

import numpy as np

from sdf_pose_bridge.geometry.formulas import row_blocks
from sdf_pose_bridge.geometry.rotations import canonical_quaternion, Floats

PoseArray: TypeAlias = Floats
"""Poses as rows: shape (n, 7), x y z in metres, unit quaternion x y z w."""


TOLERANCE = 1e-9
"""A smaller difference of poses, in metres and radians, comes from rounding."""


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


OPTICAL_POSE = Pose(0.0, 0.0, 0.0, -0.5, 0.5, -0.5, 0.5)
"""Pose of an optical frame (REP 103: z forward, x right, y down) in its camera (x forward)."""


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
    """Return the pose of frame A in frame B, of the pose of frame B in frame A."""
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
    """Return the pose of frame C in frame B, of those of frames B and C in frame A."""
    return pose_product(pose_inverse(reference), pose)


def canonical_relative_pose(reference: Pose, pose: Pose) -> Pose:
    """Return a pose in another frame as it is shown: canonical, and without negative zeros."""
    x, y, z, qx, qy, qz, qw = relative_pose(reference, pose)
    return Pose(x + 0.0, y + 0.0, z + 0.0, *canonical_quaternion((qx, qy, qz, qw)))


def distance_and_angle(a: Pose, b: Pose) -> tuple[float, float]:
    """Return the distance of two poses in metres, and their angle in radians."""
    between = relative_pose(a, b)
    return (math.hypot(*between[:3]), 2.0 * math.atan2(math.hypot(*between[3:6]), abs(between.qw)))


def pose_products(a: PoseArray, b: PoseArray) -> PoseArray:
    """Chain many pairs of poses with :func:`pose_product`; ``a`` may be one pose for all."""
    return _in_blocks(pose_product, a, b)


def relative_poses(references: PoseArray, poses: PoseArray) -> PoseArray:
    """Return many poses in other frames with :func:`relative_pose`, or in one for all."""
    return _in_blocks(relative_pose, references, poses)


def canonical_relative_poses(references: PoseArray, poses: PoseArray) -> PoseArray:
    """Return many poses in other frames with :func:`canonical_relative_pose`."""
    return canonical_poses(relative_poses(references, poses))


def canonical_poses(poses: PoseArray) -> PoseArray:
    """Return poses with canonical quaternions, and without negative zeros."""
    return np.concatenate([poses[:, :3] + 0.0, canonical_quaternion(poses[:, 3:])], axis=1)


def transformed_points(poses: PoseArray, points: Floats) -> Floats:
    """Return points, shape (n, 3), that are given in the frames of poses, in their parents."""
    translations = np.tile(Pose(), (len(points), 1))
    translations[:, :3] = points
    return pose_products(poses, translations)[:, :3]


class ScrewMotions:
    """
    Poses that are products of a constant pose, a screw motion and a constant pose.

    Both parts of such a product are linear in sines and cosines: the position in those of the
    angle, and in the distance; the quaternion in those of half the angle. The factors are
    computed once, here.

    Source: Rodrigues' rotation formula. With the unit axis a through the point p, the angle r and
    the distance d, a point x moves to ``p + u + cos(r) v + sin(r) (a x v) + d a``, where u and v
    are the parts of x - p along the axis and normal to it. The quaternion is
    ``(a sin(r/2), cos(r/2))``.

    :param before: shape (n, 7), the poses before the motions.
    :param axes: shape (n, 3), unit vectors.
    :param points: shape (n, 3), a point of each axis, in metres.
    :param rad_per_unit: shape (n,), angle about the axis for a position of 1.
    :param m_per_unit: shape (n,), distance along the axis for a position of 1.
    :param after: shape (n, 7), the poses after the motions.
    """

    def __init__(
        self, before: PoseArray, axes: Floats, points: Floats, rad_per_unit: Floats,
        m_per_unit: Floats, after: PoseArray,
    ) -> None:
        arms = after[:, :3] - points
        along = (arms * axes).sum(axis=1, keepdims=True) * axes
        normal = arms - along
        half_turns = np.zeros((len(axes), 7))
        half_turns[:, 3:6] = axes
        rotations = before.copy()
        rotations[:, :3] = 0.0
        # Shape (n, 6, 7): the factors of 1, the position, and the cosines and sines of the angle
        # and of its half.
        self._factors = np.zeros((len(axes), 6, 7))
        self._factors[:, 0, :3] = transformed_points(before, points + along)
        self._factors[:, 1, :3] = transformed_points(rotations, m_per_unit[:, np.newaxis] * axes)
        self._factors[:, 2, :3] = transformed_points(rotations, normal)
        self._factors[:, 3, 3:] = pose_products(before, after)[:, 3:]
        self._factors[:, 4, :3] = transformed_points(rotations, np.cross(axes, normal))
        self._factors[:, 5, 3:] = pose_products(pose_products(before, half_turns), after)[:, 3:]
        self._angles_per_unit = np.stack([rad_per_unit, 0.5 * rad_per_unit], axis=1)

    def poses(self, positions: Floats) -> PoseArray:
        """Return the poses at a position of each motion; shapes (n,) and (n, 7)."""
        angles = self._angles_per_unit * positions[:, np.newaxis]
        terms = np.empty((len(positions), 6))
        terms[:, 0] = 1.0
        terms[:, 1] = positions
        np.cos(angles, out=terms[:, 2:4])
        np.sin(angles, out=terms[:, 4:])
        poses: PoseArray = np.einsum('nt,ntk->nk', terms, self._factors)
        return poses


def _in_blocks(formula: Callable[[Pose, Pose], Pose], a: PoseArray, b: PoseArray) -> PoseArray:
    a, results = np.broadcast_to(a, b.shape), np.empty(b.shape)
    for block in row_blocks(len(b)):
        # Poses whose components are arrays.
        pair = (Pose(*np.ascontiguousarray(poses[block].T)) for poses in (a, b))
        results[block] = np.transpose(formula(*pair))
    return results
