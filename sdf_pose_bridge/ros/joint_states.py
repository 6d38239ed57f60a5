# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Follow topics of joint states, and publish the frames that their messages move.

The transforms that a message changes are published on ``/tf`` with the stamp of the message.
Frames of joints that no message has named are not published. If such joints are at zero, all
frames are published before the first message, and then these frames with each message, so that TF
is complete.

With a highest rate, a message is published at once and begins a period, which is the same for all
topics. Later ones wait in the subscriptions for its end, without waking the executor: waking it
takes ten times as long as processing a message. There, all changes are published in one message,
and another period begins if there are any. Only the first message of a topic after a silence does
not wait, unless all topics were silent: then many robots may start together.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from numpy.typing import NDArray
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.timer import Timer

from sdf_pose_bridge.ros.joint_state_topic import JointStateTopic
from sdf_pose_bridge.ros.log_lines import line_about_unreported_joints, MissingJoints
from sdf_pose_bridge.ros.published_frames import PublishedMovingFrames
from sdf_pose_bridge.ros.topic_names import JointStateTopics
from sdf_pose_bridge.tf.joint_positions import NEVER

INITIAL_PERIOD_S = 0.1
"""Period of ``/tf`` before the first message, if joints are at zero then."""

GRACE_S = 2.0
"""Seconds until joints that no message has named are reported."""

TOPICS_PERIOD_S = 1.0 / 30.0
"""Shortest period of the topics of moving frames."""

SUBSCRIPTIONS_AT_ONCE = 40
"""Number of subscriptions, made in some 20 milliseconds, before other callbacks run."""

SILENCE_S = 1.0
"""Seconds without a message, and two periods at least, after which a topic is silent. With fewer,
each message of many slow robots would be published by itself."""

_REST_S = 0.5


