# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Add the mass of the child link of a fixed joint to the mass of the parent link.

Source: ``ReduceInertialToParent`` of libsdformat's ``parser_urdf.cc``.
"""

from __future__ import annotations

import math

import numpy as np

from sdf_pose_bridge.geometry.poses import relative_pose
from sdf_pose_bridge.geometry.rotations import matrix_from_quaternion
from sdf_pose_bridge.sdformat.inertials import (
    matrix_from_moments,
    moments_from_matrix,
    moved_moments,
)
from sdf_pose_bridge.sdformat.urdf.robot import Inertial


def lumped_inertial(parent: Inertial, lumped: Inertial) -> Inertial:
    """
    Add two inertials.

    :param lumped: with its frame in the parent link.
    :return: their sum, with the axes of the first one; its center is NaN if both masses are zero.
    """
    mass = parent.mass + lumped.mass
    if not mass:
        nowhere = parent.origin._replace(x=math.nan, y=math.nan, z=math.nan)
        return Inertial(mass, nowhere, parent.moments)
    x, y, z = (
        (a * parent.mass + b * lumped.mass) / mass
        for a, b in zip(parent.origin[:3], lumped.origin[:3], strict=True))
    origin = parent.origin._replace(x=x, y=y, z=z)
    places = [relative_pose(origin, parent.origin), relative_pose(origin, lumped.origin)]
    axes = np.array([matrix_from_quaternion(place[3:]) for place in places])
    matrices = np.array([matrix_from_moments(each.moments) for each in (parent, lumped)])
    moved = moved_moments(
        axes @ matrices @ axes.transpose(0, 2, 1), np.array([parent.mass, lumped.mass]),
        np.array([place[:3] for place in places]))
    return Inertial(mass, origin, moments_from_matrix(moved.sum(axis=0)))
