# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Process the messages of one topic of joint states, and set the positions in them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
import contextlib
import copy
from dataclasses import dataclass
import threading
import time
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription
from sensor_msgs.msg import JointState

from sdf_pose_bridge.ros.cdr import joint_state_from_bytes, JointStateBytes
from sdf_pose_bridge.ros.log_lines import names_in_line
from sdf_pose_bridge.ros.published_frames import PublishedMovingFrames
from sdf_pose_bridge.ros.publishers import NANOSECONDS
from sdf_pose_bridge.ros.qos_overrides import SUBSCRIPTION_OVERRIDES
from sdf_pose_bridge.tf.joint_positions import JointPositions, LARGEST_POSITION, Selection

_WARNING_PERIOD_S = 10.0
_MOST_PLANS = 20
_MOST_WAITING = 1000


class Change(NamedTuple):
    """The changes of a message."""

    rows: NDArray[np.intp]
    """The moving transforms that have to be published."""
    stamp_ns: int


@dataclass
class _Plan:
    """The changes of messages with the same names."""

    selection: Selection
    """The degrees of freedom that the names mean."""
    dofs_beside: NDArray[np.intp]
    """All degrees of freedom of the same top-level models."""
    rows: NDArray[np.intp]
    """The moving transforms to publish."""
    reported_count: int = -1
    """Number of reported joints when these were found; -1 if they were not."""


class _Gate(ReentrantCallbackGroup):
    """
    The group of a subscription whose messages wake the executor only while it is open.

    If no other callback can run, the executor processes messages of a closed group too.
    """

    def __init__(self) -> None:
        super().__init__()
        self.is_open = True
        self.keeps_messages = False

    def can_execute(self, _entity: object) -> bool:
        return self.is_open or not self.keeps_messages

    def beginning_execution(self, entity: object) -> bool:
        return self.can_execute(entity)


