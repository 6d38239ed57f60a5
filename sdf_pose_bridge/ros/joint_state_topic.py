# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A topic of joint states: its subscription, and what is read of its messages."""

from __future__ import annotations

from collections.abc import Callable, Sequence
import time
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

from sdf_pose_bridge.ros.cdr import joint_state_from_bytes, NANOSECONDS
from sdf_pose_bridge.ros.joint_names import Meaning, Meanings
from sdf_pose_bridge.ros.log_lines import names_in_line
from sdf_pose_bridge.ros.qos_overrides import SUBSCRIPTION_OVERRIDES
from sdf_pose_bridge.ros.wait_set import NoExecutor, take_message
from sdf_pose_bridge.tf.joint_positions import LARGEST_POSITION

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
        self._logger = node.get_logger()
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
            reason = str(error)
            self._warn('message', lambda: f'a message on {self.name} is ignored: {reason}')
            return None
        if last is None or names is not last.names:
            last, unknown = meanings.find(names, self.name, self.model)
            if unknown:
                where = f' in model "{self.model}"' if self.model else ''
                self._warn('names', lambda: (
                    f'{self.name} has {names_in_line(unknown)}, not the name of one moving joint'
                    f'{where}{meanings.positions.hint(unknown[0], self.model)}'))
        return Message(last, values, sec * NANOSECONDS + nanosec)

    def warn_about_invalid(self, names: Sequence[str]) -> None:
        """Log the joints whose positions cannot be used, if there are any."""
        if names:
            self._warn('positions', lambda: (
                f'{self.name} has positions for {names_in_line(names)} that are not finite or '
                f'beyond {LARGEST_POSITION:g}; the last ones are kept'))

    def _warn(self, about: str, text: Callable[[], str]) -> None:
        """Log a warning, unless the last one about the same was not long ago."""
        now = time.monotonic()
        if now >= self._warnings_due.get(about, 0.0):
            self._warnings_due[about] = now + _WARNING_PERIOD_S
            self._logger.warning(text())
