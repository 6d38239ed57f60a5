# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Topics of messages about joints and models: their subscriptions, and reading of messages."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, TransformStamped
from nav_msgs.msg import Odometry
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSPolicyKind, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

from sdf_pose_bridge.ros.cdr import joint_state_from_bytes, poses_from_bytes
from sdf_pose_bridge.ros.log_lines import names_in_line
from sdf_pose_bridge.ros.state_messages import (
    add_newest,
    Effect,
    Effects,
    Message,
    StateSource,
)
from sdf_pose_bridge.ros.wait_set import NoExecutor, take_message

MOST_WAITING = 100
"""Largest number of messages that wait in a subscription; then new ones replace the oldest."""


class PoseType(NamedTuple):
    """A type of messages with poses of models."""

    message_class: type
    has_child: bool
    """Whether it has a child frame id."""
    is_sequence: bool = False
    """Whether it has many poses, each of the model that its child frame id names."""


POSE_TYPES = {
    'geometry_msgs/msg/PoseStamped': PoseType(PoseStamped, has_child=False),
    'geometry_msgs/msg/PoseWithCovarianceStamped': PoseType(
        PoseWithCovarianceStamped, has_child=False),
    'geometry_msgs/msg/TransformStamped': PoseType(TransformStamped, has_child=True),
    'nav_msgs/msg/Odometry': PoseType(Odometry, has_child=True),
    'tf2_msgs/msg/TFMessage': PoseType(TFMessage, has_child=True, is_sequence=True),
}


JOINT_STATE = 'sensor_msgs/msg/JointState'


class TopicKey(NamedTuple):
    """A topic of a node, and its type."""

    name: str
    """The name of the topic, before it is remapped."""
    model: str
    """The model that the messages are about; empty for any."""
    type_name: str
    """:data:`JOINT_STATE`, or one of :data:`POSE_TYPES`."""


class StateTopic(StateSource):
    """A topic of messages about joints or models."""

    def __init__(self, node: Node, key: TopicKey, message_class: type) -> None:
        self.model = key.model
        # A best effort and volatile subscription is compatible with every publisher, so there is
        # nothing to report unless parameters change that.
        self.subscription = node.create_subscription(
            message_class, key.name, lambda _: None,
            QoSProfile(depth=MOST_WAITING, reliability=ReliabilityPolicy.BEST_EFFORT),
            callback_group=NoExecutor(), raw=True,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
            # Without the depth, which the node chooses.
            qos_overriding_options=QoSOverridingOptions((
                QoSPolicyKind.RELIABILITY, QoSPolicyKind.DURABILITY)))
        super().__init__(node, self.subscription.topic_name)

    def take(  # noqa: D102 - as in the base class
        self, effects: Effects, newest: dict[Effect, Message],
    ) -> bool:
        data = take_message(self.subscription)
        if data is not None:
            add_newest(self.read(data, effects), newest)
        return data is not None

    def read(self, data: bytes, effects: Effects) -> Sequence[Message]:
        """Read a serialized message; return nothing, with a warning, if it cannot be used."""
        try:
            return self._messages(data, effects)
        except ValueError as error:
            reason = str(error)
            self.warn('message', lambda: f'a message on {self.name} is ignored: {reason}')
            return ()

    def _messages(self, data: bytes, effects: Effects) -> Sequence[Message]:
        raise NotImplementedError


class JointStateTopic(StateTopic):
    """A topic of joint states; its model is a top-level model of a world."""

    def __init__(self, node: Node, key: TopicKey) -> None:
        super().__init__(node, key, JointState)

    def _messages(self, data: bytes, effects: Effects) -> Sequence[Message]:
        effect = effects.last.get(self.name)
        stamp_ns, names, positions = joint_state_from_bytes(
            data, None if effect is None else effect.names)
        if effect is None or names is not effect.names:
            effect, unknown = effects.find(names, self, self.model)
            if unknown:
                where = f' in model "{self.model}"' if self.model else ''
                self.warn('names', lambda: (
                    f'{self.name} has {names_in_line(unknown)}, not the name of one moving joint'
                    f'{where}{effects.positions.hint(unknown[0], self.model)}'))
        return (Message(self, effect, positions, stamp_ns),)


class ModelPoseTopic(StateTopic):
    """A topic of poses of models; its model is a free model."""

    def __init__(self, node: Node, key: TopicKey) -> None:
        self._type = POSE_TYPES[key.type_name]
        super().__init__(node, key, self._type.message_class)

    def _messages(self, data: bytes, effects: Effects) -> Sequence[Message]:
        poses = poses_from_bytes(
            data, has_child=self._type.has_child, is_sequence=self._type.is_sequence)
        if self._type.is_sequence:
            return self.messages_from_poses(poses, effects)
        dof = effects.models.get(self.model) if self.model else effects.only_model
        if dof is None:
            msg = 'no single model is meant; {model} in its entry of model_pose_topics names one'
            raise ValueError(msg)
        return self.messages_from_poses(poses, effects, dof)


def state_topic(node: Node, key: TopicKey) -> StateTopic:
    """Subscribe to a topic."""
    return (JointStateTopic if key.type_name == JOINT_STATE else ModelPoseTopic)(node, key)
