# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The thread that takes the messages of all topics of joint states, and publishes what they move.

The transforms that a message changes are published on ``/tf`` with the stamp of the message, if it
is newer than their last one. Frames of joints that no message has named are not published. If such
joints are at zero, all frames are published before the first message, and then these frames with
each message, so that TF is complete.

With a highest rate, a message is published at once and begins a period, which is the same for all
topics. Later ones wait in the subscriptions for its end. Then the newest of them are published in
one message, and another period begins if there are any. Only the first message of a topic after a
silence does not wait, unless all topics were silent: then many robots may start together.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
import contextlib
import math
import threading
import time
import traceback
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rclpy.clock import JumpThreshold
from rclpy.duration import Duration
from rclpy.exceptions import InvalidHandle
from rclpy.node import Node
from rclpy.task import Future

from sdf_pose_bridge.ros.background import wake
from sdf_pose_bridge.ros.joint_names import Meaning, Meanings
from sdf_pose_bridge.ros.joint_state_topic import JointStateTopic, Message
from sdf_pose_bridge.ros.log_lines import line_about_unreported_joints, MissingJoints
from sdf_pose_bridge.ros.published_frames import PublishedMovingFrames
from sdf_pose_bridge.ros.publishers import NANOSECONDS
from sdf_pose_bridge.ros.wait_set import WaitSet

INITIAL_PERIOD_S = 0.1
"""Period of ``/tf`` before the first message, if joints are at zero then."""

GRACE_S = 2.0
"""Seconds until joints that no message has named are reported."""

TOPICS_PERIOD_S = 1.0 / 30.0
"""Shortest period of the topics of moving frames, and longest time for which waiting messages are
taken before others get their turn."""

SILENCE_S = 1.0
"""Seconds without a message, and two periods at least, after which a topic is silent. With fewer,
each message of many slow robots would be published by itself."""

_REST_S = 0.5
_LONGEST_SLEEP_S = 0.1
_NO_ROWS = np.array([], np.intp)


class Rule(NamedTuple):
    """When transforms are published on ``/tf``."""

    highest_hz: float
    """The highest rate of each; 0.0 for each message."""
    ignores_stamps: bool
    """Whether to publish for each message, also with a stamp that is not newer than the last."""

    @property
    def period_ns(self) -> float:
        """The period in nanoseconds; 0.0 for each message."""
        has_period = self.highest_hz and not self.ignores_stamps
        return NANOSECONDS / self.highest_hz if has_period else 0.0


class Target(NamedTuple):
    """The frames, topics and rule that the thread follows."""

    frames: PublishedMovingFrames
    topics: Sequence[JointStateTopic]
    topic_count: int
    """The number of these topics, and of those that follow."""
    rule: Rule