class JointStates:
    """
    Follows topics of joint states.

    :param topics: the topics.
    :param rule: the highest rate of each transform on ``/tf`` in Hz, or 0.0 for each message; and
        whether to publish for each message anyway, even with the stamp of the last one.
    """

    def __init__(
        self, node: Node, frames: PublishedMovingFrames, topics: JointStateTopics,
        rule: tuple[float, bool],
    ) -> None:
        self.rule = rule
        """As it was given."""
        frequency, self._ignores_stamps = rule
        self._node = node
        self._logger = node.get_logger()
        self._frames = frames
        # By their full names, with their models.
        self._topics: dict[tuple[str, str], JointStateTopic] = {}
        self._missing_topics: list[tuple[str, str]] = []
        self._warnings: tuple[str, ...] = ()
        self._topic_count = 0
        # For each moving transform its last stamp, and whether it has to be published.
        self._stamps_ns = np.full(len(frames.frames.indices), NEVER)
        self._is_waiting = np.zeros(len(self._stamps_ns), np.bool_)
        self._topics_due = 0.0
        self._are_topics_behind = False
        self._published_at = 0.0
        self._has_moved = False
        self._is_grace_over = False
        self._has_reported_missing = False
        # Simulated time may stand still.
        steady_clock = Clock(clock_type=ClockType.STEADY_TIME)
        self._initial_timer = node.create_timer(
            INITIAL_PERIOD_S, self._publish_initially, clock=steady_clock)
        self._grace_timer = node.create_timer(GRACE_S, self._end_grace, clock=steady_clock)
        self._timers = [self._initial_timer, self._grace_timer]
        rest_period = TOPICS_PERIOD_S
        self._period_timer: Timer | None = None
        self._silent_periods = max(2.0, SILENCE_S * frequency)
        if frequency and not self._ignores_stamps:
            period = 1.0 / frequency
            # While messages follow one another, the other timer does not wake the executor.
            rest_period = min(max(TOPICS_PERIOD_S, 1.5 * period), _REST_S)
            # A bag that is played faster has as many transforms in each of its seconds.
            clock = node.get_clock()
            self._period_timer = node.create_timer(
                period, self._end_period,
                clock=clock if clock.ros_time_is_active else steady_clock)
            self._period_timer.cancel()
            self._timers.append(self._period_timer)
        self._rest_timer = node.create_timer(
            rest_period, self._follow_to_rest, clock=steady_clock)
        self._timers.append(self._rest_timer)
        self._follow(topics)

    def destroy(self) -> None:
        """Stop following, and destroy the subscriptions and timers."""
        self._missing_topics.clear()
        for topic in self._topics.values():
            topic.destroy()
        for timer in self._timers:
            self._node.destroy_timer(timer)

    def replace(self, frames: PublishedMovingFrames, topics: JointStateTopics) -> None:
        """Change the frames and the topics."""
        self._follow(topics)
        if frames is self._frames:
            return
        if set(frames.positions.missing).difference(self._frames.positions.missing):
            self._is_grace_over = False
            self._grace_timer.reset()
        self._frames = frames
        self._stamps_ns = np.full(len(frames.frames.indices), NEVER)
        self._is_waiting = np.zeros(len(self._stamps_ns), np.bool_)
        for topic in self._topics.values():
            topic.forget_frames()
        self._initial_timer.reset()

    @property
    def unreported(self) -> MissingJoints:
        """The joints that no message has named in time."""
        positions = self._frames.positions
        if not self._is_grace_over or not positions.missing:
            return MissingJoints()
        return MissingJoints(positions.missing, tuple(
            topic.name for (_, model), topic in self._topics.items()
            if not positions.selection(positions.missing[:1], model).unknown))

    def take_waiting(self) -> None:
        """Take the messages that wait in subscriptions, for a 30th of a second at most."""
        # If messages come too fast, other callbacks would wait forever. Topics take turns, so that
        # one with too many messages does not delay the others.
        ends_at = time.monotonic() + TOPICS_PERIOD_S
        topics = list(self._topics.values())
        while topics and time.monotonic() < ends_at:
            topics = [topic for topic in topics if topic.take_one()]

    # Topics

    def _follow(self, topics: JointStateTopics) -> None:
        """Make the subscriptions of these topics, and destroy all others."""
        if topics.warnings != self._warnings:
            self._warnings = topics.warnings
            for line in topics.warnings:
                self._logger.warning(line)
        wanted = topics.models.items()
        for key in self._topics.keys() - wanted:
            self._topics.pop(key).destroy()
        self._missing_topics = [key for key in wanted if key not in self._topics]
        self._open_missing_topics()

    def _open_missing_topics(self) -> None:
        """Make some subscriptions now, and leave the others to a task."""
        now = self._missing_topics[:SUBSCRIPTIONS_AT_ONCE]
        del self._missing_topics[:SUBSCRIPTIONS_AT_ONCE]
        for key in now:
            self._topic_count += 1
            try:
                self._topics[key] = JointStateTopic(
                    self._node, *key, self._topic_count,
                    waits=self._period_timer is not None, receive=self._receive)
            except (RuntimeError, ValueError) as error:
                # Security may forbid it. The rest of the message names lines of the source of ROS.
                reason = str(error).partition(', at /')[0]
                self._logger.warning(f'no subscription to {key[0]}: {reason}')
        if self._missing_topics:
            self._node.executor.create_task(self._open_missing_topics)

    # Messages

    def _receive(self, topic: JointStateTopic, data: bytes, info: Any) -> None:
        """
        Process a message, and publish the frames that it moves unless they have to wait.

        :param info: metadata of the message from rclpy.
        """
        change = topic.update(self._frames, data, info['source_timestamp'])
        if self._has_reported_missing and topic.has_new_joints and (
                not self._frames.positions.missing):
            self._has_reported_missing = False
            self._logger.info('all joints have been reported now')
        if change is None:
            return
        if not self._has_moved:
            self._has_moved = True
            count = len(self._topics) + len(self._missing_topics)
            self._logger.info(f'following {topic.name}' if count == 1 else (
                f'following {count} topics of joint states; the first message is on {topic.name}'))
        rows, stamp_ns = change
        # TF accepts one transform for each stamp, and warns of a second one.
        is_waiting = self._is_waiting[rows] | (self._stamps_ns[rows] != stamp_ns)
        self._stamps_ns[rows] = stamp_ns
        if topic.is_open:
            self._publish(rows if self._ignores_stamps else rows[is_waiting], stamp_ns)
            self._close(topic)
        else:
            self._is_waiting[rows] = is_waiting
        topic.silent_periods = 0

    def _close(self, topic: JointStateTopic) -> None:
        """Have messages wait for the end of a period, which begins now if there is none."""
        timer = self._period_timer
        # Simulated time that has not begun would never end a period.
        if timer is None or not self._node.get_clock().now().nanoseconds:
            return
        if timer.is_canceled():
            timer.reset()
            self._open_silent_topics()
        topic.is_open = False

    def _open_silent_topics(self) -> None:
        """Have messages wait for the end of a period but for those of silent topics."""
        for topic in self._topics.values():
            topic.is_open = topic.silent_periods > self._silent_periods

    def _publish(self, rows: NDArray[np.intp], stamps_ns: NDArray[np.int64] | int) -> None:
        """
        Publish changed transforms.

        :param rows: the moving transforms to publish.
        :param stamps_ns: their stamps in nanoseconds, or one for all.
        """
        if len(rows):
            self._is_waiting[rows] = False
            self._frames.publish_tf(rows, stamps_ns)
        self._publish_topics_if_due()

    def _end_period(self) -> None:
        """Publish waiting changes; without any, publish the next message at once."""
        self.take_waiting()
        for topic in self._topics.values():
            topic.silent_periods += 1
        rows = np.flatnonzero(self._is_waiting)
        if len(rows):
            self._publish(rows, self._stamps_ns[rows])
            self._open_silent_topics()
        elif self._period_timer is not None:
            self._period_timer.cancel()
            for topic in self._topics.values():
                topic.is_open = True

    def _end_grace(self) -> None:
        """Report the joints that no message has named, once."""
        self._grace_timer.cancel()
        self._is_grace_over = True
        if self.unreported.names:
            self._has_reported_missing = True
            self._logger.info(line_about_unreported_joints(self.unreported))

    def _publish_initially(self) -> None:
        """Publish all frames on ``/tf`` until there are positions."""
        positions = self._frames.positions
        if (positions.stamps_ns == NEVER).all() and positions.is_known.any():
            self._frames.publish_all()
        else:
            self._initial_timer.cancel()

    def _publish_topics_if_due(self) -> None:
        """Publish the topics of moving frames now, or leave it to a message or timer."""
        now = time.monotonic()
        self._are_topics_behind = now < self._topics_due
        if not self._are_topics_behind:
            # A late one does not delay those that follow.
            self._topics_due = max(self._topics_due + TOPICS_PERIOD_S, now)
            self._frames.publish_topics(only_listeners=True)
        # While messages follow one another, the timer need not wake the executor.
        self._rest_timer.reset()
        self._published_at = now

    def _follow_to_rest(self) -> None:
        """Publish the last positions on topics; at rest once more, for later listeners."""
        is_at_rest = time.monotonic() >= self._published_at + _REST_S
        if is_at_rest:
            self._rest_timer.cancel()
        if is_at_rest or self._are_topics_behind:
            self._are_topics_behind = False
            self._frames.publish_topics(only_listeners=not is_at_rest)
