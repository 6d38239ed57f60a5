# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Compare what TF depends on in two scenes: frames, poses, parents, joints and frame ids of sensors.

Scenes without a difference have the same transforms at all positions of their joints. Shapes and
masses are not compared.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence
import enum
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from sdf_pose_bridge.geometry.chains import ends_from_pointers
from sdf_pose_bridge.geometry.poses import (
    canonical_relative_poses,
    distance_and_angle,
    Pose,
    relative_pose,
    TOLERANCE,
)
from sdf_pose_bridge.geometry.rotations import rpy_from_quaternion
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.joints import AXIS_TAGS
from sdf_pose_bridge.sdformat.specification import JOINT_TYPES
from sdf_pose_bridge.tf.joint_motion import JointMotion
from sdf_pose_bridge.tf.parents import tf_parents_from_scene


class Change(enum.Enum):
    """The kind of a difference."""

    ADDED = 'added'
    REMOVED = 'removed'
    RENAMED = 'renamed'
    MOVED = 'moved'
    PARENT = 'parent'
    """The parent in TF."""
    TYPE = 'type'
    """The type of a joint, or whether it or a model can move."""
    AXIS = 'axis'
    LIMITS = 'limits'
    MIMIC = 'mimic'
    FRAME_ID = 'frame id'
    """The frame id of the data of a sensor, or of its optical frame."""


class Difference(NamedTuple):
    """A difference between two scenes."""

    change: Change
    kind: Kind
    name: str
    """Absolute name in the new scene; in the old one if it was removed."""
    old_name: str
    """Absolute name in the old scene; empty if it was added."""
    distance_m: float = 0.0
    angle_rad: float = 0.0
    moved_with: str = ''
    """The moved element that took this one with it; empty if it has moved by itself."""
    old: str = ''
    """The old value, for ``MOVED`` x y z roll pitch yaw; empty for ``ADDED`` and ``REMOVED``."""
    new: str = ''


_Fact: TypeAlias = tuple[str | float, ...]
_Facts: TypeAlias = dict[tuple[Change, int], _Fact]
"""The words and numbers that are compared of an element, or of one of its axes."""


def differences_of_scenes(
    old: Scene, new: Scene, *, relative_to: str = '', tolerance: float = TOLERANCE,
) -> list[Difference]:
    """
    List the differences.

    An element counts as renamed if it is the only removed or added one of its kind, scope and
    pose; the model of a model file always does. The model of a URDF is no frame.

    :param relative_to: the frame in which poses are compared; empty for the world or the implicit
        root.
    :param tolerance: largest difference of numbers that does not count, in metres and radians.
    :return: the removed elements in the order of the old scene, then the others in that of the new
        one.
    :raises UnknownFrameError: if there is no such frame in one of the scenes.
    """
    old_poses, new_poses = (
        [Pose(*pose) for pose in canonical_relative_poses(
            scene.poses[scene.index(relative_to)] if relative_to else np.array(Pose()),
            scene.poses).tolist()] for scene in (old, new))
    # Also with roots and models of URDF, which are no frames.
    old_of_all = _old_of_new(old, new)
    old_frames, new_frames = _frames(old), _frames(new)
    old_of_new = {index: before for index, before in old_of_all.items()
                  if before in old_frames and index in new_frames}
    remaining = {*old_of_new.values()}
    movements = {
        index: movement for index, before in old_of_new.items()
        if max(movement := distance_and_angle(old_poses[before], new_poses[index])) > tolerance}
    carriers = np.full(len(new.names), -1, np.int32)
    for index in movements:
        carrier = int(new.references[index])
        if carrier in movements and max(distance_and_angle(
                relative_pose(old_poses[old_of_new[carrier]], old_poses[old_of_new[index]]),
                relative_pose(new_poses[carrier], new_poses[index]))) <= tolerance:
            carriers[index] = carrier
    first_moved = ends_from_pointers(carriers).tolist()
    differences = [
        Difference(Change.REMOVED, Kind(old.kinds[index]), old.names[index], old.names[index])
        for index in old_frames if index not in remaining]
    old_facts, new_facts = _facts(old, old.names), _facts(new, [
        old.names[old_of_all[index]] if index in old_of_all else name
        for index, name in enumerate(new.names)])
    for index in new_frames:
        kind, name, before = Kind(new.kinds[index]), new.names[index], old_of_new.get(index)
        if before is None:
            differences.append(Difference(Change.ADDED, kind, name, ''))
            continue
        moved = Difference(Change.MOVED, kind, name, old.names[before])
        if new.own_name(index) != old.own_name(before):
            differences.append(moved._replace(change=Change.RENAMED, old=moved.old_name, new=name))
        if index in movements:
            first, (distance_m, angle_rad) = first_moved[index], movements[index]
            differences.append(moved._replace(
                distance_m=distance_m, angle_rad=angle_rad,
                moved_with='' if first == index else new.names[first],
                old=_text_of_pose(old_poses[before]), new=_text_of_pose(new_poses[index])))
        for each, fact in new_facts[index].items():
            was = old_facts[before].get(each, fact)
            if len(was) != len(fact) or not all(
                    a == b or (isinstance(a, float) and isinstance(b, float)
                               and abs(a - b) <= tolerance)
                    for a, b in zip(was, fact, strict=True)):
                differences.append(moved._replace(change=each[0], old=_text(was), new=_text(fact)))
    return differences


