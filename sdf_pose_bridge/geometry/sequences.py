# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Convert angles of rotations about three axes, one after the other, to quaternions and back.

A sequence is written with the axes about which a body turns: ``z-y'-x''`` is a rotation about its
z axis, then about its y axis, then about its x axis. It is the same as rotations about the fixed
axes x, y, z with the angles in reverse order, so it is the sequence of roll, pitch and yaw.
"""

from __future__ import annotations

from functools import cache
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


_AFTER_QUARTER_TURN = math.sqrt(0.5) * np.array([
    [1.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, 1.0], [1.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 1.0]])
"""Takes from quaternions a first turn about y by a right angle, after which x is where z was."""


@cache
def angle_sequence(letters: str) -> AngleSequence:
    """Return the sequence about the axes with these letters, such as ``zyx``; always the same."""
    first, middle, last = np.eye(3)[['xyz'.index(letter) for letter in letters]]
    is_same = letters[0] == letters[2]
    # In these axes the rotations are about z, y or -y, and x; or about z, y and z.
    x = np.cross(middle, first) if is_same else last
    y = np.cross(first, x)
    matrix = np.eye(4)
    matrix[:3, :3] = np.column_stack((x, y, first))
    return AngleSequence(
        "{}-{}'-{}''".format(*letters), matrix @ _AFTER_QUARTER_TURN if is_same else matrix,
        float(y @ middle), 0.5 if is_same else 0.0)


ZYX = angle_sequence('zyx')
"""Yaw, pitch and roll."""
