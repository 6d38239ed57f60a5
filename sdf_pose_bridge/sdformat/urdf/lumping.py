# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Lump links into their parents with their masses, as Gazebo does at fixed joints.

Source: ``ReduceInertialToParent`` of libsdformat's ``parser_urdf.cc``.
"""

from __future__ import annotations

from collections.abc import Mapping
import math
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.poses import Pose, pose_product, relative_pose
from sdf_pose_bridge.geometry.rotations import matrix_from_quaternion
from sdf_pose_bridge.names import WORLD_FRAME
from sdf_pose_bridge.sdformat.inertials import (
    matrix_from_moments,
    moments_from_matrix,
    moved_moments,
)
from sdf_pose_bridge.sdformat.urdf.robot import Robot, RobotInertial, RobotJoint, RobotLink
from sdf_pose_bridge.sdformat.urdf.values import pose_from_xyz_rpy, rpy_by_urdfdom


class Base(NamedTuple):
    """The link that another one is lumped into; for other links, the link itself."""

    link: RobotLink
    pose: Pose
    """Pose of the lumped link in it."""
    members: list[RobotLink]
    """The link itself and those that are lumped into it."""


def is_reducible(joint: RobotJoint, robot: Robot) -> bool:
    """Return whether libsdformat removes a joint."""
    return joint.type == 'fixed' and joint.name not in robot.kept_joints


def bases_of_links(robot: Robot) -> dict[str, Base]:
    """Find the link that each link is lumped into."""
    bases: dict[str, Base] = {}
    for link in robot.links:
        joint = robot.parent_joints.get(link.name)
        if joint is None or joint.parent == WORLD_FRAME or not is_reducible(joint, robot):
            base = Base(link, Pose(), [])
        else:
            base = bases[joint.parent]
            base = base._replace(pose=pose_product(base.pose, joint.origin))
        base.members.append(link)
        bases[link.name] = base
    return bases


def lumped_inertials(
    robot: Robot, bases: Mapping[str, Base], *, skips_massless: bool,
) -> dict[str, RobotInertial | None]:
    """
    Add the inertials of lumped links to those of their parents.

    :param skips_massless: whether two inertials without a mass give None instead of NaN.
    """
    inertials = {link.name: link.inertial for link in robot.links}
    for link in reversed(robot.links):
        inertial = inertials[link.name]
        if inertial is None or bases[link.name].link is link:
            continue
        joint = robot.parent_joints[link.name]
        parent = inertials[joint.parent] or RobotInertial()
        place = pose_from_xyz_rpy(joint.origin[:3], rpy_by_urdfdom(joint.origin))
        if parent.mass + inertial.mass or not skips_massless:
            inertials[joint.parent] = lumped_inertial(
                parent, inertial._replace(origin=pose_product(place, inertial.origin)))
    return inertials


def lumped_inertial(parent: RobotInertial, lumped: RobotInertial) -> RobotInertial:
    """
    Add two inertials.

    :param lumped: with its frame in the parent link.
    :return: their sum, with the axes of the first one; its center is NaN if both masses are zero.
    """
    mass = parent.mass + lumped.mass
    x, y, z = (
        (a * parent.mass + b * lumped.mass) / mass if mass else math.nan
        for a, b in zip(parent.origin[:3], lumped.origin[:3], strict=True))
    origin = parent.origin._replace(x=x, y=y, z=z)
    both = parent, lumped
    places = np.array([relative_pose(origin, each.origin) for each in both])
    axes = matrix_from_quaternion(places[:, 3:])
    matrices = np.array([matrix_from_moments(each.moments) for each in both])
    moved = moved_moments(
        axes @ matrices @ axes.transpose(0, 2, 1), np.array([each.mass for each in both]),
        places[:, :3])
    return RobotInertial(mass, origin, moments_from_matrix(moved.sum(axis=0)))
