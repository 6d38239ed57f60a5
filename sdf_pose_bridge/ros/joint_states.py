# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Follow ``joint_states``: take the positions of joints, and publish the frames that they move.

``/tf`` gets the transforms that a message changes, with the stamp of the message. What a joint
moves that no message has named so far is not there; or, if such joints are at zero, it is there
before the first message, and then with each message, so that TF is complete.

With a highest rate, a message is published at once and those that follow it wait in the
subscription for one period, without waking the executor: to wake it takes ten times as long as
everything that is done with a message.
"""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Sequence
import contextlib
import copy
from dataclasses import dataclass
import threading
import time

import numpy as np
from numpy.typing import NDArray
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.clock import Clock
from rclpy.clock import ClockType
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from rclpy.subscription import Subscription
from rclpy.timer import Timer
from sensor_msgs.msg import JointState

from sdf_pose_bridge.ros.cdr import joint_state_from_bytes
from sdf_pose_bridge.ros.cdr import JointStateBytes
from sdf_pose_bridge.ros.cdr import StampedMessages
from sdf_pose_bridge.ros.log_lines import line_about_unreported_joints
from sdf_pose_bridge.ros.log_lines import names_in_line
from sdf_pose_bridge.ros.published_frames import PublishedMovingFrames
from sdf_pose_bridge.ros.publishers import Stamp
from sdf_pose_bridge.ros.qos_overrides import overriding_options
from sdf_pose_bridge.ros.qos_overrides import POLICIES_OF_SUBSCRIPTION
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.joint_positions import LARGEST_POSITION
from sdf_pose_bridge.tf.joint_positions import Selection

INITIAL_PERIOD_S = 0.1
"""How often ``/tf`` is published before the first message, if joints are at zero then."""

GRACE_S = 2.0
"""After how long joints that no message has named are reported."""

TOPICS_PERIOD_S = 1.0 / 30.0
"""How often the topics of moving frames are published at most."""

_REST_S = 0.5
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
    is_waiting: bool = False
    """Whether that message still has to be published."""


class _Gate(ReentrantCallbackGroup):
    """
    The group of a subscription whose messages wake the executor only while it is open.

    What is closed lets the executor take messages all the same if nothing else can.
    """

    def __init__(self) -> None:
        super().__init__()
        self.is_open = True
        self.keeps_messages = False

    def can_execute(self, _entity: object) -> bool:
        return self.is_open or not self.keeps_messages

    def beginning_execution(self, entity: object) -> bool:
        return self.can_execute(entity)


class JointStates:
    """
    Follows ``joint_states``.

    :param frequency: how often each transform is published on ``/tf`` at most, in Hz; 0.0 for
        each message.
    :param ignores_stamps: whether to publish each message, also one with the last one's stamp.
    """

    def __init__(
        self, node: Node, frames: PublishedMovingFrames, frequency: float, *,
        ignores_stamps: bool = False,
    ) -> None:
        self.rule = frequency, ignores_stamps
        """These parameters."""
        frequency = 0.0 if ignores_stamps else frequency
        self._ignores_stamps = ignores_stamps
        self._node = node
        self._logger = node.get_logger()
        self._frames = frames
        self._plans: dict[tuple[str, ...], _Plan] = {}
        self._last_message: JointStateBytes | None = None
        self._topics_due = 0.0
        # When names that mean nothing are logged again.
        self._unknown_due = 0.0
        self._are_topics_behind = False
        self._published_at = 0.0
        self._is_grace_over = False
        self._has_reported_missing = False
        self._gate = _Gate()
        # Simulated time may stand still.
        steady_clock = Clock(clock_type=ClockType.STEADY_TIME)
        self._initial_timer = node.create_timer(
            INITIAL_PERIOD_S, self._publish_initially, clock=steady_clock)
        self._grace_timer = node.create_timer(GRACE_S, self._end_grace, clock=steady_clock)
        self._timers = [self._initial_timer, self._grace_timer]
        # A copy, which parameters may change.
        rest_period, quality = TOPICS_PERIOD_S, copy.copy(qos_profile_sensor_data)
        self._period_timer: Timer | None = None
        if frequency:
            period = 1.0 / frequency
            # While messages follow one another, the other timer does not wake the executor.
            rest_period = min(max(TOPICS_PERIOD_S, 1.5 * period), _REST_S)
            quality = QoSProfile(depth=_MOST_WAITING, reliability=ReliabilityPolicy.BEST_EFFORT)
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
        # What is best effort and volatile fits every publisher, so there is nothing to report
        # unless parameters change that.
        self._subscription = node.create_subscription(
            JointState, 'joint_states', self.update_from_message, quality,
            callback_group=self._gate, raw=True,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
            qos_overriding_options=overriding_options(
                node, 'joint_states', 'subscription', POLICIES_OF_SUBSCRIPTION))
        self._take_message = _take_message_from_subscription(self._subscription)
        self._gate.keeps_messages = self._take_message is not None

    def destroy(self) -> None:
        """Stop following, and destroy what was created for it."""
        self._node.destroy_subscription(self._subscription)
        for timer in self._timers:
            self._node.destroy_timer(timer)

    def replace(self, frames: PublishedMovingFrames) -> None:
        """Move other frames from now on."""
        if frames is self._frames:
            return
        if set(frames.positions.missing).difference(self._frames.positions.missing):
            self._is_grace_over = False
            self._grace_timer.reset()
        self._frames = frames
        self._plans.clear()
        self._initial_timer.reset()

    @property
    def unreported(self) -> tuple[str, ...]:
        """The joints that no message has named, although there was time."""
        return self._frames.positions.missing if self._is_grace_over else ()

    def take_waiting(self) -> None:
        """Take all messages that wait in the subscription, for a 30th of a second at most."""
        if self._gate.is_open or self._take_message is None:
            return  # the executor takes them
        # Other callbacks would wait for ever for the end of messages that come too fast.
        ends_at = time.monotonic() + TOPICS_PERIOD_S
        with self._subscription.handle:
            while time.monotonic() < ends_at and (
                    taken := self._take_message(JointState, True)) is not None:
                self.update_from_message(taken[0])

    # Messages

    def update_from_message(self, data: bytes) -> None:
        """
        Take positions of joints, and publish what they move unless it has to wait.

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
        positions = self._frames.positions
        plan = self._plans.get(message.names) or self._new_plan(message)
        were_reported = positions.is_reported.copy()
        invalid = positions.update(plan.selection, values)
        if (positions.is_reported != were_reported).any():
            # Plans would publish other transforms from now on.
            self._publish_tf()
            self._plans.clear()
            plan = self._new_plan(message)
            if self._has_reported_missing and not positions.missing:
                self._has_reported_missing = False
                self._logger.info('all joints have been reported now')
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
        plan.is_waiting |= self._ignores_stamps or plan.stamp != stamp
        plan.stamp = stamp
        if self._gate.is_open:
            self._publish()

    def _new_plan(self, message: JointStateBytes) -> _Plan:
        positions = self._frames.positions
        selection = positions.selection(message.names)
        if selection.unknown:
            self._warn_about_unknown(selection.unknown, positions)
        if len(self._plans) == _MOST_PLANS:
            self._publish_tf()
            self._plans.clear()
        rows = np.array([], np.intp)
        if len(selection.rows):
            others = np.flatnonzero(positions.is_known & ~positions.is_reported).tolist()
            rows = self._frames.frames.rows_moved_by([*selection.changed, *others])
            rows = rows[self._frames.has_transform[rows]]
        plan = _Plan(selection, rows, self._frames.tf_message(rows))
        self._plans[message.names] = plan
        return plan

    def _warn_about_unknown(self, names: Sequence[str], positions: JointPositions) -> None:
        now = time.monotonic()
        if now < self._unknown_due:
            return
        self._unknown_due = now + _WARNING_PERIOD_S

        def warn() -> None:
            self._logger.warning(
                f'{self._subscription.topic_name} has {names_in_line(names)}, not the name of one '
                f'moving joint{positions.hint(names[0])}')

        # To find the name that was probably meant takes long where there are many.
        with contextlib.suppress(RuntimeError):  # there is no room for another thread
            threading.Thread(target=warn, name='hint', daemon=True).start()

    def _publish(self) -> None:
        """Publish what messages have changed, and let those that follow wait."""
        self._publish_tf()
        self._publish_topics_if_due()
        # Simulated time that has not begun would never end a period.
        if self._period_timer is not None and self._node.get_clock().now().nanoseconds:
            self._gate.is_open = False
            self._period_timer.reset()

    def _publish_tf(self) -> None:
        for plan in self._plans.values():
            if plan.is_waiting and plan.stamp is not None:
                plan.is_waiting = False
                self._frames.publish_tf(plan.rows, plan.message, plan.stamp)

    def _end_period(self) -> None:
        """Publish what has waited; where nothing has, publish the next message at once."""
        self.take_waiting()
        if any(plan.is_waiting for plan in self._plans.values()):
            self._publish()
        elif self._period_timer is not None:
            self._period_timer.cancel()
            self._gate.is_open = True

    def _end_grace(self) -> None:
        """Report the joints that no message has named, once."""
        self._grace_timer.cancel()
        self._is_grace_over = True
        if self.unreported:
            self._has_reported_missing = True
            self._logger.info(line_about_unreported_joints(self.unreported))

    def _publish_initially(self) -> None:
        """Publish all frames on ``/tf`` until there are positions."""
        if self._frames.stamp is None and self._frames.positions.is_known.any():
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


def _take_message_from_subscription(
    subscription: Subscription,
) -> Callable[[type, bool], tuple[bytes, object] | None] | None:
    """Return what takes a waiting message from a subscription, if this release of rclpy has it."""
    # Executors call it; rclpy has no public way.
    take: Callable[[type, bool], tuple[bytes, object] | None] | None = getattr(
        subscription.handle, 'take_message', None)
    return take
