# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Topics of messages about joints and models: their subscriptions, and reading of messages."""

from __future__ import annotations

from collections.abc import Sequence
import importlib
from typing import NamedTuple

from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSPolicyKind, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions

from sdf_pose_bridge.ros.cdr import joint_state_from_bytes, POSE_TYPES, poses_from_bytes, PoseType
from sdf_pose_bridge.ros.following.model_poses import messages_from_poses
from sdf_pose_bridge.ros.following.state_messages import KnownStreams, Message, StateSource
from sdf_pose_bridge.ros.following.wait_set import NoExecutor, take_message

MOST_WAITING = 100
"""Largest number of messages that wait in a subscription; then new ones replace the oldest."""


class TopicKey(NamedTuple):
    """A topic of a node, and its type."""

    name: str
    """The name of the topic, before it is remapped."""
    model: str
    """The top-level model of joint states, or the free model of poses; empty for any."""
    type_name: str
    """``JOINT_STATE``, or one of :data:`POSE_TYPES`."""
    is_latched: bool = False
    """Whether the subscription gets what was published before it, by latched publishers only."""


class StateTopic(StateSource):
    """A topic of messages about joints or models."""

    def __init__(self, node: Node, key: TopicKey) -> None:
        self._pose_type = POSE_TYPES.get(key.type_name)
        self.is_of_joints = self._pose_type is None
        package, _, name = key.type_name.split('/')
        # A best effort and volatile subscription is compatible with every publisher, so there is
        # nothing to report unless parameters change that. A latched one is beside such a one.
        qos = QoSProfile(depth=MOST_WAITING, reliability=ReliabilityPolicy.BEST_EFFORT)
        if key.is_latched:
            qos.reliability = ReliabilityPolicy.RELIABLE
            qos.durability = DurabilityPolicy.TRANSIENT_LOCAL
        self.subscription = node.create_subscription(
            getattr(importlib.import_module(f'{package}.msg'), name), key.name, lambda _: None,
            qos, callback_group=NoExecutor(), raw=True,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
            # Without the depth, which the node chooses.
            qos_overriding_options=None if key.is_latched else QoSOverridingOptions((
                QoSPolicyKind.RELIABILITY, QoSPolicyKind.DURABILITY)))
        super().__init__(node, self.subscription.topic_name, key.model)

    def messages(self, streams: KnownStreams) -> Sequence[Message] | None:  # noqa: D102 - as above
        taken = take_message(self.subscription)
        if taken is None:
            return None
        data, self.number = taken
        return self.read(data, streams)

    def read(self, data: bytes, streams: KnownStreams) -> Sequence[Message]:
        """Read a serialized message; return nothing, with a warning, if it cannot be used."""
        try:
            if self._pose_type is None:
                return (self._joint_states(data, streams),)
            return self._poses(data, self._pose_type, streams)
        except ValueError as error:
            reason = str(error)
            self.warn('message', lambda: f'a message on {self.name} is ignored: {reason}')
            return ()

    def _joint_states(self, data: bytes, streams: KnownStreams) -> Message:
        stream = streams.last.get(self)
        stamp_ns, names, positions = joint_state_from_bytes(
            data, None if stream is None else stream.names)
        if stream is None or names is not stream.names:
            stream = streams.of_joints(names, self)
        return Message(stream, positions, stamp_ns)

    def _poses(self, data: bytes, pose_type: PoseType, streams: KnownStreams) -> Sequence[Message]:
        dof = None
        if not pose_type.is_sequence:
            dof = streams.models.get(self.model) if self.model else streams.only_model
            if dof is None and not pose_type.has_child:
                msg = ('no single model is meant; {model} in its entry of model_pose_topics '
                       'names one')
                raise ValueError(msg)
        return messages_from_poses(
            poses_from_bytes(data, pose_type), self, streams, dof, streams.placements)
