# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Follow messages about joints and models in a thread, and publish what they move.

The messages are joint states, poses of models on topics, and answers of a simulator.

The transforms that a message changes are published on ``/tf`` with the stamp of the message, if it
is newer than their last one. Frames of joints and models that no message has named are not
published. If these are where the file puts them, all frames are published before the first
message, and then these frames with each message, so that TF is complete.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence
import contextlib
import math
import threading
import time
from typing import NamedTuple, TypeVar

from rclpy.exceptions import InvalidHandle
from rclpy.node import Node
from rclpy.task import Future

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.ros.background import result_from_executor, result_from_thread, wake
from sdf_pose_bridge.ros.cdr import NANOSECONDS, NO_ROWS, Rows
from sdf_pose_bridge.ros.following.message_failures import MessageFailures
from sdf_pose_bridge.ros.following.message_problems import MessageProblems
from sdf_pose_bridge.ros.following.publish_period import PublishPeriod, union
from sdf_pose_bridge.ros.following.state_messages import (
    KnownStreams,
    Message,
    MessageStream,
    StateSource,
)
from sdf_pose_bridge.ros.following.state_sources import StateSources
from sdf_pose_bridge.ros.following.state_topic import StateTopic
from sdf_pose_bridge.ros.following.wait_set import WaitSet
from sdf_pose_bridge.ros.log_lines import text_about_defect
from sdf_pose_bridge.ros.parameters.declarations import Settings
from sdf_pose_bridge.ros.publishing.published_frames import MovingTopics
from sdf_pose_bridge.ros.publishing.state_report import StateReport
from sdf_pose_bridge.ros.publishing.topic_names import StateTopics
from sdf_pose_bridge.tf.lookup import PoseLookup

INITIAL_PERIOD_S = 0.1
"""Period of ``/tf`` before the first message, if joints and models are known then."""

PUBLISHERS_PERIOD_S = 3.0
"""Period of the search for several publishers of a joint or a model."""

GRACE_S = 2.0
"""Seconds until joints and models that no message has named are reported."""

TOPICS_PERIOD_S = 1.0 / 30.0
"""Shortest period of the topics of moving frames, and longest time to take messages at once."""

SILENCE_NS = NANOSECONDS
"""Time without a message, and two periods at least, after which a topic is silent. With less, each
message of many slow robots would be published by itself."""

LONGEST_ANSWER_S = 60.0
"""Longest time in s to wait for the thread, which answers within a second unless it has failed."""

_REST_S = 0.5
_LONGEST_SLEEP_S, _CLOCK_PERIOD_S = 0.1, 0.01
"""Longest waits in a period: before too many messages wait, and for a simulated clock."""

_Result = TypeVar('_Result')


class _Target(NamedTuple):
    """The frames, sources and settings that the thread follows."""

    frames: MovingTopics
    lookup: PoseLookup
    sources: Sequence[StateSource]
    settings: Settings

    @property
    def period_ns(self) -> float:
        """The period of each transform on ``/tf`` in nanoseconds; 0.0 for each message."""
        frequency = self.settings.publish_frequency
        return NANOSECONDS / frequency if frequency and not self.settings.ignore_timestamp else 0.0


