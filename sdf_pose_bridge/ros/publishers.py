# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Publish the frames of a TF tree on latched topics."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Mapping
from collections.abc import Sequence
from itertools import compress

from geometry_msgs.msg import PoseStamped
from geometry_msgs.msg import TransformStamped
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.event_handler import QoSPublisherMatchedInfo
from rclpy.logging import LoggingSeverity
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy
from rclpy.qos import HistoryPolicy
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from tf2_msgs.msg import TFMessage

from sdf_pose_bridge.ros.background import run_other_callbacks
from sdf_pose_bridge.ros.cdr import pose_stamped_messages
from sdf_pose_bridge.ros.cdr import StampedMessages
from sdf_pose_bridge.ros.cdr import tf_message
from sdf_pose_bridge.ros.cdr import transform_stamped_messages
from sdf_pose_bridge.tf.parents import NO_PARENT
from sdf_pose_bridge.tf.tree import TfTree

# How many can be published, or made, in the milliseconds that other callbacks can wait.
MESSAGES_AT_ONCE = 500
PUBLISHERS_AT_ONCE = 40


class FramePublishers:
    """
    Publishers of the frames of a tree: ``/tf_static``, ``~/transforms`` and ``~/poses/...``.

    :param node: the node that they belong to.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._tf_static = latched_publisher(node, TFMessage, '/tf_static', depth=1)
        self._transforms: Publisher | None = None
        self._depth = 0
        self._poses: dict[str, Publisher] = {}
        self._topics: Mapping[str, str] = {}
        self._children: frozenset[str] = frozenset()
        self._published: list[tuple[Sequence[Publisher], StampedMessages]] = []

    def publish_tf_static(self, tree: TfTree) -> None:
        """
        Publish a tree on ``/tf_static``; :meth:`publish_topics` must follow.

        :param tree: the tree.
        """
        self._tree = tree
        self._tf_message = tf_message(
            *tree.ids_of_transforms(tree.fixed_indices), tree.transforms[tree.fixed_indices])
        self.publish_tf_static_again()

    async def publish_topics(self, topics: Mapping[str, str]) -> list[str]:
        """
        Publish the tree on all other topics, with the stamp that it has on ``/tf_static``.

        Frames that joints move get publishers here, and messages by others.

        :param topics: names of pose topics by frame id.
        :return: the frames that had a transform before and have none now, sorted.
        """
        tree, self._published = self._tree, []
        indices = tree.fixed_indices
        publisher = self._transforms_publisher(len(indices))
        self._published.append((
            [publisher] * len(indices),
            transform_stamped_messages(
                *tree.ids_of_transforms(indices), tree.transforms[indices])))
        await self._send(*self._published[-1])
        await self._replace_pose_publishers(topics)
        self._topics = topics
        moving = set() if tree.moving is None else set(tree.moving.posed_indices.tolist())
        posed = [
            (index, self._poses[topics[frame_id]]) for index, frame_id in enumerate(tree.frame_ids)
            if frame_id in topics and index not in moving]
        poses = tree.poses[[index for index, _ in posed]]
        self._published.append((
            [publisher for _, publisher in posed],
            pose_stamped_messages([tree.root_frame] * len(posed), poses)))
        await self._send(*self._published[-1])
        before = self._children
        self._children = frozenset(compress(tree.frame_ids, (tree.parents != NO_PARENT).tolist()))
        return sorted(before - self._children)

    def pose_publisher(self, frame_id: str) -> Publisher | None:
        """
        Return the publisher of the pose of a frame.

        :param frame_id: a frame of the tree.
        :return: the publisher; None if the frame has no topic.
        """
        return self._poses.get(self._topics.get(frame_id, ''))

    def publish_tf_static_again(self) -> None:
        """Publish the tree on ``/tf_static`` with a new stamp."""
        self._stamp: tuple[int, int] = self._node.get_clock().now().seconds_nanoseconds()
        (message,) = self._tf_message.with_stamp(*self._stamp)
        self._tf_static.publish(message)

    async def publish_again(self) -> None:
        """Publish everything again with a new stamp."""
        self.publish_tf_static_again()
        for publishers, messages in self._published:
            await self._send(publishers, messages)

    async def _send(self, publishers: Sequence[Publisher], messages: StampedMessages) -> None:
        await run_other_callbacks(self._node)
        pairs = zip(publishers, messages.with_stamp(*self._stamp), strict=True)
        for number, (publisher, message) in enumerate(pairs, start=1):
            publisher.publish(message)
            if number % MESSAGES_AT_ONCE == 0:
                await run_other_callbacks(self._node)

    def _transforms_publisher(self, count: int) -> Publisher:
        # It keeps as many messages as there are transforms, so new messages replace all old ones.
        # For another number there is another publisher, which does not keep the old messages.
        if self._transforms is None or count != self._depth:
            if self._transforms is not None:
                self._node.destroy_publisher(self._transforms)
            self._transforms = latched_publisher(
                self._node, TransformStamped, '~/transforms', depth=max(1, count))
            self._depth = count
        return self._transforms

    async def _replace_pose_publishers(self, topics: Mapping[str, str]) -> None:
        wanted = set(topics.values())
        for number, name in enumerate([name for name in self._poses if name not in wanted]):
            if number % PUBLISHERS_AT_ONCE == 0:
                await run_other_callbacks(self._node)
            self._node.destroy_publisher(self._poses.pop(name))
        logger = self._node.get_logger()
        is_debugged = logger.is_enabled_for(LoggingSeverity.DEBUG)
        for frame_id, name in topics.items():
            if name not in self._poses:
                if len(self._poses) % PUBLISHERS_AT_ONCE == 0:
                    await run_other_callbacks(self._node)
                self._poses[name] = latched_publisher(
                    self._node, PoseStamped, f'~/poses/{name}', depth=1)
            if is_debugged:
                logger.debug(f'frame "{frame_id}" has the topic ~/poses/{name}')


def latched_publisher(
    node: Node, message_type: type, name: str, *, depth: int,
    matched: Callable[[QoSPublisherMatchedInfo], None] | None = None,
) -> Publisher:
    """
    Make a publisher whose last messages also reach listeners that come later.

    :param node: the node that it belongs to.
    :param message_type: class of the messages.
    :param name: name of the topic.
    :param depth: how many messages it keeps.
    :param matched: called when a listener comes or goes.
    :return: the publisher.
    """
    quality = QoSProfile(
        history=HistoryPolicy.KEEP_LAST, depth=depth,
        reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL)
    # The default callbacks only report listeners that ask for more than is offered, and more
    # cannot be offered; but the executor waits for each, a thousand of them in a large scene.
    return node.create_publisher(
        message_type, name, quality,
        event_callbacks=PublisherEventCallbacks(matched=matched, use_default_callbacks=False))
