# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Choose the parameters with which the node follows the topics that ros_gz_bridge passes on."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.gazebo_topics import GROUPS, is_true
from sdf_pose_bridge.tf.bridged_topics import BridgedTopic
from sdf_pose_bridge.tf.joint_positions import leading_dofs
from sdf_pose_bridge.tf.parents import tf_parents_from_scene


def followed_topics(
    scene: Scene, topics: Sequence[BridgedTopic], world: str = '',
) -> dict[str, object]:
    """
    Choose the topics that the node follows; patterns if they are about all that moves.

    :param world: the world in Gazebo, for a model file.
    :return: parameters of the node by their names; what is empty is not set.
    """
    joints = {model: each for each in topics if each.topic.group == 'joints'
              for model in each.models}
    sources = sorted(
        (each for each in topics if each.models and each.topic.group != 'joints'),
        # Before Harmonic 8.10, PosePublisher needs this option for the pose of its own model, too.
        key=lambda each: (
            bool(each.doubt), each.topic.is_of_wheels, each.topic.group == 'poses' and not is_true(
                each.owners[0].values, 'publish_nested_model_pose'),
            GROUPS.index(each.topic.group)))
    poses = {model: each for each in reversed(sources) for model in each.models}
    chosen = {each.ros_name for each in poses.values()}
    others = {each.pattern for each in sources if each.ros_name not in chosen}
    models = tf_parents_from_scene(scene).with_free_models(scene).free_models.values()
    has_poses = any(each.topic.group == 'poses' for each in poses.values())
    return {
        'use_joint_states': bool(joints),
        'joint_states_topics': _names(joints, {
            scene.parents.item(each.joint.element) for each in leading_dofs(scene)}),
        'model_pose_topics': _names(poses, models, others),
        'model_pose_frames': [world] if world and has_poses else []}


def _names(
    topics: Mapping[int, BridgedTopic], models: Collection[int], others: Collection[str] = (),
) -> list[str]:
    # A pattern must not name a topic of other models, or a second source of a model.
    patterns = {each.pattern for each in topics.values()}
    are_all = topics.keys() >= {*models} and all(each.model for each in topics.values())
    return sorted(patterns if are_all and patterns.isdisjoint(others) else {
        each.ros_name for each in topics.values()})
