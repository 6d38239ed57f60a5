# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The topics that say where frames are, latched for listeners that come later."""

from __future__ import annotations

from collections.abc import Generator
from collections.abc import Sequence
from typing import NamedTuple

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

from sdf_pose_bridge.poses import PoseArray
from sdf_pose_bridge.tf_message_bytes import pose_stamped_bytes
from sdf_pose_bridge.tf_message_bytes import StampedBytes
from sdf_pose_bridge.tf_message_bytes import tf_message_bytes
from sdf_pose_bridge.tf_message_bytes import transform_stamped_bytes
from sdf_pose_bridge.tf_tree import TfTree
from sdf_pose_bridge.topic_names import is_everything_too_much
from sdf_pose_bridge.topic_names import LONGEST_NAME
from sdf_pose_bridge.topic_names import MOST_BY_DEFAULT
from sdf_pose_bridge.topic_names import patterns_of_nothing
from sdf_pose_bridge.topic_names import topic_names_from_frame_ids

LONGEST_FULL_NAME = 246
"""Most characters that the middleware takes in the full name of a topic."""

SENT_IN_STEP = 200
"""How many messages are sent in one step, which is a matter of milliseconds."""

MADE_IN_STEP = 10
"""How many publishers are made or destroyed in one step."""


class Outcome(NamedTuple):
    """What there is to know of a tree that was published."""

    transforms: int
    """How many transforms it has."""
    vanished: list[str]
    """The frames that had a transform before and have none now, sorted."""


class _Transforms(NamedTuple):
    """The transforms of a tree, which not every frame has."""

    parent_ids: Sequence[str]
    child_ids: Sequence[str]
    poses: PoseArray

    @classmethod
    def from_tree(cls, tree: TfTree) -> _Transforms:
        if '' not in tree.parent_ids:
            return cls(tree.parent_ids, tree.frame_ids, tree.transforms)
        rows = [row for row, parent_id in enumerate(tree.parent_ids) if parent_id]
        return cls(
            [tree.parent_ids[row] for row in rows], [tree.frame_ids[row] for row in rows],
            tree.transforms[rows])


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
        self._sent: list[tuple[Sequence[Publisher], StampedBytes]] = []
        self._announced: TfTree | None = None

    def publish_tf_static(self, tree: TfTree) -> None:
        """
        Publish the one message that most listeners wait for, before all others.

        :param tree: a tree that :meth:`publish` is going to be called with.
        """
        transforms = _Transforms.from_tree(tree)
        self._announced = tree
        self._sent = []
        messages = tf_message_bytes(*transforms)
        self._sent.append(([self._tf_static], messages))
        (data,) = messages.at(*self._now())
        self._tf_static.publish(data)

    def publish(
        self, tree: TfTree, patterns: Sequence[str],
    ) -> Generator[None, None, Outcome]:
        """
        Publish a tree, in the place of the one before, in steps of milliseconds.

        The first step has ``/tf_static``. All of them must be taken before anything else is asked.

        :param tree: the tree.
        :param patterns: glob patterns for the frame ids that get a topic of their own.
        :return: what there is to know of it.
        """
        if tree is not self._announced:
            self.publish_tf_static(tree)
            yield
        del self._sent[1:]
        now = self._now()
        transforms = _Transforms.from_tree(tree)
        count = len(transforms.child_ids)
        publisher = self._transforms_publisher(count)
        yield from self._send_also([publisher] * count, transform_stamped_bytes(*transforms), now)
        topics = self._topics_from_tree(tree, patterns)
        yield from self._replace_pose_publishers(topics)
        rows = [row for row, frame_id in enumerate(tree.frame_ids) if frame_id in topics]
        yield from self._send_also(
            [self._poses[topics[tree.frame_ids[row]]] for row in rows],
            pose_stamped_bytes([tree.root_frame] * len(rows), tree.poses[rows]), now)
        children = frozenset(transforms.child_ids)
        vanished = sorted(self._children - children)
        self._children = children
        return Outcome(count, vanished)

    def publish_again(self) -> Generator[None, None, None]:
        """Publish what was published last once more, with new stamps, in such steps."""
        now = self._now()
        for publishers, messages in self._sent:
            yield from _sent(publishers, messages, now)

    def _now(self) -> tuple[int, int]:
        seconds, nanoseconds = self._node.get_clock().now().seconds_nanoseconds()
        return seconds, nanoseconds

    def _send_also(
        self, publishers: Sequence[Publisher], messages: StampedBytes, stamp: tuple[int, int],
    ) -> Generator[None, None, None]:
        self._sent.append((publishers, messages))
        yield from _sent(publishers, messages, stamp)

    def _transforms_publisher(self, count: int) -> Publisher:
        # It keeps as many messages as there are transforms, so that the new ones push all the old
        # ones out. Another number needs another publisher, which knows nothing of the old ones.
        if self._transforms is None or count != len(self._children) or not count:
            if self._transforms is not None:
                self._node.destroy_publisher(self._transforms)
            self._transforms = self._publisher(
                TransformStamped, '~/transforms', depth=max(1, count))
        return self._transforms

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

    def _replace_pose_publishers(self, topics: dict[str, str]) -> Generator[None, None, None]:
        wanted = set(topics.values())
        for number, name in enumerate([name for name in self._poses if name not in wanted]):
            if not number % MADE_IN_STEP:
                yield
            self._node.destroy_publisher(self._poses.pop(name))
        logger = self._node.get_logger()
        is_debugged = logger.is_enabled_for(LoggingSeverity.DEBUG)
        for frame_id, name in topics.items():
            if name not in self._poses:
                if not len(self._poses) % MADE_IN_STEP:
                    yield
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


def _sent(
    publishers: Sequence[Publisher], messages: StampedBytes, stamp: tuple[int, int],
) -> Generator[None, None, None]:
    # To lay out many messages took as long as a step.
    yield
    pairs = zip(publishers, messages.at(*stamp), strict=True)
    for number, (publisher, message) in enumerate(pairs, start=1):
        publisher.publish(message)
        if not number % SENT_IN_STEP:
            yield
