# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Units of lengths and angles, numbers of a pose in them, and numbers that are in another one."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.poses import Pose, TOLERANCE
from sdf_pose_bridge.geometry.rotations import Floats, rpy_from_quaternion

LARGEST_ANGLE_RAD = 2.5 * math.pi
"""A larger angle is probably in degrees; one of a little more than a turn may be meant."""

FAR_M = 100.0
"""A position that is at least this far away is probably in millimetres."""


class Unit(NamedTuple):
    """A unit of lengths or angles, with the number of digits to show."""

    name: str
    text: str
    """The unit in sentences, and in options of commands."""
    factor: float
    """Number of these units in a metre or a radian."""
    digits: int

    @property
    def half_turn(self) -> float:
        """A half turn in this unit of angles."""
        return math.pi * self.factor

    def rounded(self, value: float) -> str:
        """Write a length in metres, or an angle in radians, in this unit; only 0 is a zero."""
        if abs(value) < TOLERANCE:
            value = 0.0
        shown = round(value * self.factor, self.digits)
        return f'{shown:.{self.digits}f}' if shown or not value else f'{value * self.factor:.2g}'


METRES, MILLIMETRES = Unit('m', 'metres', 1.0, 4), Unit('mm', 'mm', 1000.0, 1)
RADIANS = Unit('rad', 'radians', 1.0, 4)
DEGREES = Unit('deg', 'degrees', math.degrees(1.0), 2)

UNLIKELY = {
    METRES: (FAR_M, math.inf, MILLIMETRES),
    MILLIMETRES: (1e-3, 2.0, METRES),
    RADIANS: (LARGEST_ANGLE_RAD, math.inf, DEGREES),
    DEGREES: (0.5, 3.15, RADIANS),
}
"""A position or rotation is probably in the other unit if its largest number is in this range."""

_ROUND_DEG = 0.1
"""Multiples of this are probably degrees, also if they are small."""

POSE_LABELS = ('x', 'y', 'z', 'roll', 'pitch', 'yaw')
"""Labels of the numbers of a pose."""


class Units(NamedTuple):
    """Units of the poses that a command shows."""

    length: Unit = METRES
    angle: Unit = RADIANS

    @property
    def of_pose(self) -> list[Unit]:
        """The units of x, y, z, roll, pitch and yaw."""
        return 3 * [self.length] + 3 * [self.angle]

    @property
    def labels(self) -> tuple[str, ...]:
        """The labels of the columns of a table of poses."""
        return f'x {self.length.name}', 'y', 'z', f'roll {self.angle.name}', 'pitch', 'yaw'

    def texts(self, pose: Pose) -> list[str]:
        """Write a pose in these units: x, y, z, roll, pitch and yaw, rounded."""
        values = (*pose[:3], *rpy_from_quaternion(pose[3:]))
        return [unit.rounded(value) for value, unit in zip(values, self.of_pose, strict=True)]


def are_unlikely(rows: Floats, unit: Unit) -> Any:
    """Return for each position or rotation, shape (n, count), if it is hardly in this unit."""
    lower, upper, _ = UNLIKELY[unit]
    largest = np.abs(rows).max(axis=1, initial=0.0)
    steps = rows / _ROUND_DEG
    is_round = (unit == DEGREES) & (np.abs(steps - steps.round()) < 1e-6).all(axis=1)
    return (lower <= largest) & (largest <= upper) & ~is_round
