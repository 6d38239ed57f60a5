# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Look up poses by the names of SDF and of TF."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

from sdf_pose_bridge.errors import JointPositionError, Place, UnknownFrameError
from sdf_pose_bridge.geometry.poses import canonical_relative_pose, Pose
from sdf_pose_bridge.names import NameIndex
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.tf.joint_motion import NO_DOF
from sdf_pose_bridge.tf.joint_positions import JointPositions
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
    (``robot/arm/tool``), including optical frames. A name that is both is treated as a
    name of SDF.

    :param positions: the current positions of the joints; not copied. None for the positions in
        the file.
    """

    def __init__(
        self, scene: Scene, tree: TfTree, positions: JointPositions | None = None,
    ) -> None:
        self._scene = scene
        self._tree = tree
        self._joints = positions
        self._indices = {frame_id: index for index, frame_id in enumerate(tree.frame_ids)}
        self._frame_ids = dict(zip(tree.elements.tolist(), tree.frame_ids, strict=True))

    def pose(self, frame: str, relative_to: str = '') -> FoundPose:
        """
        Look up the pose of a frame in another one.

        :param frame: a name of SDF or of TF.
        :param relative_to: the reference frame, likewise; empty for the root frame.
        :raises UnknownFrameError: if a name is unknown or ambiguous.
        :raises JointPositionError: if it depends on a joint without a position.
        """
        pose, _, last = self._pose_in_root(frame)
        if not relative_to:
            self._check_positions(last, NO_DOF)
            return FoundPose(pose, self._tree.root_frame)
        reference, frame_id, last_of_reference = self._pose_in_root(relative_to)
        self._check_positions(last, last_of_reference)
        return FoundPose(canonical_relative_pose(reference, pose), frame_id)

    def is_frame_id(self, name: str) -> bool:
        """Return whether a frame of TF other than the root frame has a name."""
        return name in self._indices

    def knows(self, name: str) -> bool:
        """Return whether a frame, an element or the root frame has a name."""
        return name == self._tree.root_frame or name in self._indices or self._scene.has(name)

    def pose_of_element(self, element: int, relative_to: str = '') -> Pose:
        """
        Look up the pose of an element of the scene in a frame.

        :param relative_to: as for :meth:`pose`.
        :raises UnknownFrameError: if the name is unknown or ambiguous.
        :raises JointPositionError: as for :meth:`pose`.
        """
        reference, last_of_reference = Pose(), NO_DOF
        if relative_to:
            reference, _, last_of_reference = self._pose_in_root(relative_to)
        pose, last = self._pose_of(element)
        self._check_positions(last, last_of_reference)
        return canonical_relative_pose(reference, pose)

    def element(self, name: str) -> tuple[int, Pose]:
        """
        Find the element whose pose places a frame.

        :param name: a name of SDF or of TF.
        :return: its index in the scene, and the pose of the frame in it: the identity, except for
            the optical frame of a camera.
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
        """All names, sorted when a name is not found for the first time."""
        return NameIndex([*self._indices, *self._scene.names])

    def _check_positions(self, first: int, second: int) -> None:
        """
        Refuse a pose that depends on a joint without a position.

        :param first: the last degree of freedom between the root and the one frame.
        :param second: likewise for the other one.
        """
        moving, joints = self._tree.moving, self._joints
        if moving is None or joints is None or joints.is_known.all():
            return
        for dof in moving.dofs_between(first, second):
            if not joints.is_known[dof]:
                msg = (f'the pose depends on joint "{joints.names[dof]}", which has not been '
                       'reported yet')
                raise JointPositionError(msg, Place(self._scene.path))

    def _pose_in_root(self, name: str) -> tuple[Pose, str, int]:
        """
        Return the pose of a frame in the root frame.

        :return: the pose, its frame id or else its name, and the last degree of freedom between
            the root and it.
        """
        scene, tree = self._scene, self._tree
        if name == tree.root_frame:
            return Pose(), name, NO_DOF
        if not scene.has(name) and name in self._indices:
            index = self._indices[name]
            if self._joints is not None and tree.moving is not None:
                pose = tree.moving.pose_of_frame(index, self._joints.values)
                return pose, name, tree.moving.last_dof_of_frame(index)
            return Pose(*tree.poses[index].tolist()), name, NO_DOF
        element = self._element(name)
        frame_id = tree.root_frame if element == 0 else self._frame_ids.get(element, name)
        pose, last = self._pose_of(element)
        return pose, frame_id, last

    def _element(self, name: str) -> int:
        """Find an element by its name in SDF."""
        scene = self._scene
        if not scene.elements_called(name):
            msg = f'no frame or element is called "{name}"{self._name_index.hint(name)}'
            raise UnknownFrameError(msg, Place(scene.path))
        element = scene.index(name, world=self._tree.world)
        if scene.roots[element]:
            msg = f'"{name}" is in world "{scene.world_of(element)}", which is not published'
            raise UnknownFrameError(msg, Place(scene.path))
        return element

    def _pose_of(self, element: int) -> tuple[Pose, int]:
        """Return the pose of an element in the root frame, and its last degree of freedom."""
        pose, moving = self._scene.pose_of(element), self._tree.moving
        if element and self._joints is not None and moving is not None:
            moved = moving.pose_of_element(element, pose, self._joints.values)
            return moved, moving.last_dof_of_element(element)
        return pose, NO_DOF
