# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Limit how much a load reads and makes, so that a small hostile file cannot take all memory.

A few includes that double one another can stand for any number of elements.
"""

from __future__ import annotations

from typing import NamedTuple

from sdf_pose_bridge.errors import LimitError
from sdf_pose_bridge.errors import Place


class Limits(NamedTuple):
    """What a load may use. The defaults leave room for a file of a million poses."""

    bytes_read: int = 512 * 1024 * 1024
    """Size of all files together, included files and manifests among them."""
    elements: int = 10_000_000
    """XML elements that are written in all files together."""
    included_elements: int = 500_000
    """Elements that includes copy; those of a merged model count ten times."""
    include_depth: int = 64
    """How deep files may include one another."""
    depth: int = 300
    """How deep elements may be nested; libxml2 allows 256 levels in one file."""
    name_characters: int = 100_000_000
    """Length of the absolute names of all elements together."""


DEFAULT_LIMITS = Limits()


class Usage:
    """
    What a load has used so far.

    :param limits: what it may use.
    """

    def __init__(self, limits: Limits = DEFAULT_LIMITS) -> None:
        self.limits = limits
        self._used = dict.fromkeys(Limits._fields, 0)

    def add(self, limit: str, amount: int, place: Place) -> None:
        """
        Count what is used.

        :param limit: name of a field of the limits.
        :param amount: how much of it is used.
        :param place: where it is used.
        :raises LimitError: if that is more than the limit allows.
        """
        self._used[limit] += amount
        self.check(limit, self._used[limit], place)

    def left(self, limit: str) -> int:
        """
        Return how much may still be used.

        :param limit: name of a field of the limits.
        :return: how much of it is left.
        """
        most: int = getattr(self.limits, limit)
        return most - self._used[limit]

    def add_elements_of(self, text: bytes, place: Place) -> None:
        """
        Count the elements in a text before it is parsed, which takes many times its memory.

        :param text: XML; comments in it are counted too.
        :param place: its file.
        :raises LimitError: if it has more elements than the limit allows.
        """
        self.add('elements', text.count(b'<') - text.count(b'</'), place)

    def check(self, limit: str, value: int, place: Place) -> None:
        """
        Compare a value with a limit.

        :param limit: name of a field of the limits.
        :param value: the value.
        :param place: where it was reached.
        :raises LimitError: if it is greater than the limit.
        """
        most: int = getattr(self.limits, limit)
        if value > most:
            msg = f'the file needs more than a load may use: the limit {limit} is {most}'
            raise LimitError(msg, place)
