# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``~/set_pose``: write a measured pose into the file that places a frame."""

from __future__ import annotations

from collections.abc import Mapping

from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import PoseNotSetError
from sdf_pose_bridge.geometry.formats import converted_poses
from sdf_pose_bridge.geometry.formats import PoseFormatError
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.poses import pose_inverse
from sdf_pose_bridge.geometry.poses import pose_product
from sdf_pose_bridge.ros.loaded_scene import loaded_scene_from_settings
from sdf_pose_bridge.ros.loaded_scene import LoadedScene
from sdf_pose_bridge.ros.parameters import Settings
from sdf_pose_bridge.scene.comparison import Change
from sdf_pose_bridge.scene.comparison import differences_of_scenes
from sdf_pose_bridge.scene.pose_setting import pose_change
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.pose_writing import replace_file
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene
from sdf_pose_bridge_interfaces.srv import SetPose


def set_pose(
    request: SetPose.Request, loaded: LoadedScene, settings: Settings,
) -> SetPose.Response:
    """
    Write into a file that a frame is where it was measured, unless it is a dry run.

    :param loaded: the scene that is published.
    :param settings: the settings that it was loaded with.
    :return: the answer: what changes. With it the file is valid and can be published.
    :raises SdfError: if the request is no pose, no pose in a file can say it, or the file cannot
        be written.
    """
    if not settings.sdf_file:
        msg = 'the pose stands in the parameter robot_description, not in a file'
        raise PoseNotSetError(msg, Place(str(loaded.path)))
    asked, reference = _pose_from_request(request, loaded), request.pose.header.frame_id
    # A copy: the joints go on moving.
    positions = None if loaded.joint_positions is None else loaded.joint_positions.values.copy()

    def scene_with(texts: Mapping[str, bytes]) -> Scene:
        return loaded_scene_from_settings(settings, texts).scene

    def measured(scene: Scene, element: int) -> Pose:
        tree = tf_tree_from_scene(scene, settings.tf_options)
        return PoseLookup(scene, tree, positions).pose_of_element(element, reference)

    scene = loaded.scene
    element, in_element = loaded.lookup.element(request.frame)
    asked = pose_product(asked, pose_inverse(in_element))
    change = pose_change(scene, element, asked, measured, scene_with)
    if not request.dry_run:
        replace_file(change.path, change.old_text, change.new_text)
    moved = {
        difference.name for difference in differences_of_scenes(scene, change.scene)
        if difference.change is Change.MOVED}
    elements = loaded.tree.elements.tolist()
    return SetPose.Response(
        success=True, file=change.path, line=change.line, diff=change.diff, moved_frames=[
            frame_id for frame_id, other in zip(loaded.tree.frame_ids, elements, strict=True)
            if other not in (-1, element) and scene.names[other] in moved])


def _pose_from_request(request: SetPose.Request, loaded: LoadedScene) -> Pose:
    position, quaternion = request.pose.pose.position, request.pose.pose.orientation
    numbers = [
        position.x, position.y, position.z,
        quaternion.x, quaternion.y, quaternion.z, quaternion.w]
    try:
        return Pose(*converted_poses(numbers, 'sdf_quat_xyzw', 'sdf_quat_xyzw').tolist())
    except PoseFormatError as error:
        raise PoseNotSetError(str(error), Place(str(loaded.path))) from error
