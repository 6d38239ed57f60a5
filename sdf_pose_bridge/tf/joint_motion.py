# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Move the elements of a scene, and its frames in TF, by positions of joints and poses of models.

Poses in the root are products of exponentials: each degree of freedom between the root and an
element displaces it by a rotation about, and a translation along, the axis where the file puts it.
Source: Lynch and Park, Modern Robotics, chapter 4. That axis is fixed in the parent of its joint,
or for the second axis of a joint in the body between both axes. A free model is displaced from its
pose in the file to another pose; it counts as one degree of freedom, after those of all joints.

Coordinates are the positions of the joints' degrees of freedom, in radians or metres, and then the
seven numbers of the pose of each free model in the root: x y z in metres, quaternion x y z w.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.geometry.chains import ends_from_pointers, Indices, poses_along_chains
from sdf_pose_bridge.geometry.poses import (
    canonical_poses,
    canonical_relative_poses,
    Pose,
    pose_products,
    PoseArray,
    relative_poses,
    ScrewMotions,
    transformed_points,
)
from sdf_pose_bridge.geometry.rotations import Floats
from sdf_pose_bridge.scene.scene import Joint, Scene
from sdf_pose_bridge.sdformat.joints import JointAxis
from sdf_pose_bridge.sdformat.specification import JOINT_TYPES, Motion
from sdf_pose_bridge.tf.frame_ids import FrameNames, FrameNaming
from sdf_pose_bridge.tf.parents import NO_PARENT, TfParents

NO_DOF = -1
"""Index for no degree of freedom."""

_TURN_RAD = 2.0 * math.pi


class DegreeOfFreedom(NamedTuple):
    """A degree of freedom of a joint."""

    joint: Joint
    number: int | None
    """The axis of the joint, 0 or 1; None for a ball joint."""
    name: str
    """Its name in ``joint_states``."""
    suffix: str
    """The end of this name, after the name of the joint."""
    axis: JointAxis
    """The axis with its limits; of a ball joint a fixed direction without limits."""
    rad_per_unit: float
    """Angle about the axis for a position of 1."""
    m_per_unit: float
    """Distance along the axis for a position of 1."""

    @property
    def is_screw(self) -> bool:
        """Whether it both turns and slides."""
        return bool(self.rad_per_unit and self.m_per_unit)


def dofs_from_joint(joint: Joint, name: str = '') -> list[DegreeOfFreedom]:
    """
    List the degrees of freedom of a joint.

    :param name: the name of the joint in ``joint_states``.
    :return: in order from its parent to its child; none for a fixed joint. A ball joint has yaw,
        pitch and roll of its child in its parent.
    :raises KeyError: if :data:`JOINT_TYPES` does not have the type of the joint.
    """
    rad_and_m_per_unit = {
        Motion.TURN: (1.0, 0.0), Motion.SLIDE: (0.0, 1.0),
        Motion.SCREW: (1.0, joint.screw_pitch_m / _TURN_RAD)}
    return [
        DegreeOfFreedom(
            joint, axis if isinstance(axis, int) else None, name + suffix, suffix,
            joint.axes[axis] if isinstance(axis, int) else JointAxis(axis),
            *rad_and_m_per_unit[motion])
        for motion, axis, suffix in JOINT_TYPES[joint.type]]


class DisplacedPoses(NamedTuple):
    """Products of a constant pose, a displacement by a degree of freedom, and a constant pose."""

    dofs: Indices
    """Shape (k,), the degrees of freedom."""
    screws: ScrewMotions
    """The screw motions of joints; rows of free models are not used."""
    free_rows: NDArray[np.intp]
    """Shape (m,), the rows of free models. The constant pose before is the identity there, since
    only the root is before them."""
    coordinates: NDArray[np.intp]
    """Shape (m, 7), the coordinates of these."""
    in_models: PoseArray
    """Shape (m, 7), the constant pose after, in the model where the file puts it."""

    def poses(self, values: Floats) -> PoseArray:
        """Return the products at coordinates; shapes (n,) and (k, 7)."""
        poses = self.screws.poses(values[self.dofs])
        if len(self.free_rows):
            poses[self.free_rows] = pose_products(values[self.coordinates], self.in_models)
        return poses


