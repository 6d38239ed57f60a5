# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Answer one question about a rotation, as the service ConvertRotation asks it."""

from __future__ import annotations

import enum
import math
from typing import NamedTuple

from sdf_pose_bridge.geometry.angles import degrees_from_radians
from sdf_pose_bridge.geometry.angles import radians_from_degrees
from sdf_pose_bridge.geometry.rotation import canonical_quaternion
from sdf_pose_bridge.geometry.rotation import near_gimbal_lock
from sdf_pose_bridge.geometry.rotation import quaternion_from_rpy
from sdf_pose_bridge.geometry.rotation import RotationError
from sdf_pose_bridge.geometry.rotation import rpy_from_quaternion
from sdf_pose_bridge.geometry.rotation_checks import check_rpy


class Given(enum.IntEnum):
    """Which representation of the rotation counts; the constants of ConvertRotation.srv."""

    RPY = 0
    QUATERNION = 1


class RotationAnswer(NamedTuple):
    """One rotation in both representations."""

    rpy: tuple[float, float, float]
    """Roll, pitch, yaw; in degrees if the question was."""
    quat_xyzw: tuple[float, float, float, float]
    """x, y, z, w; unit, w >= 0."""
    gimbal_lock: bool
    """Pitch is a right angle to about 4.5e-8: roll and yaw mean little one without the other."""


def converted_rotation(
    given: int,
    rpy: tuple[float, float, float],
    quat_xyzw: tuple[float, float, float, float],
    degrees: bool,  # noqa: FBT001 - as the fields of the request follow each other
) -> RotationAnswer:
    """
    Give both representations of a rotation.

    :param given: which of the two that follow counts, a value of :class:`Given`; the other one is
        not looked at.
    :param rpy: roll, pitch, yaw, of any size.
    :param quat_xyzw: x, y, z, w, of any norm but zero.
    :param degrees: the angles given are degrees, and those returned shall be.
    :return: roll and yaw within a half turn, pitch within a right angle, yaw 0 at gimbal lock; the
        unit quaternion with w >= 0. Angles that are in these ranges already come back as they are.
    :raises RotationError: an unknown value of ``given``, numbers not finite, or a zero quaternion.
    """
    if given == Given.RPY:
        # The numbers as they were given, not as radians; numpy takes its time over three of them.
        if not all(map(math.isfinite, rpy)):
            check_rpy(rpy)
        rpy_rad = _radians(rpy) if degrees else rpy
        unit = quaternion_from_rpy(rpy_rad)
        lock = near_gimbal_lock(unit)
        if not lock and _in_range(rpy, 180.0 if degrees else math.pi):
            roll, pitch, yaw = rpy
            return RotationAnswer((roll + 0.0, pitch + 0.0, yaw + 0.0), unit, gimbal_lock=False)
    elif given == Given.QUATERNION:
        unit = canonical_quaternion(quat_xyzw)
        lock = near_gimbal_lock(unit)
    else:
        known = ', '.join(f'{value.value} ({value.name})' for value in Given)
        msg = f'given is {given!r}, which says neither RPY nor quaternion; known are {known}'
        raise RotationError(msg)
    answer = rpy_from_quaternion(unit)
    return RotationAnswer(_degrees(answer) if degrees else answer, unit, lock)


def _in_range(rpy: tuple[float, float, float], half_turn: float) -> bool:
    roll, pitch, yaw = rpy
    return abs(roll) <= half_turn and 2.0 * abs(pitch) <= half_turn and abs(yaw) <= half_turn


def _radians(rpy_deg: tuple[float, float, float]) -> tuple[float, float, float]:
    roll, pitch, yaw = rpy_deg
    return radians_from_degrees(roll), radians_from_degrees(pitch), radians_from_degrees(yaw)


def _degrees(rpy_rad: tuple[float, float, float]) -> tuple[float, float, float]:
    roll, pitch, yaw = rpy_rad
    return degrees_from_radians(roll), degrees_from_radians(pitch), degrees_from_radians(yaw)
