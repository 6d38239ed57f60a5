# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Follow topics of joint states in a thread, and publish what their messages move.

The transforms that a message changes are published on ``/tf`` with the stamp of the message, if it
is newer than their last one. Frames of joints that no message has named are not published. If such
joints are at zero, all frames are published before the first message, and then these frames with
each message, so that TF is complete.

With a highest rate, a message is published at once and begins a period, which is the same for all
topics. Later ones wait in the subscriptions for its end. Then the newest of them are published in
one message, and another period begins if there are any. The first message of a silent topic is
published at once, unless all topics are silent, as when many robots start together.
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
from rclpy.exceptions import InvalidHandle
from rclpy.node import Node
from rclpy.task import Future

from sdf_pose_bridge.ros.background import result_from_executor, wake
from sdf_pose_bridge.ros.cdr import NANOSECONDS
from sdf_pose_bridge.ros.joint_state_topic import JointStateTopic, Meaning, Meanings, Message
from sdf_pose_bridge.ros.log_lines import line_about_unreported_joints, MissingJoints
from sdf_pose_bridge.ros.parameters import Settings
from sdf_pose_bridge.ros.published_frames import PublishedMovingFrames
from sdf_pose_bridge.ros.topic_names import JointStateTopics
from sdf_pose_bridge.ros.wait_set import WaitSet
from sdf_pose_bridge.tf.lookup import PoseLookup

INITIAL_PERIOD_S = 0.1
"""Period of ``/tf`` before the first message, if joints are at zero then."""

GRACE_S = 2.0
"""Seconds until joints that no message has named are reported."""

TOPICS_PERIOD_S = 1.0 / 30.0
"""Shortest period of the topics of moving frames, and longest time to take messages at once."""

SILENCE_NS = NANOSECONDS
"""Time without a message, and two periods at least, after which a topic is silent. With less, each
message of many slow robots would be published by itself."""

_REST_S = 0.5
_LONGEST_SLEEP_S, _CLOCK_PERIOD_S = 0.1, 0.01
"""Longest waits in a period: before too many messages wait, and for a simulated clock."""

_NO_ROWS: NDArray[np.intp] = np.array([], np.intp)


class _Target(NamedTuple):
    """The frames, topics and settings that the thread follows."""

    frames: PublishedMovingFrames
    lookup: PoseLookup
    topics: Sequence[JointStateTopic]
    settings: Settings

    @property
    def period_ns(self) -> float:
        """The period of each transform on ``/tf`` in nanoseconds; 0.0 for each message."""
        frequency = self.settings.publish_frequency
        return NANOSECONDS / frequency if frequency and not self.settings.ignore_timestamp else 0.0