class JointMotion:
    """
    The degrees of freedom of a scene, and the elements that they move.

    Joints that close a loop move nothing, and nothing moves a link of a static model.

    :param frame_names: the part of a scoped name that the name of a joint contains.
    :param others: names of further free bodies, which are not in the scene and have no parts.
    """

    def __init__(
        self, scene: Scene, tf_parents: TfParents, frame_names: FrameNames = FrameNames.AUTO,
        others: Sequence[str] = (),
    ) -> None:
        joints = np.array([joint.element for joint in tf_parents.joints.values()], np.int32)
        names = FrameNaming(frame_names).frame_ids_from_scene(scene, joints)
        dofs: list[DegreeOfFreedom] = []
        bodies: list[int] = []
        for (body, joint), name in zip(tf_parents.joints.items(), names, strict=True):
            if not scene.is_static(body):
                path = dofs_from_joint(joint, name)
                is_reversed = scene.bodies[joint.parent] == body
                dofs += map(_reversed, reversed(path)) if is_reversed else path
                bodies += [body] * len(path)
        self.joint_names = dict(zip(joints.tolist(), names, strict=True))
        """The name of each joint, also of a fixed one, by its element."""
        self.dofs = tuple(dofs)
        """The degrees of freedom of joints; those of one joint are adjacent, in order from the
        root. The axis is reversed if the moved body is the parent of the joint."""
        self.moved_bodies = tuple(bodies)
        """The body at the end of the joint of each of these."""
        models = list(tf_parents.free_models.values())
        names = FrameNaming(frame_names).frame_ids_from_scene(scene, np.array(models, np.int32))
        self.names = (*(each.name for each in dofs), *names, *others)
        """The name of each degree of freedom in messages: those of joints, then the models that
        move freely in the root, then other bodies."""
        self.elements = (*(each.joint.element for each in dofs), *models)
        """The joint or the model of each, except for other bodies."""
        bodies += tf_parents.free_models
        indices = np.arange(len(bodies), dtype=np.int32)
        last_of_elements = np.full(len(scene.kinds), NO_DOF, np.int32)
        # The last degree of freedom of a joint replaces the others.
        last_of_elements[bodies] = indices
        last_of_elements = last_of_elements[
            ends_from_pointers(np.where(last_of_elements != NO_DOF, -1, tf_parents.parents))]
        self.last_dofs: Indices = np.append(
            last_of_elements, np.arange(len(self.names), dtype=np.int32))
        """For each element the last degree of freedom between the root and it; -1 for none. Then
        each degree of freedom itself, for frames between it and the next one."""
        self.previous: Indices = np.append(np.where(
            np.diff(bodies, prepend=-1), last_of_elements[tf_parents.parents[bodies]],
            indices - 1), np.full(len(others), NO_DOF, np.int32))
        """For each degree of freedom the previous one on the path from the root; -1 for none."""
        poses = np.concatenate([
            scene.poses[list(self.elements)], np.tile(Pose(), (len(others), 1))])
        values = np.zeros((len(poses), 5))
        values[:len(dofs)] = np.reshape(
            [(*each.axis.xyz, each.rad_per_unit, each.m_per_unit) for each in dofs], (-1, 5))
        axes = transformed_points(poses, values[:, :3]) - poses[:, :3]
        self._poses = poses
        self._screws = axes, poses[:, :3], values[:, 3], values[:, 4]
        self.initial_coordinates = np.append(np.zeros(len(dofs)), poses[len(dofs):])
        """The coordinates where the file puts everything."""
        identities = np.tile(Pose(), (len(poses), 1))
        self._displacements = self.displaced_poses(
            identities, np.arange(len(poses), dtype=np.int32), identities)

    def coordinates(self, dofs: NDArray[np.integer]) -> NDArray[np.intp]:
        """Return the indices of the coordinates of free models, shape (k, 7)."""
        count = len(self.dofs)
        found: NDArray[np.intp] = (count + 7 * (dofs - count))[:, np.newaxis] + np.arange(7)
        return found

    def displaced_poses(
        self, before: PoseArray, dofs: Indices, after: PoseArray,
    ) -> DisplacedPoses:
        """
        Return poses that degrees of freedom displace.

        :param before: shape (k, 7), the constant poses before them.
        :param dofs: shape (k,), the degrees of freedom.
        :param after: shape (k, 7), the constant poses after them, where the file puts everything.
        """
        axes, points, rad_per_unit, m_per_unit = (each[dofs] for each in self._screws)
        free = np.flatnonzero(dofs >= len(self.dofs))
        return DisplacedPoses(
            dofs, ScrewMotions(before, axes, points, rad_per_unit, m_per_unit, after), free,
            self.coordinates(dofs[free]), relative_poses(self._poses[dofs[free]], after[free]))

    def moved_poses(self, poses: PoseArray, elements: Indices, values: Floats) -> PoseArray:
        """
        Return poses at given coordinates.

        :param poses: shape (k, 7), poses in the root where the file puts them.
        :param elements: shape (k,), the element that each moves with.
        :param values: shape (n,), the coordinates.
        :return: shape (k, 7), poses in the root; unit quaternions with w >= 0.
        """
        # The root comes last, at the index -1.
        edges = np.concatenate([self._displacements.poses(values), [Pose()]])
        ends = np.append(self.previous % len(edges), NO_DOF)
        displacements = poses_along_chains(edges, ends, np.arange(len(edges)))
        return canonical_poses(pose_products(displacements[self.last_dofs[elements]], poses))

    def last_chosen(self, is_chosen: NDArray[np.bool_]) -> Indices:
        """
        Find the last of some chosen degrees of freedom on the path from the root to each one.

        It is the same for two ends of paths if no chosen one moves one end in the other.

        :param is_chosen: whether each degree of freedom is chosen.
        :return: shape (n + 1,), the last chosen one up to each, itself included; -1 for none. The
            last entry is for the root.
        """
        ends = ends_from_pointers(np.where(is_chosen, NO_DOF, self.previous))
        return np.append(np.where(is_chosen[ends], ends, NO_DOF), NO_DOF)


