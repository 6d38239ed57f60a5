# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Limits of a load, so that no small file takes long, or all memory.

A few includes that double one another can produce any number of elements. So all work that is not
proportional to the bytes that are read is counted in its loops, in steps of about a microsecond. A
file of 1 MB, with its included files, is checked in less than two seconds.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from sdf_pose_bridge.errors import LimitError, Place


class Limits(NamedTuple):
    """Limits of a load. The defaults allow a file of a million poses."""

    bytes_read: int = 512 * 1024 * 1024
    """Size of all files together, with included files and manifests."""
    elements: int = 10_000_000
    """XML elements in all files together."""
    work: int = 1_000_000
    """Steps of work beyond reading, such as copying included elements, joining names and following
    references. Every ``BYTES_OF_STEP`` bytes that are read allow one step more."""
    include_depth: int = 64
    """Depth of includes."""
    depth: int = 300
    """Depth of elements; libxml2 allows 256 levels in one file."""


DEFAULT_LIMITS = Limits()

BYTES_OF_STEP = 4
"""One more step of work is allowed per this many bytes that are read."""

STEPS_OF_INCLUDE = 100
"""Steps of work of each include, without its copies; twice as many for a merge."""

STEPS_OF_MERGE = 500
"""Further steps for a merged model, which is checked by itself."""

STEPS_OF_MOVED_CHILD = 4
"""Further steps for each child of a merged model, which gets another parent."""

STEPS_OF_PLACE = 8
"""Steps of work to find the place of an error or a warning, and to report it."""

STEPS_OF_ELEMENT = 2
"""Steps of work of each copied element."""

STEPS_OF_NAMED_ELEMENT = 8
"""Further steps for one with a name, as most elements with a frame have a name."""

CHARACTERS_OF_LOOK = 1000
"""Searching a model for a name costs one step per this many characters."""

CHARACTERS_OF_STEP = 16
"""Joining names and copying elements cost one step of work per this many characters."""


class Usage:
    """
    The use of a load so far. Limits are named by their fields.

    :param limits: the limits of the load.
    """

    def __init__(self, limits: Limits = DEFAULT_LIMITS) -> None:
        self.limits = limits
        self._used = dict.fromkeys(Limits._fields, 0)

    def add(self, limit: str, amount: int, place: Place | Callable[[], Place]) -> None:
        """
        Count a use.

        :param place: the place that uses it, or a function that returns the place.
        :raises LimitError: if the limit is exceeded.
        """
        self._used[limit] += amount
        self.check(limit, self._used[limit], place)

    def left(self, limit: str) -> int:
        """Return the rest of a limit."""
        return self._most(limit) - self._used[limit]

    def check(self, limit: str, value: int, place: Place | Callable[[], Place]) -> None:
        """
        Compare a value with a limit.

        :param place: the place of the value, or a function that returns the place.
        :raises LimitError: if it is greater than the limit.
        """
        most = self._most(limit)
        if value > most:
            msg = f'the file exceeds the limits of a load: the limit {limit} is {most}'
            raise LimitError(msg, place if isinstance(place, Place) else place())

    def _most(self, limit: str) -> int:
        most: int = getattr(self.limits, limit)
        return most + self._used['bytes_read'] // BYTES_OF_STEP if limit == 'work' else most
