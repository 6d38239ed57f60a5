# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The frames of TF that joints move, and their transforms at given positions of the joints."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.geometry.chains import ends_from_pointers, Indices
from sdf_pose_bridge.geometry.poses import (
    canonical_relative_poses,
    Pose,
    pose_products,
    PoseArray,
    relative_poses,
)
from sdf_pose_bridge.tf.joint_motion import JointMotion, NO_DOF
from sdf_pose_bridge.tf.parents import NO_PARENT


class MovingFrames:
    """
    The frames whose transforms depend on the positions of joints.

    The path from the parent of a frame to the frame crosses degrees of freedom: most often one,
    more for joints with several, or if frames between both are not published. Methods take the
    position of each degree of freedom, shape (n,), in radians or metres.

    :param poses: shape (n, 7): pose of each frame in the root.
    :param parents: index of the parent of each frame, or :data:`ROOT_IS_PARENT`, or
        :data:`NO_PARENT`.
    :param elements: the element that each frame moves with.
    :param pose_frame: index of the frame that :meth:`poses` are given in; -1 for the root frame.
    """

    def __init__(
        self, motion: JointMotion, poses: PoseArray, parents: Indices, elements: Indices,
        pose_frame: int = -1,
    ) -> None:
        self._motion = motion
        self.dofs = motion.dofs
        """The degrees of freedom, in the order of positions."""
        last = motion.last_dofs[elements]
        # The last two entries are for ROOT_IS_PARENT and NO_PARENT, which are negative.
        last_of_parents = np.append(last, [NO_DOF, NO_DOF])[parents]
        self.indices = np.flatnonzero((last != last_of_parents) & (parents != NO_PARENT))
        """Shape (m,), the frames that move in their parents."""
        self.posed_indices = np.flatnonzero(
            last != (NO_DOF if pose_frame < 0 else last[pose_frame]))
        """The frames that move in the frame that poses are given in."""
        self.last_dofs = last[self.indices]
        """The last degree of freedom between the root and each of :attr:`indices`."""
        self.posed_last_dofs = last[self.posed_indices]
        """The same for each of :attr:`posed_indices`; -1 for none."""
        self.last_dof_of_pose_frame = NO_DOF if pose_frame < 0 else int(last[pose_frame])
        self._pose_frame = pose_frame
        self._poses, self._elements = poses, elements
        crossed = [
            _dofs_from_last(motion.previous, *ends)[::-1] for ends in zip(
                last[self.indices].tolist(), last_of_parents[self.indices].tolist(), strict=True)]
        identities = np.tile(Pose(), (len(self.indices), 1))
        parents = parents[self.indices]
        # The last pose is for ROOT_IS_PARENT.
        before = relative_poses(np.concatenate([poses, [Pose()]])[parents], identities)
        after = poses[self.indices]
        # The first part has all frames, the second those that cross two degrees of freedom, ...
        self._parts = []
        for number in range(max(map(len, crossed), default=0)):
            rows = np.flatnonzero([len(dofs) > number for dofs in crossed])
            dofs = np.array([crossed[row][number] for row in rows])
            is_last = np.array([[len(crossed[row]) == number + 1] for row in rows])
            self._parts.append((rows, dofs, motion.screw_motions(
                identities[rows] if number else before,
                dofs, np.where(is_last, after[rows], identities[rows]))))

    def transforms(self, positions: NDArray[np.float64]) -> PoseArray:
        """
        Return the transforms of the frames that move in their parents.

        :return: shape (m, 7), pose of each frame in its parent; unit quaternions with w >= 0.
        """
        transforms = np.empty((0, 7))
        for number, (rows, dofs, motions) in enumerate(self._parts):
            poses = motions.poses(positions[dofs])
            if number:
                transforms[rows] = pose_products(transforms[rows], poses)
            else:
                transforms = poses
        # They are unit quaternions already. Only the sign has to be made canonical.
        quaternions = transforms[:, 3:]
        quaternions *= np.copysign(1.0, quaternions[:, 3:])
        return transforms

    def poses(self, positions: NDArray[np.float64]) -> PoseArray:
        """
        Return the poses of the frames that move in the frame that poses are given in.

        :return: shape (k, 7), pose of each of :attr:`posed_indices` in that frame; unit
            quaternions with w >= 0.
        """
        poses = self._motion.moved_poses(
            self._poses[self.posed_indices], self._elements[self.posed_indices], positions)
        if self._pose_frame < 0:
            return poses
        reference = self.pose_of_frame(self._pose_frame, positions)
        return canonical_relative_poses(np.array(reference), poses)

    def depends_on(self, is_chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """
        Return which of :meth:`transforms` depend on some degrees of freedom.

        :param is_chosen: whether each degree of freedom is one of these.
        :return: shape (m,).
        """
        found = np.zeros(len(self.indices), np.bool_)
        for rows, dofs, _ in self._parts:
            found[rows] |= is_chosen[dofs]
        return found

    def has_pose(self, is_known: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """
        Return which of :meth:`poses` follow from known positions.

        :param is_known: whether the position of each degree of freedom is known.
        :return: shape (k,).
        """
        # The root comes last, at the index -1.
        previous = np.append(self._motion.previous, NO_DOF)
        is_unknown = np.append(~is_known, False)
        common = _dofs_from_last(self._motion.previous, self.last_dof_of_pose_frame)
        needed = [dof for dof in common if is_unknown[dof]][:1]
        is_common = np.isin(np.arange(len(previous)), common)
        # Those between the root and the reference count only for frames that are not behind them.
        is_barrier = is_unknown & ~is_common
        last = self._motion.last_dofs[self._elements[self.posed_indices]]
        found = ~is_barrier[ends_from_pointers(np.where(is_barrier, -1, previous))[last]]
        if needed:
            is_needed = np.isin(np.arange(len(previous)), needed)
            found &= is_needed[ends_from_pointers(np.where(is_needed, -1, previous))[last]]
        return found

    def last_dof_of_frame(self, index: int) -> int:
        """Return the last degree of freedom between the root and a frame; -1 for none."""
        return self.last_dof_of_element(int(self._elements[index]))

    def last_dof_of_element(self, element: int) -> int:
        """Return the last degree of freedom between the root and an element; -1 for none."""
        return int(self._motion.last_dofs[element])

    def dofs_between(self, first: int, second: int) -> list[int]:
        """
        Return the degrees of freedom that decide the pose of one frame in another.

        :param first: the last degree of freedom between the root and the one; -1 for none.
        :param second: likewise for the other one.
        """
        ways = [_dofs_from_last(self._motion.previous, last) for last in (first, second)]
        common = set(ways[0]).intersection(ways[1])
        return [dof for dof in (*ways[0], *ways[1]) if dof not in common]

    def pose_of_frame(self, index: int, positions: NDArray[np.float64]) -> Pose:
        """Return the pose of one frame in the root."""
        pose = Pose(*self._poses[index].tolist())
        return self.pose_of_element(int(self._elements[index]), pose, positions)

    def pose_of_element(self, element: int, pose: Pose, positions: NDArray[np.float64]) -> Pose:
        """
        Return the pose of an element, which need not have a frame, in the root.

        :param pose: its pose in the root where the file puts it.
        """
        (moved,) = self._motion.moved_poses(
            np.array([pose]), np.array([element], np.int32), positions)
        return Pose(*moved.tolist())


def _dofs_from_last(previous: Indices, last: int, end: int = NO_DOF) -> list[int]:
    """Return a degree of freedom and those before it, back to another one that is left out."""
    found = []
    while last != end:
        found.append(last)
        last = int(previous[last])
    return found
