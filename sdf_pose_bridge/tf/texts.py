# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Hold many short texts in one piece of memory, as messages need them.

To make thousands of strings takes longer than to write what they say into a message, so that is
left for when somebody asks for them.
"""

from __future__ import annotations

from collections.abc import Iterator
from collections.abc import Sequence
from functools import cached_property
from typing import Any
from typing import TYPE_CHECKING
from typing import TypeAlias

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

Rows: TypeAlias = 'npt.NDArray[np.integer[Any]] | slice'
Places: TypeAlias = 'npt.NDArray[np.int64]'

CHUNK = 56
"""So many bytes can be taken from anywhere in a text, whether or not it is so long."""

ZEROS = 8
"""Zeros behind each text: the one that ends it, and what fills up a word."""

_HOLDS_ZERO = 'a frame id holds a zero character, which no message can carry'
_FEW_BYTES = 10_000
"""As long as texts have so few bytes, a set of strings is made faster than sums."""
_WORD = 8
_FACTOR = 0x9E3779B97F4A7C15
"""Any large odd number whose bits look random; this is 2 to the power 64 by the golden ratio."""


class Texts:
    """
    Texts that can be taken out of one piece of memory.

    :param joined: the texts in UTF-8, each with a zero behind it.
    """

    def __init__(self, joined: bytes) -> None:
        self.joined = joined

    @classmethod
    def from_strings(cls, strings: Sequence[str]) -> Texts:
        """
        Join strings.

        :param strings: any number of them.
        :return: the same as texts.
        :raises ValueError: if one of them holds a zero character.
        """
        texts = cls('\0'.join([*strings, '']).encode())
        if texts.joined.count(0) != len(strings):
            raise ValueError(_HOLDS_ZERO)
        texts.strings = tuple(strings)
        return texts

    @cached_property
    def strings(self) -> tuple[str, ...]:
        """The texts as strings."""
        return tuple(self.joined.decode().split('\0')[:-1])

    @cached_property
    def lengths(self) -> Places:
        """How many bytes each has, with one zero."""
        ends = np.flatnonzero(np.frombuffer(self.joined, np.uint8) == 0) + 1
        lengths: Places = ends.copy()
        lengths[1:] -= ends[:-1]
        return lengths

    @cached_property
    def starts(self) -> Places:
        """Where each begins in the data."""
        sizes = self.lengths + (ZEROS - 1)
        starts: Places = np.cumsum(sizes) - sizes
        return starts

    @cached_property
    def data(self) -> bytes:
        """The texts with all the zeros that make room for chunks."""
        return self.joined.replace(b'\0', bytes(ZEROS)) + bytes(CHUNK)

    def __len__(self) -> int:
        return len(self.lengths)

    def __iter__(self) -> Iterator[str]:
        return iter(self.strings)

    def taken(self, rows: Rows) -> Texts:
        """
        Choose some of the texts, or some of them more than once.

        :param rows: which ones; from behind where negative.
        :return: those.
        """
        return _TakenTexts(self, rows)

    def with_one_more(self, string: str) -> Texts:
        """
        Put another text behind these.

        :param string: the text.
        :return: all of them.
        :raises ValueError: if it holds a zero character.
        """
        if '\0' in string:
            raise ValueError(_HOLDS_ZERO)
        return Texts(b'%b%b\0' % (self.joined, string.encode()))

    def has_repeats(self) -> bool:
        """
        Tell whether any text is there more than once.

        :return: whether it is.
        """
        if len(self.joined) > _FEW_BYTES and self.lengths.max() <= CHUNK:
            sums = self._sums()
            sums.sort()
            if (sums[1:] != sums[:-1]).all():
                return False
        return len(set(self.strings)) < len(self.strings)

    def has_white_space(self) -> bool:
        """
        Tell whether any character is white space.

        :return: whether one is; also true of control characters.
        """
        if self.joined.isascii():
            # Without the zeros, which are the highest of these numbers.
            codes = np.frombuffer(self.joined, np.uint8) - 1
            return bool((codes < ord(' ')).any())
        text = self.joined.decode()
        return text.split(None, 1) != [text]

    def _sums(self) -> npt.NDArray[np.uint64]:
        """Make a number of each, which hardly ever is that of another text, too."""
        words = np.ndarray((len(self.data) - _WORD + 1,), '<u8', self.data, strides=(1,))
        sums = np.zeros(len(self), np.uint64)
        for step in range(0, int(self.lengths.max(initial=0)), _WORD):
            # The zeros behind a text fill up its last word; words behind that are of others.
            word = words[self.starts + step] * (self.lengths > step)
            word ^= word >> 32
            word *= pow(_FACTOR, step // _WORD + 1, 2**64)
            sums += word
        return sums


class _TakenTexts(Texts):

    def __init__(self, texts: Texts, rows: Rows) -> None:
        self._all = texts
        self._rows = rows
        self.data = texts.data
        self.starts = texts.starts[rows]
        self.lengths = texts.lengths[rows]

    @cached_property
    def strings(self) -> tuple[str, ...]:
        strings = self._all.strings
        if isinstance(self._rows, slice):
            return strings[self._rows]
        return tuple(map(strings.__getitem__, self._rows.tolist()))