class JointStates:
    """
    Follows messages about joints and models, and publishes the frames that they move.

    A thread does this from its construction to :meth:`end`. It is constructed beside the executor
    of the node, which makes and destroys the subscriptions.

    :param lookup: looks up poses at the positions of these frames.
    """

    def __init__(
        self, node: Node, frames: MovingTopics, lookup: PoseLookup,
        topics: StateTopics, settings: Settings,
    ) -> None:
        self._node = node
        self._logger = node.get_logger()
        self._wait_set = WaitSet(node.context)
        self.sources = result_from_executor(
            node, lambda: StateSources(node, self._follow_sources, self._wait_set.wake))
        self._target = self._next_target = _Target(frames, lookup, (), settings)
        self._calls: deque[Callable[[], object]] = deque()
        self._has_to_end = False
        self._failures = MessageFailures(
            lambda: self._logger.error(
                text_about_defect('joint states'), throttle_duration_sec=60.0),
            InvalidHandle, MemoryError)
        # The thread alone uses everything else. First, what is due at some monotonic time.
        self._due: dict[Callable[[], None], float] = {}
        self._topics_due = 0.0
        self._now_ns = 0
        self._is_simulated = self._has_jumped = False
        self._has_moved = self._has_reported_missing = False
        self._period = PublishPeriod()
        self._processed: set[StateSource] = set()
        self._start_frames()
        self._end_period()
        self._thread = threading.Thread(target=self._run, name='joint states', daemon=True)
        self._thread.start()
        self.follow(frames, lookup, topics, settings)
        node.context.on_shutdown(self.end)

    # Calls of the loader and, for look-ups, of the executor

    def follow(
        self, frames: MovingTopics, lookup: PoseLookup, topics: StateTopics,
        settings: Settings,
    ) -> None:
        """
        Change what is followed; joints and models with the same names keep what was reported.

        When this returns, the thread publishes nothing of the frames before.
        """
        target = _Target(frames, lookup, (), settings)
        unwanted = self.sources.follow(topics, settings, frames.positions)
        result_from_executor(self._node, lambda: self._follow_sources(unwanted, target))
        self.wait()

    def publish_topics(self) -> None:
        """Publish all moving frames on ``~/transforms`` and ``~/poses/...`` soon."""
        self._call(lambda: self._due.update({self._publish_at_rest: 0.0}))

    def wait(self) -> None:
        """Wait until all messages so far are processed; a thread that hangs ends the node."""
        self._result(lambda: None)

    def report(self) -> StateReport:
        """Return the report of the thread when all messages so far are processed."""
        return self._result(self._report)

    def current_lookup(self) -> Future:
        """
        Return a future for the look-up of poses, when all messages so far are processed.

        It reads the positions while the thread goes on; new ones replace the array of values.
        """
        future = Future()
        self._call(lambda: future.set_result(self._target.lookup))
        return future

    def end(self) -> None:
        """End the thread, and destroy the subscriptions; the executor calls this."""
        self._has_to_end = True
        self._wait_set.wake()
        self._thread.join()
        self.sources.end()

    def _follow_sources(
        self, unwanted: Sequence[StateTopic], target: _Target | None = None,
    ) -> None:
        """Follow all sources, and destroy topics then; the executor alone calls this."""
        self._next_target = (target or self._next_target)._replace(sources=self.sources.sources)
        self._call(lambda: self.sources.close(unwanted))

    def _call(self, function: Callable[[], object]) -> None:
        """Have the thread call a function when all messages so far are processed."""
        self._calls.append(function)
        self._wait_set.wake()

    def _result(self, function: Callable[[], _Result]) -> _Result:
        return result_from_thread(self._call, function, LONGEST_ANSWER_S)

    # The thread

    def _run(self) -> None:
        with contextlib.suppress(InvalidHandle):  # the node was destroyed
            while not self._has_to_end:
                self._processed.clear()
                self._failures.attempt(self._processed, None, self._turn)
        self._wait_set.close()
        self._make_calls(len(self._calls))

    def _turn(self) -> None:
        """Wait once, and do what is due."""
        with self._node.handle:
            pass  # the wait set would not notice that the node was destroyed
        call_count = len(self._calls)
        awaited = self._period.awaited
        topics = [each for each in awaited if each.subscription is not None]
        indices = self._wait_set.wait(
            [each.subscription for each in topics], 0.0 if call_count else self._longest_wait())
        ready = [topics[index] for index in indices]
        ready += [each for each in awaited if each.has_answers]
        if self._target is not self._next_target:
            self._follow_next_target()
            return  # the messages are ready again
        self._follow_clock()
        has_ended = self._period.has_begun and (
            self._has_jumped or self._now_ns >= self._period.ends_ns)
        if ready and not has_ended:
            self._process(ready, at_once=True)
        if self._period.has_begun and (has_ended or call_count or not ready):
            # The next turn takes the messages of awaited sources, at once.
            self._process([each for each in self._target.sources
                           if has_ended or call_count or each not in awaited], at_once=False)
        if has_ended:
            self._end_period()
        self._make_calls(call_count)
        for function in [each for each, due in self._due.items() if due <= time.monotonic()]:
            del self._due[function]
            function()
        self._failures.note_success(self._processed)

    def _longest_wait(self) -> float:
        seconds = min(self._due.values(), default=math.inf) - time.monotonic()
        if self._period.has_begun:
            seconds = min(
                seconds, _LONGEST_SLEEP_S, _CLOCK_PERIOD_S if self._is_simulated
                else (self._period.ends_ns - time.time_ns()) / NANOSECONDS)
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
        frames, lookup, _, settings = self._target
        self._streams = KnownStreams(
            frames, lookup, settings.model_pose_frames, settings.model_pose_placement)
        self._problems = MessageProblems(frames)
        self._period.forget()
        now = time.monotonic()
        self._due[self._publish_all] = self._due[self._publish_at_rest] = now
        self._due[self._look_at_publishers] = now + PUBLISHERS_PERIOD_S
        if not self._has_reported_missing:
            self._due[self._end_grace] = now + GRACE_S

    def _end_period(self) -> None:
        """Publish what has waited, if anything has; otherwise publish the next message at once."""
        rows, sources = self._period.end(self._target.sources), self._target.sources
        silent_ns = self._now_ns - max(2.0 * self._target.period_ns, SILENCE_NS)
        self._publish(rows, [each for each in sources if each.last_ns < silent_ns])

    # Messages

    def _process(self, sources: Sequence[StateSource], *, at_once: bool) -> None:
        """
        Take the messages of sources, and set their positions.

        :param at_once: whether to publish what they move, and to leave the others as soon as a
            period has begun. Otherwise it waits; of those with the same names the newest counts.
        """
        newest: dict[MessageStream, Message] = {}
        # Messages may come faster than they are taken. Sources take turns, so that one with too
        # many messages does not delay the others.
        ends_at = time.monotonic() + TOPICS_PERIOD_S
        while sources and time.monotonic() < ends_at:
            sources = [
                each for each in sources
                if self._failures.attempt([each], True, each.take, self._streams, newest)]
            if at_once:
                self._publish(self._move_all(newest))
                newest.clear()
                # The wait tells whether there are more. Calls wait for all of them.
                if self._period.has_begun or not self._calls:
                    return
        self._period.add(self._move_all(newest))

    def _move_all(self, newest: Mapping[MessageStream, Message]) -> Rows:
        return union([
            self._failures.attempt([each.stream.source], NO_ROWS, self._move, each)
            for each in newest.values()])

    def _follow_clock(self) -> None:
        """Accept any stamp after time has jumped back, for example when a bag starts again."""
        clock = self._node.get_clock()
        self._is_simulated = clock.ros_time_is_active
        now_ns = clock.now().nanoseconds if self._is_simulated else time.time_ns()
        self._has_jumped, self._now_ns = now_ns < self._now_ns, now_ns
        if self._has_jumped:
            self._logger.info('time has jumped back', throttle_duration_sec=10.0)
            self._target.frames.forget_stamps()
            self._period.forget()

    def _move(self, message: Message) -> Rows:
        target, stream, source = self._target, message.stream, message.stream.source
        positions, ignores_stamps = target.frames.positions, target.settings.ignore_timestamp
        stamp_ns = message.stamp_ns or self._node.get_clock().now().nanoseconds
        if self._has_jumped and stamp_ns > self._now_ns:
            return NO_ROWS  # it was sent before that
        try:
            values = self._streams.values(message)
        except SdfError as error:
            reason = str(error)
            source.warn('frame', lambda: f'a pose from {source.name} is ignored: {reason}')
            return NO_ROWS
        source.last_ns = self._now_ns
        source.warn_about_invalid(positions.update(
            stream.selection, values, stamp_ns, ignore_stamps=ignores_stamps))
        if self._has_reported_missing and not any(positions.unreported()):
            self._has_reported_missing = False
            models = ' and models' if positions.free_models else ''
            self._logger.info(f'all joints{models} have been reported now')
        rows = self._streams.rows(stream)
        if len(rows) and not self._has_moved:
            self._has_moved = True
            count = len(target.sources)
            self._logger.info(
                f'following {source.name}' if count == 1 else
                f'following {count} sources; the first message is on {source.name}')
        moved = target.frames.stamp(rows, stamp_ns, ignore_stamps=ignores_stamps)
        if len(rows) and not len(moved):
            self._problems.note_lateness(stream, stamp_ns, self._now_ns)
        self._processed.add(source)
        return moved

    # Publication

    def _publish(self, rows: Rows, awaited: Sequence[StateSource] = ()) -> None:
        """
        Publish moving transforms, if any; with a highest rate, a period begins if there is none.

        :param awaited: the sources whose messages do not wait for the end of this period.
        """
        if not len(rows):
            return
        self._target.frames.publish_tf(rows)
        now = time.monotonic()
        self._due[self._publish_to_listeners] = max(self._topics_due, now)
        self._due[self._publish_at_rest] = now + _REST_S
        if self._period.has_begun:
            self._period.publish_early(rows, self._now_ns)
        # Simulated time that has not begun would never end a period.
        elif self._target.period_ns and self._now_ns:
            self._period.begin(self._now_ns + self._target.period_ns, awaited)

    def _publish_all(self) -> None:
        """Publish all frames on ``/tf``; repeatedly as long as no message has come."""
        self._period.forget()
        if self._target.frames.publish_all():
            self._due[self._publish_all] = time.monotonic() + INITIAL_PERIOD_S

    def _publish_to_listeners(self) -> None:
        # Later publications keep their schedule.
        self._topics_due = max(self._topics_due + TOPICS_PERIOD_S, time.monotonic())
        self._target.frames.publish_topics(only_listeners=True)

    def _publish_at_rest(self) -> None:
        # Later listeners get the last positions.
        self._target.frames.publish_topics(only_listeners=False)

    def _look_at_publishers(self) -> None:
        self._due[self._look_at_publishers] = time.monotonic() + PUBLISHERS_PERIOD_S
        self._problems.look_at_publishers(self._streams.known)

    def _report(self) -> StateReport:
        target = self._target
        positions = target.frames.positions
        joints, models = ([], []) if self._end_grace in self._due else positions.unreported()
        return StateReport(
            joints, models,
            [each.name for each in target.sources if joints and each.is_of_joints
             and not positions.unknown(joints[:1], each.model)],
            self._problems.lines(target.sources), self._failures.problems())

    def _end_grace(self) -> None:
        """Log the joints and models that no message has named, once."""
        if line := self._report().line_about_unreported():
            self._has_reported_missing = True
            self._logger.info(line)
