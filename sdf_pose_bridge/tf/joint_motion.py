# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Move the elements of a scene by the positions of its joints.

Poses in the root are products of exponentials: each degree of freedom between the root and an
element displaces it by a rotation about, and a translation along, the axis where the file puts it.
Source: Lynch and Park, Modern Robotics, chapter 4. That axis is fixed in the parent of its joint,
or for the second axis of a joint in the body between both axes.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.geometry.chains import ends_from_pointers, Indices, poses_along_chains
from sdf_pose_bridge.geometry.poses import (
    Pose,
    pose_products,
    PoseArray,
    ScrewMotions,
    transformed_points,
)
from sdf_pose_bridge.geometry.rotations import canonical_quaternion, Floats
from sdf_pose_bridge.scene.scene import Joint, Scene
from sdf_pose_bridge.sdformat.joints import JointAxis
from sdf_pose_bridge.sdformat.specification import JOINT_TYPES, Motion
from sdf_pose_bridge.tf.parents import TfParents

NO_DOF = -1
"""Index for no degree of freedom."""

_TURN_RAD = 2.0 * math.pi


class DegreeOfFreedom(NamedTuple):
    """A degree of freedom of a joint."""

    joint: Joint
    number: int | None
    """The axis of the joint, 0 or 1; None for a ball joint."""
    suffix: str
    """Appended to the name of the joint for its name in ``joint_states``."""
    axis: JointAxis
    """The axis with its limits; of a ball joint a fixed direction without limits."""
    rad_per_unit: float
    """Angle about the axis for a position of 1."""
    m_per_unit: float
    """Distance along the axis for a position of 1."""


def dofs_from_joint(joint: Joint) -> list[DegreeOfFreedom]:
    """
    List the degrees of freedom of a joint.

    :return: in order from its parent to its child; none for a fixed joint. A ball joint has yaw,
        pitch and roll of its child in its parent.
    :raises KeyError: if :data:`JOINT_TYPES` does not have the type of the joint.
    """
    rad_and_m_per_unit = {
        Motion.TURN: (1.0, 0.0), Motion.SLIDE: (0.0, 1.0),
        Motion.SCREW: (1.0, joint.screw_pitch_m / _TURN_RAD)}
    return [
        DegreeOfFreedom(joint, axis, suffix, joint.axes[axis], *rad_and_m_per_unit[motion])
        if isinstance(axis, int) else
        DegreeOfFreedom(joint, None, suffix, JointAxis(axis), *rad_and_m_per_unit[motion])
        for motion, axis, suffix in JOINT_TYPES[joint.type].dofs]


class JointMotion:
    """
    The degrees of freedom of a scene, and the elements that they move.

    Joints that close a loop move nothing, and nothing moves a link of a static model.
    """

    def __init__(self, scene: Scene, tf_parents: TfParents) -> None:
        dofs: list[DegreeOfFreedom] = []
        signs: list[float] = []
        ranges: dict[int, range] = {}
        for body, joint in tf_parents.joints.items():
            path = dofs_from_joint(joint)
            if path and scene.static_models.isdisjoint(scene.with_ancestors(body)):
                ranges[body] = range(len(dofs), len(dofs) + len(path))
                is_reversed = body in tf_parents.reversed_bodies
                dofs += reversed(path) if is_reversed else path
                signs += [-1.0 if is_reversed else 1.0] * len(path)
        self.dofs = tuple(dofs)
        """All degrees of freedom; the ones of a joint are adjacent."""
        bodies = list(ranges)
        last_of_bodies = np.full(len(scene.kinds), NO_DOF, np.int32)
        last_of_bodies[bodies] = [each[-1] for each in ranges.values()]
        last_of_elements = last_of_bodies[
            ends_from_pointers(np.where(last_of_bodies != NO_DOF, -1, tf_parents.parents))]
        self.last_dofs: Indices = np.append(
            last_of_elements, np.arange(len(dofs), dtype=np.int32))
        """For each element the last degree of freedom between the root and it; -1 for none. Then
        each degree of freedom itself, for frames between it and the next one."""
        self.moved_bodies = tuple(body for body, each in ranges.items() for _ in each)
        """The body at the end of the joint of each degree of freedom."""
        self.previous: Indices = np.arange(-1, len(dofs) - 1, dtype=np.int32)
        """For each degree of freedom the previous one on the path from the root; -1 for none."""
        self.previous[[each[0] for each in ranges.values()]] = last_of_elements[
            tf_parents.parents[bodies]]
        poses = scene.poses[[each.joint.element for each in dofs]]
        directions = np.reshape([each.axis.xyz for each in dofs], (-1, 3))
        self._points = poses[:, :3]
        self._axes = transformed_points(poses, directions) - self._points
        self._rad_per_unit = np.array([each.rad_per_unit for each in dofs]) * signs
        self._m_per_unit = np.array([each.m_per_unit for each in dofs]) * signs
        identities = np.tile(Pose(), (len(dofs), 1))
        self._displacements = self.screw_motions(
            identities, np.arange(len(dofs)), identities)

    def screw_motions(
        self, before: PoseArray, dofs: NDArray[np.intp], after: PoseArray,
    ) -> ScrewMotions:
        """
        Prepare products of a pose, the displacement by a degree of freedom, and a pose.

        :param before: shape (n, 7), poses of the root in frames.
        :param dofs: shape (n,), indices of degrees of freedom.
        :param after: shape (n, 7), poses of frames in the root.
        :return: the products, which take the positions of these degrees of freedom.
        """
        return ScrewMotions(
            before, self._axes[dofs], self._points[dofs], self._rad_per_unit[dofs],
            self._m_per_unit[dofs], after)

    def moved_poses(self, poses: PoseArray, elements: Indices, positions: Floats) -> PoseArray:
        """
        Return poses at given positions of the joints.

        :param poses: shape (k, 7), poses in the root where the file puts them.
        :param elements: shape (k,), the element that each moves with.
        :param positions: shape (n,), the position of each degree of freedom, in radians or metres.
        :return: shape (k, 7), poses in the root; unit quaternions with w >= 0.
        """
        last = self.last_dofs[elements]
        rows = np.flatnonzero(last != NO_DOF)
        moved: PoseArray = poses.copy()
        if len(rows):
            # The root comes last, at the index -1.
            edges = np.concatenate([self._displacements.poses(positions), [Pose()]])
            ends = np.append(self.previous % len(edges), NO_DOF)
            displacements = poses_along_chains(edges, ends, np.arange(len(edges)))
            moved[rows] = pose_products(displacements[last[rows]], poses[rows])
            moved[rows, 3:] = canonical_quaternion(moved[rows, 3:])
        return moved
