# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Count messages, and those that show that several publishers send them at once."""

from __future__ import annotations

import numpy as np

from sdf_pose_bridge.geometry.rotations import Floats

_LEAST_CONTRADICTIONS = 3
"""Smallest number of contradictions in a period; a publisher that starts again has one."""

_LEAST_STEP = 1e-3
"""Smallest change in m or rad that can be a contradiction; noise is smaller."""


class MessageCounts:
    """Counts messages with the same names, which one publisher should send."""

    def __init__(self) -> None:
        self.messages = 0
        """Number of messages in this period."""
        self.periods = 0
        """Number of periods up to the last one, each with a message."""
        self.number: int | None = None
        """The number that its publisher has given the last message; None if it has none."""
        self._contradictions = 0
        # Stamps and values of up to two messages before the next one, if they have no numbers.
        self._last: list[tuple[int, Floats]] = []

    @property
    def have_several_publishers(self) -> bool:
        """Whether one publisher cannot have sent the messages of this period."""
        return self._contradictions >= _LEAST_CONTRADICTIONS

    def add(self, stamp_ns: int, values: Floats, number: int | None) -> None:
        """
        Count a message, and whether the publisher of the one before cannot have sent it.

        Its number does not go up. Without a number, its stamp is older, or it repeats the values
        of the second last message, as messages of two publishers by turns do.

        :param stamp_ns: its stamp in nanoseconds; 0 if it has none.
        :param values: its values, as many in each message.
        :param number: the number that its publisher has given it; None if messages have none.
        """
        self.messages += 1
        if number is not None:
            self._contradictions += self.number is not None and number <= self.number
        else:
            self._contradictions += len(self._last) > 1 and self._contradicts(stamp_ns, values)
            # A copy, as the values are a part of the bytes of the message.
            self._last = [*self._last[-1:], (stamp_ns, values.copy())]
        self.number = number

    def end_period(self) -> None:
        """Begin to count again."""
        self.periods = self.periods + 1 if self.messages else 0
        self.messages = self._contradictions = 0

    def _contradicts(self, stamp_ns: int, values: Floats) -> bool:
        with np.errstate(all='ignore'):  # values need not be finite
            changes = [values - each for _, each in self._last]
            # Squares of the distances.
            rest, step = (np.vdot(each, each) for each in changes)
        return bool(
            0 < stamp_ns < self._last[-1][0] or (step > _LEAST_STEP**2 and rest < step / 16.0))