class JointStateTopic:
    """
    Processes the messages of one topic.

    :param name: the name of the topic, before it is remapped.
    :param model: the top-level model whose joints the messages name; empty for all joints.
    :param number: a number that no other topic has.
    :param waits: whether messages may have to wait in the subscription.
    :param receive: called with this topic, a message, and its metadata from rclpy.
    """

    def __init__(
        self, node: Node, name: str, model: str, number: int, *, waits: bool,
        receive: Callable[[JointStateTopic, bytes, Any], None],
    ) -> None:
        self.silent_periods = 0
        """Number of periods that have ended since the last message; the caller counts them."""
        self.has_new_joints = False
        """Whether joints have been reported since the message before with the same names."""
        self._node = node
        self._logger = node.get_logger()
        self._model = model
        self._number = number
        self._plans: dict[tuple[str, ...], _Plan] = {}
        self._last_message: JointStateBytes | None = None
        # Time to log unknown names again.
        self._unknown_due = 0.0
        self._gate = _Gate()

        def take(data: bytes, info: Any) -> None:
            receive(self, data, info)

        self._take = take
        # A copy, which parameters may change. A best effort and volatile subscription is
        # compatible with every publisher, so there is nothing to report unless parameters change
        # that.
        self._subscription = node.create_subscription(
            JointState, name, take,
            QoSProfile(depth=_MOST_WAITING, reliability=ReliabilityPolicy.BEST_EFFORT) if waits
            else copy.copy(qos_profile_sensor_data),
            callback_group=self._gate, raw=True,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
            qos_overriding_options=SUBSCRIPTION_OVERRIDES)
        self._take_message = _take_message_from_subscription(self._subscription)
        self._gate.keeps_messages = self._take_message is not None

    @property
    def name(self) -> str:
        """The full name of the topic."""
        name: str = self._subscription.topic_name
        return name

    @property
    def is_open(self) -> bool:
        """Whether messages wake the executor; otherwise they wait in the subscription."""
        return self._gate.is_open

    @is_open.setter
    def is_open(self, is_open: bool) -> None:
        self._gate.is_open = is_open

    def destroy(self) -> None:
        """Destroy the subscription."""
        self._node.destroy_subscription(self._subscription)

    def forget_frames(self) -> None:
        """Prepare for other frames."""
        self._plans.clear()

    def take_one(self) -> bool:
        """Process one message that waits in the subscription; return whether there was one."""
        if self.is_open or self._take_message is None:
            return False  # the executor takes them
        with self._subscription.handle:
            taken = self._take_message(JointState, True)
        if taken is not None:
            self._take(*taken)
        return taken is not None

    def update(
        self, frames: PublishedMovingFrames, data: bytes, sent_ns: int,
    ) -> Change | None:
        """
        Set the positions of a message.

        :param data: a serialized message.
        :param sent_ns: the time of sending.
        :return: the changes to publish; None if there are none.
        """
        self.has_new_joints = False
        message = self._valid_message(data)
        if message is None:
            return None
        positions = frames.positions
        names, values = message.names, message.positions
        plan = self._plans.get(names) or self._new_plan(names, positions)
        is_newer = positions.take_newer(plan.selection, self._number, sent_ns)
        if is_newer is not None:
            rows = plan.selection.rows[is_newer]
            names, values = tuple(names[row] for row in rows.tolist()), values[rows]
            plan = self._plans.get(names) or self._new_plan(names, positions)
        invalid = positions.update(plan.selection, values)
        if invalid:
            self._logger.warning(
                f'{self.name} has positions for {names_in_line(invalid)} that '
                f'are not finite or beyond {LARGEST_POSITION:g}; the last ones are kept',
                throttle_duration_sec=_WARNING_PERIOD_S)
        reported_count = int(np.count_nonzero(positions.is_reported))
        self.has_new_joints = plan.reported_count != reported_count
        if self.has_new_joints:
            plan.reported_count = reported_count
            plan.rows = _rows_of_plan(plan, frames)
        if not len(plan.rows):
            return None
        sec, nanosec = message.stamp
        stamp_ns: int = sec * NANOSECONDS + nanosec or self._node.get_clock().now().nanoseconds
        positions.stamps_ns[plan.dofs_beside] = stamp_ns
        return Change(plan.rows, stamp_ns)

    def _valid_message(self, data: bytes) -> JointStateBytes | None:
        """Read a message; return None with a warning if it cannot be used."""
        try:
            message = self._last_message = joint_state_from_bytes(data, self._last_message)
        except ValueError as error:
            self._logger.warning(
                f'a message on {self.name} cannot be read: {error}',
                throttle_duration_sec=_WARNING_PERIOD_S)
            return None
        if len(message.positions) != len(message.names):
            self._logger.warning(
                f'a message on {self.name} has {len(message.names)} names '
                f'and {len(message.positions)} positions; it is ignored, as each name must have '
                'a position', throttle_duration_sec=_WARNING_PERIOD_S)
            return None
        sec, nanosec = message.stamp
        if sec < 0 or nanosec >= NANOSECONDS:
            self._logger.warning(
                f'a message on {self.name} has the stamp sec={sec} nanosec={nanosec}; it is '
                'ignored, as sec must not be negative and nanosec must be less than '
                f'{NANOSECONDS}', throttle_duration_sec=_WARNING_PERIOD_S)
            return None
        return message

    def _new_plan(self, names: tuple[str, ...], positions: JointPositions) -> _Plan:
        selection = positions.selection(names, self._model)
        if selection.unknown:
            self._warn_about_unknown(selection.unknown, positions)
        if len(self._plans) == _MOST_PLANS:
            self._plans.clear()
        plan = self._plans[names] = _Plan(
            selection, positions.dofs_beside(selection.changed), np.array([], np.intp))
        return plan

    def _warn_about_unknown(self, names: Sequence[str], positions: JointPositions) -> None:
        now = time.monotonic()
        if now < self._unknown_due:
            return
        self._unknown_due = now + _WARNING_PERIOD_S
        where = f' in model "{self._model}"' if self._model else ''

        def warn() -> None:
            self._logger.warning(
                f'{self.name} has {names_in_line(names)}, not the name of one '
                f'moving joint{where}{positions.hint(names[0], self._model)}')

        # Finding the nearest name takes long if there are many.
        with contextlib.suppress(RuntimeError):  # no memory for another thread
            threading.Thread(target=warn, name='hint', daemon=True).start()


def _rows_of_plan(plan: _Plan, frames: PublishedMovingFrames) -> NDArray[np.intp]:
    """Return the transforms that the names of a plan move, and those of unreported joints."""
    if not len(plan.selection.rows):
        return np.array([], np.intp)
    positions = frames.positions
    others = np.flatnonzero(positions.is_known & ~positions.is_reported).tolist()
    rows = frames.frames.rows_moved_by([*plan.selection.changed, *others])
    return rows[frames.has_transform[rows]]


def _take_message_from_subscription(
    subscription: Subscription,
) -> Callable[[type, bool], tuple[bytes, object] | None] | None:
    """Return the function that takes a waiting message, if this release of rclpy has it."""
    # Executors call it; rclpy has no public function for it.
    take: Callable[[type, bool], tuple[bytes, object] | None] | None = getattr(
        subscription.handle, 'take_message', None)
    return take