class JointStateThread:
    """
    Takes messages and publishes frames in a thread, from its construction to :meth:`end`.

    :param target: the first target.
    """

    def __init__(self, node: Node, target: Target) -> None:
        self._node = node
        self._logger = node.get_logger()
        self._wait_set = WaitSet(node.context)
        # Other threads set these.
        self._next_target = target
        # Futures of callers, and when they do not wait longer if messages come too fast.
        self._callers: deque[tuple[Future, float]] = deque()
        self._has_to_publish_topics = False
        self._has_to_end = False
        # The thread alone uses everything else.
        self._target = target
        # The functions that are due at some monotonic time.
        self._due: dict[Callable[[], None], float] = {}
        self._topics_due = 0.0
        self._now_ns = 0
        self._has_jumped = False
        self._has_moved = False
        self._has_reported_missing = False
        self._period = 0
        self._start_frames()
        self._end_periods()
        self._clock = node.get_clock()
        # The thread waits in real time, and any step of simulated time may end a period.
        self._clock_steps = self._clock.create_jump_callback(
            JumpThreshold(
                min_forward=Duration(nanoseconds=1), min_backward=Duration(nanoseconds=-1)),
            post_callback=self._follow_step)
        # The node may be destroyed with its context only.
        node.context.on_shutdown(self.end)
        self._thread = threading.Thread(target=self._run, name='joint states', daemon=True)
        self._thread.start()

    # Calls of other threads

    def follow(self, target: Target) -> None:
        """Follow something else, starting at the positions that joints have."""
        before = self._next_target.frames.positions
        if target.frames.positions is not before:
            # Look-ups do not wait until the thread does it again.
            target.frames.positions.take_over(before)
        self._next_target = target
        self._wake()

    def publish_topics(self) -> None:
        """Publish all moving frames on ``~/transforms`` and ``~/poses/...`` soon."""
        self._has_to_publish_topics = True
        self._wake()

    def catch_up(self) -> Future:
        """Return a future that is done when all calls and messages so far are processed."""
        future = Future()
        self._callers.append((future, time.monotonic() + TOPICS_PERIOD_S))
        self._wake()
        return future

    def end(self) -> None:
        """End the thread."""
        self._has_to_end = True
        self._wake()
        self._thread.join()
        # Not by the thread, as the executor may be calling it.
        self._clock_steps.unregister()

    def _follow_step(self, _step: object) -> None:
        if self._has_period_ended(self._clock.now().nanoseconds):
            self._wake()

    def _wake(self) -> None:
        # The thread may have ended with the node.
        with contextlib.suppress(InvalidHandle):
            self._wait_set.wake()

    # The thread

    def _run(self) -> None:
        while not self._has_to_end:
            try:
                self._turn()
            except InvalidHandle:
                # A topic has been destroyed, which follows a change of the target; or the node.
                if self._target is self._next_target:
                    break
                self._follow_next_target()
            except Exception as error:  # noqa: BLE001 - includes defects
                self._logger.error(
                    f'internal error in joint states: {error}\n{traceback.format_exc()}',
                    throttle_duration_sec=60.0)
        self._wait_set.close()
        self._answer(len(self._callers))

    def _turn(self) -> None:
        """Wait once, and do what is due."""
        with self._node.handle:
            pass  # the wait set would not notice that the node was destroyed
        caller_count = len(self._callers)
        ready = self._wait_set.wait(
            [each.subscription for each in self._awaited],
            0.0 if caller_count else self._longest_wait())
        if self._target is not self._next_target:
            self._follow_next_target()
            return  # the messages are ready again
        self._follow_clock()
        has_ended = self._has_period_ended(self._now_ns)
        is_due = has_ended or not ready or (
            caller_count > 0 and time.monotonic() > self._callers[0][1])
        if ready and not has_ended:
            self._take_at_once([self._awaited[index] for index in ready])
        if self._is_in_period and is_due:
            self._target.frames.wait(self._rows_of_messages(self._target.topics))
        if has_ended:
            self._end_period()
        if is_due:
            self._answer(caller_count)
        if self._has_to_publish_topics:
            self._has_to_publish_topics = False
            self._target.frames.publish_topics(only_listeners=False)
        now = time.monotonic()
        for function in [each for each, due in self._due.items() if due <= now]:
            del self._due[function]
            function()

    def _longest_wait(self) -> float:
        seconds = min(self._due.values(), default=math.inf) - time.monotonic()
        if self._is_in_period:
            # Messages of a long period are taken before there are too many.
            seconds = min(seconds, _LONGEST_SLEEP_S)
            if not self._clock.ros_time_is_active:
                seconds = min(seconds, (self._period_ends_ns - time.time_ns()) / NANOSECONDS)
        return max(seconds, 0.0)

    def _answer(self, count: int) -> None:
        for _ in range(count):
            future, _ = self._callers.popleft()
            future.set_result(None)
        if count:
            wake(self._node.executor)

    def _follow_next_target(self) -> None:
        before, self._target = self._target, self._next_target
        if self._target.frames is not before.frames:
            self._target.frames.positions.take_over(before.frames.positions)
            self._start_frames()
        self._end_periods()

    def _start_frames(self) -> None:
        self._meanings = Meanings(self._target.frames)
        self._has_to_publish_topics = True
        now = time.monotonic()
        self._due[self._publish_all] = now
        if not self._has_reported_missing:
            self._due[self._end_grace] = now + GRACE_S

    # Periods

    @property
    def _is_in_period(self) -> bool:
        return self._period_ends_ns < math.inf

    def _has_period_ended(self, now_ns: int) -> bool:
        return self._is_in_period and (self._has_jumped or now_ns >= self._period_ends_ns)

    def _begin_period(self, awaited: Sequence[JointStateTopic]) -> None:
        """Begin a period, for whose end the messages of all but some topics wait."""
        self._period_ends_ns = self._now_ns + self._target.rule.period_ns
        self._period += 1
        self._awaited = awaited

    def _end_period(self) -> None:
        """Publish what has waited; without any, publish the next message at once."""
        if self._target.frames.publish_waiting():
            self._publish_topics_soon()
            longest = max(2.0, SILENCE_S * self._target.rule.highest_hz)
            self._begin_period([
                each for each in self._target.topics if self._period - each.last_period > longest])
        else:
            self._end_periods()

    def _end_periods(self) -> None:
        self._period_ends_ns = math.inf
        self._awaited = self._target.topics

    # Messages

    def _take_at_once(self, topics: Sequence[JointStateTopic]) -> None:
        """Take a message of each of some topics, and publish what they move."""
        rows = self._rows_of_messages(topics, has_all=False)
        if not len(rows):
            return
        self._target.frames.publish_tf(rows)
        self._publish_topics_soon()
        if self._is_in_period:
            self._awaited = [each for each in self._awaited if each not in topics]
        # Simulated time that has not begun would never end a period.
        elif self._target.rule.period_ns and self._now_ns:
            self._begin_period([])

    def _rows_of_messages(
        self, topics: Sequence[JointStateTopic], *, has_all: bool = True,
    ) -> NDArray[np.intp]:
        """
        Take messages; of those with the same names the newest counts.

        :param has_all: whether to take all that wait, or one of each topic.
        :return: the moving transforms to publish.
        """
        newest: dict[Meaning, tuple[JointStateTopic, Message]] = {}
        # Messages may come faster than they are taken. Topics take turns, so that one with too
        # many messages does not delay the others.
        ends_at = time.monotonic() + TOPICS_PERIOD_S
        while topics and time.monotonic() < ends_at:
            others = []
            for topic in topics:
                data = topic.take()
                if data is None:
                    continue
                if has_all:
                    others.append(topic)
                message = topic.read(data, self._meanings, self._target.frames.positions)
                if message is None:
                    continue
                known = newest.get(message.meaning)
                if known is None or not 0 < message.stamp_ns < known[1].stamp_ns:
                    newest[message.meaning] = topic, message
            topics = others
        moved = [self._move(topic, message) for topic, message in newest.values()]
        return moved[0] if len(moved) == 1 else np.unique(np.concatenate([_NO_ROWS, *moved]))

    def _follow_clock(self) -> None:
        """Accept any stamp after time has jumped back, for example when a bag starts again."""
        clock = self._clock
        now_ns = clock.now().nanoseconds if clock.ros_time_is_active else time.time_ns()
        self._has_jumped = now_ns < self._now_ns
        self._now_ns = now_ns
        if self._has_jumped:
            self._logger.info('time has jumped back', throttle_duration_sec=10.0)
            self._target.frames.forget_stamps()

    def _move(self, topic: JointStateTopic, message: Message) -> NDArray[np.intp]:
        """Set the positions of a message; return the moving transforms to publish."""
        target, meaning = self._target, message.meaning
        positions, ignores_stamps = target.frames.positions, target.rule.ignores_stamps
        stamp_ns = message.stamp_ns or self._now_ns
        if self._has_jumped and stamp_ns > self._now_ns:
            return _NO_ROWS  # it was sent before that
        topic.last_period = self._period
        topic.warn_about_invalid(positions.update(
            meaning.selection, message.positions, stamp_ns, ignore_stamps=ignores_stamps))
        if self._has_reported_missing and positions.unreported() is None:
            self._has_reported_missing = False
            self._logger.info('all joints have been reported now')
        rows = self._meanings.rows(meaning)
        if len(rows) and not self._has_moved:
            self._has_moved = True
            self._logger.info(
                f'following {topic.name}' if target.topic_count == 1 else
                f'following {target.topic_count} topics of joint states; the first message is on '
                f'{topic.name}')
        return target.frames.stamp(rows, stamp_ns, ignore_stamps=ignores_stamps)

    # Publication

    def _publish_all(self) -> None:
        """Publish all frames on ``/tf``; repeatedly as long as no message has come."""
        if self._target.frames.publish_all():
            self._due[self._publish_all] = time.monotonic() + INITIAL_PERIOD_S

    def _publish_topics_soon(self) -> None:
        now = time.monotonic()
        self._due[self._publish_to_listeners] = max(self._topics_due, now)
        self._due[self._publish_at_rest] = now + _REST_S

    def _publish_to_listeners(self) -> None:
        # A late one does not delay those that follow.
        self._topics_due = max(self._topics_due + TOPICS_PERIOD_S, time.monotonic())
        self._target.frames.publish_topics(only_listeners=True)

    def _publish_at_rest(self) -> None:
        """Publish the last positions once more, for later listeners."""
        self._target.frames.publish_topics(only_listeners=False)

    # Joints that no message has named

    @property
    def unreported(self) -> MissingJoints:
        """The joints that no message has named in time."""
        target = self._next_target
        positions = target.frames.positions
        found = None if self._end_grace in self._due else positions.unreported()
        if found is None:
            return MissingJoints()
        name = positions.names[found.first]
        return MissingJoints(found.joint_count, name, [
            topic.name for topic in target.topics if not positions.unknown([name], topic.model)])

    def _end_grace(self) -> None:
        """Report the joints that no message has named, once."""
        unreported = self.unreported
        if unreported.number:
            self._has_reported_missing = True
            self._logger.info(line_about_unreported_joints(unreported))
