# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A scene as the page shows it: its models, its joints, and its frames at positions of joints."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
import copy
from itertools import accumulate, chain
import math
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge import Pose, Scene, scene_at_positions
from sdf_pose_bridge.geometry.poses import relative_pose
from sdf_pose_bridge.geometry.rotations import Floats
from sdf_pose_bridge.tf.joint_positions import leading_dofs
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT
from sdf_pose_bridge.tf.tree import elements_in_model, tf_tree_from_scene, TfOptions

_LARGEST_RANGE = 1000.0
"""A joint with a wider range counts as one without limits, which the page moves by half a turn or
half a metre to either side."""
_MOST_SCOPES = 4
"""Largest number of scopes of a short name; others have all of them."""


class JointRange(NamedTuple):
    """The range of a joint, in radians or metres."""

    is_angle: bool
    lower: float
    upper: float
    is_free: bool = False
    """Whether the joint also has other positions; an angle then has a whole turn."""


def range_within_limits(lower: float, upper: float, *, is_angle: bool) -> JointRange:
    """Return the range of a joint with these limits."""
    if upper - lower >= _LARGEST_RANGE:
        most = math.pi if is_angle else 0.5
        return JointRange(is_angle, -most, most, is_free=True)
    return JointRange(is_angle, lower, max(lower, upper))


def short_names(names: Iterable[str]) -> list[str]:
    """Return the ends of names such as ``arm/tool``, as short as they are unique."""
    ends = [
        [*accumulate(reversed(name.rsplit('/', _MOST_SCOPES)), lambda end, part: f'{part}/{end}')]
        for name in names]
    counts = Counter(chain.from_iterable(ends))
    return [next((end for end in each if counts[end] == 1), each[-1]) for each in ends]


class ShownScene:
    """
    A scene as the page shows it, at some positions of its joints; at first where they start.

    :param loaded: the scene, loaded with its shapes.
    :param options: the elements that are frames, and the rules for their names.
    :raises SdfError: if the scene has no TF tree, or a model to show does not exist.
    """

    def __init__(self, loaded: Scene, options: TfOptions) -> None:
        self.loaded, self._options = loaded, options
        dofs = leading_dofs(loaded)
        self.is_in_model = elements_in_model(loaded, options.model) & (loaded.roots == 0)
        """Shape (n,): whether each element is to be shown."""
        self.joints: dict[str, JointRange] = {
            dof.name: range_within_limits(
                dof.axis.lower, dof.axis.upper, is_angle=bool(dof.rad_per_unit))
            for dof in dofs if self.is_in_model[dof.joint.element]}
        """The range of each degree of freedom that does not follow another one, in file order."""
        self.positions: Mapping[str, float] = {
            name: min(max(0.0, limits.lower), limits.upper)
            for name, limits in self.joints.items()}
        """The positions of joints, in radians or metres: at first zero, or the nearest limit."""
        self.scene = scene_at_positions(loaded, self.positions)
        """The scene at these positions."""
        self.tree = tf_tree_from_scene(self.scene, options)
        """The TF tree at the first positions."""
        self.poses = _with_root(self.tree.poses)
        """Shape (n + 1, 7): the poses of all frames in the root frame, and of the root frame."""
        self.ids: Sequence[str] = (*self.tree.frame_ids, self.tree.root_frame)
        """The ids of all frames, and of the root frame, at the index ``ROOT_IS_PARENT``."""
        self.short_names: Sequence[str] = short_names(self.tree.frame_ids)
        """The ids of frames without the scopes that are not needed to tell them apart."""
        self.labels: Sequence[str] = self.tree.kind_labels(loaded)
        """The label of the kind of each frame."""
        self.is_in_robot = loaded.are_in(
            [loaded.top_level_element(dof.joint.element) for dof in dofs])
        """Shape (n,): whether each element is in a model that moves."""

    def at(self, positions: Mapping[str, float], scene: Scene | None = None) -> ShownScene:
        """Return the scene at positions of its joints; ``scene`` replaces the loaded one."""
        shown = copy.copy(self)
        shown.positions, shown.loaded = positions, scene or self.loaded
        shown.scene = scene_at_positions(shown.loaded, positions)
        shown.poses = _with_root(tf_tree_from_scene(shown.scene, self._options).poses)
        return shown

    def with_pose(self, frame: int, pose: Pose) -> ShownScene:
        """Return the scene with a frame at another pose; other frames stay."""
        shown = copy.copy(self)
        shown.poses = self.poses.copy()
        shown.poses[frame] = pose
        return shown

    def element_of(self, frame: int) -> int:
        """Return the element of a frame; -1 for the root frame and for one without an element."""
        return -1 if frame == ROOT_IS_PARENT else int(self.tree.elements[frame])

    def pose_of(self, frame: int) -> Pose:
        """Return the pose of a frame in the root frame, for which ``ROOT_IS_PARENT`` stands."""
        return Pose(*self.poses[frame].tolist())

    def pose_in(self, reference: int, frame: int) -> Pose:
        """Return the pose of a frame in another one."""
        return relative_pose(self.pose_of(reference), self.pose_of(frame))


def _with_root(poses: Floats) -> Floats:
    return np.append(poses, [Pose()], axis=0)
