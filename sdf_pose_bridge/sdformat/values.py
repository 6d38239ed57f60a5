# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read and check values as libsdformat does (``Param.cc``), by the types of the grammar.

Values on which no pose depends, such as a friction coefficient, are checked too, because Gazebo
does not load a file with a wrong one.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
import re
import sys

from sdf_pose_bridge.geometry.pose_attributes import boolean_from_text
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.sdformat.grammar import Item, ValueType
from sdf_pose_bridge.sdformat.specification import Choice
from sdf_pose_bridge.sdformat.xml_tree import (
    attribute_of,
    child_at,
    text_of,
    WHITE_SPACE,
    words_of,
    XmlElement,
)

_DECIMAL = r'(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?'
"""A decimal number without its sign."""
_C_NUMBER = re.compile(
    rf'[+-]?(?:0x(?:[0-9a-f]+\.?[0-9a-f]*|\.[0-9a-f]+)(?:p[+-]?[0-9]+)?|{_DECIMAL}|inf(?:inity)?|nan)',
    re.IGNORECASE)
"""The beginning of a word that C's ``strtod`` reads; it drops the rest."""
_C_INTEGER = re.compile(r'0x[0-9a-f]+|[+-]?[0-9]+', re.IGNORECASE)
_STREAM_NUMBER = re.compile(rf'[{WHITE_SPACE}]*([+-]?{_DECIMAL})')
"""The part that a C++ stream reads; it leaves the rest for the next number."""
_STREAM_INTEGERS = re.compile(r'([+-]?[0-9]+)(\s+[+-]?[0-9]+|[+-][0-9]+)', re.ASCII)
"""Two integers, as a C++ stream reads them."""
_PLAIN_NUMBERS = re.compile(
    rf'[0-9+\-.{WHITE_SPACE}]*(?:[eE][+-]?[0-9]{{1,2}}(?![0-9])[0-9+\-.{WHITE_SPACE}]*)*')
_LONGEST_PLAIN = 200
"""
A number with fewer characters, and an exponent of two digits at most, is in the range of a double.
"""
_SHORTEST_AXIS = 9.999999974752427e-07
"""The float that is nearest to 1e-6, as libsdformat compares with it."""
_SMALLEST_FLOAT, _LARGEST_FLOAT = 2.0 ** -126, (2.0 - 2.0 ** -23) * 2.0 ** 127
_NOT_ZERO = re.compile(r'[^eE]*[1-9]')
TRUE_TEXTS = ('true', 'True', 'TRUE', '1')
"""The true values of the flags that are not read by type: ``merge`` and those of old versions."""
_INTEGER_RANGES = {
    ValueType.INTEGER: (-2 ** 31, 2 ** 31 - 1),
    # A negative number counts modulo 2 ** 64.
    ValueType.UNSIGNED: (-2 ** 64 + 1, 2 ** 64 - 1),
}
_TYPES_BY_COUNT = {1: ValueType.NUMBER, 2: ValueType.TWO_NUMBERS, 3: ValueType.THREE_NUMBERS}


def frame_of_attribute(xml: XmlElement, attribute: str) -> str:
    """
    Return the frame that an attribute names.

    :return: the name; empty if there is none, and for the implicit root, an error that the check
        of attributes reports.
    """
    name = attribute_of(xml, attribute)
    return '' if name == ROOT_FRAME else name


def choice_fault(text: str, choice: Choice) -> str:
    """Return the rule that a stripped value of a choice breaks; empty if it is valid."""
    value = text.lower() if choice.ignores_case else text
    return '' if value in choice.texts else f'must be one of {", ".join(choice.texts)}'


def judged_value(text: str, rule: Item) -> tuple[str, str]:
    """
    Judge the value of an element or an attribute as libsdformat does.

    :param text: the value, stripped. If it is not required, the default replaces an empty one.
    :param rule: the rule of the grammar for it, which is not a pose.
    :return: the rule that it breaks, empty if it is valid; and the numbers that were read, empty
        if they agree with the text. In a message, both follow the value.
    """
    value_type = rule.value_type
    if not text:
        return 'is empty; it must have a value' if rule.required == '!' else '', ''
    if value_type is ValueType.STRING:
        return '', ''
    if rule.choice is not None:
        return choice_fault(text, rule.choice), ''
    numbers = numbers_from_text(text, value_type)
    if not _is_of_type(text, numbers, value_type):
        return f'is not {value_type.description}', ''
    if value_type is ValueType.AXIS and math.hypot(*numbers) <= _SHORTEST_AXIS:
        return 'is not a valid axis: its length is zero', ''
    # Like libsdformat, this accepts NaN.
    if numbers and (numbers[0] < rule.minimum or numbers[0] > rule.maximum):
        limits = (f'at least {rule.minimum:g}' if rule.maximum == math.inf
                  else f'from {rule.minimum:g} to {rule.maximum:g}')
        return f'must be {limits}', ''
    is_integer = value_type.is_integer and _C_INTEGER.fullmatch(text)
    return '', '' if is_integer or not numbers else doubt_about_numbers(text, numbers)


