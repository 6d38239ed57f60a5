# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Look up poses by the names of SDF and of TF."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import UnknownFrameError
from sdf_pose_bridge.geometry.poses import canonical_relative_pose
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.names import NameIndex
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.tf.tree import TfTree


class FoundPose(NamedTuple):
    """The result of a lookup."""

    pose: Pose
    """Pose of the frame in the reference frame; unit quaternion with w >= 0."""
    frame_id: str
    """The reference frame, by its TF name if it has one."""


class PoseLookup:
    """
    Looks up poses in a scene and its TF tree.

    Names are absolute names of SDF (``robot::arm::tool``) of any kind of element, or frame ids
    (``robot/arm/tool``), including those of optical frames. A name that is both is taken as a name
    of SDF.

    :param positions: the current position of each degree of freedom of the joints, in radians or
        metres; not copied. None for all joints where the file puts them.
    """

    def __init__(
        self, scene: Scene, tree: TfTree, positions: NDArray[np.float64] | None = None,
    ) -> None:
        self._scene = scene
        self._tree = tree
        self._positions = positions
        self._indices = {frame_id: index for index, frame_id in enumerate(tree.frame_ids)}
        self._frame_ids = dict(zip(tree.elements.tolist(), tree.frame_ids, strict=True))

    def pose(self, frame: str, relative_to: str = '') -> FoundPose:
        """
        Look up the pose of a frame in another one.

        :param frame: a name of SDF or of TF.
        :param relative_to: the reference frame, likewise; empty for the root frame.
        :raises UnknownFrameError: if a name is unknown or ambiguous.
        """
        pose, _ = self._pose_in_root(frame)
        if not relative_to:
            return FoundPose(pose, self._tree.root_frame)
        reference, frame_id = self._pose_in_root(relative_to)
        return FoundPose(canonical_relative_pose(reference, pose), frame_id)

    def pose_of_element(self, element: int, relative_to: str = '') -> Pose:
        """
        Look up the pose of an element of the scene in a frame.

        :param relative_to: as for :meth:`pose`.
        :raises UnknownFrameError: if the name is unknown or ambiguous.
        """
        reference = self._pose_in_root(relative_to)[0] if relative_to else Pose()
        return canonical_relative_pose(reference, self._pose_of(element))

    def element(self, name: str) -> tuple[int, Pose]:
        """
        Find the element whose pose decides where a frame is.

        :param name: a name of SDF or of TF.
        :return: its index in the scene, and the pose of the frame in it: the identity, but for the
            optical frame of a camera.
        :raises UnknownFrameError: if the name is unknown or ambiguous.
        """
        tree = self._tree
        if self._scene.has(name) or name not in self._indices:
            return self._element(name), Pose()
        index = self._indices[name]
        element = int(tree.elements[index])
        if element >= 0:
            return element, Pose()
        camera = int(tree.parents[index])
        if camera < 0 or tree.elements[camera] not in self._scene.sensors:
            msg = f'"{name}" is the optical frame of a camera without a frame of its own'
            raise UnknownFrameError(msg, Place(self._scene.path))
        return int(tree.elements[camera]), canonical_relative_pose(
            *(Pose(*tree.poses[each].tolist()) for each in (camera, index)))

    @cached_property
    def _name_index(self) -> NameIndex:
        """All names, put in order when one was not found for the first time."""
        return NameIndex([*self._indices, *self._scene.names])

    def _pose_in_root(self, name: str) -> tuple[Pose, str]:
        """Return the pose of a frame in the root frame, and its frame id or else its name."""
        scene, tree, positions = self._scene, self._tree, self._positions
        if name == tree.root_frame:
            return Pose(), name
        if not scene.has(name) and name in self._indices:
            index = self._indices[name]
            if positions is not None and tree.moving is not None:
                return tree.moving.pose_of_frame(index, positions), name
            return Pose(*tree.poses[index].tolist()), name
        element = self._element(name)
        frame_id = tree.root_frame if element == 0 else self._frame_ids.get(element, name)
        return self._pose_of(element), frame_id

    def _element(self, name: str) -> int:
        """Find an element by its name in SDF."""
        scene = self._scene
        if not scene.has(name):
            msg = f'"{name}" is the name of nothing{self._name_index.hint(name)}'
            raise UnknownFrameError(msg, Place(scene.path))
        element = scene.index(name, world=self._tree.world)
        if scene.roots[element]:
            msg = f'"{name}" is in world "{scene.world_of(element)}", which is not published'
            raise UnknownFrameError(msg, Place(scene.path))
        return element

    def _pose_of(self, element: int) -> Pose:
        """Return the pose of an element in the root frame."""
        pose = self._scene.pose_of(element)
        if element and self._positions is not None and self._tree.moving is not None:
            return self._tree.moving.pose_of_element(element, pose, self._positions)
        return pose
