# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The numbers of a pose as people read and type them: texts in units, rounded."""

from __future__ import annotations

import math
from typing import NamedTuple

from sdf_pose_bridge.geometry.formats import PoseFormatError
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.rotations import rpy_from_quaternion
from sdf_pose_bridge.names import shortened

TEXT_FORMATS = {
    'urdf_origin': ('sdf_rpy', '<origin xyz="{} {} {}" rpy="{} {} {}"/>'),
    'sdf_pose': ('sdf_rpy', '<pose>{} {} {} {} {} {}</pose>'),
    'static_transform_publisher': (
        'sdf_quat_xyzw', '--x {} --y {} --z {} --qx {} --qy {} --qz {} --qw {}'),
}
"""Texts for other programs: the format of their numbers, and the places of these."""


class Unit(NamedTuple):
    """A unit of lengths or angles, with the number of digits to show."""

    name: str
    factor: float
    """Number of these units in a metre or a radian."""
    digits: int


METRES, MILLIMETRES = Unit('m', 1.0, 4), Unit('mm', 1000.0, 1)
RADIANS, DEGREES = Unit('rad', 1.0, 4), Unit('deg', math.degrees(1.0), 2)

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

    def texts(self, pose: Pose, *, fewer_digits: int = 0) -> list[str]:
        """
        Write a pose in these units.

        :param fewer_digits: the number of digits to leave out.
        :return: x, y, z, roll, pitch and yaw, rounded.
        """
        texts = []
        values = (*pose[:3], *rpy_from_quaternion(pose[3:]))
        for value, unit in zip(values, self.of_pose, strict=True):
            digits = unit.digits - fewer_digits
            # Adding zero removes negative zeros.
            texts.append(f'{round(value * unit.factor, digits) + 0.0:.{digits}f}')
        return texts


def number_from_text(text: str) -> float:
    """Read a number; raise a PoseFormatError for another text."""
    try:
        if '_' in text or not text.isascii():
            # float() accepts 1_000 and digits of all scripts; other readers of poses do not.
            raise ValueError
        return float(text)
    except ValueError:
        msg = f'{shortened(text)!r} is not a number'
        raise PoseFormatError(msg) from None
