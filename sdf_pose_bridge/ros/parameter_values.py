# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The values that parameters can have: their types, and the rules of single parameters.

A function ``<rule>_setting`` makes the setting of a value. If the value is not allowed, it raises
ValueError with the words that follow "parameter <name>" in a sentence.
"""

from __future__ import annotations

import array
from collections.abc import Callable
from collections.abc import Sequence
import enum
from pathlib import Path
from typing import TypeVar

from rclpy.parameter import Parameter

from sdf_pose_bridge.names import printable
from sdf_pose_bridge.names import shortened
from sdf_pose_bridge.sdformat.grammar import Kind

Choice = TypeVar('Choice', bound=enum.Enum)

TYPES = {
    str: Parameter.Type.STRING, bool: Parameter.Type.BOOL, float: Parameter.Type.DOUBLE,
    list: Parameter.Type.STRING_ARRAY}
"""The types of parameters that are used, by the type of their values in Python."""

_NAMES_OF_TYPES = {
    Parameter.Type.STRING: 'a string', Parameter.Type.BOOL: 'true or false',
    Parameter.Type.INTEGER: 'an integer', Parameter.Type.DOUBLE: 'a number',
    Parameter.Type.STRING_ARRAY: 'a list of strings',
    Parameter.Type.BOOL_ARRAY: 'a list of booleans',
    Parameter.Type.INTEGER_ARRAY: 'a list of integers',
    Parameter.Type.DOUBLE_ARRAY: 'a list of numbers', Parameter.Type.BYTE_ARRAY: 'a list of bytes',
}

PUBLISHED_KINDS = {
    kind.label: kind for kind in Kind if kind not in (Kind.ROOT, Kind.WORLD, Kind.ACTOR)}
"""The kinds of element that can become frames, by their names."""

LOWEST_RATE, HIGHEST_RATE = 0.001, 100.0
"""The limits of ``publish_rate`` in Hz."""

MOST_VALUES = 1000
"""How many patterns or directories a parameter may have. Each pattern is compared with each frame,
and each directory is looked into for each include."""

MOST_CHARACTERS = 255
"""How long a name or a pattern may be; a prefix is a part of every frame id."""

MOST_CHARACTERS_OF_PATH = 4096
"""How long a path may be, as in Linux."""

MOST_CHARACTERS_OF_SEPARATOR = 8
"""How long a separator may be, which stands many times in a frame id."""


def parameter_with_type(given: Parameter, wanted: Parameter.Type) -> Parameter:
    """
    Give a value another type in which it has the same meaning.

    :return: an integer as a number, or an empty list of any type as a list of strings, if that is
        the wanted type; otherwise the value as it was given.
    """
    if wanted is Parameter.Type.DOUBLE and given.type_ is Parameter.Type.INTEGER:
        return Parameter(given.name, wanted, float(given.value))
    if (wanted is Parameter.Type.STRING_ARRAY and given.type_.name.endswith('ARRAY')
            and not len(given.value)):
        return Parameter(given.name, wanted, [])
    return given


def words_about_wrong_type(given: Parameter, wanted: Parameter.Type) -> str:
    """
    Explain that a value has the wrong type.

    :return: the words that follow "parameter <name>" in a sentence.
    """
    return (f'is {_shown_value(given)}, which is {_NAMES_OF_TYPES[given.type_]}; it must be '
            f'{_NAMES_OF_TYPES[wanted]}')


def hint_about_command_line(given: Parameter, wanted: Parameter.Type) -> str:
    """
    Show how to write a value of the wrong type on the command line.

    :return: the end of a sentence; empty if there is nothing to show.
    """
    if wanted is Parameter.Type.STRING:
        return f', so quote it twice: -p "{given.name}:=\'{_shown_value(given)}\'"'
    if given.type_ is Parameter.Type.STRING and wanted is Parameter.Type.STRING_ARRAY:
        return f': -p "{given.name}:=[\'{given.value}\']"'
    return ''


def _shown_value(given: Parameter) -> object:
    return list(given.value) if isinstance(given.value, array.array) else given.value


def root_frame_setting(value: str) -> str:
    """Refuse what cannot be the frame id of the root."""
    if not value:
        raise _refusal(value, 'a frame id, which is not empty')
    return prefix_setting(value)


def prefix_setting(value: str) -> str:
    """Refuse what frame ids cannot begin with."""
    if value.startswith('/'):
        raise _refusal(value, 'without a leading slash, which TF does not allow')
    return _name_setting(value, MOST_CHARACTERS)


def separator_setting(value: str) -> str:
    """Refuse what cannot separate the parts of frame ids."""
    if not value:
        raise _refusal(value, 'at least one character, or names run together')
    return _name_setting(value, MOST_CHARACTERS_OF_SEPARATOR)


def rate_setting(value: float) -> float:
    """Refuse rates that are too low, too high or not a number; 0.0 is for never."""
    if value and not LOWEST_RATE <= value <= HIGHEST_RATE:
        raise _refusal(value, f'0.0 for never, or from {LOWEST_RATE} to {HIGHEST_RATE}')
    return value


def choice_setting(choices: type[Choice]) -> Callable[[str], Choice]:
    """Return a function that makes members of an enumeration."""
    def convert(value: str) -> Choice:
        known = [choice.value for choice in choices]
        if value not in known:
            raise _refusal(value, f'one of {", ".join(known)}')
        return choices(value)
    return convert


def kinds_setting(values: Sequence[str]) -> frozenset[Kind]:
    """Make kinds of element of their names."""
    known = ', '.join(PUBLISHED_KINDS)
    if not values:
        raise _refusal([], f'at least one of {known}')
    for value in values:
        if value not in PUBLISHED_KINDS:
            raise _refusal(value, f'made of {known}')
    return frozenset(PUBLISHED_KINDS[value] for value in values)


def patterns_setting(values: Sequence[str]) -> tuple[str, ...]:
    """Refuse too many patterns, and long ones."""
    _check_count(values, 'patterns')
    for value in values:
        _check_length(value, MOST_CHARACTERS)
    return tuple(values)


def path_setting(value: str) -> str:
    """Refuse what is too long for a path."""
    _check_length(value, MOST_CHARACTERS_OF_PATH)
    return value


def directories_setting(values: Sequence[str]) -> tuple[Path, ...]:
    """Make paths, without those that are empty; refuse too many, and long ones."""
    _check_count(values, 'directories')
    return tuple(Path(path_setting(value)).expanduser() for value in values if value)


def _check_count(values: Sequence[str], what: str) -> None:
    if len(values) > MOST_VALUES:
        msg = f'has {len(values)} {what}; it must have at most {MOST_VALUES}'
        raise ValueError(msg)


def _check_length(value: str, most: int) -> None:
    if len(value) > most:
        msg = f'has a value of {len(value)} characters; it must have at most {most}'
        raise ValueError(msg)


def _name_setting(value: str, most: int) -> str:
    _check_length(value, most)
    if not value.isprintable():
        raise _refusal(value, 'without control characters')
    return value


def _refusal(value: object, rule: str) -> ValueError:
    shown = f'"{printable(shortened(value))}"' if isinstance(value, str) else value
    return ValueError(f'is {shown}; it must be {rule}')