class MovingFrames:
    """
    The frames whose transforms depend on the positions of joints or the poses of free models.

    The path from the parent of a frame to the frame crosses degrees of freedom: most often one,
    more for joints with several, or if frames between both are not published. Methods take
    coordinates, shape (n,).

    :param poses: shape (n, 7): pose of each frame in the root.
    :param parents: index of the parent of each frame, or :data:`ROOT_IS_PARENT`, or
        :data:`NO_PARENT`.
    :param elements: the element that each frame moves with.
    :param pose_frame: index of the pose frame, which :meth:`poses` are in; -1 for the root frame.
    """

    def __init__(
        self, motion: JointMotion, poses: PoseArray, parents: Indices, elements: Indices,
        pose_frame: int = -1,
    ) -> None:
        self.motion = motion
        self.elements = elements
        """The element that each frame, also one that does not move, moves with."""
        last = motion.last_dofs[elements]
        # The last two entries are for ROOT_IS_PARENT and NO_PARENT, which are negative.
        last_of_parents = np.append(last, [NO_DOF, NO_DOF])[parents]
        self.indices = np.flatnonzero((last != last_of_parents) & (parents != NO_PARENT))
        """Shape (m,), the frames that move in their parents."""
        self.last_dofs = last[self.indices]
        """The last degree of freedom between the root and each of :attr:`indices`."""
        self.last_dof_of_pose_frame = NO_DOF if pose_frame < 0 else int(last[pose_frame])
        self.posed_indices = np.flatnonzero(last != self.last_dof_of_pose_frame)
        """The moving frames, in the pose frame."""
        self.posed_last_dofs = last[self.posed_indices]
        """The last degree of freedom before each of :attr:`posed_indices`; -1 for none."""
        self._poses, self._pose_frame = poses, pose_frame
        self._last_dofs_of_parents = last_of_parents[self.indices]
        identities = np.tile(Pose(), (len(self.indices), 1))
        # The last pose is for ROOT_IS_PARENT.
        before = relative_poses(
            np.concatenate([poses, [Pose()]])[parents[self.indices]], identities)
        after = poses[self.indices]
        # The first part has the last degree of freedom before each frame, the second the one
        # before that, for frames that cross two, ...
        self._parts = []
        rows, dofs = np.arange(len(self.indices)), self.last_dofs
        while len(rows):
            previous = motion.previous[dofs]
            is_first = previous == self._last_dofs_of_parents[rows]
            self._parts.append((rows, motion.displaced_poses(
                np.where(is_first[:, np.newaxis], before[rows], identities[rows]), dofs,
                after[rows])))
            rows, dofs, after = rows[~is_first], previous[~is_first], identities

    def transforms(self, values: Floats) -> PoseArray:
        """Return the poses of the moving frames in their parents, shape (m, 7), canonical."""
        transforms = np.empty((0, 7))
        for number, (rows, displaced) in enumerate(self._parts):
            poses = displaced.poses(values)
            if number:
                transforms[rows] = pose_products(poses, transforms[rows])
            else:
                transforms = poses
        # They are unit quaternions already. Only the sign has to be made canonical.
        quaternions = transforms[:, 3:]
        quaternions *= np.copysign(1.0, quaternions[:, 3:])
        return transforms

    def poses(self, values: Floats) -> PoseArray:
        """
        Return the poses of the moving frames in the pose frame.

        :return: shape (k, 7), pose of each of :attr:`posed_indices` in that frame; unit
            quaternions with w >= 0.
        """
        poses = self.poses_in_root(self.posed_indices, values)
        if self._pose_frame < 0:
            return poses
        return canonical_relative_poses(
            self.poses_in_root(np.array([self._pose_frame]), values)[0], poses)

    def poses_in_root(self, frames: NDArray[np.intp], values: Floats) -> PoseArray:
        """Return the poses of some frames in the root, shape (k, 7)."""
        return self.motion.moved_poses(self._poses[frames], self.elements[frames], values)

    def depends_on(self, is_chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return which of :meth:`transforms` depend on chosen degrees of freedom, shape (m,)."""
        last = self.motion.last_chosen(is_chosen)
        found: NDArray[np.bool_] = last[self.last_dofs] != last[self._last_dofs_of_parents]
        return found

    def has_pose(self, is_known: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return which of :meth:`poses` follow from the known positions, shape (k,)."""
        last = self.motion.last_chosen(~is_known)
        found: NDArray[np.bool_] = (
            last[self.posed_last_dofs] == last[self.last_dof_of_pose_frame])
        return found


def _reversed(dof: DegreeOfFreedom) -> DegreeOfFreedom:
    x, y, z = dof.axis.xyz
    return dof._replace(axis=dof.axis._replace(xyz=(-x, -y, -z)))
