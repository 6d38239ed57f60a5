# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Subscribe to topics of joint states, for a thread that follows them."""

from __future__ import annotations

from collections.abc import Iterable

from rclpy.node import Node

from sdf_pose_bridge.ros.joint_state_thread import JointStateThread, Rule, Target
from sdf_pose_bridge.ros.joint_state_topic import JointStateTopic
from sdf_pose_bridge.ros.published_frames import PublishedMovingFrames
from sdf_pose_bridge.ros.topic_names import JointStateTopics

SUBSCRIPTIONS_AT_ONCE = 40
"""Number of subscriptions, made in some 20 milliseconds, before other callbacks run."""


class JointStates:
    """
    Follows topics of joint states, and publishes the frames that their messages move.

    :param node: the node, with an executor, which calls all methods.
    """

    def __init__(
        self, node: Node, frames: PublishedMovingFrames, topics: JointStateTopics, rule: Rule,
    ) -> None:
        self._node = node
        # By their names before they are remapped, with their models.
        self._topics: dict[tuple[str, str], JointStateTopic] = {}
        self._missing_topics: list[tuple[str, str]] = []
        self._warnings: tuple[str, ...] = ()
        self._target = Target(frames, (), 0, rule)
        self.thread = JointStateThread(node, self._target)
        self.follow(frames, topics, rule)

    def follow(
        self, frames: PublishedMovingFrames, topics: JointStateTopics, rule: Rule,
    ) -> None:
        """Change what is followed; joints with the same names keep their positions."""
        logger = self._node.get_logger()
        if topics.warnings != self._warnings:
            self._warnings = topics.warnings
            for line in topics.warnings:
                logger.warning(line)
        wanted = topics.models.items()
        unwanted = [self._topics.pop(key) for key in self._topics.keys() - wanted]
        self._missing_topics = [key for key in wanted if key not in self._topics]
        self._target = Target(frames, (), len(wanted), rule)
        self._open_missing_topics()
        self._destroy(unwanted)

    def end(self) -> None:
        """Stop following, and destroy the subscriptions."""
        self._missing_topics.clear()
        self.thread.end()
        self._destroy(self._topics.values())

    def _destroy(self, topics: Iterable[JointStateTopic]) -> None:
        for topic in topics:
            self._node.destroy_subscription(topic.subscription)

    def _open_missing_topics(self) -> None:
        """Make some subscriptions now, and leave the others to a task."""
        now = self._missing_topics[:SUBSCRIPTIONS_AT_ONCE]
        del self._missing_topics[:SUBSCRIPTIONS_AT_ONCE]
        for key in now:
            try:
                self._topics[key] = JointStateTopic(self._node, *key)
            except (RuntimeError, ValueError) as error:
                # Security may forbid it. The rest of the message names lines of the source of ROS.
                reason = str(error).partition(', at /')[0]
                self._node.get_logger().warning(f'no subscription to {key[0]}: {reason}')
        self._target = self._target._replace(topics=tuple(self._topics.values()))
        self.thread.follow(self._target)
        if self._missing_topics:
            self._node.executor.create_task(self._open_missing_topics)