def names_of_moved(old: Scene, new: Scene) -> list[str]:
    """Return the names of moved elements, in the order of the new scene."""
    return list(dict.fromkeys(
        difference.name for difference in differences_of_scenes(old, new)
        if difference.change is Change.MOVED))


def _frames(scene: Scene) -> dict[int, None]:
    """Return the elements without worlds, implicit roots, and the model of a URDF, in order."""
    is_of_urdf = (scene.kinds == Kind.MODEL) & (scene.parents == 0) & scene.is_urdf
    return dict.fromkeys(np.flatnonzero((scene.parents >= 0) & ~is_of_urdf).tolist())


def _old_of_new(old: Scene, new: Scene) -> dict[int, int]:
    """Return the old element of each new one that is not added; the first roots are the same."""
    def name(scene: Scene, index: int) -> Hashable:
        return scene.kinds.item(index), scene.own_name(index)

    def place(scene: Scene, index: int) -> Hashable:
        # A model file has one model, wherever that is. If only names change, poses stay.
        is_only = scene.kinds[scene.parents[index]] == Kind.ROOT
        return scene.kinds.item(index), is_only or scene.poses[index].tobytes()

    def by_key(scene: Scene, indices: Iterable[int], key: Any) -> dict[Hashable, list[int]]:
        groups: dict[Hashable, list[int]] = {}
        for index in indices:
            groups.setdefault(key(scene, index), []).append(index)
        return groups

    old_children, new_children = (
        by_key(scene, range(len(scene.names)), lambda scene, index: scene.parents.item(index))
        for scene in (old, new))
    # In a world, frame ids have the names of models.
    waiting = [
        pair for pair in zip(new_children.get(-1, []), old_children.get(-1, []), strict=False)
        if new.kinds[pair[0]] == old.kinds[pair[1]]]
    found = dict(waiting)
    while waiting:
        index, before = waiting.pop()
        come, gone = {*new_children.get(index, ())}, {*old_children.get(before, ())}
        for key in (name, place):
            others = by_key(old, gone, key)
            pairs = {there[0]: others[each][0] for each, there in by_key(new, come, key).items()
                     if len(there) == len(others.get(each, ())) == 1}
            found.update(pairs)
            waiting += pairs.items()
            come, gone = come.difference(pairs), gone.difference(pairs.values())
    return found


def _facts(scene: Scene, names: Sequence[str]) -> list[_Facts]:
    """Return what TF depends on besides names and poses, with given names of elements."""
    tf_parents = tf_parents_from_scene(scene)
    moving = {dof.joint.element for dof in JointMotion(scene, tf_parents).dofs}
    found: list[_Facts] = [
        {(Change.PARENT, 0): (names[parent] if scene.parents[parent] >= 0 else 'world',)}
        for parent in tf_parents.parents.tolist()]
    for model in np.flatnonzero(scene.kinds == Kind.MODEL).tolist():
        is_static = model in scene.static_models
        found[model][Change.TYPE, 0] = ('static' if is_static else 'not static',)
    for index, sensor in scene.sensors.items():
        found[index][Change.FRAME_ID, 0] = (
            sensor.frame_id or 'by its name',
            *((f'in Harmonic {sensor.older_frame_id or "by its name"}',)
              if sensor.older_frame_id != sensor.frame_id else ()),
            *((sensor.optical_frame_id or 'and _optical',) if sensor.is_camera else ()))
    for joint in scene.joints:
        facts = found[joint.element]
        is_still = joint.type != 'fixed' and joint.element not in moving
        facts[Change.TYPE, 0] = (
            joint.type, *((joint.screw_pitch_m, 'm') if joint.type == 'screw' else ()),
            *(('that moves nothing',) if is_still else ()))
        for _, number, _ in JOINT_TYPES[joint.type]:
            if isinstance(number, int):
                axis, label = joint.axes[number], AXIS_TAGS[1:number + 1]
                facts[Change.AXIS, number] = *label, *axis.xyz
                facts[Change.LIMITS, number] = *label, axis.lower, 'to', axis.upper
                facts[Change.MIMIC, number] = (*label, 'none') if axis.mimic is None else (
                    *label, axis.mimic.multiplier, '*', names[axis.mimic.joint],
                    *AXIS_TAGS[1:axis.mimic.axis + 1], '+',
                    axis.mimic.offset - axis.mimic.multiplier * axis.mimic.reference)
    return found


def _text(fact: _Fact) -> str:
    return ' '.join(each if isinstance(each, str) else f'{each + 0.0:.10g}' for each in fact)


def _text_of_pose(pose: Pose) -> str:
    return _text((*pose[:3], *rpy_from_quaternion(pose[3:])))
