# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Limit how much a load reads and does, so that no small file takes long, or all memory.

A few includes that double one another can stand for any number of elements. So all work that is
not in proportion to what is read is counted where its loops are, in steps of about a microsecond.
A file of 1 MB, with what it includes, is judged in less than two seconds, whatever it holds.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from sdf_pose_bridge.errors import LimitError
from sdf_pose_bridge.errors import Place


class Limits(NamedTuple):
    """What a load may use. The defaults leave room for a file of a million poses."""

    bytes_read: int = 512 * 1024 * 1024
    """Size of all files together, included files and manifests among them."""
    elements: int = 10_000_000
    """XML elements that are written in all files together."""
    work: int = 1_000_000
    """Steps of work beyond reading: what includes copy, names that are joined, references that are
    followed. Every ``BYTES_OF_STEP`` bytes that are read allow one step more."""
    include_depth: int = 64
    """How deep files may include one another."""
    depth: int = 300
    """How deep elements may be nested; libxml2 allows 256 levels in one file."""


DEFAULT_LIMITS = Limits()

BYTES_OF_STEP = 4
"""How many bytes that are read allow one more step of work."""

STEPS_OF_INCLUDE = 100
"""Steps of work that each include counts for, without what it copies; one that merges twice."""

STEPS_OF_MERGE = 500
"""Further steps for an include that merges a model, which is checked by itself."""

STEPS_OF_MOVED_CHILD = 4
"""Further steps for each child of a model that is merged, which gets another parent."""

STEPS_OF_PLACE = 8
"""Steps of work to find the place of an error or a warning, and to report it."""

STEPS_OF_ELEMENT = 2
"""Steps of work that each element counts for that is copied."""

STEPS_OF_NAMED_ELEMENT = 8
"""Further steps for one with a name, as most elements with a frame have one."""

CHARACTERS_OF_LOOK = 1000
"""Searching a model for a name costs one step per this many characters."""

CHARACTERS_OF_STEP = 16
"""How many characters of a name, or of an element that is copied, count for one step of work."""


class Usage:
    """
    What a load has used so far. Limits are named by their fields.

    :param limits: what it may use.
    """

    def __init__(self, limits: Limits = DEFAULT_LIMITS) -> None:
        self.limits = limits
        self._used = dict.fromkeys(Limits._fields, 0)

    def add(self, limit: str, amount: int, place: Place | Callable[[], Place]) -> None:
        """
        Count what is used.

        :param place: where it is used, or a function that returns that.
        :raises LimitError: if that is more than the limit allows.
        """
        self._used[limit] += amount
        self.check(limit, self._used[limit], place)

    def left(self, limit: str) -> int:
        """Return how much of a limit may still be used."""
        return self._most(limit) - self._used[limit]

    def check(self, limit: str, value: int, place: Place | Callable[[], Place]) -> None:
        """
        Compare a value with a limit.

        :param place: where it was reached, or a function that returns that.
        :raises LimitError: if it is greater than the limit.
        """
        most = self._most(limit)
        if value > most:
            msg = f'the file needs more than a load may use: the limit {limit} is {most}'
            raise LimitError(msg, place if isinstance(place, Place) else place())

    def _most(self, limit: str) -> int:
        most: int = getattr(self.limits, limit)
        return most + self._used['bytes_read'] // BYTES_OF_STEP if limit == 'work' else most
