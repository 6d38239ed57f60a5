# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Hints with the nearest name, for messages about a name that was not found."""

from __future__ import annotations

import bisect
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
import difflib

from sdf_pose_bridge.names import SEPARATOR

_LONGEST_COMPARED = 200
"""Longer names are not compared."""

_NEIGHBORS = 25
"""Number of names on each side of an unknown name that are compared with it, in both orders."""

_SEPARATORS = '_-. '

_MOST_PAIRS = 5_000
"""Largest number of pairs of equal characters in compared names; the time is proportional to
it."""


def hint_from_names(wanted: str, names: Iterable[str]) -> str:
    """Return the end of a message about a name that was not found: the nearest name, or ''."""
    return NameIndex(names).hint(wanted)


class NameIndex:
    """
    Sorted names, in which the nearest name is found quickly.

    :param names: the existing names; very long ones are ignored.
    """

    def __init__(self, names: Iterable[str]) -> None:
        short = {name for name in names if len(name) <= 2 * _LONGEST_COMPARED}
        self._names = sorted(short, key=_sort_key)
        self._reversed_names = sorted((name[::-1] for name in short), key=_sort_key)

    def nearest(self, wanted: str) -> str:
        """Return the nearest other name; an empty string if none is near."""
        if len(wanted) > _LONGEST_COMPARED:
            return ''
        likely = [*_neighbors(self._names, wanted), *(
            name[::-1] for name in _neighbors(self._reversed_names, wanted[::-1]))]
        near = difflib.get_close_matches(wanted, _comparable(wanted, likely), n=1, cutoff=0.6)
        # Equal endings of files would make short names look alike.
        stem, dot, ending = wanted.rpartition('.')
        is_far = near and dot and near[0].endswith(dot + ending) and not (
            difflib.get_close_matches(stem, [near[0].removesuffix(dot + ending)]))
        return near[0] if near and not is_far and near[0] != wanted else ''

    def hint(self, wanted: str) -> str:
        """Return the end of a message about a name that was not found."""
        nearest = self.nearest(wanted)
        return f'; did you mean "{nearest}"?' if nearest else ''


def _sort_key(name: str) -> str:
    """Return the sort key of a name, which ignores case and separators."""
    name = name.replace(SEPARATOR, '/')
    for separator in _SEPARATORS:
        # For names beyond ASCII this is faster than str.translate.
        name = name.replace(separator, '/')
    return name.lower()


def _neighbors(names: Sequence[str], wanted: str) -> Sequence[str]:
    """Return the names around an unknown one; the nearest name has the same beginning."""
    index = bisect.bisect(names, _sort_key(wanted), key=_sort_key)
    return names[max(index - _NEIGHBORS, 0):index + _NEIGHBORS]


def _comparable(wanted: str, names: Iterable[str]) -> Iterator[str]:
    """Leave out names that take long to compare, such as a few letters repeated."""
    counts = Counter(wanted)
    pairs = 0
    for name in dict.fromkeys(names):
        new_pairs = sum(map(counts.__getitem__, name))
        if pairs + new_pairs <= _MOST_PAIRS:
            pairs += new_pairs
            yield name
