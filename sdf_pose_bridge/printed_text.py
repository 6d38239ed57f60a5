# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Text of others for one line of a message, a log or a terminal: escaped and shortened."""

from __future__ import annotations

from collections.abc import Sequence
import re

_LONGEST_VALUE = 80
_LONGEST_PATH = 300
_MOST_SHOWN = 5

_COMMAND_OF_RUNNER = re.compile(r'#(?=#\[)|(?<!\S):(?=:)')
"""The first character of a command of GitHub's runner: ``##[...]``, or ``::`` at the beginning."""

_INVISIBLE = frozenset(map(chr, (
    0x34f, 0x115f, 0x1160, 0x17b4, 0x17b5, 0x180b, 0x180c, 0x180d, 0x180f, 0x2800, 0x3164,
    *range(0xfe00, 0xfe10), 0xffa0, *range(0xe0100, 0xe01f0))))
"""Characters without a picture that count as printable (``Default_Ignorable_Code_Point``)."""


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
