# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Find what the names in joint states mean, and keep it for messages with the same names."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.ros.cdr import SerializedNames
from sdf_pose_bridge.ros.published_frames import PublishedMovingFrames
from sdf_pose_bridge.tf.joint_positions import Selection

MOST_BYTES = 4_000_000
"""Largest size of all names and rows that are kept. A message has a quarter of it at most."""


@dataclass(eq=False)
class Meaning:
    """The meaning of the names in a message."""

    names: SerializedNames
    selection: Selection
    """Their degrees of freedom."""
    rows: NDArray[np.intp]
    """The moving transforms to publish."""
    unreported_count: int = -1
    """Number of unreported degrees of freedom when these were found; -1 if they were not."""


class Meanings:
    """
    The meanings of the names on all topics.

    :param frames: the frames that messages move.
    """

    def __init__(self, frames: PublishedMovingFrames) -> None:
        self.positions = frames.positions
        self._frames = frames
        # By the model and the names, and the last one of each topic.
        self._meanings: dict[tuple[str, tuple[str, ...]], Meaning] = {}
        self._last: dict[str, Meaning] = {}
        self._size = 0

    def last(self, topic: str) -> Meaning | None:
        """Return the meaning of the names in the last message on a topic, if it is kept."""
        return self._last.get(topic)

    def find(
        self, names: SerializedNames, topic: str, model: str,
    ) -> tuple[Meaning, list[str]]:
        """
        Find the meaning of names.

        :param topic: the full name of their topic.
        :param model: the top-level model whose joints they name; empty for all joints.
        :return: the meaning; and the unknown and ambiguous names, if it was not kept.
        """
        unknown = []
        found = self._meanings.get((model, names.names))
        if found is None:
            found = Meaning(
                names, self.positions.selection(names.names, model), np.array([], np.intp))
            unknown = self.positions.unknown(names.names, model)
            self._make_room(len(names.data))
            self._meanings[model, names.names] = found
        self._last[topic] = found
        return found, unknown

    def rows(self, meaning: Meaning) -> NDArray[np.intp]:
        """Return the transforms that the names move, and those of joints at zero."""
        positions = self.positions
        if meaning.unreported_count != positions.unreported_count and len(meaning.selection.dofs):
            meaning.unreported_count = positions.unreported_count
            is_changed = positions.is_known & ~positions.is_reported
            is_changed[meaning.selection.changed] = True
            meaning.rows = np.flatnonzero(
                self._frames.frames.depends_on(is_changed) & self._frames.has_transform)
            self._make_room(meaning.rows.nbytes)
        return meaning.rows

    def _make_room(self, size: int) -> None:
        """Forget all meanings if they would be too many."""
        self._size += size
        if self._size > MOST_BYTES:
            self._meanings.clear()
            self._last.clear()
            self._size = size
