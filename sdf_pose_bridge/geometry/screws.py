# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Poses of bodies that rotate about axes and move along them.

Source: Rodrigues' rotation formula. With the unit axis a through the point p, the angle r and the
distance d, a point x moves to ``p + u + cos(r) v + sin(r) (a x v) + d a``, where u and v are the
parts of x - p along the axis and normal to it. The quaternion is ``(a sin(r/2), cos(r/2))``.
"""

from __future__ import annotations

import numpy as np

from sdf_pose_bridge.geometry.poses import pose_products, PoseArray, transformed_points
from sdf_pose_bridge.geometry.rotations import Floats


class ScrewMotions:
    """
    Poses that are products of a constant pose, a screw motion and a constant pose.

    Both parts of such a product are linear in sines and cosines: the position in those of the
    angle, and in the distance; the quaternion in those of half the angle. The factors are
    computed once, here.

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
        self._factors[:, 1, :3] = transformed_points(
            rotations, m_per_unit[:, np.newaxis] * axes)
        self._factors[:, 2, :3] = transformed_points(rotations, normal)
        self._factors[:, 3, 3:] = pose_products(before, after)[:, 3:]
        self._factors[:, 4, :3] = transformed_points(rotations, np.cross(axes, normal))
        self._factors[:, 5, 3:] = pose_products(pose_products(before, half_turns), after)[:, 3:]
        self._angles_per_unit = np.stack([rad_per_unit, 0.5 * rad_per_unit], axis=1)

    def poses(self, positions: Floats) -> PoseArray:
        """
        Return the poses at given positions.

        :param positions: shape (n,), the position of each motion.
        :return: shape (n, 7), the poses; unit quaternions.
        """
        angles = self._angles_per_unit * positions[:, np.newaxis]
        terms = np.empty((len(positions), 6))
        terms[:, 0] = 1.0
        terms[:, 1] = positions
        np.cos(angles, out=terms[:, 2:4])
        np.sin(angles, out=terms[:, 4:])
        poses: PoseArray = np.einsum('nt,ntk->nk', terms, self._factors)
        return poses
