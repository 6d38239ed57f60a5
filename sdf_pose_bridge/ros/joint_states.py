# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Follow ``joint_states``: take the positions of joints, and publish the frames that they move.

``/tf`` gets the transforms that a message changes, with the stamp of the message, and those of
joints that no message has named so far, so that TF is complete. Before the first message all
joints are published where the file puts them.
"""

from __future__ import annotations

from dataclasses import dataclass
import time

import numpy as np
from numpy.typing import NDArray
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.clock import Clock
from rclpy.clock import ClockType
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from sensor_msgs.msg import JointState

from sdf_pose_bridge.ros.cdr import joint_state_from_bytes
from sdf_pose_bridge.ros.cdr import JointStateBytes
from sdf_pose_bridge.ros.cdr import StampedMessages
from sdf_pose_bridge.ros.log_lines import names_in_line
from sdf_pose_bridge.ros.published_frames import PublishedMovingFrames
from sdf_pose_bridge.ros.publishers import Stamp
from sdf_pose_bridge.tf.joint_positions import LARGEST_POSITION
from sdf_pose_bridge.tf.joint_positions import Selection

INITIAL_PERIOD_S = 0.1
"""How often ``/tf`` is published before the first message of ``joint_states``."""

TOPICS_PERIOD_S = 1.0 / 30.0
"""How often the topics of moving frames are published at most."""

_PERIODS_UNTIL_REST = 15
_WARNING_PERIOD_S = 10.0
_NANOSECONDS = 1_000_000_000
_MOST_PLANS = 20
_MOST_WAITING = 1000


@dataclass
class _Plan:
    """What messages with the same names change."""

    selection: Selection
    """The degrees of freedom that the names mean."""
    rows: NDArray[np.intp]
    """The moving transforms to publish."""
    message: StampedMessages
    """A message for ``/tf`` with these."""
    stamp: Stamp | None = None
    """That of the last message."""


class JointStates:
    """
    Follows ``joint_states``.

    :param is_published_later: whether messages wait for :meth:`publish_waiting` instead of being
        published at once.
    """

    def __init__(
        self, node: Node, frames: PublishedMovingFrames, *, is_published_later: bool,
    ) -> None:
        self.is_published_later = is_published_later
        self._node = node
        self._logger = node.get_logger()
        self._frames = frames
        self._plans: dict[tuple[str, ...], _Plan] = {}
        self._last_message: JointStateBytes | None = None
        self._waiting_rows: set[int] = set()
        self._topics_due = 0.0
        self._are_topics_behind = False
        self._periods_at_rest = 0
        # Simulated time may stand still.
        steady_clock = Clock(clock_type=ClockType.STEADY_TIME)
        self._rest_timer = node.create_timer(
            TOPICS_PERIOD_S, self._follow_to_rest, clock=steady_clock)
        self._initial_timer = node.create_timer(
            INITIAL_PERIOD_S, self._publish_initially, clock=steady_clock)
        self._timers = [self._rest_timer, self._initial_timer]
        quality, group = qos_profile_sensor_data, None
        if is_published_later:
            # The messages of a period wait in the subscription, which does not wake the executor:
            # that takes ten times as long as everything that is done with a message.
            quality = QoSProfile(depth=_MOST_WAITING, reliability=ReliabilityPolicy.BEST_EFFORT)
            group = MutuallyExclusiveCallbackGroup()
            self._timers.append(node.create_timer(
                TOPICS_PERIOD_S, self._take_waiting, clock=steady_clock))
        # What is best effort and volatile fits every publisher, so there is nothing to report.
        self._subscription = node.create_subscription(
            JointState, 'joint_states', self.take, quality, callback_group=group, raw=True,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False))
        if group is not None:
            # To executors a callback of the group is always running, so they take no messages.
            group.beginning_execution(self._subscription)

    def destroy(self) -> None:
        """Stop following, and destroy what was created for it."""
        self._node.destroy_subscription(self._subscription)
        for timer in self._timers:
            self._node.destroy_timer(timer)

    def replace(self, frames: PublishedMovingFrames) -> None:
        """Move other frames from now on."""
        self._frames = frames
        self._plans.clear()
        self._waiting_rows.clear()

    def publish_waiting(self) -> None:
        """Publish on ``/tf`` what messages have changed since the last call."""
        self._take_waiting()
        if self._waiting_rows and self._frames.stamp is not None:
            rows = np.array(sorted(self._waiting_rows), np.intp)
            self._waiting_rows.clear()
            self._frames.publish_tf(rows, self._frames.tf_message(rows), self._frames.stamp)

    # Messages

    def _take_waiting(self) -> None:
        """Take all messages that wait in the subscription, for one period at most."""
        # Other callbacks would wait for ever for the end of messages that come too fast.
        ends_at = time.monotonic() + TOPICS_PERIOD_S
        # Executors do the same; rclpy has no public way.
        with self._subscription.handle:
            while time.monotonic() < ends_at and (
                    taken := self._subscription.handle.take_message(JointState, True)) is not None:
                self.take(taken[0])

    def take(self, data: bytes) -> None:
        """
        Take positions of joints, and publish what they move.

        :param data: a serialized message.
        """
        try:
            message = self._last_message = joint_state_from_bytes(data, self._last_message)
        except ValueError as error:
            self._logger.warning(
                f'a message on {self._subscription.topic_name} cannot be read: {error}',
                throttle_duration_sec=_WARNING_PERIOD_S)
            return
        values, stamp = message.positions, message.stamp
        if len(values) != len(message.names):
            self._logger.warning(
                f'a message on {self._subscription.topic_name} has {len(message.names)} names '
                f'and {len(values)} positions; it is ignored, as each name must have a position',
                throttle_duration_sec=_WARNING_PERIOD_S)
            return
        if stamp[0] < 0 or stamp[1] >= _NANOSECONDS:
            self._logger.warning(
                f'a message on {self._subscription.topic_name} has the stamp sec={stamp[0]} '
                f'nanosec={stamp[1]}; it is ignored, as sec must not be negative and nanosec must '
                f'be less than {_NANOSECONDS}', throttle_duration_sec=_WARNING_PERIOD_S)
            return
        plan = self._plans.get(message.names) or self._new_plan(message)
        invalid = self._frames.positions.update(plan.selection, values)
        if invalid:
            self._logger.warning(
                f'{self._subscription.topic_name} has positions for {names_in_line(invalid)} that '
                f'are not finite or beyond {LARGEST_POSITION:g}; the last ones are kept',
                throttle_duration_sec=_WARNING_PERIOD_S)
        if not len(plan.rows):
            return
        if not any(stamp):
            stamp = self._node.get_clock().now().seconds_nanoseconds()
        if self._frames.stamp is None:
            self._logger.info(f'following {self._subscription.topic_name}')
        self._frames.stamp = stamp
        # TF takes one transform for each time, and complains about a second one.
        is_repeated, plan.stamp = plan.stamp == stamp, stamp
        if self.is_published_later:
            self._waiting_rows.update(plan.rows.tolist())
        elif not is_repeated:
            self._frames.publish_tf(plan.rows, plan.message, stamp)
        self._publish_topics_if_due()

    def _new_plan(self, message: JointStateBytes) -> _Plan:
        positions = self._frames.positions
        selection = positions.selection(message.names)
        if selection.unknown:
            self._logger.warning(
                f'{self._subscription.topic_name} has {names_in_line(selection.unknown)}, not the '
                f'name of one moving joint{positions.hint(selection.unknown[0])}',
                throttle_duration_sec=_WARNING_PERIOD_S)
        were_known = positions.is_known.copy()
        positions.update(selection, message.positions)
        if len(self._plans) == _MOST_PLANS or (positions.is_known != were_known).any():
            # Other plans would publish what this one does from now on.
            self._plans.clear()
        rows = np.array([], np.intp)
        if len(selection.rows):
            unknown = np.flatnonzero(~positions.is_known).tolist()
            rows = self._frames.frames.rows_moved_by([*selection.changed, *unknown])
        plan = _Plan(selection, rows, self._frames.tf_message(rows))
        self._plans[message.names] = plan
        return plan

    def _publish_initially(self) -> None:
        """Publish all frames on ``/tf`` until there are positions."""
        if self._frames.stamp is None:
            self._frames.publish_all()
        else:
            # If it were only cancelled, the executor would go on to wait for it.
            self._node.destroy_timer(self._initial_timer)

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
        self._periods_at_rest = 0

    def _follow_to_rest(self) -> None:
        """Publish the last positions on topics; at rest once more, for later listeners."""
        self._periods_at_rest += 1
        is_at_rest = self._periods_at_rest == _PERIODS_UNTIL_REST
        if is_at_rest:
            self._rest_timer.cancel()
        if is_at_rest or self._are_topics_behind:
            self._are_topics_behind = False
            self._frames.publish_topics(only_listeners=not is_at_rest)
