# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A topic of joint states: its subscription, and what is read of its messages."""

from __future__ import annotations

from collections.abc import Sequence
import contextlib
import time
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

from sdf_pose_bridge.ros.background import run_in_thread
from sdf_pose_bridge.ros.cdr import joint_state_from_bytes
from sdf_pose_bridge.ros.joint_names import Meaning, Meanings
from sdf_pose_bridge.ros.log_lines import names_in_line
from sdf_pose_bridge.ros.publishers import NANOSECONDS
from sdf_pose_bridge.ros.qos_overrides import SUBSCRIPTION_OVERRIDES
from sdf_pose_bridge.ros.wait_set import NoExecutor, take_message
from sdf_pose_bridge.tf.joint_positions import JointPositions, LARGEST_POSITION

MOST_WAITING = 100
"""Largest number of messages that wait in a subscription; then new ones replace the oldest."""

_WARNING_PERIOD_S = 10.0


class Message(NamedTuple):
    """The fields of a message that are read."""

    meaning: Meaning
    positions: NDArray[np.float64]
    """A position for each name."""
    stamp_ns: int
    """Its stamp in nanoseconds; 0 if it has none."""


class JointStateTopic:
    """
    A topic of joint states.

    :param name: the name of the topic, before it is remapped.
    :param model: the top-level model whose joints the messages name; empty for all joints.
    """

    def __init__(self, node: Node, name: str, model: str) -> None:
        self.model = model
        self.last_period = 0
        """Number of the period in which the last message was taken; the caller counts them."""
        self._node = node
        self._warnings_due: dict[str, float] = {}
        # A best effort and volatile subscription is compatible with every publisher, so there is
        # nothing to report unless parameters change that.
        self.subscription = node.create_subscription(
            JointState, name, lambda _: None,
            QoSProfile(depth=MOST_WAITING, reliability=ReliabilityPolicy.BEST_EFFORT),
            callback_group=NoExecutor(), raw=True,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
            qos_overriding_options=SUBSCRIPTION_OVERRIDES)
        self.name: str = self.subscription.topic_name
        """The full name of the topic."""

    def take(self) -> bytes | None:
        """Take a message; return None if there is none."""
        return take_message(self.subscription)

    def read(self, data: bytes, meanings: Meanings) -> Message | None:
        """Read a serialized message; return None with a warning if it cannot be used."""
        last = meanings.last(self.name)
        try:
            (sec, nanosec), names, values = joint_state_from_bytes(
                data, None if last is None else last.names)
            if len(values) != len(names.names):
                msg = (
                    f'it has {len(names.names)} names and {len(values)} positions, and each '
                    'name must have a position')
                raise ValueError(msg)
            if sec < 0 or nanosec >= NANOSECONDS:
                msg = (
                    f'it has the stamp sec={sec} nanosec={nanosec}, and sec must not be negative '
                    f'and nanosec must be less than {NANOSECONDS}')
                raise ValueError(msg)
        except ValueError as error:
            if self._may_warn('message'):
                self._node.get_logger().warning(f'a message on {self.name} is ignored: {error}')
            return None
        if last is None or names is not last.names:
            last, unknown = meanings.find(names, self.name, self.model)
            self._warn_about_unknown(unknown, meanings.positions)
        return Message(last, values, sec * NANOSECONDS + nanosec)

    def warn_about_invalid(self, names: Sequence[str]) -> None:
        """Log the joints whose positions cannot be used, if there are any."""
        if names and self._may_warn('positions'):
            self._node.get_logger().warning(
                f'{self.name} has positions for {names_in_line(names)} that '
                f'are not finite or beyond {LARGEST_POSITION:g}; the last ones are kept')

    def _warn_about_unknown(self, names: Sequence[str], positions: JointPositions) -> None:
        if not names or not self._may_warn('names'):
            return
        where = f' in model "{self.model}"' if self.model else ''

        def warn() -> None:
            self._node.get_logger().warning(
                f'{self.name} has {names_in_line(names)}, not the name of one '
                f'moving joint{where}{positions.hint(names[0], self.model)}')

        # Finding the nearest name takes long if there are many.
        with contextlib.suppress(MemoryError):
            run_in_thread(self._node, warn)

    def _may_warn(self, about: str) -> bool:
        now = time.monotonic()
        if now < self._warnings_due.get(about, 0.0):
            return False
        self._warnings_due[about] = now + _WARNING_PERIOD_S
        return True
