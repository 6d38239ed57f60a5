# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Find the frames in which plugins of Gazebo send the odometry of their models.

The odometry of wheels is zero where the model was spawned. OdometryPublisher sends a pose in the
world, with offsets. Source: ``UpdateOdometry`` of their classes in gz-sim 8 to 10.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from sdf_pose_bridge.geometry.pose_attributes import PoseTextError
from sdf_pose_bridge.geometry.poses import Pose, pose_inverse
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.poses import EULER_RPY, pose_from_text
from sdf_pose_bridge.tf.bridged_topics import BridgedTopic
from sdf_pose_bridge.tf.joint_motion import JointMotion


class Odometry(NamedTuple):
    """A frame of odometry."""

    pose: Pose
    """Its pose in the root."""
    model: Pose
    """The pose of the model of the plugin in the frame whose pose is sent."""
    is_of_wheels: bool
    nested_model: str = ''
    """The scoped name of this model if it is not the free model, but moves with it."""


def odometry_from_scene(
    scene: Scene, topics: Sequence[BridgedTopic], motion: JointMotion, problems: Problems,
) -> dict[tuple[int, str, str], Odometry]:
    """
    Find the frames of the odometry of free models.

    :param topics: the topics of the plugins in the scene.
    :param problems: takes warnings about topics of several plugins.
    :return: the frames, by the degrees of freedom of free models, the frame ids in messages, and
        the topics in ROS and in Gazebo; with an empty topic the first one for any other.
    """
    dofs = {element: dof for dof, element in enumerate(motion.elements)}
    found: dict[tuple[int, str, str], Odometry] = {}
    for bridged in topics:
        if bridged.doubt and bridged.topic.group == 'odometry':
            problems.warning(bridged.doubt.message, bridged.doubt.place)
        for element, free_model, _, topic, values in bridged.owners:
            if free_model not in dofs or not topic.odometry_frame:
                continue
            frame_id = values.get(topic.odometry_frame, f'{scene.own_name(element)}/odom')
            # A spawned model is not where its own file puts it.
            start = scene.pose_of(element) if scene.world_of(element) else (
                scene.relative_pose_of(element, scene.top_level_element(element)))
            odometry = Odometry(start, Pose(), is_of_wheels=True) if topic.is_of_wheels else (
                Odometry(_offset(values, 'global_offset'),
                         pose_inverse(_offset(values, 'offset')), is_of_wheels=False))
            if element != free_model:
                odometry = odometry._replace(nested_model=scene.names[element])
            for name in ('', bridged.ros_name, bridged.gz_name):
                key = dofs[free_model], frame_id.replace(SEPARATOR, '/'), name
                found.setdefault(key, odometry)
    return found


def _offset(parameters: Mapping[str, str], name: str) -> Pose:
    texts = (parameters.get(f'{each}_{name}', '0 0 0') for each in ('xyz', 'rpy'))
    try:
        return pose_from_text(' '.join(texts), EULER_RPY)[0]
    except PoseTextError:
        return Pose()
