# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The joints and models that follow messages, among all that can move."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.names import WORLD_FRAME
from sdf_pose_bridge.scene.scene import Joint, Scene
from sdf_pose_bridge.sdformat.gazebo_topics import STATE_GROUPS
from sdf_pose_bridge.tf.bridged_topics import bridged_topics, BridgedTopic
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.joint_motion import JointMotion
from sdf_pose_bridge.tf.parents import TfParents


class Followed(NamedTuple):
    """Joints and models that follow messages."""

    tf_parents: TfParents
    """The parents in TF, where free models follow messages."""
    joints: Mapping[int, Joint]
    """The joints that follow messages, by the bodies at their ends."""
    topics: Sequence[BridgedTopic]
    """The topics of plugins in the file."""
    every: TfParents
    """The parents in TF if each model that can move freely did so."""

    def at_rest(
        self, scene: Scene, is_inside: NDArray[np.bool_], frame_names: FrameNames,
    ) -> tuple[Sequence[str], Sequence[str]]:
        """
        Return names of the joints and of the models that could move, but follow no messages.

        :param is_inside: for each element whether it is published.
        """
        if self.every is self.tf_parents and len(self.joints) == len(self.every.joints):
            return [], []
        motion = JointMotion(scene, self.every, frame_names)
        moving = {*self.tf_parents.free_models.values(),
                  *(each.element for each in self.joints.values())}
        joints = {each.joint.element: each.name for each in reversed(motion.dofs)
                  if is_inside[each.joint.element] and each.axis.mimic is None}
        count = len(motion.dofs)
        models = zip(motion.elements[count:], motion.names[count:], strict=True)
        return ([joints[each] for each in sorted(joints) if each not in moving],
                [name for each, name in models if each not in moving])


def followed_from_topics(
    scene: Scene, tf_parents: TfParents, is_detached: NDArray[np.bool_], only_model: str,
    joint_topics: Sequence[str] | None, pose_topics: Sequence[str] | None,
) -> Followed:
    """
    Find the joints and models that topics are about: all, unless all topics are those of plugins.

    :param is_detached: as for :meth:`TfParents.with_free_models`, and so is ``only_model``.
    :param joint_topics: the topics of joint states; None if no joint follows messages.
    :param pose_topics: the topics of poses, or none if a simulator gives them; None if no model
        follows messages.
    """
    follows_any = joint_topics is not None or pose_topics is not None
    topics = bridged_topics(
        scene, STATE_GROUPS, WORLD_FRAME) if follows_any and scene.plugins else []
    owners, models = (_models_on(each or (), topics) for each in (joint_topics, pose_topics))
    joints = {body: each for body, each in tf_parents.joints.items() if joint_topics is not None
              and (owners is None or scene.parents.item(each.element) in owners)}
    every = tf_parents if pose_topics is None else (
        tf_parents.with_free_models(scene, is_detached, only_model))
    return Followed(
        every if models is None else (
            tf_parents.with_free_models(scene, is_detached, only_model, models)),
        joints, topics, every)


def _models_on(names: Sequence[str], topics: Sequence[BridgedTopic]) -> frozenset[int] | None:
    """Return the models that topics of plugins are about; None if any name is another topic's."""
    models = {name: each.models for each in topics for name in (each.ros_name, each.gz_name)}
    return frozenset().union(*(models[name] for name in names)) if (
        names and models.keys() >= {*names}) else None
