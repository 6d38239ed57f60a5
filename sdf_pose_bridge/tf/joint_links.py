# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Find the frames at joints for which URDF needs links that SDFormat does not have.

In URDF a joint is where its child link is, and has one axis.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.poses import Pose, relative_pose
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.tf.frame_ids import FrameNames, FrameNaming
from sdf_pose_bridge.tf.joint_motion import JointMotion
from sdf_pose_bridge.tf.joint_positions import SLIDE_SUFFIX

LINK_SUFFIX = '_frame'
"""Appended to the name of a joint for the name of such a link."""

_SAME_PLACE = 1e-12
"""Frames that differ by less, in metres and halves of radians, are the same."""


class JointLink(NamedTuple):
    """A frame at a joint."""

    name: str
    dof: int
    """The degree of freedom that it moves with, an index into ``JointMotion.dofs``."""
    pose: Pose
    """Its pose in the root where the file puts it."""


def is_same_place(pose: Pose) -> bool:
    """Return whether a pose is the identity, except for rounding errors."""
    return math.dist(pose[:6], Pose()[:6]) < _SAME_PLACE


def joint_links_from_motion(
    scene: Scene, motion: JointMotion, frame_names: FrameNames,
) -> list[JointLink]:
    """
    Find the frames between degrees of freedom, and those of joints away from their links.

    The frame between the turning and the sliding of a screw joint is left out.
    """
    joints = np.array([dof.joint.element for dof in motion.dofs], np.int32)
    names = FrameNaming(frame_names).frame_ids_from_scene(scene, joints)
    links = []
    for index, (dof, body) in enumerate(zip(motion.dofs, motion.moved_bodies, strict=True)):
        pose = scene.pose_of(dof.joint.element)
        is_last = motion.last_dofs[body] == index
        if is_last and is_same_place(relative_pose(pose, scene.pose_of(body))):
            continue
        slide = SLIDE_SUFFIX if dof.rad_per_unit and dof.m_per_unit else ''
        links.append(JointLink(
            f'{names[index]}{dof.suffix}{slide}{LINK_SUFFIX}', index, pose))
    return links
