# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A topic of joint states: its subscription, and what its messages mean."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
import time
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import QoSPolicyKind, QoSProfile, ReliabilityPolicy
from rclpy.qos_overriding_options import QoSOverridingOptions
from sensor_msgs.msg import JointState

from sdf_pose_bridge.ros.cdr import joint_state_from_bytes, SerializedNames
from sdf_pose_bridge.ros.log_lines import names_in_line
from sdf_pose_bridge.ros.published_frames import PublishedMovingFrames
from sdf_pose_bridge.ros.wait_set import NoExecutor, take_message
from sdf_pose_bridge.tf.joint_positions import LARGEST_POSITION, Selection

MOST_WAITING = 100
"""Largest number of messages that wait in a subscription; then new ones replace the oldest."""

MOST_BYTES = 4_000_000
"""Largest size of all names and rows that are kept. A message has a quarter of it at most."""

BYTES_OF_OBJECTS = 2_000
"""Size that is counted for the objects of a meaning, in addition to its names and rows."""

_WARNING_PERIOD_S = 10.0


@dataclass(eq=False)
class Meaning:
    """The meaning of the names in a message."""

    names: SerializedNames
    selection: Selection
    """Their degrees of freedom."""
    rows: NDArray[np.intp]
    """The moving transforms to publish."""
    reported_count: int = -1
    """Number of reported degrees of freedom when these were found; -1 if they were not."""


class Message(NamedTuple):
    """The fields of a message that are read, and their meaning."""

    topic: JointStateTopic
    meaning: Meaning
    positions: NDArray[np.float64]
    """A position for each name."""
    stamp_ns: int
    """Its stamp in nanoseconds; 0 if it has none."""


class Meanings:
    """
    The meanings of the names on all topics, kept for messages with the same names.

    :param frames: the frames that messages move.
    """

    def __init__(self, frames: PublishedMovingFrames) -> None:
        self.positions = frames.positions
        self._frames = frames
        # By the model and the names.
        self._meanings: dict[tuple[str, tuple[str, ...]], Meaning] = {}
        self.last: dict[str, Meaning] = {}
        """The meaning of the names in the last message on each topic, as far as it is kept."""
        self._size = 0

    def find(self, names: SerializedNames, topic: JointStateTopic) -> tuple[Meaning, list[str]]:
        """
        Find the meaning of names on a topic.

        :return: the meaning; and the unknown and ambiguous names, if it was not kept.
        """
        unknown = []
        found = self._meanings.get((topic.model, names.names))
        if found is None:
            found = Meaning(
                names, self.positions.selection(names.names, topic.model), np.array([], np.intp))
            unknown = self.positions.unknown(names.names, topic.model)
            self._make_room(BYTES_OF_OBJECTS + len(names.data))
            self._meanings[topic.model, names.names] = found
        self.last[topic.name] = found
        return found, unknown

    def rows(self, meaning: Meaning) -> NDArray[np.intp]:
        """Return the transforms that the names move, and those of joints at zero."""
        if meaning.reported_count != self.positions.reported_count and meaning.selection.changed:
            meaning.reported_count = self.positions.reported_count
            meaning.rows = self._frames.rows_from_dofs(meaning.selection.changed)
            self._make_room(meaning.rows.nbytes)
        return meaning.rows

    def _make_room(self, size: int) -> None:
        """Forget all meanings if they would be too many."""
        self._size += size
        if self._size > MOST_BYTES:
            self._meanings.clear()
            self.last.clear()
            self._size = size


class JointStateTopic:
    """
    A topic of joint states.

    :param name: the name of the topic, before it is remapped.
    :param model: the top-level model whose joints the messages name; empty for all joints.
    """

    def __init__(self, node: Node, name: str, model: str) -> None:
        self.model = model
        self.last_ns = 0
        """Time of the node when the last message was used; the caller sets it."""
        self._logger = node.get_logger()
        self._warnings_due: dict[str, float] = {}
        # A best effort and volatile subscription is compatible with every publisher, so there is
        # nothing to report unless parameters change that.
        self.subscription = node.create_subscription(
            JointState, name, lambda _: None,
            QoSProfile(depth=MOST_WAITING, reliability=ReliabilityPolicy.BEST_EFFORT),
            callback_group=NoExecutor(), raw=True,
            event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False),
            # Without the depth, which the node chooses.
            qos_overriding_options=QoSOverridingOptions((
                QoSPolicyKind.RELIABILITY, QoSPolicyKind.DURABILITY)))
        self.name: str = self.subscription.topic_name
        """The full name of the topic."""

    def take(self, meanings: Meanings, newest: dict[Meaning, Message]) -> bool:
        """
        Take a message.

        :param newest: gets it, unless the one with the same names there is newer.
        :return: whether there was one.
        """
        data = take_message(self.subscription)
        message = None if data is None else self.read(data, meanings)
        if message is not None:
            known = newest.get(message.meaning, message)
            if not 0 < message.stamp_ns < known.stamp_ns:
                newest[message.meaning] = message
        return data is not None

    def read(self, data: bytes, meanings: Meanings) -> Message | None:
        """Read a serialized message; return None with a warning if it cannot be used."""
        meaning = meanings.last.get(self.name)
        try:
            stamp_ns, names, positions = joint_state_from_bytes(
                data, None if meaning is None else meaning.names)
        except ValueError as error:
            reason = str(error)
            self._warn('message', lambda: f'a message on {self.name} is ignored: {reason}')
            return None
        if meaning is None or names is not meaning.names:
            meaning, unknown = meanings.find(names, self)
            if unknown:
                where = f' in model "{self.model}"' if self.model else ''
                self._warn('names', lambda: (
                    f'{self.name} has {names_in_line(unknown)}, not the name of one moving joint'
                    f'{where}{meanings.positions.hint(unknown[0], self.model)}'))
        return Message(self, meaning, positions, stamp_ns)

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
