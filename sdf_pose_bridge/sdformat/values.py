# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read and check values as libsdformat does (``Param.cc``), by the types of the grammar.

No pose depends on a friction coefficient. But Gazebo does not load a file with a wrong one, so
such a file is refused here too.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
import re
import sys

from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.sdformat.grammar import Definition
from sdf_pose_bridge.sdformat.grammar import ValueType
from sdf_pose_bridge.sdformat.specification import Choice
from sdf_pose_bridge.sdformat.xml_tree import attribute_of
from sdf_pose_bridge.sdformat.xml_tree import first_child
from sdf_pose_bridge.sdformat.xml_tree import text_of
from sdf_pose_bridge.sdformat.xml_tree import WHITE_SPACE
from sdf_pose_bridge.sdformat.xml_tree import XmlElement

# Like C's strtod, libsdformat takes the number at the beginning of a word and drops the rest.
_LEADING_NUMBER = re.compile(
    r'[+-]?(?:[0-9]+\.?[0-9]*(?:[eE][+-]?[0-9]+)?|\.[0-9]+(?:[eE][+-]?[0-9]+)?|inf|nan)',
    re.IGNORECASE)
_LEADING_INTEGER_OR_BOOLEAN = re.compile(r'[+-]?[0-9]|true|false', re.IGNORECASE)
_LEADING_BOOLEAN = re.compile(r'true|false', re.IGNORECASE)
_DIGITS = frozenset('0123456789')
_SHORTEST_AXIS = 1e-6
LONGEST_PLAIN = 200
"""A number with fewer characters, and without an exponent, is in the range of a double."""
_NOT_ZERO = re.compile(r'[^eE]*[1-9]')
_FEWEST_COLOR_NUMBERS = 3


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


def frame_of_attribute(xml: XmlElement, attribute: str) -> str:
    """
    Return the frame that an attribute names.

    :return: the name; empty if there is none, and for the implicit root, which is an error that
        the check of attributes reports.
    """
    name = attribute_of(xml, attribute)
    return '' if name == ROOT_FRAME else name


def choice_fault(text: str, choice: Choice) -> str:
    """
    Return what is wrong with a value that is one of a few texts.

    :param text: the value, stripped.
    :param choice: what it can be.
    :return: which it must be one of; empty if it is right.
    """
    value = text.lower() if choice.ignores_case else text
    return '' if value in choice.texts else f'must be one of {", ".join(choice.texts)}'


def value_fault(text: str, definition: Definition) -> str:
    """
    Return what is wrong with the value of an element.

    :param text: the value. If the element is not required, the default replaces a blank one.
    :param definition: the definition of the element; not that of a pose.
    :return: the value and the rule that it breaks; empty if it is right.
    """
    if (definition.takes_any_number and text[:1] in _DIGITS and len(text) < LONGEST_PLAIN
            and 'e' not in text and 'E' not in text):
        return ''
    value_type = definition.value_type
    stripped = text.strip(WHITE_SPACE)
    if not stripped and definition.is_required and value_type is not None:
        return f'<{definition.identifier}> is empty; it must have a value'
    if not stripped or value_type is None or definition.is_text:
        return ''
    if definition.choice is not None:
        fault = choice_fault(stripped, definition.choice)
        return f'"{stripped}" of <{definition.identifier}> {fault}' if fault else ''
    numbers = leading_numbers(stripped, value_type.count)
    if not _is_of_type(stripped, numbers, value_type):
        return f'"{stripped[:80]}" is not {value_type.description}'
    if value_type is ValueType.AXIS and math.hypot(*numbers) <= _SHORTEST_AXIS:
        return f'"{stripped}" is not a valid axis: its length is zero'
    minimum, maximum = definition.minimum, definition.maximum
    # Like libsdformat, this accepts what is not a number.
    if not numbers or not (numbers[0] < minimum or numbers[0] > maximum):
        return ''
    rule = f'at least {minimum:g}' if maximum == math.inf else f'from {minimum:g} to {maximum:g}'
    return f'"{stripped}" must be {rule}'


def is_representable(text: str, number: float) -> bool:
    """
    Return whether C's ``strtod`` reads a number without a range error.

    :param text: the number as written, such as ``1e-3`` or ``inf``.
    :param number: the number as a double.
    :return: False for numbers such as ``1e400`` and ``1e-400``.
    """
    if number == 0.0:
        return not _NOT_ZERO.match(text)
    if math.isinf(number):
        return text.lstrip('+-')[:1] in 'iI'
    return math.isnan(number) or abs(number) >= sys.float_info.min


def is_of_type(text: str, value_type: ValueType) -> bool:
    """
    Return whether libsdformat takes a text as a value of a type.

    :param text: the value, stripped and not empty.
    :param value_type: any type but ``POSE``; of a choice any text is one.
    :return: True if it does.
    """
    return _is_of_type(text, leading_numbers(text, value_type.count), value_type)


def _is_of_type(text: str, numbers: Sequence[float], value_type: ValueType) -> bool:
    if value_type is ValueType.COLOR:
        return len(numbers) == len(text.split()) >= _FEWEST_COLOR_NUMBERS and all(
            not (number < 0.0 or number > 1.0) for number in numbers)
    if value_type is ValueType.NUMBER:
        return (bool(numbers) and is_representable(text, numbers[0])) or (
            _LEADING_BOOLEAN.match(text) is not None)
    if value_type is ValueType.INTEGER:
        return _LEADING_INTEGER_OR_BOOLEAN.match(text) is not None
    if value_type is ValueType.BOOLEAN:
        return boolean_from_text(text) is not None
    if value_type is ValueType.FRAME:
        return text != ROOT_FRAME
    return len(numbers) == value_type.count  # 0 for a text


def leading_numbers(text: str, count: int) -> Sequence[float]:
    """
    Return the numbers that the first words of a text begin with.

    :param text: the value of an element.
    :param count: how many words are read.
    :return: the numbers; none for a word that begins with none.
    """
    words = text.split()[:count]
    # Python also reads 1_000 and the digits of all scripts.
    if '_' not in text and text.isascii():
        try:
            return [float(word) for word in words]
        except ValueError:
            pass
    matches = map(_LEADING_NUMBER.match, words)
    return [float(number[0]) for number in matches if number]


def numbers_of_child(
    parent: XmlElement, tag: str, default: tuple[float, ...],
) -> tuple[float, ...]:
    """
    Return the numbers in a child element.

    :param default: the numbers if there is no child, or if it has fewer numbers than these.
    :return: as many numbers as there are in the default.
    """
    child = first_child(parent, tag)
    numbers = () if child is None else tuple(leading_numbers(text_of(child), len(default)))
    return numbers if len(numbers) == len(default) else default
