# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Names in SDFormat: scopes, reserved names, and hints with the nearest name."""

from __future__ import annotations

import bisect
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
import difflib
import re

SEPARATOR = '::'
"""Separates the parts of a scoped name: ``robot::arm::hand``."""

WORLD_FRAME = 'world'
"""The name of the frame of a world in references."""

ROOT_FRAME = '__root__'
"""The implicit root of a model file. No file may write this name."""

MODEL_FRAME = '__model__'
"""The name of the frame of a model in references inside the model."""

PROXY_START, PROXY_END = '_merged__', '__model__'
"""The beginning and the end of the name of the frame that replaces the frame of a merged model."""

JOINT_SUFFIX = '_joint'
"""Appended to the name of a joint if another element has the name."""

_LONGEST_VALUE = 80
_LONGEST_PATH = 300
_MOST_SHOWN = 5

_COMMAND_OF_RUNNER = re.compile(r'#(?=#\[)|(?<!\S):(?=:)')
"""The first character of a command of GitHub's runner: ``##[...]``, or ``::`` at the beginning."""

_INVISIBLE = frozenset(map(chr, (
    0x34f, 0x115f, 0x1160, 0x17b4, 0x17b5, 0x180b, 0x180c, 0x180d, 0x180f, 0x2800, 0x3164,
    *range(0xfe00, 0xfe10), 0xffa0, *range(0xe0100, 0xe01f0))))
"""Characters without a picture that count as printable (``Default_Ignorable_Code_Point``)."""

_LONGEST_COMPARED = 200
"""Longer names are not compared."""

_NEIGHBORS = 25
"""Number of names on each side of an unknown name that are compared with it, in both orders."""

_SEPARATORS = '_-. '

_MOST_PAIRS = 5_000
"""Largest number of pairs of equal characters in compared names; the time is proportional to
it."""


def is_reserved(name: str) -> bool:
    """
    Return whether a name without its scope is reserved (``isReservedName`` of libsdformat).

    :return: True for ``world``, and for four or more characters that begin and end with ``__``.
    """
    return name == WORLD_FRAME or (
        len(name) >= 4 and name.startswith('__') and name.endswith('__'))


def is_name_of_proxy(name: str) -> bool:
    """Return whether a merge may have made a name."""
    return name.startswith(PROXY_START) and name.endswith(PROXY_END)


def scoped_name(scope: str, name: str) -> str:
    """
    Return the absolute name of an element or of the target of a reference.

    :param scope: absolute name of its scope; empty for a world or the implicit root.
    """
    return f'{scope}{SEPARATOR}{name}' if scope else name


def unused_name(name: str, used: dict[str, int], separator: str = '_') -> str:
    """Return a name, numbered if it is used, and add it; ``used`` has the last number of each."""
    unused = name
    while unused in used:
        used[name] += 1
        unused = f'{name}{separator}{used[name]}'
    used[unused] = 0
    return unused


def shortened(value: str, longest: int = _LONGEST_VALUE) -> str:
    """
    Return a value from a file for a message, without its middle if it is too long.

    A path or a URI may be longer than other values.
    """
    if len(value) <= longest or ('/' in value and ' ' not in value and (
            len(value) <= _LONGEST_PATH)):
        return value
    half = (longest - 3) // 2
    return f'{value[:half]}...{value[-half:]}'


def quoted_names(names: Sequence[str], most: int = _MOST_SHOWN) -> str:
    """Return the first names for a message, in double quotes, and the number of the others."""
    return listed([f'"{shortened(name)}"' for name in names], most)


def listed(texts: Sequence[str], most: int = _MOST_SHOWN) -> str:
    """Return the first texts for a message, and the number of the others."""
    more = f' and {len(texts) - most} more' if len(texts) > most else ''
    return ', '.join(texts[:most]) + more


def printable(text: str) -> str:
    r"""
    Return text for one line of a log or a terminal.

    A name in a file can contain line breaks, which must not forge a line, characters that control
    a terminal or the direction of writing, and commands of a program that reads the log.

    :return: the text with escapes, such as ``\n``, for these and for characters that nobody sees.
    """
    text = _COMMAND_OF_RUNNER.sub(lambda match: f'\\x{ord(match[0]):x}', text)
    if text.isprintable() and _INVISIBLE.isdisjoint(text):
        return text
    return ''.join(
        character if character.isprintable() and character not in _INVISIBLE
        else character.encode('unicode_escape').decode() for character in text)


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
        """Return the nearest name; an empty string if none is near."""
        if len(wanted) > _LONGEST_COMPARED:
            return ''
        likely = [*_neighbors(self._names, wanted), *(
            name[::-1] for name in _neighbors(self._reversed_names, wanted[::-1]))]
        near = difflib.get_close_matches(wanted, _comparable(wanted, likely), n=1, cutoff=0.6)
        # Equal endings of files would make short names look alike.
        stem, dot, ending = wanted.rpartition('.')
        is_far = near and dot and near[0].endswith(dot + ending) and not (
            difflib.get_close_matches(stem, [near[0].removesuffix(dot + ending)]))
        return near[0] if near and not is_far else ''

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
