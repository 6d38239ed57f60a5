# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Poses of bodies that rotate about axes and move along them.

Source: Rodrigues' rotation formula. With the unit axis a through the point p, the angle r and the
distance d, a point x moves to ``p + u + cos(r) v + sin(r) (a x v) + d a``, where u and v are the
parts of x - p along the axis and normal to it. The quaternion is ``(a sin(r/2), cos(r/2))``.
"""

from __future__ import annotations

from typing import Any
from typing import TYPE_CHECKING

import numpy as np

from sdf_pose_bridge.geometry.poses import pose_products
from sdf_pose_bridge.geometry.poses import PoseArray

if TYPE_CHECKING:
    from numpy.typing import NDArray
    Floats = NDArray[np.float64]


class ScrewMotions:
    """
    Poses that are products of a constant pose, a screw motion and a constant pose.

    Both parts of such a product, position and quaternion, are linear in the sines and cosines of
    the angles and in the distances. The factors are computed once, here.

    :param before: shape (n, 7), the poses before the motions.
    :param axes: shape (n, 3), unit vectors.
    :param points: shape (n, 3), a point of each axis, in metres.
    :param rad_per_unit: shape (n,), how far a motion turns about its axis for a position of 1.
    :param m_per_unit: shape (n,), how far it moves along its axis for a position of 1.
    :param after: shape (n, 7), the poses after the motions.
    """

    def __init__(
        self, before: PoseArray, axes: Floats, points: Floats, rad_per_unit: Floats,
        m_per_unit: Floats, after: PoseArray,
    ) -> None:
        arms = after[:, :3] - points
        along = (arms * axes).sum(axis=1, keepdims=True) * axes
        normal = arms - along
        self._fixed = pose_products(before, _translations(points + along))[:, :3]
        self._with_cosine = _rotated(before, normal)
        self._with_sine = _rotated(before, np.cross(axes, normal))
        self._with_distance = _rotated(before, axes)
        half_turns = np.zeros((len(axes), 7))
        half_turns[:, 3:6] = axes
        self._quat_with_cosine = pose_products(before, after)[:, 3:]
        self._quat_with_sine = pose_products(pose_products(before, half_turns), after)[:, 3:]
        self._half_rad_per_unit = 0.5 * rad_per_unit
        self._m_per_unit = m_per_unit

    def poses(self, positions: Floats) -> PoseArray:
        """
        Return the poses at given positions.

        :param positions: shape (n,), the position of each motion.
        :return: shape (n, 7), the poses; unit quaternions.
        """
        half_angles = (self._half_rad_per_unit * positions)[:, np.newaxis]
        cosine, sine = np.cos(half_angles), np.sin(half_angles)
        poses: np.ndarray[Any, np.dtype[np.float64]] = np.empty((len(positions), 7))
        poses[:, :3] = (
            self._fixed + (1.0 - 2.0 * sine * sine) * self._with_cosine
            + 2.0 * sine * cosine * self._with_sine
            + (self._m_per_unit * positions)[:, np.newaxis] * self._with_distance)
        poses[:, 3:] = cosine * self._quat_with_cosine + sine * self._quat_with_sine
        return poses


def _translations(vectors: Floats) -> PoseArray:
    poses = np.zeros((len(vectors), 7))
    poses[:, :3] = vectors
    poses[:, 6] = 1.0
    return poses


def _rotated(poses: PoseArray, vectors: Floats) -> Floats:
    rotations = poses.copy()
    rotations[:, :3] = 0.0
    return pose_products(rotations, _translations(vectors))[:, :3]
