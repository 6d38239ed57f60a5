# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Look up poses by the names of SDF or of TF, of everything in a scene."""

from __future__ import annotations

from typing import NamedTuple

from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import UnknownFrameError
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.poses import pose_inverse
from sdf_pose_bridge.geometry.poses import pose_product
from sdf_pose_bridge.geometry.rotations import canonical_quaternion
from sdf_pose_bridge.names import hint_from_names
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.tf.tree import TfTree

MOST_KEPT = 1000
"""How many answers are kept; who asks often asks the same."""


class FoundPose(NamedTuple):
    """The answer to a query."""

    pose: Pose
    """Pose of the frame in the one that it is relative to; unit quaternion with w >= 0."""
    frame_id: str
    """The frame that it is relative to, by its TF name where it has one."""


class PoseLookup:
    """
    Answers queries about a scene and the frames that were made of it.

    Names may be absolute names of SDF (``robot::arm::tool``), of every kind of element, or frame
    ids (``robot/arm/tool``), optical frames among them. Where a text is both, SDF's name is meant.

    :param scene: the scene.
    :param tree: its frames.
    """

    def __init__(self, scene: Scene, tree: TfTree) -> None:
        self._scene = scene
        self._tree = tree
        self._rows = {frame_id: row for row, frame_id in enumerate(tree.frame_ids)}
        self._ids = {
            element: frame_id
            for element, frame_id in zip(tree.elements.tolist(), tree.frame_ids, strict=True)
            if element >= 0}
        self._found: dict[tuple[str, str], FoundPose] = {}
        # Made when it is first wanted, which takes too long while somebody waits for an answer.
        scene.has('')

    def pose(self, frame: str, relative_to: str = '') -> FoundPose:
        """
        Find the pose of one frame in another.

        :param frame: a name of SDF or of TF.
        :param relative_to: likewise; empty for the root frame.
        :return: the pose.
        :raises UnknownFrameError: if a name means nothing, or more than one thing.
        """
        question = (frame, relative_to)
        found = self._found.get(question)
        if found is None:
            found = self._find(frame, relative_to)
            if len(self._found) >= MOST_KEPT:
                self._found.clear()
            self._found[question] = found
        return found

    def _find(self, frame: str, relative_to: str) -> FoundPose:
        pose, _ = self._in_root(frame)
        if not relative_to:
            return FoundPose(pose, self._tree.root_frame)
        reference, frame_id = self._in_root(relative_to)
        relative = pose_product(pose_inverse(reference), pose)
        x, y, z = (value + 0.0 for value in relative[:3])
        return FoundPose(Pose(x, y, z, *canonical_quaternion(relative[3:])), frame_id)

    def _in_root(self, name: str) -> tuple[Pose, str]:
        if name == self._tree.root_frame:
            return Pose(), name
        row = self._rows.get(name)
        if row is not None and not self._scene.has(name):
            return Pose(*self._tree.poses[row].tolist()), name
        if row is None and not self._scene.has(name):
            names = [*self._rows, *self._scene.names]
            msg = f'"{name}" is the name of nothing{hint_from_names(name, names)}'
            raise UnknownFrameError(msg, Place(self._scene.path))
        index = self._scene.index(name, world=self._tree.world)
        # The first root of a file is the one that is published.
        if self._scene.roots[index]:
            msg = f'"{name}" is in world "{self._scene.world_of(index)}", which is not published'
            raise UnknownFrameError(msg, Place(self._scene.path))
        if not index:
            return Pose(), self._tree.root_frame
        return self._scene.pose_of(index), self._ids.get(index, name)
