# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The period in which moved transforms wait, so that they are published at a highest rate.

A message is published at once and begins a period, which is the same for all topics. Later ones
wait in the subscriptions for its end. Then the newest of them are published in one message, and
another period begins if there are any. The first message of a silent topic is published at once,
unless all topics are silent, as when many robots start together.
"""

from __future__ import annotations

from collections.abc import Sequence
import math

import numpy as np

from sdf_pose_bridge.ros.cdr import NO_ROWS, Rows
from sdf_pose_bridge.ros.following.state_messages import StateSource


class PublishPeriod:
    """A period, or the time until the next one begins."""

    def __init__(self) -> None:
        self.ends_ns = math.inf
        """Time of the node in ns at which it ends; infinity if there is none."""
        self.awaited: Sequence[StateSource] = ()
        """The sources whose messages do not wait for its end."""
        self._rows = NO_ROWS

    @property
    def has_begun(self) -> bool:
        """Whether there is a period."""
        return self.ends_ns < math.inf

    def begin(self, ends_ns: float, awaited: Sequence[StateSource]) -> None:
        """Begin a period after a publication."""
        self.ends_ns, self.awaited = ends_ns, awaited

    def add(self, rows: Rows) -> None:
        """Have transforms wait for the end."""
        self._rows = union([self._rows, rows])

    def publish_early(self, rows: Rows, now_ns: int) -> None:
        """Note transforms that are published before the end, and the sources that moved them."""
        self._rows = np.setdiff1d(self._rows, rows)
        self.awaited = [each for each in self.awaited if each.last_ns < now_ns]

    def forget(self) -> None:
        """Let no transforms wait."""
        self._rows = NO_ROWS

    def end(self, sources: Sequence[StateSource]) -> Rows:
        """End the period, and await all sources; return the transforms that have waited."""
        rows, self._rows = self._rows, NO_ROWS
        self.begin(math.inf, sources)
        return rows


def union(parts: Sequence[Rows]) -> Rows:
    """Return the rows of all parts in ascending order."""
    return np.unique(np.concatenate([NO_ROWS, *parts]))
