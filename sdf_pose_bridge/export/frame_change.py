# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Write a measured pose of a frame into the file of a published scene."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from sdf_pose_bridge.errors import Place, PoseNotSetError
from sdf_pose_bridge.export.pose_setting import pose_change
from sdf_pose_bridge.export.published_scene import fingerprint_of_scene, LoadRequest
from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.geometry.poses import Pose, pose_inverse, pose_product
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.tf.comparison import names_of_moved
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene


class FrameChange(NamedTuple):
    """A change of one pose in a file."""

    file: str
    """Its path."""
    diff: str
    line: int
    """The line of the pose, or of the element in which it is inserted."""
    moved_frames: list[str]
    """The other frames that move."""


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

    def scene_with(*, texts: Mapping[str, bytes]) -> Scene:
        return loaded_scene_from_request(request, texts).scene

    def lookup(scene: Scene) -> PoseLookup:
        return PoseLookup(scene, tf_tree_from_scene(scene, request.tf_options), positions)

    element, in_element = loaded.lookup.element(frame)
    asked = pose_product(asked, pose_inverse(in_element))
    change = pose_change(scene, element, asked, lookup, scene_with, relative_to=reference)
    moved = set(names_of_moved(scene, change.scene))
    elements = loaded.tree.elements.tolist()
    if not dry_run:
        change.file.write()
    return FrameChange(change.file.path, change.file.diff, change.line, [
        frame_id for frame_id, other in zip(loaded.tree.frame_ids, elements, strict=True)
        if other not in (-1, element) and scene.names[other] in moved])
