# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Sums of masses, centers and moments of inertia."""

import math

import numpy as np
import pytest

from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.rotations import quaternion_from_rpy
from sdf_pose_bridge.sdformat.urdf.lumping import lumped_inertial
from sdf_pose_bridge.sdformat.urdf.robot import RobotInertial

HERE = Pose()
TURNED = quaternion_from_rpy((0.0, 0.0, math.pi / 2.0))


def box(x, y, z, origin=HERE):
    """Return the inertial of a box of 12 kg per cubic metre."""
    moments = (y * y + z * z, x * x + z * z, x * x + y * y)
    mass = x * y * z
    return RobotInertial(
        12.0 * mass, origin, (*(mass * moment for moment in moments), 0.0, 0.0, 0.0))


def test_center_of_nothing_is_not_a_number():
    total = lumped_inertial(RobotInertial(), RobotInertial(origin=Pose(1.0)))
    assert total.mass == 0.0
    assert np.isnan(total.origin[:3]).all()


def test_sum_has_the_axes_of_the_parent():
    total = lumped_inertial(
        box(1, 2, 3, Pose(0.0, 0.0, 0.0, *TURNED)), box(2, 1, 3, Pose(-2.0)))
    assert (total.mass, *total.origin) == pytest.approx((144.0, -1.0, 0.0, 0.0, *TURNED))
    assert total.moments == pytest.approx(box(1, 4, 3).moments)


def test_moments_of_a_turned_link_are_turned_into_the_axes_of_the_parent():
    turned = box(1, 2, 3, Pose(0.0, 0.0, 0.0, *quaternion_from_rpy((0.0, 0.0, 0.5))))
    xx, yy, *_ = turned.moments
    moments = lumped_inertial(RobotInertial(), turned).moments
    assert moments[3] == pytest.approx((xx - yy) * math.sin(0.5) * math.cos(0.5))


def test_link_without_a_mass_changes_nothing():
    assert lumped_inertial(RobotInertial(), box(1, 2, 3, Pose(1.0))).moments == pytest.approx(
        box(1, 2, 3).moments)
