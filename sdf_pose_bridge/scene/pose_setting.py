# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Find the change of a file that moves an element to a pose.

No rule of SDFormat is implemented here: the scene has the ``<pose>`` that places the element and
its reference, and the new numbers are checked by reading the changed file.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
import os
from pathlib import Path
from typing import NamedTuple, TypeAlias

import numpy as np

from sdf_pose_bridge.errors import Place, PoseNotSetError, SdfError
from sdf_pose_bridge.geometry.poses import (
    distance_and_angle,
    Pose,
    pose_inverse,
    pose_product,
    relative_pose,
)
from sdf_pose_bridge.geometry.rotations import canonical_quaternion
from sdf_pose_bridge.names import quoted_names
from sdf_pose_bridge.scene.comparison import TOLERANCE
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.file_change import FileChange
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.include.uris import resource_finder
from sdf_pose_bridge.sdformat.limits import Usage
from sdf_pose_bridge.sdformat.pose_writing import PoseText
from sdf_pose_bridge.sdformat.xml_file import bytes_from_file

_MOST_ATTEMPTS = 4

Load: TypeAlias = Callable[[Mapping[str, bytes]], Scene]
"""Reads the scene with other texts instead of some of its files."""

Measure: TypeAlias = Callable[[Scene, int], Pose]
"""Returns the pose of an element in the requested frame."""


class PoseChange(NamedTuple):
    """A change of one pose in a file."""

    file: FileChange
    line: int
    """The line of the pose, or of the element in which it is inserted."""
    scene: Scene
    """The scene with the new text."""


def pose_change(
    scene: Scene, element: int, asked: Pose, measure: Measure, load: Load, *,
    all_instances: bool = False,
) -> PoseChange:
    """
    Find the change of a file that moves an element to a pose. Nothing is written.

    If the pose of a model places a frame in it, that pose is changed, unless the frame moves in
    the model.

    :param asked: the pose, as ``measure`` shall return it.
    :param measure: returns the pose of an element in a frame of the caller's choice, always at the
        same positions of joints.
    :param all_instances: whether other elements that the same ``<pose>`` places may move too.
    :return: the change; with it, the pose is right to 1e-9 metres and radians.
    :raises PoseNotSetError: if no change of a single ``<pose>`` gives this pose.
    :raises SdfError: if a file can no longer be read.
    """
    try:
        return _change_of_own_pose(
            scene, element, asked, measure, load, all_instances=all_instances)
    except PoseNotSetError:
        model = next(
            (model for model, frame in scene.placements.items() if frame == element), None)
        if model is None:
            raise
    in_model = relative_pose(measure(scene, model), measure(scene, element))
    return _change_of_own_pose(
        scene, model, pose_product(asked, pose_inverse(in_model)), measure, load,
        all_instances=all_instances)


def _change_of_own_pose(
    scene: Scene, element: int, asked: Pose, measure: Measure, load: Load, *, all_instances: bool,
) -> PoseChange:
    _check_kind(scene, element)
    path = place_of_pose(scene, element)[0]
    cache = Path(os.path.realpath(resource_finder().fuel_cache))
    if cache in Path(os.path.realpath(path)).parents:
        msg = 'the file is in the cache of Gazebo Fuel; copy the model and include the copy'
        raise PoseNotSetError(msg, Place(path))
    text = PoseText(bytes_from_file(path, Usage()), path)
    marked = load({path: text.with_a_line_for_each_tag()})
    if marked.names != scene.names or not np.array_equal(marked.poses, scene.poses):
        msg = 'the file has changed since it was read'
        raise PoseNotSetError(msg, Place(path))
    _, line, is_written = place = place_of_pose(marked, element)
    target = text.element_at_line(line)
    at = Place(path, text.line(target))
    if not all_instances:
        _check_instances(marked, element, place, at)
    reference = int(scene.references[element])
    in_asked, old = measure(scene, reference), measure(scene, element)
    _check_joints(scene, element, relative_pose(in_asked, old), at)
    written = text.pose(target) if is_written else relative_pose(in_asked, old)
    current, tolerance = old, TOLERANCE
    for _ in range(_MOST_ATTEMPTS):
        # The element has the pose C in the frame that the pose in the file places, most often the
        # identity. So requested = R written C, before and after the change, and C follows from the
        # current poses.
        there = pose_product(pose_product(asked, pose_inverse(current)), in_asked)
        written = pose_product(relative_pose(in_asked, there), written)
        written = Pose(*written[:3], *canonical_quaternion(written[3:]))
        change = text.with_pose(target, written, tolerance) if is_written else (
            text.with_new_pose(target, written, tolerance))
        try:
            new = load({path: change.new_text})
        except SdfError as error:
            msg = f'with this pose the file would not be valid: {error.errors[0].message}'
            raise PoseNotSetError(msg, at) from error
        current, in_asked = measure(new, element), measure(new, reference)
        if are_close(current, asked):
            return PoseChange(change, at.line, new)
        tolerance /= 10.0
    msg = (f'no pose of "{scene.names[element]}" in the file puts it there: the frame that the '
           'pose is measured in moves with it, or parameters of an include decide where it is')
    raise PoseNotSetError(msg, at)


def _check_kind(scene: Scene, element: int) -> None:
    kind = Kind(scene.kinds[element])
    reason = ''
    if scene.parents[element] < 0:
        reason = 'the frame in which all others are placed'
    elif kind is Kind.ACTOR:
        reason = 'an actor, which moves along its trajectory'
    elif element in scene.automatic_inertials:
        reason = 'an inertial that is computed from the collisions of its link'
    if reason:
        msg = f'the pose of "{scene.names[element]}" cannot be set: it is {reason}'
        raise PoseNotSetError(msg, scene.place(element))


def place_of_pose(scene: Scene, element: int) -> tuple[str, int, bool]:
    """Return file and line of the pose, or else of the element; and whether it is a pose."""
    path, line = scene.place(element)[:2]
    include = scene.includes.get(element)
    if include is not None and include.file != path:
        # The include has no pose yet.
        return include.file, include.line, False
    pose_line = int(scene.pose_lines[element])
    return path, pose_line or line, bool(pose_line)


def _check_instances(
    scene: Scene, element: int, place: tuple[str, int, bool], at: Place,
) -> None:
    others = [
        scene.names[other] for other in range(len(scene.names))
        if other != element and scene.parents[other] >= 0
        and place_of_pose(scene, other) == place]
    if others:
        msg = (f'the same pose in the file also places {quoted_names(others)}, '
               'which would move too')
        raise PoseNotSetError(msg, at)


def _check_joints(scene: Scene, element: int, in_reference: Pose, at: Place) -> None:
    reference = int(scene.references[element])
    expected = scene.relative_pose_of(element, reference)
    size_m = float(np.abs(scene.poses[:, :3]).max())
    if max(distance_and_angle(in_reference, expected)) > TOLERANCE * (1.0 + size_m):
        msg = (f'a joint has moved "{scene.names[element]}" away from "{scene.names[reference]}", '
               'which its pose in the file is relative to; move the joint back, or set the pose '
               'of another frame')
        raise PoseNotSetError(msg, at)


def are_close(a: Pose, b: Pose) -> bool:
    """Return whether two poses are equal to 1e-9 metres and radians."""
    return max(distance_and_angle(a, b)) <= TOLERANCE
