# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Follow ``joint_states``: take the positions of joints, and publish the frames that they move.

``/tf`` gets the transforms that a message changes, with the stamp of the message, and those of
joints that no message has named so far, so that TF is complete. Before the first message all
joints are published where the file puts them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from rclpy.clock import Clock
from rclpy.clock import ClockType
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import JointState

from sdf_pose_bridge.ros.log_lines import names_in_line
from sdf_pose_bridge.ros.moving_publishers import MovingPublishers
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.joint_positions import LARGEST_POSITION
from sdf_pose_bridge.tf.joint_positions import Selection
from sdf_pose_bridge.tf.moving_frames import MovingFrames
from sdf_pose_bridge.tf.tree import TfTree

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from sdf_pose_bridge.ros.cdr import StampedMessages
    from sdf_pose_bridge.ros.publishers import FramePublishers

INITIAL_PERIOD_S = 0.1
"""How often ``/tf`` is published before the first message of ``joint_states``."""

TOPICS_PERIOD_S = 1.0 / 30.0
"""How often the topics of moving frames are published at most."""

_PERIODS_UNTIL_REST = 15
_WARNING_PERIOD_S = 10.0
_MOST_PLANS = 20


class _Plan:
    """
    What messages with the same names change.

    :param names: the names.
    :param selection: the degrees of freedom that they mean.
    :param rows: the moving transforms to publish.
    :param message: a message for ``/tf`` with these.
    """

    def __init__(
        self, names: Sequence[str], selection: Selection, rows: NDArray[np.intp],
        message: StampedMessages,
    ) -> None:
        self.names = names
        self.selection = selection
        self.rows = rows
        self.message = message
        self.stamp: tuple[int, int] | None = None
        """That of the last message."""