class JointStates:
    """
    Follows topics of joint states, and publishes the frames that their messages move.

    A thread does this from its construction to :meth:`end`. It is constructed beside the executor
    of the node, which makes and destroys the subscriptions.

    :param lookup: looks up poses at the positions of these frames.
    """

    def __init__(
        self, node: Node, frames: PublishedMovingFrames, lookup: PoseLookup,
        topics: JointStateTopics, settings: Settings,
    ) -> None:
        self._node = node
        self._logger = node.get_logger()
        # By their names before they are remapped, with their models.
        self._topics: dict[tuple[str, str], JointStateTopic] = {}
        self._warnings: tuple[str, ...] = ()
        self._wait_set = WaitSet(node.context)
        self._target = self._next_target = _Target(frames, lookup, (), settings)
        # The thread makes them when it has processed the messages that came before.
        self._calls: deque[Callable[[], object]] = deque()
        self._has_to_end = False
        # The thread alone changes everything else. First, what is due at some monotonic time.
        self._due: dict[Callable[[], None], float] = {}
        self._topics_due = 0.0
        self._now_ns = 0
        self._is_simulated = self._has_jumped = False
        self._has_moved = self._has_reported_missing = False
        self._start_frames()
        self._end_period()
        self._thread = threading.Thread(target=self._run, name='joint states', daemon=True)
        self._thread.start()
        self.follow(frames, lookup, topics, settings)
        node.context.on_shutdown(self.end)

    # Calls of the loader and, for look-ups, of the executor

    def follow(
        self, frames: PublishedMovingFrames, lookup: PoseLookup, topics: JointStateTopics,
        settings: Settings,
    ) -> None:
        """
        Change what is followed; joints with the same names keep their positions.

        When this returns, the thread publishes nothing of the frames before.
        """
        if topics.warnings != self._warnings:
            self._warnings = topics.warnings
            for line in topics.warnings:
                self._logger.warning(line)
        wanted = topics.models.items()
        unwanted = [self._topics.pop(key) for key in self._topics.keys() - wanted]
        for key in [key for key in wanted if key not in self._topics]:
            self._open(*key)
        self._topic_count = len(wanted)
        self._next_target = _Target(frames, lookup, tuple(self._topics.values()), settings)
        self.wait()
        for topic in unwanted:
            self._close(topic)

    def publish_topics(self) -> None:
        """Publish all moving frames on ``~/transforms`` and ``~/poses/...`` soon."""
        self._calls.append(lambda: self._due.update({self._publish_at_rest: 0.0}))
        self._wake()

    def wait(self) -> None:
        """Wait until all messages so far are processed."""
        has_come = threading.Event()
        self._calls.append(has_come.set)
        self._wake()
        has_come.wait()

    def current_lookup(self) -> Future:
        """Return a future for the look-up of poses, when all messages so far are processed."""
        future = Future()
        self._calls.append(lambda: future.set_result(self._target.lookup))
        self._wake()
        return future

    def end(self) -> None:
        """End the thread, and destroy the subscriptions; the executor calls this."""
        self._has_to_end = True
        self._wake()
        self._thread.join()
        for topic in self._topics.values():
            self._node.destroy_subscription(topic.subscription)

    @property
    def unreported(self) -> MissingJoints:
        """The joints that no message has named in time."""
        target = self._next_target
        positions = target.frames.positions
        found = [] if self._end_grace in self._due else positions.unreported()
        return MissingJoints(len(found), found[0], [
            topic.name for topic in target.topics if not positions.unknown(found[:1], topic.model)
        ]) if found else MissingJoints()

    def _open(self, name: str, model: str) -> None:
        # The executor goes on between two of them.
        try:
            self._topics[name, model] = result_from_executor(
                self._node, lambda: JointStateTopic(self._node, name, model))
        except (RuntimeError, ValueError) as error:
            # Security may forbid it. The rest of the message names lines of the source of ROS.
            reason = str(error).partition(', at /')[0]
            self._logger.warning(f'no subscription to {name}: {reason}')

    def _close(self, topic: JointStateTopic) -> None:
        result_from_executor(
            self._node, lambda: self._node.destroy_subscription(topic.subscription))

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
                break  # the node was destroyed
            except MemoryError:
                raise
            except Exception as error:  # noqa: BLE001 - includes defects
                self._logger.error(
                    f'internal error in joint states: {error}\n{traceback.format_exc()}',
                    throttle_duration_sec=60.0)
        self._wait_set.close()
        self._make_calls(len(self._calls))

    def _turn(self) -> None:
        """Wait once, and do what is due."""
        with self._node.handle:
            pass  # the wait set would not notice that the node was destroyed
        call_count = len(self._calls)
        ready = self._wait_set.wait(
            [each.subscription for each in self._awaited],
            0.0 if call_count else self._longest_wait())
        if self._target is not self._next_target:
            self._follow_next_target()
            return  # the messages are ready again
        self._follow_clock()
        has_ended = self._is_in_period and (
            self._has_jumped or self._now_ns >= self._period_ends_ns)
        if ready and not has_ended:
            self._take([self._awaited[index] for index in ready], at_once=True)
        if self._is_in_period and (has_ended or call_count or not ready):
            self._take(self._target.topics, at_once=False)
        if has_ended:
            self._end_period()
        self._make_calls(call_count)
        now = time.monotonic()
        for function in [each for each, due in self._due.items() if due <= now]:
            del self._due[function]
            function()

    def _longest_wait(self) -> float:
        seconds = min(self._due.values(), default=math.inf) - time.monotonic()
        if self._is_in_period:
            seconds = min(
                seconds, _LONGEST_SLEEP_S, _CLOCK_PERIOD_S if self._is_simulated
                else (self._period_ends_ns - time.time_ns()) / NANOSECONDS)
        return max(seconds, 0.0)

    def _make_calls(self, count: int) -> None:
        for _ in range(count):
            self._calls.popleft()()
        if count:
            wake(self._node.executor)

    def _follow_next_target(self) -> None:
        before, self._target = self._target, self._next_target
        if self._target.frames is not before.frames:
            self._target.frames.positions.take_over(before.frames.positions)
            self._start_frames()
        self._end_period()

    def _start_frames(self) -> None:
        self._meanings = Meanings(self._target.frames)
        self._waiting = _NO_ROWS
        now = time.monotonic()
        self._due[self._publish_all] = self._due[self._publish_at_rest] = now
        if not self._has_reported_missing:
            self._due[self._end_grace] = now + GRACE_S

    # Periods

    @property
    def _is_in_period(self) -> bool:
        return self._period_ends_ns < math.inf

    def _end_period(self) -> None:
        """Publish what has waited, if anything has; otherwise publish the next message at once."""
        rows, self._waiting = self._waiting, _NO_ROWS
        self._period_ends_ns, self._awaited = math.inf, self._target.topics
        silent_ns = self._now_ns - max(2.0 * self._target.period_ns, SILENCE_NS)
        self._publish(rows, [each for each in self._awaited if each.last_ns < silent_ns])

    # Messages

    def _take(self, topics: Sequence[JointStateTopic], *, at_once: bool) -> None:
        """
        Take messages of topics, and set their positions.

        :param at_once: whether to publish what they move, and to leave the others as soon as a
            period has begun. Otherwise it waits, and of those with the same names the newest
            counts.
        """
        newest: dict[Meaning, Message] = {}
        # Messages may come faster than they are taken. Topics take turns, so that one with too
        # many messages does not delay the others.
        ends_at = time.monotonic() + TOPICS_PERIOD_S
        while topics and time.monotonic() < ends_at:
            topics = [topic for topic in topics if topic.take(self._meanings, newest)]
            if at_once:
                self._publish(_union([self._move(each) for each in newest.values()]))
                newest.clear()
                # The wait tells whether there are more. Calls wait for all of them.
                if self._is_in_period or not self._calls:
                    return
        self._waiting = _union([self._waiting, *(self._move(each) for each in newest.values())])

    def _follow_clock(self) -> None:
        """Accept any stamp after time has jumped back, for example when a bag starts again."""
        clock = self._node.get_clock()
        self._is_simulated = clock.ros_time_is_active
        now_ns = clock.now().nanoseconds if self._is_simulated else time.time_ns()
        self._has_jumped, self._now_ns = now_ns < self._now_ns, now_ns
        if self._has_jumped:
            self._logger.info('time has jumped back', throttle_duration_sec=10.0)
            self._target.frames.forget_stamps()
            self._waiting = _NO_ROWS

    def _move(self, message: Message) -> NDArray[np.intp]:
        target, topic, meaning = self._target, message.topic, message.meaning
        positions, ignores_stamps = target.frames.positions, target.settings.ignore_timestamp
        stamp_ns = message.stamp_ns or self._node.get_clock().now().nanoseconds
        if self._has_jumped and stamp_ns > self._now_ns:
            return _NO_ROWS  # it was sent before that
        topic.last_ns = self._now_ns
        topic.warn_about_invalid(positions.update(
            meaning.selection, message.positions, stamp_ns, ignore_stamps=ignores_stamps))
        if self._has_reported_missing and not positions.unreported():
            self._has_reported_missing = False
            self._logger.info('all joints have been reported now')
        rows = self._meanings.rows(meaning)
        if len(rows) and not self._has_moved:
            self._has_moved = True
            self._logger.info(
                f'following {topic.name}' if self._topic_count == 1 else
                f'following {self._topic_count} topics of joint states; the first message is on '
                f'{topic.name}')
        return target.frames.stamp(rows, stamp_ns, ignore_stamps=ignores_stamps)

    # Publication

    def _publish(
        self, rows: NDArray[np.intp], awaited: Sequence[JointStateTopic] = (),
    ) -> None:
        """
        Publish moving transforms, if any; with a highest rate, a period begins if there is none.

        :param awaited: the topics whose messages do not wait for the end of this period.
        """
        if not len(rows):
            return
        self._target.frames.publish_tf(rows)
        now = time.monotonic()
        self._due[self._publish_to_listeners] = max(self._topics_due, now)
        self._due[self._publish_at_rest] = now + _REST_S
        if self._is_in_period:
            self._waiting = np.setdiff1d(self._waiting, rows)
            self._awaited = [each for each in self._awaited if each.last_ns < self._now_ns]
        # Simulated time that has not begun would never end a period.
        elif self._target.period_ns and self._now_ns:
            self._period_ends_ns = self._now_ns + self._target.period_ns
            self._awaited = awaited

    def _publish_all(self) -> None:
        """Publish all frames on ``/tf``; repeatedly as long as no message has come."""
        self._waiting = _NO_ROWS
        if self._target.frames.publish_all():
            self._due[self._publish_all] = time.monotonic() + INITIAL_PERIOD_S

    def _publish_to_listeners(self) -> None:
        # A late one does not delay those that follow.
        self._topics_due = max(self._topics_due + TOPICS_PERIOD_S, time.monotonic())
        self._target.frames.publish_topics(only_listeners=True)

    def _publish_at_rest(self) -> None:
        # Later listeners get the last positions.
        self._target.frames.publish_topics(only_listeners=False)

    def _end_grace(self) -> None:
        """Report the joints that no message has named, once."""
        unreported = self.unreported
        if unreported.number:
            self._has_reported_missing = True
            self._logger.info(line_about_unreported_joints(unreported))


def _union(parts: Sequence[NDArray[np.intp]]) -> NDArray[np.intp]:
    """Return the rows of all parts, most often of one, in ascending order."""
    return parts[0] if len(parts) == 1 else np.unique(np.concatenate([_NO_ROWS, *parts]))
