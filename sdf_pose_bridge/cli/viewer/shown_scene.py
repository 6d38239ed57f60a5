# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Prepare a scene for the page: its models, its joints, and its frames at positions of joints."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.cli.printing import kind_labels_of
from sdf_pose_bridge.cli.viewer.joint_sliders import JointRange, range_of_dof
from sdf_pose_bridge.geometry.chains import ends_from_pointers
from sdf_pose_bridge.geometry.poses import Pose, relative_pose
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.tf.joint_motion import JointMotion
from sdf_pose_bridge.tf.joint_positions import JointPositions, scene_at_positions
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT, tf_parents_from_scene
from sdf_pose_bridge.tf.tree import elements_in_model, tf_tree_from_scene, TfOptions, TfTree


class PosedScene(NamedTuple):
    """A scene at some positions of its joints, and its TF tree there."""

    scene: Scene
    tree: TfTree
    labels: Sequence[str]
    """The label of the kind of each frame."""

    def pose_of(self, frame: int) -> Pose:
        """Return the pose of a frame in the root frame, for which ``ROOT_IS_PARENT`` stands."""
        return Pose() if frame == ROOT_IS_PARENT else Pose(*self.tree.poses[frame].tolist())

    @property
    def ids(self) -> Sequence[str]:
        """The ids of all frames, and of the root frame, at the index ``ROOT_IS_PARENT``."""
        return *self.tree.frame_ids, self.tree.root_frame

    def pose_in(self, reference: int, frame: int) -> Pose:
        """Return the pose of a frame in another one."""
        return relative_pose(self.pose_of(reference), self.pose_of(frame))

    def with_pose(self, frame: int, pose: Pose) -> PosedScene:
        """Return the same with a frame at another pose; other frames stay."""
        poses = self.tree.poses.copy()
        poses[frame] = pose
        return self._replace(tree=replace(self.tree, poses=poses))


class ShownScene:
    """
    A scene as the page shows it.

    :param loaded: the scene, loaded with its shapes.
    :param options: the elements that are frames, and the rules for their names.
    :raises SdfError: if the scene has no TF tree, or a model to show does not exist.
    """

    def __init__(self, loaded: Scene, options: TfOptions) -> None:
        tree = tf_tree_from_scene(loaded, options)
        dofs = JointMotion(loaded, tf_parents_from_scene(loaded)).dofs
        self.loaded, self._options = loaded, options
        self._is_in_model = elements_in_model(loaded, options.model) & (loaded.roots == 0)
        # The outermost element around each, below the world or the implicit root.
        self._tops = ends_from_pointers(
            np.where(loaded.parents[loaded.parents] < 0, -1, loaded.parents))
        self._labels = kind_labels_of(loaded, tree)
        self.kinds = tuple(dict.fromkeys(self._labels))
        """The labels of the kinds of its frames."""
        self.joints: dict[str, JointRange] = {
            name: range_of_dof(dof)
            for name, dof in zip(JointPositions(loaded, dofs).names, dofs, strict=True)
            if self._is_in_model[dof.joint.element] and dof.axis.mimic is None}
        """The range of each degree of freedom that does not follow another one."""
        self.is_in_robot: NDArray[np.bool_] = np.isin(
            self._tops, self._tops[[dof.joint.element for dof in dofs]])
        """Shape (n,): whether each element is in a model that moves."""

    def is_shown(self, hidden: Iterable[int]) -> NDArray[np.bool_]:
        """Return whether each element is in none of the hidden elements, shape (n,)."""
        shown: NDArray[np.bool_] = self._is_in_model.copy()
        for element in hidden:
            shown &= ~self.is_in(element)
        return shown

    def is_in(self, element: int) -> NDArray[np.bool_]:
        """Return whether each element is a given one, or in it, shape (n,)."""
        is_end = np.arange(len(self.loaded.parents)) == element
        inside: NDArray[np.bool_] = ends_from_pointers(
            np.where(is_end, -1, self.loaded.parents)) == element
        return inside

    def at(self, positions: Mapping[str, float], scene: Scene | None = None) -> PosedScene:
        """
        Return the scene with its joints at positions, in radians or metres.

        :param scene: the same scene with other poses.
        """
        scene = scene_at_positions(scene or self.loaded, positions)
        return PosedScene(scene, tf_tree_from_scene(scene, self._options), self._labels)
