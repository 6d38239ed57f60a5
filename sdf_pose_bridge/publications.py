# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The topics that say where frames are, latched for listeners that come later."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any
from typing import NamedTuple

from builtin_interfaces.msg import Time
from geometry_msgs.msg import PoseStamped
from geometry_msgs.msg import TransformStamped
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.logging import LoggingSeverity
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy
from rclpy.qos import HistoryPolicy
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from tf2_msgs.msg import TFMessage

from sdf_pose_bridge.messages import poses_from_tree
from sdf_pose_bridge.messages import tf_message_from_transforms
from sdf_pose_bridge.messages import transforms_from_tree
from sdf_pose_bridge.tf_tree import TfTree
from sdf_pose_bridge.topic_names import is_everything_too_much
from sdf_pose_bridge.topic_names import LONGEST_NAME
from sdf_pose_bridge.topic_names import MOST_BY_DEFAULT
from sdf_pose_bridge.topic_names import patterns_of_nothing
from sdf_pose_bridge.topic_names import topic_names_from_frame_ids

LONGEST_FULL_NAME = 246
"""Most characters that the middleware takes in the full name of a topic."""


class Outcome(NamedTuple):
    """What there is to know of a tree that was published."""

    transforms: int
    """How many transforms it has."""
    vanished: list[str]
    """The frames that had a transform before and have none now, sorted."""


class Publications:
    """
    Publishers of one node for the frames of a tree.

    :param node: the node that they belong to.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._tf_static = self._publisher(TFMessage, '/tf_static', depth=1)
        self._transforms: Publisher | None = None
        self._children: frozenset[str] = frozenset()
        self._poses: dict[str, Publisher] = {}
        self._stamp = Time()
        self._sent: list[tuple[Publisher, Any]] = []

    def publish(self, tree: TfTree, patterns: Sequence[str]) -> Outcome:
        """
        Publish a tree, in the place of the one before.

        :param tree: the tree.
        :param patterns: glob patterns for the frame ids that get a topic of their own.
        :return: what there is to know of it.
        """
        self._stamp = self._node.get_clock().now().to_msg()
        transforms = transforms_from_tree(tree, self._stamp)
        self._prepare_transforms_publisher(len(transforms))
        self._sent = [
            (self._tf_static, tf_message_from_transforms(transforms)),
            *((self._transforms, transform) for transform in transforms)]
        topics = self._topics_from_tree(tree, patterns)
        self._replace_pose_publishers(topics)
        rows = [row for row, frame_id in enumerate(tree.frame_ids) if frame_id in topics]
        messages = poses_from_tree(tree, rows, self._stamp)
        self._sent += [
            (self._poses[topics[tree.frame_ids[row]]], message)
            for row, message in zip(rows, messages, strict=True)]
        self._send()
        children = frozenset(each.child_frame_id for each in transforms)
        vanished = sorted(self._children - children)
        self._children = children
        return Outcome(len(transforms), vanished)

    def publish_again(self) -> None:
        """Publish what was published last once more, with new stamps."""
        now = self._node.get_clock().now().to_msg()
        # All messages hold this one stamp.
        self._stamp.sec, self._stamp.nanosec = now.sec, now.nanosec
        self._send()

    def _send(self) -> None:
        for publisher, message in self._sent:
            publisher.publish(message)

    def _prepare_transforms_publisher(self, count: int) -> None:
        # It keeps as many messages as there are transforms, so that the new ones push all the old
        # ones out. Another number needs another publisher, which knows nothing of the old ones.
        if count and count == len(self._children):
            return
        if self._transforms is not None:
            self._node.destroy_publisher(self._transforms)
        self._transforms = self._publisher(TransformStamped, '~/transforms', depth=max(1, count))

    def _topics_from_tree(self, tree: TfTree, patterns: Sequence[str]) -> dict[str, str]:
        if is_everything_too_much(tree.frame_ids, patterns):
            self._node.get_logger().warning(
                f'no ~/poses/... topics: {len(tree.frame_ids)} frames are more than '
                f'{MOST_BY_DEFAULT}; name those that you want in pose_topics, such as "robot/*", '
                'or ask for all with "?*"')
            return {}
        room = LONGEST_FULL_NAME - len(f'{self._node.get_fully_qualified_name()}/poses/')
        for pattern in patterns_of_nothing(tree.frame_ids, patterns):
            self._node.get_logger().warning(
                f'no ~/poses/... topics for "{pattern}" in pose_topics: no frame id matches it')
        try:
            return topic_names_from_frame_ids(
                tree.frame_ids, patterns, min(room, LONGEST_NAME))
        except ValueError:
            self._node.get_logger().warning(
                'no ~/poses/... topics: the name of the node and its namespace are so long that '
                'the names of topics would be longer than the middleware allows')
            return {}

    def _replace_pose_publishers(self, topics: dict[str, str]) -> None:
        wanted = set(topics.values())
        for name in [name for name in self._poses if name not in wanted]:
            self._node.destroy_publisher(self._poses.pop(name))
        logger = self._node.get_logger()
        is_debugged = logger.is_enabled_for(LoggingSeverity.DEBUG)
        for frame_id, name in topics.items():
            if name not in self._poses:
                self._poses[name] = self._publisher(PoseStamped, f'~/poses/{name}', depth=1)
            if is_debugged:
                logger.debug(f'frame "{frame_id}" has the topic ~/poses/{name}')

    def _publisher(self, message_type: type, name: str, *, depth: int) -> Publisher:
        quality = QoSProfile(
            history=HistoryPolicy.KEEP_LAST, depth=depth,
            reliability=ReliabilityPolicy.RELIABLE,
            durability=DurabilityPolicy.TRANSIENT_LOCAL)
        # The default callbacks only report listeners that ask for more than is offered, and there
        # is no more to offer; but each would be waited on, a thousand of them for a large scene.
        return self._node.create_publisher(
            message_type, name, quality,
            event_callbacks=PublisherEventCallbacks(use_default_callbacks=False))
