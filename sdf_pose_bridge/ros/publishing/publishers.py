# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The publishers of a node."""

from __future__ import annotations

from collections import deque
from collections.abc import Collection
from typing import NamedTuple

from rclpy.event_handler import PublisherEventCallbacks
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions

from sdf_pose_bridge.ros.parameters.rules import MOST_TOPICS

MOST_PUBLISHERS = MOST_TOPICS + 10
"""The recipes for networks in docs/ros_interface.md were measured with so many: the topics of
poses, and a few others."""


class Topic(NamedTuple):
    """A topic with the settings of its publisher. Equal topics share a publisher."""

    name: str
    message_type: type
    depth: int = 1
    """Number of messages that the publisher keeps."""
    is_latched: bool = True
    """Whether later listeners receive these messages."""
    part: str = ''
    """Distinguishes publishers on one topic."""
    is_overridable: bool = False
    """Whether parameters can override its quality of service."""


class Publishers:
    """The publishers of a node, by their topics."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._publishers: dict[Topic, Publisher] = {}
        self.static_stamps_ns: deque[int] = deque(maxlen=1000)
        """The last stamps on ``/tf_static``, in nanoseconds."""

    def now_ns(self) -> int:
        """Return the time of the node in nanoseconds."""
        time_ns: int = self._node.get_clock().now().nanoseconds
        return time_ns

    def existing(self, topic: Topic) -> Publisher | None:
        """Return the publisher of a topic if there is one."""
        return self._publishers.get(topic)

    def opened(self, topic: Topic) -> Publisher:
        """Return the publisher of a topic; make it if there is none."""
        publisher = self._publishers.get(topic)
        if publisher is None:
            publisher = self._publishers[topic] = new_publisher(self._node, topic)
        return publisher

    def destroy_others(self, topics: Collection[Topic]) -> None:
        """
        Destroy all publishers but those of these topics.

        If there are more than :data:`MOST_PUBLISHERS`, a warning is logged once.
        """
        for topic in self._publishers.keys() - topics:
            self._node.destroy_publisher(self._publishers.pop(topic))
        if len(self._publishers) > MOST_PUBLISHERS:
            self._node.get_logger().warning(
                f'{len(self._publishers)} publishers are more than {MOST_PUBLISHERS}, the most '
                'that was measured over networks; listeners may wait long for their first '
                'message: choose fewer topics with pose_topics', once=True)


def new_publisher(node: Node, topic: Topic) -> Publisher:
    """Make a reliable publisher; any thread can do this."""
    quality = QoSProfile(
        history=HistoryPolicy.KEEP_LAST, depth=topic.depth, reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if topic.is_latched
        else DurabilityPolicy.VOLATILE)
    # The default callbacks only report incompatible listeners, and the executor would wait for
    # each of them, a thousand in a large scene, while another thread destroys its publisher.
    return node.create_publisher(
        topic.message_type, topic.name, quality,
        qos_overriding_options=QoSOverridingOptions.with_default_policies()
        if topic.is_overridable else None,
        event_callbacks=PublisherEventCallbacks(use_default_callbacks=False))


class SwitchedPublisher:
    """The publisher of a topic that exists while it is switched on."""

    def __init__(self, node: Node, topic: Topic) -> None:
        self._node, self._topic = node, topic
        self._publisher: Publisher | None = None

    def switch(self, *, on: bool) -> None:
        """Make the publisher or destroy it. Then nobody gets an old message."""
        if on and self._publisher is None:
            self._publisher = new_publisher(self._node, self._topic)
        elif not on and self._publisher is not None:
            self._node.destroy_publisher(self._publisher)
            self._publisher = None

    @property
    def is_on(self) -> bool:
        """Whether it is switched on."""
        return self._publisher is not None

    def publish(self, message: object) -> None:
        """Publish a message if it is switched on."""
        if self._publisher is not None:
            self._publisher.publish(message)

    def has_listeners(self) -> bool:
        """Return whether it is switched on and somebody listens."""
        return self._publisher is not None and self._publisher.get_subscription_count() > 0