def doubt_about_numbers(text: str, numbers: Sequence[float]) -> str:
    """
    Return the numbers that were read from a text, as a part of a sentence behind it.

    :return: empty if they are those that are written, or if the text is blank.
    """
    words = words_of(text)
    try:
        written = [*map(float, words)]
    except ValueError:
        written = []
    if not words or (len(written) == len(numbers) and all(
            word == number or math.isnan(word)
            for word, number in zip(written, numbers, strict=True))):
        return ''
    shown = ' '.join(repr(number).removesuffix('.0') for number in numbers)
    return f'is read as {shown}, as by Gazebo'


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


def _is_of_type(text: str, numbers: Sequence[float], value_type: ValueType) -> bool:
    count = value_type.count
    if count:
        # A color may be without its last number.
        if not min(count, 3) <= len(numbers) <= count:
            return False
        if value_type is ValueType.FLOAT:
            # C's strtof reads others with a range error.
            size = abs(numbers[0])
            return not (0.0 < size < _SMALLEST_FLOAT or _LARGEST_FLOAT < size < math.inf)
        return value_type is not ValueType.COLOR or not [
            number for number in numbers if number < 0.0 or number > 1.0]
    if value_type is ValueType.BOOLEAN:
        return boolean_from_text(text) is not None
    return value_type is not ValueType.FRAME or text != ROOT_FRAME


def numbers_from_text(text: str, value_type: ValueType) -> Sequence[float]:
    """
    Return the numbers of a value.

    :param text: the value, stripped.
    :return: as many numbers as the type has, or three of a color; fewer if the text is not of the
        type.
    """
    count = value_type.count
    if count == 0:
        return ()
    if not value_type.is_integer:
        numbers = plain_numbers_from_text(text)
        if len(numbers) == count:
            return numbers
    boolean = boolean_from_text(text) if count == 1 else None
    if boolean is not None:
        return (float(boolean),)
    if value_type is ValueType.TIME:
        match = _STREAM_INTEGERS.match(text)
        return [
            number for word in (match.groups() if match else ())
            for number in _integer(word.strip(WHITE_SPACE), ValueType.INTEGER)]
    if value_type in _INTEGER_RANGES:
        return _integer(text, value_type)
    if value_type in (ValueType.NUMBER, ValueType.FLOAT, ValueType.COLOR):
        words = [text] if count == 1 else words_of(text)
        numbers = [number for word in words for number in number_from_word(word)]
        return numbers if len(numbers) == len(words) else ()
    return _streamed_numbers(text, count)


def plain_numbers_from_text(text: str) -> Sequence[float]:
    """Return the numbers of a text that all readers read alike; none for other texts."""
    if len(text) >= _LONGEST_PLAIN or not _PLAIN_NUMBERS.fullmatch(text):
        return ()
    try:
        return [*map(float, words_of(text))]
    except ValueError:
        return ()


def number_from_word(word: str) -> Sequence[float]:
    """Return the number at the beginning of a text, as ``std::stod`` reads it, or none."""
    match = _C_NUMBER.match(word)
    if match is None:
        return ()
    if 'x' in match[0] or 'X' in match[0]:
        try:
            return (float.fromhex(match[0]),)
        except OverflowError:
            return ()
    number = float(match[0])
    return (number,) if is_representable(match[0], number) else ()


def number_from_stream(word: str) -> Sequence[float]:
    """Return the number that a C++ stream reads, if it reads all of a text; else none."""
    # Unlike fullmatch, this takes no longer for many digits before something else.
    match = _STREAM_NUMBER.match(word)
    number = math.inf if match is None or match.end() < len(word) else float(match[1])
    return (number,) if math.isfinite(number) else ()


def _integer(text: str, value_type: ValueType) -> Sequence[float]:
    """Read an integer as ``std::stoi`` and ``std::stoul`` do."""
    match = _C_INTEGER.match(text)
    if match is None or len(match[0]) > _LONGEST_PLAIN:
        return ()
    number = int(match[0], 16 if 'x' in match[0] or 'X' in match[0] else 10)
    minimum, maximum = _INTEGER_RANGES[value_type]
    return (number,) if minimum <= number <= maximum else ()


def _streamed_numbers(text: str, count: int) -> Sequence[float]:
    numbers: list[float] = []
    position = 0
    while len(numbers) < count:
        match = _STREAM_NUMBER.match(text, position)
        if match is None or math.isinf(float(match[1])):
            break
        position = match.end()
        if text[position:position + 1] in ('e', 'E') and 'e' not in match[1].lower():
            break  # an exponent without digits
        numbers.append(float(match[1]))
    return numbers


def numbers_of(xml: XmlElement | None, default: tuple[float, ...]) -> tuple[float, ...]:
    """
    Return the numbers in an element.

    :param default: the numbers if there is no element, or if it has fewer numbers than these.
    :return: as many numbers as there are in the default.
    """
    if xml is None:
        return default
    numbers = tuple(numbers_from_text(text_of(xml), _TYPES_BY_COUNT[len(default)]))
    return numbers if len(numbers) == len(default) else default


def number_of_child(parent: XmlElement, path: str, default: float) -> float:
    """Return the number in the child element at a path, or the default, as `numbers_of`."""
    (number,) = numbers_of(child_at(parent, path), (default,))
    return number
