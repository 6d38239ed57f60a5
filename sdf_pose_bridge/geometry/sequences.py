# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Convert angles of rotations about three axes, one after the other, to quaternions and back.

A sequence is written with the axes about which a body turns: ``z-y'-x''`` is a rotation about its
z axis, then about its y axis, then about its x axis. It is the same as rotations about the fixed
axes x, y, z with the angles in reverse order, so it is the sequence of roll, pitch and yaw.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.rotations import (
    canonical_quaternion,
    Floats,
    quaternion_from_rpy,
    rpy_from_quaternion,
)

_LOCK_TOLERANCE = 1e-15


class AngleSequence(NamedTuple):
    """
    A sequence, expressed by yaw, pitch and roll of a related rotation.

    The quaternion of that rotation is the product of the quaternion and a matrix. Its yaw is the
    first angle, its roll the last one, and its pitch the middle one but for a sign and an offset.
    So every sequence is as precise as roll, pitch and yaw, and has the same rule for gimbal lock.
    """

    name: str
    """The axes in their order."""
    matrix: Floats
    """An orthogonal 4 x 4 matrix; quaternions x, y, z, w are rows."""
    sign: float = 1.0
    offset: float = 0.0
    """The middle angle at a pitch of 0, in half turns."""

    def quaternions_from_numbers(self, angles_rad: Floats) -> Floats:
        """
        Convert angles to canonical quaternions.

        :param angles_rad: the first, middle and last angle, of any size; shape (n, 3).
        :return: x, y, z, w; shape (n, 4).
        """
        if self is ZYX:  # as the others, but in half of the time
            return quaternion_from_rpy(angles_rad[:, ::-1])
        rpy: Floats = angles_rad[:, ::-1].copy()
        rpy[:, 1] = self._pitch(rpy[:, 1], math.pi)
        turned: Floats = quaternion_from_rpy(rpy) @ self.matrix.T
        return canonical_quaternion(turned)

    def numbers_from_quaternions(self, quats_xyzw: Floats) -> Floats:
        """
        Convert canonical quaternions to angles.

        :param quats_xyzw: shape (n, 4).
        :return: the first, middle and last angle in radians, shape (n, 3). The first and the last
            are in [-pi, pi], the middle one in [-pi/2, pi/2], or in [0, pi] if the first and the
            last axis are the same. At gimbal lock, at the ends of this range, the first is 0.
        """
        if self is ZYX:
            return rpy_from_quaternion(quats_xyzw)[:, ::-1]
        angles: Floats = rpy_from_quaternion(quats_xyzw @ self.matrix)[:, ::-1]
        angles[:, 1] = self.sign * angles[:, 1] + self.offset * math.pi
        return angles

    def are_canonical(self, angles: Any, half_turn: float) -> Any:
        """Return whether angles are in their ranges and not near gimbal lock; floats or arrays."""
        first, middle, last = angles
        return (
            (abs(first) <= half_turn) & (abs(last) <= half_turn)
            & (abs(self._pitch(middle, half_turn)) * (2.0 + 1e-7) <= half_turn))

    def near_lock(self, quats_xyzw: Floats) -> Any:
        """
        Return whether the first and the last angle alone are practically undefined.

        The rule is gz-math's: the sine of pitch differs from 1 or -1 by less than 1e-15, so pitch
        is within 4.5e-8 radians of a right angle.

        :param quats_xyzw: canonical quaternions, shape (..., 4).
        """
        x, y, z, w = np.moveaxis(quats_xyzw @ self.matrix, -1, 0)
        return abs(abs(2.0 * (w * y - x * z)) - 1.0) < _LOCK_TOLERANCE

    def _pitch(self, middle: Any, half_turn: float) -> Any:
        return self.sign * (middle - self.offset * half_turn)


ZYX = AngleSequence("z-y'-x''", np.eye(4))
"""Yaw, pitch and roll."""

XYZ = AngleSequence("x-y'-z''", np.eye(4)[[2, 1, 0, 3]] * [1.0, -1.0, 1.0, 1.0], sign=-1.0)
"""In axes that are turned half about (1, 0, 1), so that x is z, and y points backwards."""

ZYZ = AngleSequence("z-y'-z''", math.sqrt(0.5) * np.array([
    [1.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, 1.0], [1.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 1.0],
]), offset=0.5)
"""The body first turns about y by a right angle, so that its x axis is z."""
