# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Make the transforms of a file as messages, for nodes that publish them by themselves."""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from std_msgs.msg import Header

from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.ros.parameters.given import settings_from_values


def transforms_from_parameters(**parameters: Any) -> list[TransformStamped]:
    """
    Return the transforms that the node publishes, without stamps.

    Those that joints or poses of models move are as the file puts them.

    :param parameters: parameters of the node, such as ``sdf_file`` or ``robot_description``,
        ``model_name``, ``root_frame`` and ``frame_prefix``; others have their defaults.
    :return: pose of each frame in its parent, in metres, with a unit quaternion.
    :raises SettingsError: if a parameter is not valid.
    :raises AddressError: if ``sdf_file`` is a URI of a file that is not found.
    :raises SdfError: if the file is not valid, or cannot be published.
    """
    tree = loaded_scene_from_request(settings_from_values(parameters).load_request).tree
    return [
        TransformStamped(
            header=Header(frame_id=parent), child_frame_id=frame, transform=Transform(
                translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=qx, y=qy, z=qz, w=qw)))
        for frame, parent, (x, y, z, qx, qy, qz, qw) in zip(
            tree.frame_ids, tree.parent_ids, tree.transforms.tolist(), strict=True) if parent]
