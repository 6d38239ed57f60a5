# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Limits of a load, and its choice of what to do about missing files.

They bound the size of the tree that is read, as a few includes that double one another can produce
any number of elements. The time and memory that a hostile file takes are bounded by the process in
which it is read.
"""

from __future__ import annotations

from contextvars import ContextVar
import enum
from typing import NamedTuple

from sdf_pose_bridge.errors import LimitError, Place


class Limits(NamedTuple):
    """Limits of a load. The defaults allow a file of a million poses."""

    bytes_read: int = 512 * 1024 * 1024
    """Size of all files together, with included files and manifests."""
    elements: int = 10_000_000
    """XML elements in all files together."""
    copied_elements: int = 400_000
    """XML elements that includes and their parameters copy, beyond those in the files; a merged
    model counts twice, as it is also checked by itself."""
    characters: int = 10_000_000
    """Characters of the scoped names of all elements together, beyond 64 for each."""
    include_depth: int = 64
    """Depth of includes."""
    depth: int = 300
    """Depth of elements; libxml2 allows 256 levels in one file."""
    processor_s: int = 120
    """Processor time in s; only in a process with limits, which grow with the size of files."""
    memory_bytes: int = 4_000_000_000
    """Memory, likewise."""


DEFAULT_LIMITS = Limits()

FOLLOWED: ContextVar[list[Usage] | None] = ContextVar('followed', default=None)
"""Gets the amounts of each load that begins, for one who tells how far it is."""


class MissingInclude(enum.Enum):
    """Treatment of includes that are not found."""

    ERROR = 'error'
    """The file is not valid."""
    SKIP = 'skip'
    """The include is left out, with a warning."""


class Usage:
    """
    The amounts that a load has used so far. Limits are named by their fields.

    :param limits: the limits of the load.
    """

    def __init__(self, limits: Limits = DEFAULT_LIMITS) -> None:
        self.limits = limits
        self._used = dict.fromkeys(Limits._fields, 0)
        self.files: list[str] = []
        """Paths of the files that were read."""
        self.elements: list[list[str]] = []
        """Names of the elements with a pose that were read, in lists that grow."""
        if (followed := FOLLOWED.get()) is not None:
            followed.append(self)

    def add(self, limit: str, amount: int, place: Place) -> None:
        """
        Count a use.

        :param place: the place that uses it.
        :raises LimitError: if the limit is exceeded.
        """
        self._used[limit] += amount
        self.check(limit, self._used[limit], place)

    def left(self, limit: str) -> int:
        """Return the rest of a limit."""
        most: int = getattr(self.limits, limit)
        return most - self._used[limit]

    def check(self, limit: str, value: int, place: Place) -> None:
        """
        Compare a value with a limit.

        :param place: the place of the value.
        :raises LimitError: if it is greater than the limit.
        """
        most: int = getattr(self.limits, limit)
        if value > most:
            msg = f'the file exceeds the limits of a load: the limit {limit} is {most}'
            raise LimitError(msg, place)
