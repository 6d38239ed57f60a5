# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Both representations of one rotation, as the service ConvertRotation returns them."""

from __future__ import annotations

import enum
from typing import NamedTuple

from sdf_pose_bridge.geometry.formats import converted_rotations, ROTATION_FORMATS
from sdf_pose_bridge.geometry.rotations import (
    near_gimbal_lock,
    Quaternion,
    RotationError,
    Triple,
)
from sdf_pose_bridge.geometry.units import Doubt


class RotationForm(enum.IntEnum):
    """The given representation of a rotation; the constants of ConvertRotation.srv."""

    RPY = 0
    QUATERNION = 1


_UNSET_QUATERNIONS = ((0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0, 0.0))


class RotationAnswer(NamedTuple):
    """One rotation in both representations."""

    rpy: Triple
    """Roll, pitch, yaw; in degrees if requested."""
    quat_xyzw: Quaternion
    """x, y, z, w; unit, w >= 0."""
    gimbal_lock: bool
    """Whether pitch is within 4.5e-8 of a right angle, where roll and yaw alone are uncertain."""
    doubt: Doubt | None
    """Why the given angles are probably in another unit."""


def converted_rotation(
    given: int, rpy: Triple, quat_xyzw: Quaternion, *, degrees: bool,
) -> RotationAnswer:
    """
    Return both representations of one rotation, as the service ConvertRotation does.

    :param given: a value of :class:`RotationForm`, which chooses one of the next two; the other
        one has to be unset: zeros, or the identity for the quaternion.
    :param rpy: roll, pitch, yaw, of any size.
    :param quat_xyzw: x, y, z, w, of any norm but zero.
    :param degrees: True if the angles, given and returned, are in degrees.
    :return: roll and yaw within a half turn, pitch within a right angle, yaw 0 at gimbal lock; the
        canonical quaternion. Angles in these ranges keep their digits.
    :raises RotationError: an unknown value of ``given``, or a value of the other representation.
    :raises PoseFormatError: numbers that are not finite, or a quaternion of zeros.
    """
    _check_unused(given, rpy, quat_xyzw)
    angles = ROTATION_FORMATS['rpy_degrees' if degrees else 'rpy']
    if given == RotationForm.RPY:
        source, values = angles, [*rpy]
    elif given == RotationForm.QUATERNION:
        source, values = ROTATION_FORMATS['quaternion'], [*quat_xyzw]
    else:
        known = ', '.join(f'{value.value} ({value.name})' for value in RotationForm)
        msg = f'given is {given!r}, which is neither RPY nor quaternion; known are {known}'
        raise RotationError(msg)
    roll, pitch, yaw = converted_rotations(values, source, angles).tolist()
    x, y, z, w = quat = converted_rotations(values, source, 'quaternion').tolist()
    return RotationAnswer(
        (roll, pitch, yaw), (x, y, z, w), near_gimbal_lock(quat), source.doubt(values))


def _check_unused(given: int, rpy: Triple, quat_xyzw: Quaternion) -> None:
    """Check that a value that would be ignored is not there, as ``given`` may be forgotten."""
    unused = ''
    if given == RotationForm.RPY and tuple(quat_xyzw) not in _UNSET_QUATERNIONS:
        unused = f'quaternion is {quat_xyzw}'
    elif given == RotationForm.QUATERNION and tuple(rpy) != (0.0, 0.0, 0.0):
        unused = f'rpy is {rpy}'
    if unused:
        used, other = RotationForm(given), RotationForm(1 - given)
        msg = (f'given is {used.value} ({used.name}), but {unused}; set given to {other.value} '
               f'({other.name}), or leave that out')
        raise RotationError(msg)
