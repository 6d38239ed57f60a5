# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Find the frames in which plugins of Gazebo send the odometry of their models.

The odometry of wheels is zero where the model was spawned. OdometryPublisher sends a pose in the
world, with offsets. Source: ``UpdateOdometry`` of their classes in gz-sim 8 to 10.
"""

from __future__ import annotations

from typing import NamedTuple

from sdf_pose_bridge.geometry.poses import Pose, pose_inverse
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.gazebo_topics import topics_of
from sdf_pose_bridge.sdformat.poses import EULER_RPY, pose_from_text, PoseTextError
from sdf_pose_bridge.tf.joint_motion import JointMotion


class Odometry(NamedTuple):
    """A frame of odometry."""

    pose: Pose
    """Its pose in the root."""
    model: Pose
    """The pose of the model in the frame whose pose is sent."""
    is_of_wheels: bool


def odometry_from_scene(scene: Scene, motion: JointMotion) -> dict[tuple[int, str], Odometry]:
    """
    Find the frames of the odometry of free models.

    :param scene: the scene, loaded with ``plugins=True``.
    :return: the frames, by the degrees of freedom of their models and the frame ids in messages.
    """
    found: dict[tuple[int, str], Odometry] = {}
    for dof, model in list(enumerate(motion.elements))[len(motion.dofs):]:
        # A spawned model is not where its own file puts it.
        start = scene.pose_of(model) if scene.world_of(model) else Pose()
        for plugin in scene.plugins.get(model, ()):
            parameters = dict(reversed(plugin.parameters))
            for topic in topics_of(plugin.system, parameters):
                if not topic.odometry_frame:
                    continue
                frame_id = parameters.get(topic.odometry_frame, f'{scene.own_name(model)}/odom')
                found.setdefault(
                    (dof, frame_id.replace(SEPARATOR, '/')),
                    Odometry(start, Pose(), is_of_wheels=True) if topic.is_of_wheels else Odometry(
                        _offset(parameters, 'global_offset'),
                        pose_inverse(_offset(parameters, 'offset')), is_of_wheels=False))
    return found


def _offset(parameters: dict[str, str], name: str) -> Pose:
    texts = (parameters.get(f'{each}_{name}', '0 0 0') for each in ('xyz', 'rpy'))
    try:
        return Pose(*pose_from_text(' '.join(texts), EULER_RPY))
    except PoseTextError:
        return Pose()
