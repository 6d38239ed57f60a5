# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Check values as libsdformat does (``Param.cc``), by the types of the grammar.

No pose depends on a friction coefficient. But Gazebo does not load a file with a wrong one, so
such a file is refused here too.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
import re

from sdf_pose_bridge.sdformat.grammar import Definition
from sdf_pose_bridge.sdformat.grammar import ValueType
from sdf_pose_bridge.sdformat.xml_tree import WHITE_SPACE

_COUNTS = {ValueType.TWO_NUMBERS: 2, ValueType.THREE_NUMBERS: 3, ValueType.AXIS: 3}
_SINGLE_NUMBERS = (ValueType.NUMBER, ValueType.INTEGER)

# Like C's strtod, libsdformat takes the number at the beginning of a word and drops the rest.
_NUMBER_START = re.compile(r'[+-]?(?:[0-9]|\.[0-9]|inf|nan)', re.IGNORECASE)
_INTEGER_START = re.compile(r'[+-]?[0-9]')
_BOOLEAN_START = re.compile(r'true|false', re.IGNORECASE)
_LEADING_NUMBER = re.compile(r'[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?')
_DIGITS = frozenset('0123456789')
_SHORTEST_AXIS = 1e-6


def boolean_from_text(text: str) -> bool | None:
    """
    Read a boolean.

    :param text: the value, with or without white space around it.
    :return: the boolean; None if the text is not ``true``, ``false``, ``1`` or ``0`` in any case.
    """
    value = text.strip(WHITE_SPACE).lower()
    if value in ('true', '1'):
        return True
    if value in ('false', '0'):
        return False
    return None


def value_fault(text: str, definition: Definition) -> str:
    """
    Return what is wrong with the value of an element.

    :param text: the value. A blank one is never wrong: the default applies.
    :param definition: the definition of the element; not that of a pose.
    :return: the value and the rule that it breaks; empty if it is right.
    """
    value_type = definition.value_type
    stripped = text.strip()
    if not stripped or value_type is None or value_type is ValueType.STRING:
        return ''
    if not is_of_type(stripped, value_type):
        return f'"{stripped[:80]}" is not {value_type.description}'
    if value_type is ValueType.AXIS and math.hypot(*_numbers(stripped)) <= _SHORTEST_AXIS:
        return f'"{stripped}" is not a valid axis: its length is zero'
    minimum, maximum = definition.minimum, definition.maximum
    if minimum == -math.inf or all(
            minimum <= number <= maximum for number in _numbers(stripped)[:1]):
        return ''
    rule = f'at least {minimum:g}' if maximum == math.inf else f'from {minimum:g} to {maximum:g}'
    return f'"{stripped}" must be {rule}'


def is_of_type(text: str, value_type: ValueType) -> bool:
    """
    Return whether libsdformat takes a text as a value of a type.

    :param text: the value, stripped and not empty.
    :param value_type: any type but ``POSE``.
    :return: True if it does.
    """
    if value_type in _SINGLE_NUMBERS:
        if text[0] in _DIGITS:
            return True
        start = _NUMBER_START if value_type is ValueType.NUMBER else _INTEGER_START
        return bool(start.match(text) or _BOOLEAN_START.match(text))
    if value_type is ValueType.BOOLEAN:
        return boolean_from_text(text) is not None
    words = text.split()
    if value_type is ValueType.COLOR:
        numbers = _numbers(text)
        return len(numbers) == len(words) and len(words) in (3, 4) and all(
            0.0 <= number <= 1.0 for number in numbers)
    count = _COUNTS.get(value_type, 0)
    return len(words) >= count and all(map(_NUMBER_START.match, words[:count]))


def _numbers(text: str) -> Sequence[float]:
    """Return the number that each word begins with, without words that begin with none."""
    matches = map(_LEADING_NUMBER.match, text.split())
    return [float(number.group()) for number in matches if number]