class JointStates:
    """
    Follows ``joint_states``.

    :param node: the node.
    :param tree: the tree to move at first.
    :param moving: its moving frames.
    :param positions: the positions of its joints.
    """

    def __init__(
        self, node: Node, tree: TfTree, moving: MovingFrames, positions: JointPositions,
    ) -> None:
        self.is_published_later = False
        """Whether messages wait for :meth:`publish_waiting` instead of being published at once."""
        self._node = node
        self._logger = node.get_logger()
        self._publishers = MovingPublishers(node)
        self._stamp: tuple[int, int] | None = None
        # Simulated time may stand still.
        steady_clock = Clock(clock_type=ClockType.STEADY_TIME)
        self._initial_timer = node.create_timer(
            INITIAL_PERIOD_S, self._publish_all, clock=steady_clock)
        self._topics_timer = node.create_timer(
            TOPICS_PERIOD_S, self._publish_topics, clock=steady_clock)
        self._use(tree, moving, positions)
        self._subscription = node.create_subscription(
            JointState, 'joint_states', self.take, qos_profile_sensor_data)

    def destroy(self) -> None:
        """Stop following, and destroy what was created for it."""
        self._node.destroy_subscription(self._subscription)
        self._node.destroy_timer(self._initial_timer)
        self._node.destroy_timer(self._topics_timer)
        self._publishers.destroy()

    def replace(self, tree: TfTree, moving: MovingFrames, positions: JointPositions) -> None:
        """
        Move another tree from now on, and publish it on ``/tf``.

        :param tree: the tree.
        :param moving: its moving frames.
        :param positions: the positions of its joints. Joints with the same names as before
            continue where they are.
        """
        positions.take_over(self._positions)
        self._use(tree, moving, positions)

    def _use(self, tree: TfTree, moving: MovingFrames, positions: JointPositions) -> None:
        self._moving, self._positions = moving, positions
        self._plans: dict[tuple[str, ...], _Plan] = {}
        self._last_plan: _Plan | None = None
        self._waiting_rows: set[int] = set()
        self._publishers.use(tree, moving)
        self._publish_all()

    def set_pose_publishers(self, publishers: FramePublishers | None) -> None:
        """
        Use the publishers of pose topics.

        :param publishers: those of all frames; None to use none while they are replaced.
        """
        self._publishers.set_pose_publishers(publishers)
        self._request_topics()

    def publish_waiting(self) -> None:
        """Publish on ``/tf`` what messages have changed since the last call."""
        if self._waiting_rows and self._stamp is not None:
            rows = np.array(sorted(self._waiting_rows), np.intp)
            self._waiting_rows.clear()
            self._publish_tf(rows, self._publishers.tf_message(rows), self._stamp)

    # Messages

    def take(self, message: JointState) -> None:
        """
        Take positions of joints, and publish what they move.

        :param message: a message of ``joint_states``.
        """
        names, values = message.name, np.asarray(message.position)
        if len(values) != len(names):
            self._logger.warning(
                f'a message on {self._subscription.topic_name} has {len(names)} names and '
                f'{len(values)} positions; it is ignored, as each name must have a position',
                throttle_duration_sec=_WARNING_PERIOD_S)
            return
        plan = self._last_plan
        if plan is None or plan.names != names:
            plan = self._last_plan = self._plan_from_names(names, values)
        invalid = self._positions.update(plan.selection, values)
        if invalid:
            self._logger.warning(
                f'{self._subscription.topic_name} has positions for {names_in_line(invalid)} that '
                f'are not finite or beyond {LARGEST_POSITION:g}; the last ones are kept',
                throttle_duration_sec=_WARNING_PERIOD_S)
        if not len(plan.rows):
            return
        stamp = message.header.stamp.sec, message.header.stamp.nanosec
        if not any(stamp):
            stamp = self._now()
        if self._stamp is None:
            self._initial_timer.cancel()
            self._logger.info(f'following {self._subscription.topic_name}')
        self._stamp = stamp
        # TF takes one transform for each time, and complains about a second one.
        is_repeated, plan.stamp = plan.stamp == stamp, stamp
        if self.is_published_later:
            self._waiting_rows.update(plan.rows.tolist())
        elif not is_repeated:
            self._publish_tf(plan.rows, plan.message, stamp)
        self._request_topics()

    def _plan_from_names(self, names: Sequence[str], values: NDArray[np.float64]) -> _Plan:
        key = tuple(names)
        if key in self._plans:
            return self._plans[key]
        positions = self._positions
        selection = positions.selection(names)
        if selection.unknown:
            self._logger.warning(
                f'{self._subscription.topic_name} has {names_in_line(selection.unknown)}, not the '
                f'name of one moving joint{positions.hint(selection.unknown[0])}',
                throttle_duration_sec=_WARNING_PERIOD_S)
        were_known = positions.is_known.copy()
        positions.update(selection, values)
        if len(self._plans) == _MOST_PLANS or (positions.is_known != were_known).any():
            # Other plans would publish what this one does from now on.
            self._plans.clear()
        rows = np.array([], np.intp)
        if len(selection.rows):
            unknown = np.flatnonzero(~positions.is_known).tolist()
            rows = self._moving.rows_moved_by([*selection.changed, *unknown])
        plan = self._plans[key] = _Plan(
            names, selection, rows, self._publishers.tf_message(rows))
        return plan

    # Publishing

    def _publish_tf(
        self, rows: NDArray[np.intp], message: StampedMessages, stamp: tuple[int, int],
    ) -> None:
        message.set_poses(self._moving.transforms(self._positions.values)[rows])
        self._publishers.publish_tf(message, stamp)

    def _publish_all(self) -> None:
        """Publish all moving transforms on ``/tf`` with the time of the node."""
        rows = np.arange(len(self._moving.indices))
        if len(rows):
            self._publish_tf(rows, self._publishers.tf_message(rows), self._now())

    def _request_topics(self) -> None:
        self._periods_at_rest = -1
        if self._topics_timer.is_canceled():
            self._topics_timer.reset()

    def _publish_topics(self) -> None:
        """Publish the topics of moving frames; at rest once more, for later listeners."""
        self._periods_at_rest += 1
        is_at_rest = self._periods_at_rest == _PERIODS_UNTIL_REST
        if is_at_rest:
            self._topics_timer.cancel()
        elif self._periods_at_rest:
            return
        self._publishers.publish_topics(
            self._positions.values, self._stamp or self._now(), only_listeners=not is_at_rest)

    def _now(self) -> tuple[int, int]:
        now: tuple[int, int] = self._node.get_clock().now().seconds_nanoseconds()
        return now
