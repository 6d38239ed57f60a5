# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The frames of TF while their tree is made."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.chains import Indices
from sdf_pose_bridge.geometry.poses import canonical_relative_poses, Pose, PoseArray
from sdf_pose_bridge.tf.parents import NO_PARENT


class Frame(NamedTuple):
    """A frame that is added to the frames of the elements."""

    frame_id: str
    owner: int
    """As in :class:`Frames`."""
    parent: int
    """As in :class:`Frames`."""
    pose: Pose
    """Pose in the root frame."""


class Frames(NamedTuple):
    """The frames to publish; entry i of each sequence and array is about frame i."""

    ids: Sequence[str]
    owners: Indices
    """The element that each frame moves with: its own, or the camera of an optical frame; for a
    frame at a joint as in ``JointMotion.last_dofs``."""
    parents: Indices
    """Index of the parent of each frame, or :data:`ROOT_IS_PARENT`, or :data:`NO_PARENT`."""
    poses: PoseArray
    """Shape (n, 7): pose of each frame in the root frame."""

    def with_frames(self, frames: Sequence[Frame]) -> Frames:
        """Return these frames, and others after them."""
        if not frames:
            return self
        ids, owners, parents, poses = zip(*frames, strict=True)
        return Frames(
            [*self.ids, *ids], np.append(self.owners, np.array(owners, np.int32)),
            np.append(self.parents, np.array(parents, np.int32)),
            np.concatenate([self.poses, poses]))

    def transforms(self) -> PoseArray:
        """Return the pose of each frame in its parent; the identity if it has none."""
        # The last two poses are for ROOT_IS_PARENT and NO_PARENT, which are negative.
        transforms = canonical_relative_poses(
            np.concatenate([self.poses, [Pose(), Pose()]])[self.parents], self.poses)
        transforms[self.parents == NO_PARENT] = Pose()
        return transforms
