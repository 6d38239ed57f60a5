# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Look up poses by the names of SDF and of TF."""

from __future__ import annotations

from collections.abc import Mapping
import contextlib
from functools import cached_property
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.errors import JointPositionError, Place, SdfError, UnknownFrameError
from sdf_pose_bridge.geometry.poses import canonical_relative_pose, Pose
from sdf_pose_bridge.nearest_names import NameIndex
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.tf.joint_motion import NO_DOF
from sdf_pose_bridge.tf.joint_positions import JointPositions, scene_at_positions
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions, TfTree


class FoundPose(NamedTuple):
    """The result of a lookup."""

    pose: Pose
    """Pose of the frame in the reference frame; unit quaternion with w >= 0."""
    frame_id: str
    """The reference frame, by its TF name if it has one."""


class _Found(NamedTuple):
    """A frame or an element that was found by a name."""

    owner: int
    """The element that it moves with, if joints move anything."""
    pose: Pose
    """Pose in the root frame where the file puts it."""
    frame_id: str
    """Its TF name, or else the name."""


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
        # Of two frames of a sensor, the first one counts.
        self._frame_ids = dict(zip(
            tree.elements[::-1].tolist(), tree.frame_ids[::-1], strict=True))

    def pose(self, frame: str, relative_to: str = '') -> FoundPose:
        """
        Look up the pose of a frame in another one.

        :param frame: a name of SDF or of TF.
        :param relative_to: the reference frame, likewise; empty for the root frame.
        :raises UnknownFrameError: if a name is unknown or ambiguous.
        :raises JointPositionError: if it depends on a joint or a model without a reported one.
        """
        found = self._found(frame)
        reference = self._found(relative_to or self._tree.root_frame)
        return FoundPose(self._relative_pose(reference, found), reference.frame_id)

    def first_dof(self, frame: str) -> int:
        """
        Find the first degree of freedom on the path from the root to a frame.

        :return: its index, which is that of a free model if the frame moves with one; -1 for none,
            and if the name is unknown or ambiguous.
        """
        first = NO_DOF
        with contextlib.suppress(UnknownFrameError):
            if self._tree.moving is not None:
                motion = self._tree.moving.motion
                dof = motion.last_dofs.item(self._found(frame).owner)
                while dof != NO_DOF:
                    first, dof = dof, motion.previous.item(dof)
        return first

    def is_frame_id(self, name: str) -> bool:
        """Return whether a frame of TF other than the root frame has a name."""
        return name in self._indices

    def knows(self, name: str) -> bool:
        """Return whether a frame, an element or the root frame has a name."""
        return name == self._tree.root_frame or name in self._indices or self._scene.has(name)

    def pose_of_element(self, element: int, relative_to: str = '') -> Pose:
        """Look up the pose of an element of the scene in a frame, as :meth:`pose` does."""
        found = _Found(element, self._scene.pose_of(element), '')
        return self._relative_pose(self._found(relative_to or self._tree.root_frame), found)

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

    def _found(self, name: str) -> _Found:
        scene, tree = self._scene, self._tree
        if name == tree.root_frame:
            return _Found(0, Pose(), name)
        if not scene.has(name) and name in self._indices:
            index = self._indices[name]
            owner = 0 if tree.moving is None else int(tree.moving.elements[index])
            return _Found(owner, Pose(*tree.poses[index].tolist()), name)
        element = self._element(name)
        frame_id = tree.root_frame if element == 0 else self._frame_ids.get(element, name)
        return _Found(element, scene.pose_of(element), frame_id)

    def _relative_pose(self, reference: _Found, found: _Found) -> Pose:
        """
        Return the pose of a frame in another one, at the current positions.

        :raises JointPositionError: if it depends on a joint or a model without a reported one.
        """
        poses, joints, moving = [reference.pose, found.pose], self._joints, self._tree.moving
        if joints is not None and moving is not None:
            motion, owners = moving.motion, np.array([reference.owner, found.owner])
            end, start = motion.last_dofs[owners]
            unknown, other = motion.last_chosen(~joints.is_known)[[start, end]].tolist()
            if unknown != other:
                # A joint above both changes nothing between them.
                is_unknown = np.arange(len(joints.names)) == unknown
                dof = other if motion.last_chosen(is_unknown)[end] == unknown else unknown
                what = 'the pose of model' if joints.is_model(dof) else 'joint'
                msg = (f'the pose depends on {what} "{joints.names[dof]}", which has not been '
                       'reported yet')
                raise JointPositionError(msg, Place(self._scene.path))
            moved = motion.moved_poses(np.array(poses), owners, joints.values)
            poses = [Pose(*pose) for pose in moved.tolist()]
        return canonical_relative_pose(*poses)

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


def lookup_from_scene(scene: Scene, positions: Mapping[str, float] | None = None) -> PoseLookup:
    """Look up by names of SDF, and of TF if these are unique, at positions of joints by names."""
    scene = scene_at_positions(scene, positions) if positions else scene
    try:
        tree = tf_tree_from_scene(scene)
    except SdfError:
        # Frames that would share an id keep their names in SDF.
        tree = tf_tree_from_scene(scene, TfOptions(kinds=frozenset()))
    return PoseLookup(scene, tree)
