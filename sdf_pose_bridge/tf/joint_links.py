# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Find the frames at joints for which URDF needs links that SDFormat does not have.

In URDF a joint is where its child link is, and has one axis.
"""

from __future__ import annotations

import math

from sdf_pose_bridge.geometry.poses import Pose, relative_pose
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.tf.frames import Frame, Frames
from sdf_pose_bridge.tf.joint_motion import JointMotion
from sdf_pose_bridge.tf.joint_positions import SLIDE_SUFFIX
from sdf_pose_bridge.tf.parents import NO_PARENT, TfParents

LINK_SUFFIX = '_frame'
"""Appended to the name of a joint for the name of such a link."""

_SAME_PLACE = 1e-12
"""Frames that differ by less, in metres and halves of radians, are the same."""


def is_same_place(pose: Pose) -> bool:
    """Return whether a pose is the identity, except for rounding errors."""
    return math.dist(pose[:6], Pose()[:6]) < _SAME_PLACE


def frames_at_joints(
    frames: Frames, scene: Scene, motion: JointMotion, tf_parents: TfParents, prefix: str,
    root_frame: str,
) -> list[Frame]:
    """
    Make the frames between degrees of freedom, and those of joints away from their links.

    The frame between the turning and the sliding of a screw joint is left out, and so are those of
    joints to links that are not published, which are not in the URDF.

    :param frames: all other frames, which keep their ids.
    :param prefix: precedes the names of joints in frame ids.
    """
    rows = {owner: row for row, owner in enumerate(frames.owners.tolist())}
    used = {root_frame, *frames.ids}
    found = []
    for index, (dof, body) in enumerate(
            zip(motion.dofs, motion.moved_bodies.tolist(), strict=True)):
        pose = scene.pose_of(dof.joint.element)
        is_last = motion.last_dofs[body] == index
        if is_last and is_same_place(relative_pose(pose, scene.pose_of(body))):
            continue
        parent_body = tf_parents.parents.item(body)
        is_published = body in rows and (
            parent_body in rows or scene.parents[parent_body] < 0)
        parent = frames.parents.item(rows[body]) if is_published else NO_PARENT
        slide = SLIDE_SUFFIX if dof.is_screw else ''
        frame_id = f'{prefix}{dof.name}{slide}{LINK_SUFFIX}'
        if parent != NO_PARENT and frame_id not in used:
            used.add(frame_id)
            found.append(Frame(frame_id, len(scene.kinds) + index, parent, pose))
    return found
