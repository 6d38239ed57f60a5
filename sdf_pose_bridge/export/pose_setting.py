# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Find the change of a file that moves an element to a pose, and write it for a frame of TF.

No rule of SDFormat is implemented here: the scene has the ``<pose>`` that places the element and
its reference, and the new numbers are checked by reading the changed file. In URDF it is the
``<origin>`` of a joint; for a file of xacro, an error says which one it needs. The functions that
a caller gives are in this room or below it.
"""

from __future__ import annotations

from collections.abc import Callable
import contextlib
from functools import partial
from typing import NamedTuple, TypeAlias

import numpy as np

from sdf_pose_bridge.errors import Place, PoseNotSetError, SdfError
from sdf_pose_bridge.export.published_scene import fingerprint_of_scene, LoadRequest
from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.file_change import FileChange
from sdf_pose_bridge.geometry.poses import (
    distance_and_angle,
    Pose,
    pose_inverse,
    pose_product,
    relative_pose,
    TOLERANCE,
)
from sdf_pose_bridge.geometry.rotations import canonical_quaternion
from sdf_pose_bridge.printed_text import quoted_names
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.pose_writing import pose_text_from_file, PoseText
from sdf_pose_bridge.sdformat.source_formats import SourceFormat
from sdf_pose_bridge.tf.comparison import names_of_moved
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene

_MOST_ATTEMPTS = 4

Lookup: TypeAlias = Callable[[Scene], PoseLookup]
"""Returns a look-up of poses, always at the same positions of joints."""

Load: TypeAlias = Callable[..., Scene]
"""Reads the scene with ``texts`` instead of some files, as :func:`~sdf_pose_bridge.load`."""

_Measure: TypeAlias = Callable[..., list[Pose]]
"""Returns the poses of elements of a scene in the requested frame."""


class PoseChange(NamedTuple):
    """A change of one pose in a file."""

    file: FileChange
    line: int
    """The line of the pose, or of the element in which it is inserted."""
    scene: Scene
    """The scene with the new text."""


class FrameChange(NamedTuple):
    """A change that was written, or would be."""

    file: str
    """Its path."""
    diff: str
    line: int
    """The line of the pose, or of the element in which it is inserted."""
    moved_frames: list[str]
    """The other frames that move."""


def pose_change(
    scene: Scene, element: int, asked: Pose, lookup: Lookup, load: Load, *, relative_to: str = '',
    all_instances: bool = False,
) -> PoseChange:
    """
    Find the change of a file that moves an element to a pose. Nothing is written.

    If the pose of a model places a frame in it, that pose is changed, unless the frame moves in
    the model.

    :param asked: the pose, in the frame ``relative_to``, as ``lookup`` shall find it.
    :param all_instances: whether other elements that the same ``<pose>`` places may move too.
    :return: the change; with it, the pose is right to 1e-9 metres and radians.
    :raises PoseNotSetError: if no change of a single ``<pose>`` or ``<origin>`` gives this pose.
    :raises SdfError: if a file can no longer be read.
    """
    def measure(scene: Scene, *elements: int) -> list[Pose]:
        found = lookup(scene)
        return [found.pose_of_element(each, relative_to) for each in elements]

    change = partial(
        _change_of_own_pose, scene, measure=measure, load=load, all_instances=all_instances)
    try:
        return change(element, asked)
    except PoseNotSetError:
        model = next(
            (model for model, frame in scene.placements.items() if frame == element), None)
        if model is None:
            raise
    in_model = relative_pose(*measure(scene, model, element))
    return change(model, pose_product(asked, pose_inverse(in_model)))


def write_frame_change(
    request: LoadRequest, fingerprint: bytes, frame: str, asked: Pose, reference: str,
    positions: JointPositions | None, dry_run: bool,  # noqa: FBT001 - called in another process
) -> FrameChange:
    """
    Find and write the change of a file that moves a frame to a measured pose.

    :param request: the request of the published scene, which has this fingerprint.
    :param asked: the measured pose of the frame.
    :param reference: the name of the frame in which it was measured; empty for the root frame.
    :param positions: the positions of the joints at that time; None if they do not move.
    :param dry_run: whether to write nothing.
    :return: the change; the changed file is valid and can be published.
    :raises SdfError: if no change of a single pose gives this pose, or the file cannot be written.
    """
    loaded = loaded_scene_from_request(request)
    scene = loaded.scene
    if fingerprint_of_scene(scene) != fingerprint:
        msg = 'the file has changed since it was read'
        raise PoseNotSetError(msg, Place(str(loaded.path)))

    element, in_element = loaded.lookup.element(frame)
    change = pose_change(
        scene, element, pose_product(asked, pose_inverse(in_element)),
        lambda scene: PoseLookup(scene, tf_tree_from_scene(scene, request.tf_options), positions),
        lambda texts: loaded_scene_from_request(request, texts).scene, relative_to=reference)
    moved = set(names_of_moved(scene, change.scene))
    elements = loaded.tree.elements.tolist()
    if not dry_run:
        change.file.write()
    return FrameChange(change.file.path, change.file.diff, change.line, [
        frame_id for frame_id, other in zip(loaded.tree.frame_ids, elements, strict=True)
        if other not in (-1, element) and scene.names[other] in moved])


def _change_of_own_pose(
    scene: Scene, element: int, asked: Pose, measure: _Measure, load: Load, *, all_instances: bool,
) -> PoseChange:
    _check_kind(scene, element)
    path = place_of_pose(scene, element)[0]
    text = pose_text_from_file(path)
    marked = load(texts={path: text.with_a_line_for_each_tag()})
    if marked.names != scene.names or not np.array_equal(marked.poses, scene.poses):
        msg = 'the file has changed since it was read'
        raise PoseNotSetError(msg, Place(path))
    _, line, is_written = place = place_of_pose(marked, element)
    target = text.element_at_line(line)
    at = Place(path, text.line(target))
    if not all_instances:
        _check_instances(
            marked, element, place, at, is_urdf=text.source_format is SourceFormat.URDF)
    make = partial(_change_of_text, scene, element, asked, measure, load, path)
    match text.source_format:
        case SourceFormat.URDF:
            return _change_of_origin(scene, element, text, make)
        case SourceFormat.SDFORMAT:
            reference = int(scene.references[element])
            in_reference = relative_pose(*measure(scene, reference, element))
            _check_joints(scene, element, in_reference, at)
            if is_written:
                return make(reference, text.pose(target), partial(text.with_pose, target), at.line)
            return make(reference, in_reference, partial(text.with_new_pose, target), at.line)


def _change_of_text(
    scene: Scene, element: int, asked: Pose, measure: _Measure, load: Load, path: str,
    reference: int, written: Pose, with_pose: Callable[[Pose, float], FileChange], line: int,
) -> PoseChange:
    """
    Find the numbers of a pose in the file, which is relative to a reference.

    :param written: the pose in the file.
    :param with_pose: returns the change to another pose, with an error of its numbers.
    """
    in_asked, current = measure(scene, reference, element)
    tolerance, at = TOLERANCE, Place(path, line)
    for _ in range(_MOST_ATTEMPTS):
        # The element has the pose C in the frame that the pose in the file places, most often the
        # identity. So requested = R written C, before and after the change, and C follows from the
        # current poses.
        there = pose_product(pose_product(asked, pose_inverse(current)), in_asked)
        written = pose_product(relative_pose(in_asked, there), written)
        written = Pose(*written[:3], *canonical_quaternion(written[3:]))
        change = with_pose(written, tolerance)
        try:
            new = load(texts={path: change.new_text})
        except SdfError as error:
            msg = f'with this pose the file would not be valid: {error.errors[0].message}'
            raise PoseNotSetError(msg, at) from error
        in_asked, current = measure(new, reference, element)
        if are_close(current, asked):
            return PoseChange(change, line, new)
        tolerance /= 10.0
    msg = (f'no pose puts "{scene.names[element]}" there: the frame in which it was measured '
           'moves with it, so choose another one; or parameters of an include place it')
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
    scene: Scene, element: int, place: tuple[str, int, bool], at: Place, *, is_urdf: bool,
) -> None:
    # The links and joints of a URDF have other names than those with which they share a pose.
    others = [
        scene.names[other] for other in range(len(scene.names))
        if other != element and scene.parents[other] >= 0
        and place_of_pose(scene, other) == place
        and (scene.own_name(other) == scene.own_name(element) or not is_urdf)]
    if others:
        msg = (f'the same pose in the file also places {quoted_names(others)}, '
               'which would move too')
        raise PoseNotSetError(msg, at)


def _check_joints(scene: Scene, element: int, in_reference: Pose, at: Place) -> None:
    reference = int(scene.references[element])
    expected = scene.relative_pose_of(element, reference)
    size_m = np.abs(scene.poses[:, :3]).max()
    if max(distance_and_angle(in_reference, expected)) > TOLERANCE * (1.0 + size_m):
        msg = (f'a joint has moved "{scene.names[element]}" away from "{scene.names[reference]}", '
               'which its pose in the file is relative to; move the joint back, or set the pose '
               'of another frame')
        raise PoseNotSetError(msg, at)


def _change_of_origin(
    scene: Scene, element: int, text: PoseText, make: Callable[..., PoseChange],
) -> PoseChange:
    """Find the change of the ``<origin>`` of a joint of URDF that moves an element to a pose."""
    name = scene.own_name(element)
    scope = scene.names[element].removesuffix(name)
    for number, joint in text.joints_to_move(name, is_included=not scene.is_urdf):
        # The link "world" is the frame of the model.
        parent = scene.index(scope + joint.parent, world=scene.world_of(element)) if (
            scene.has(scope + joint.parent)) else int(scene.parents[element])
        with contextlib.suppress(PoseNotSetError):
            change: PoseChange = make(
                parent, joint.origin, partial(text.with_origin, number), text.line(number))
            break
    else:
        msg = f'this is URDF, and no <origin> of a joint in it puts "{scene.names[element]}" there'
        raise PoseNotSetError(msg, scene.place(element))
    if not text.is_plain_urdf(number):
        origin_text = change.file.new.decode(change.file.encoding).strip()
        msg = ('a pose of xacro, or in quat_xyzw, is not set; this one needs joint '
               f'"{joint.xml.get("name")}": {origin_text}')
        raise PoseNotSetError(msg, Place(change.file.path, change.line))
    return change


def are_close(a: Pose, b: Pose) -> bool:
    """Return whether two poses are equal to 1e-9 metres and radians."""
    return max(distance_and_angle(a, b)) <= TOLERANCE
