# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Names in SDFormat: how they are scoped, which are reserved, and which one was meant."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Iterable

SEPARATOR = '::'
"""Separates the parts of a scoped name: ``robot::arm::hand``."""

WORLD_FRAME = 'world'
"""The name by which references in a world mean its frame."""

ROOT_FRAME = '__root__'
"""The implicit root of a model file. No file may write this name."""

MODEL_FRAME = '__model__'
"""The name by which references in a model mean the frame of the model."""

_MOST_COMPARED = 400
"""How many names are compared in full with one that was not found."""


def is_reserved(name: str) -> bool:
    """
    Return whether a name is reserved (``isReservedName`` of libsdformat).

    :param name: an element's own name, without its scope.
    :return: True for ``world``, and for four or more characters that begin and end with ``__``.
    """
    return name == WORLD_FRAME or (
        len(name) >= 4 and name.startswith('__') and name.endswith('__'))


def scoped_name(scope: str, name: str) -> str:
    """
    Return the absolute name of an element.

    :param scope: absolute name of its scope; empty for a world or the implicit root.
    :param name: its name, or a reference, in that scope.
    :return: the two joined by ``::``.
    """
    return f'{scope}{SEPARATOR}{name}' if scope else name


def hint_from_names(wanted: str, names: Iterable[str]) -> str:
    """
    Return the end of a message about a name that was not found.

    :param wanted: the name.
    :param names: the names that exist.
    :return: ``; did you mean "..."?`` with the nearest name, or an empty string.
    """
    nearest = nearest_name(wanted, names)
    return f'; did you mean "{nearest}"?' if nearest else ''


def nearest_name(wanted: str, names: Iterable[str]) -> str:
    """
    Return the name that was probably meant.

    :param wanted: a name that was not found.
    :param names: the names that exist.
    :return: the nearest of them, or an empty string if none is near.
    """
    # The import takes a millisecond, and most processes do not need it.
    import difflib
    near = difflib.get_close_matches(wanted, _likely_names(wanted, list(names)), n=1, cutoff=0.6)
    return near[0] if near else ''


def _likely_names(wanted: str, names: list[str]) -> list[str]:
    """Return the names with the longest common beginnings and ends, if there are very many."""
    if len(names) <= _MOST_COMPARED:
        return names
    length = len(wanted)
    longest = min(length, max(map(len, names)))
    same_start = _sharing_longest(names, longest, str.startswith, lambda size: wanted[:size])
    same_end = _sharing_longest(names, longest, str.endswith, lambda size: wanted[length - size:])
    half = _MOST_COMPARED // 2
    return [*same_start[:half], *same_end[:half]]


def _sharing_longest(
    names: list[str], longest: int, shares: Callable[[str, str], bool], part: Callable[[int], str],
) -> list[str]:
    """Find, by bisection, the names that share the longest possible part with the wanted one."""
    shortest = 0
    while shortest < longest:
        size = (shortest + longest + 1) // 2
        wanted = part(size)
        sharing = [name for name in names if shares(name, wanted)]
        if sharing:
            names, shortest = sharing, size
        else:
            longest = size - 1
    return names
