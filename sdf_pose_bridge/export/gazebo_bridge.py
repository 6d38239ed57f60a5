# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Choose the parameters with which the node follows the topics that ros_gz_bridge passes on."""

from __future__ import annotations

from collections.abc import Sequence

from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.gazebo_topics import GROUPS, is_true
from sdf_pose_bridge.tf.bridged_topics import BridgedTopic


def node_parameters(
    topics: Sequence[BridgedTopic], scene: Scene, world: str = '',
) -> dict[str, object]:
    """Return the parameters with which the node follows topics, found with the same arguments."""
    joints = {each.pattern for each in topics if each.topic.group == 'joints'}
    sources = sorted(
        (each for each in topics if each.places_model),
        # Before Harmonic 8.10, PosePublisher needs this option for the pose of its own model, too.
        key=lambda each: (
            bool(each.doubt), each.topic.is_of_wheels, each.topic.group == 'poses' and not is_true(
                each.owners[0].values, 'publish_nested_model_pose'),
            GROUPS.index(each.topic.group)))
    followed = {each.owners[0].free_model: each for each in reversed(sources)}
    # A pattern must not name the second source of another model.
    others = {each.pattern for each in sources
              if each is not followed[each.owners[0].free_model]}
    poses = {each.ros_name if each.pattern in others else each.pattern
             for each in followed.values()}
    has_poses = any(each.topic.group == 'poses' for each in followed.values())
    return {
        'use_sim_time': True,
        'model_name': '' if scene.world_names else scene.names[1],
        'use_joint_states': bool(joints),
        'joint_states_topics': sorted(joints),
        'model_pose_topics': sorted(poses),
        'model_pose_frames': [world] if world and has_poses else []}
