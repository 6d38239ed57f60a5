# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Recognize the names of many tags at once, eight bytes at a time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple
from typing import TYPE_CHECKING
from typing import TypeAlias

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

_Words: TypeAlias = 'npt.NDArray[np.uint64]'
_Numbers: TypeAlias = 'npt.NDArray[np.int16]'

WIDTH = 8
"""Bytes that are looked at together."""

UNKNOWN = -1
"""Stands for the number of a name that was not asked for."""

_ENDS = b'>/'
_BELOW = ord(' ') + 1
"""White space is below this, and so is nothing else that XML has."""
_ONES = np.uint64(0x0101010101010101)
_TOPS = np.uint64(0x8080808080808080)
_SLOT_BITS = 16
_BLOCK = 1 << 15
_SPREADING = np.uint64(0x9E3779B97F4A7C15)


class _Step(NamedTuple):
    """What is known after one more word of a name."""

    factor: np.uint64
    """Spreads keys so that no two get the same slot."""
    slots: _Numbers
    """The row of each slot; any row for slots that no key gets."""
    states: _Numbers
    """For each row what was known before."""
    words: _Words
    numbers: _Numbers
    """The name that ends with this word."""
    next_states: _Numbers
    """What is known if the name goes on."""


class TagNames:
    """
    Names of tags, by number.

    :param tags: the names; the first one has number 0.
    """

    def __init__(self, tags: Sequence[str]) -> None:
        self.tags = tuple(tags)
        self.number_of = {tag: number for number, tag in enumerate(tags)}
        self._steps: list[_Step] = []
        known = {0: [(tag.encode(), number) for tag, number in self.number_of.items()]}
        while known:
            step, known = _step_from_names(known)
            self._steps.append(step)

    def numbers_from_text(
        self, text: npt.NDArray[np.uint8], places: npt.NDArray[np.intp],
    ) -> _Numbers:
        """
        Recognize names.

        :param text: bytes.
        :param places: where the names begin; each ends before white space, ``/`` or ``>``.
        :return: the number of each name, or :data:`UNKNOWN`.
        """
        # Behind each name there are at least the end of its tag and that of the outermost element.
        words = words_from_text(text)
        # Some at a time, so that what is worked with stays near to the processor.
        numbers = [self._numbers(words, places[start:start + _BLOCK])
                   for start in range(0, len(places), _BLOCK)]
        return np.concatenate([np.zeros(0, dtype=np.int16), *numbers])

    def _numbers(self, words: _Words, places: npt.NDArray[np.intp]) -> _Numbers:
        numbers = np.full(len(places), UNKNOWN, dtype=np.int16)
        rest = np.arange(len(places))
        states = np.zeros(len(places), dtype=np.int16)
        for offset, step in enumerate(self._steps):
            word, is_end = _cut_at_end(words[places + offset * WIDTH])
            found = step.slots[_slots(_keys(states, word), step.factor)]
            is_known = (step.words[found] == word) & (step.states[found] == states)
            ends = np.flatnonzero(is_known & is_end)
            numbers[rest[ends]] = step.numbers[found[ends]]
            goes_on = np.flatnonzero(is_known & ~is_end & (step.next_states[found] != UNKNOWN))
            rest, places = rest[goes_on], places[goes_on]
            states = step.next_states[found[goes_on]]
        return numbers


def words_from_text(text: npt.NDArray[np.uint8]) -> _Words:
    """
    Look at a text as words.

    :param text: bytes, at least :data:`WIDTH` of them.
    :return: for each place the word that begins there; its lowest byte is the one in that place.
    """
    words: _Words = np.ndarray(
        (len(text) - WIDTH + 1,), np.dtype('<u8'), text.data, strides=(1,))
    return words


def _cut_at_end(words: _Words) -> tuple[_Words, npt.NDArray[np.bool_]]:
    """Set to zero what follows the end of a name; tell for each word whether there is an end."""
    # Below a byte that is less than a limit, no bit is set; its own top bit is. What is above it
    # may be wrong and does not matter.
    ends = (words - _ONES * np.uint64(_BELOW)) & ~words
    for end in _ENDS:
        differences = words ^ (_ONES * np.uint64(end))
        ends |= (differences - _ONES) & ~differences
    ends &= _TOPS
    first = ends & (~ends + np.uint64(1))
    names: _Words = words & ((first >> np.uint64(7)) - np.uint64(1))
    return names, ends != 0


def _keys(states: _Numbers, words: _Words) -> _Words:
    keys: _Words = words ^ (states.astype(np.uint64) * _SPREADING)
    return keys


def _step_from_names(
    known: dict[int, list[tuple[bytes, int]]],
) -> tuple[_Step, dict[int, list[tuple[bytes, int]]]]:
    """Take one word off each name; return what is left, by what is known after it."""
    following: dict[int, list[tuple[bytes, int]]] = {}
    rows: dict[tuple[int, int], list[int]] = {}
    for state, names in known.items():
        for name, number in names:
            word = int.from_bytes(name[:WIDTH], 'little')
            row = rows.setdefault((state, word), [UNKNOWN, UNKNOWN])
            if len(name) < WIDTH:
                row[0] = number
                continue
            if row[1] == UNKNOWN:
                row[1] = len(following)
            following.setdefault(row[1], []).append((name[WIDTH:], number))
    states = np.array([state for state, _ in rows], dtype=np.int16)
    words = np.array([word for _, word in rows], dtype=np.uint64)
    numbers, next_states = np.array(list(rows.values()), dtype=np.int16).T
    keys = _keys(states, words)
    factor = _SPREADING
    while len(set(_slots(keys, factor).tolist())) < len(keys):
        factor += np.uint64(2)
    slots = np.zeros(1 << _SLOT_BITS, dtype=np.int16)
    slots[_slots(keys, factor)] = np.arange(len(keys))
    return _Step(factor, slots, states, words, numbers, next_states), following


def _slots(keys: _Words, factor: np.uint64) -> _Words:
    slots: _Words = (keys * factor) >> np.uint64(64 - _SLOT_BITS)
    return slots
