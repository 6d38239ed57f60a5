# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The topics that say where frames are, latched for listeners that come later."""

from __future__ import annotations

from collections.abc import Generator
from collections.abc import Sequence
from typing import NamedTuple

from geometry_msgs.msg import PoseStamped
from geometry_msgs.msg import TransformStamped
from rclpy.logging import LoggingSeverity
from rclpy.node import Node
from rclpy.publisher import Publisher

from sdf_pose_bridge.ros.cdr import pose_stamped_bytes
from sdf_pose_bridge.ros.cdr import StampedBytes
from sdf_pose_bridge.ros.cdr import transform_stamped_bytes
from sdf_pose_bridge.ros.log_lines import names_in_line
from sdf_pose_bridge.ros.tf_static import latched_publisher
from sdf_pose_bridge.ros.tf_static import TfStatic
from sdf_pose_bridge.ros.topic_names import is_everything_too_much
from sdf_pose_bridge.ros.topic_names import LONGEST_NAME
from sdf_pose_bridge.ros.topic_names import MOST_BY_DEFAULT
from sdf_pose_bridge.ros.topic_names import topics_from_patterns
from sdf_pose_bridge.tf.tree import TfTree

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


class Publications:
    """
    Publishers of one node for the frames of a tree.

    :param node: the node that they belong to.
    :param tf_static: the first of them, which may have published a tree already.
    """

    def __init__(self, node: Node, tf_static: TfStatic) -> None:
        self._node = node
        self._tf_static = tf_static
        self._transforms: Publisher | None = None
        self._children: frozenset[str] = frozenset()
        self._poses: dict[str, Publisher] = {}
        self._sent: list[tuple[Sequence[Publisher], StampedBytes]] = []

    def publish(
        self, tree: TfTree, patterns: Sequence[str],
    ) -> Generator[None, None, Outcome]:
        """
        Publish a tree, in the place of the one before, in steps of milliseconds.

        The first step has ``/tf_static``, and the others have its stamp. All of them must be taken
        before anything else is asked.

        :param tree: the tree.
        :param patterns: glob patterns for the frame ids that get a topic of their own.
        :return: what there is to know of it.
        """
        if tree is not self._tf_static.tree:
            self._tf_static.publish(tree)
            yield
        self._sent = []
        now = self._tf_static.stamp
        transforms = self._tf_static.transforms
        count = len(transforms.child_ids)
        publisher = self._transforms_publisher(count)
        yield from self._send_also([publisher] * count, transform_stamped_bytes(*transforms), now)
        topics = yield from self._topics_from_tree(tree, patterns)
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
        self._tf_static.publish_again()
        for publishers, messages in self._sent:
            yield from _sent(publishers, messages, self._tf_static.stamp)

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
            self._transforms = latched_publisher(
                self._node, TransformStamped, '~/transforms', depth=max(1, count))
        return self._transforms

    def _topics_from_tree(
        self, tree: TfTree, patterns: Sequence[str],
    ) -> Generator[None, None, dict[str, str]]:
        logger = self._node.get_logger()
        if is_everything_too_much(tree.frame_ids, patterns):
            logger.warning(
                f'no ~/poses/... topics: {len(tree.frame_ids)} frames are more than '
                f'{MOST_BY_DEFAULT}; name those that you want in pose_topics, such as "robot/*", '
                'or ask for all with "?*"')
            return {}
        room = LONGEST_FULL_NAME - len(f'{self._node.get_fully_qualified_name()}/poses/')
        try:
            names, idle = yield from topics_from_patterns(
                tree.frame_ids, patterns, min(room, LONGEST_NAME))
        except ValueError:
            logger.warning(
                'no ~/poses/... topics: the name of the node and its namespace are so long that '
                'the names of topics would be longer than the middleware allows')
            return {}
        if idle:
            logger.warning(
                f'no ~/poses/... topics for {names_in_line(idle)} in pose_topics: no frame id '
                'matches')
        return names

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
                self._poses[name] = latched_publisher(
                    self._node, PoseStamped, f'~/poses/{name}', depth=1)
            if is_debugged:
                logger.debug(f'frame "{frame_id}" has the topic ~/poses/{name}')


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
