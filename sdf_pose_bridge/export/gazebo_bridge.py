# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Choose the parameters with which the node follows the topics that ros_gz_bridge passes on."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from sdf_pose_bridge.export.published_scene import LoadRequest
from sdf_pose_bridge.sdformat.gazebo_topics import GROUPS, is_true
from sdf_pose_bridge.tf.bridged_topics import BridgedTopic


class FollowedTopics(NamedTuple):
    """Parameters of the node for the messages that it follows, with their default values."""

    use_joint_states: bool = False
    joint_states_topics: Sequence[str] = ('joint_states', '{model}/joint_states')
    model_pose_topics: Sequence[str] = ()
    model_pose_frames: Sequence[str] = ()


def node_parameters(request: LoadRequest, followed: FollowedTopics) -> dict[str, object]:
    """Return the parameters of the node that differ from their default values, by their names."""
    return {'use_sim_time': True} | {
        name: value for record in (request, followed) for name, value in record._asdict().items()
        if value != record._field_defaults.get(name, '')}


def followed_topics(topics: Sequence[BridgedTopic], world: str = '') -> FollowedTopics:
    """
    Choose the topics that the node follows.

    :param world: the world in Gazebo, for a model file.
    """
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
    return FollowedTopics(
        use_joint_states=bool(joints),
        joint_states_topics=tuple(sorted(joints)) or FollowedTopics().joint_states_topics,
        model_pose_topics=tuple(sorted(poses)),
        model_pose_frames=(world,) if world and has_poses else ())
