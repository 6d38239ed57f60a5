# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Compare two scenes: find elements that were added, removed, renamed or moved."""

from __future__ import annotations

import enum
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.poses import distance_and_angle, Pose, relative_pose
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind

TOLERANCE = 1e-9
"""A smaller difference of poses, in metres and radians, comes from rounding."""


class Change(enum.Enum):
    """The kind of a difference."""

    ADDED = 'added'
    REMOVED = 'removed'
    RENAMED = 'renamed'
    MOVED = 'moved'


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


def differences_of_scenes(
    old: Scene, new: Scene, *, relative_to: str = '', tolerance: float = TOLERANCE,
) -> list[Difference]:
    """
    List the differences.

    An element counts as renamed if it is the only removed or added one of its kind, scope and
    pose. An element can be renamed and moved together with the elements that contain it.

    :param relative_to: the frame in which poses are compared; empty for the world or the implicit
        root.
    :param tolerance: largest difference that does not count as a movement, in metres and radians.
    :return: the removed elements in the order of the old scene, then the others in that of the new
        one.
    :raises UnknownFrameError: if there is no such frame in one of the scenes.
    """
    old_frame, new_frame = (
        scene.pose_of(scene.index(relative_to)) if relative_to else Pose()
        for scene in (old, new))
    old_indices, new_indices = _indices(old), _indices(new)
    renamed = _renamed(
        old, new, [index for key, index in old_indices.items() if key not in new_indices],
        [index for key, index in new_indices.items() if key not in old_indices])
    old_of_new = renamed | {
        new_indices[key]: index for key, index in old_indices.items() if key in new_indices}
    remaining = set(old_of_new.values())
    differences = [
        Difference(Change.REMOVED, Kind(old.kinds[index]), old.names[index], old.names[index])
        for index in old_indices.values() if index not in remaining]
    for index in new_indices.values():
        kind, name = Kind(new.kinds[index]), new.names[index]
        if index not in old_of_new:
            differences.append(Difference(Change.ADDED, kind, name, ''))
            continue
        old_name = old.names[old_of_new[index]]
        if index in renamed:
            differences.append(Difference(Change.RENAMED, kind, name, old_name))
        movement = distance_and_angle(
            relative_pose(old_frame, old.pose_of(old_of_new[index])),
            relative_pose(new_frame, new.pose_of(index)))
        if max(movement) > tolerance:
            differences.append(Difference(Change.MOVED, kind, name, old_name, *movement))
    return differences


def names_of_moved(old: Scene, new: Scene) -> list[str]:
    """Return the names of moved elements, in the order of the new scene."""
    return list(dict.fromkeys(
        difference.name for difference in differences_of_scenes(old, new)
        if difference.change is Change.MOVED))


def _indices(scene: Scene) -> dict[tuple[str, int, str], int]:
    """Return the elements, without worlds and implicit roots, by scope, kind and name."""
    return {
        (scene.world_of(index), int(scene.kinds[index]), scene.names[index]): index
        for index in np.flatnonzero(scene.parents >= 0).tolist()}


def _renamed(old: Scene, new: Scene, gone: list[int], come: list[int]) -> dict[int, int]:
    """Return the old index of each element that has another name now, by the new one."""
    renamed: dict[int, int] = {}
    new_names: dict[str, str] = {}
    places = _indices_by_place(new, come)
    # An element comes after its parent.
    for (scope, world, kind, pose), indices in _indices_by_place(old, gone).items():
        found = places.get((new_names.get(scope, scope), world, kind, pose), [])
        if len(indices) == len(found) == 1:
            renamed[found[0]] = indices[0]
            new_names[old.names[indices[0]]] = new.names[found[0]]
    return renamed


def _indices_by_place(
    scene: Scene, indices: list[int],
) -> dict[tuple[str, str, int, bytes], list[int]]:
    """Return elements by scope, world, kind and pose, which stay if only names change."""
    places: dict[tuple[str, str, int, bytes], list[int]] = {}
    for index in indices:
        place = (
            scene.names[scene.parents[index]], scene.world_of(index), int(scene.kinds[index]),
            scene.poses[index].tobytes())
        places.setdefault(place, []).append(index)
    return places
