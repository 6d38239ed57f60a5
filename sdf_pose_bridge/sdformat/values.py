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

from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.sdformat.grammar import Definition, ValueType
from sdf_pose_bridge.sdformat.specification import Choice
from sdf_pose_bridge.sdformat.xml_tree import attribute_of, child_value, WHITE_SPACE, XmlElement

DECIMAL = r'(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?'
"""A decimal number without its sign."""
_C_NUMBER = re.compile(
    rf'[+-]?(?:0x(?:[0-9a-f]+\.?[0-9a-f]*|\.[0-9a-f]+)(?:p[+-]?[0-9]+)?|{DECIMAL}|inf(?:inity)?|nan)',
    re.IGNORECASE)
"""The beginning of a word that C's ``strtod`` reads; it drops the rest."""
_C_INTEGER = re.compile(r'0x[0-9a-f]+|[+-]?[0-9]+', re.IGNORECASE)
_STREAM_NUMBER = re.compile(rf'[{WHITE_SPACE}]*([+-]?{DECIMAL})')
"""The part that a C++ stream reads; it leaves the rest for the next number."""
_STREAM_INTEGERS = re.compile(r'([+-]?[0-9]+)(\s+[+-]?[0-9]+|[+-][0-9]+)', re.ASCII)
"""Two integers, as a C++ stream reads them."""
_PLAIN_NUMBER = re.compile(r'[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,2})?')
"""A number that all of these read alike."""
_NOT_IN_DECIMALS = re.compile(rf'[^-+.0-9{WHITE_SPACE}]')
_SHORTEST_AXIS = 9.999999974752427e-07
"""The float that is nearest to 1e-6, as libsdformat compares with it."""
LONGEST_PLAIN = 200
"""
A number with fewer characters, and an exponent of two digits at most, is in the range of a double.
"""
_NOT_ZERO = re.compile(r'[^eE]*[1-9]')
_FEWEST_COLOR_NUMBERS = 3
_BOOLEANS = {'true': True, '1': True, 'false': False, '0': False}
_INTEGER_RANGES = {
    ValueType.INTEGER: (-2 ** 31, 2 ** 31 - 1),
    # A negative number counts modulo 2 ** 64.
    ValueType.UNSIGNED: (-2 ** 64 + 1, 2 ** 64 - 1),
}
_FLOATING_TYPES = (
    ValueType.NUMBER, ValueType.THREE_NUMBERS, ValueType.COLOR, ValueType.AXIS,
    ValueType.TWO_NUMBERS)
_TYPES_BY_COUNT = {
    1: ValueType.NUMBER, 2: ValueType.TWO_NUMBERS, 3: ValueType.THREE_NUMBERS}


def boolean_from_text(text: str) -> bool | None:
    """
    Read a boolean.

    :param text: the value, with or without white space around it.
    :return: the boolean; None if the text is not ``true``, ``false``, ``1`` or ``0`` in any case.
    """
    return _BOOLEANS.get(text.strip(WHITE_SPACE).lower())


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


def judged_value(text: str, definition: Definition) -> tuple[str, str]:
    """
    Judge the value of an element as libsdformat does.

    :param text: the value. If the element is not required, the default replaces a blank one.
    :param definition: the definition of the element, which is not a pose.
    :return: the rule that it breaks, empty if it is valid; and the numbers that were read, empty
        if they agree with the text. Each is a part of a sentence behind the value.
    """
    value_type = definition.value_type
    if value_type is None or (
            definition.takes_any_number and len(text) < LONGEST_PLAIN
            and _PLAIN_NUMBER.fullmatch(text)):
        return '', ''
    stripped = text.strip(WHITE_SPACE)
    if not stripped and definition.is_required:
        return 'is empty; it must have a value', ''
    if not stripped or value_type is ValueType.STRING:
        return '', ''
    if definition.choice is not None:
        return choice_fault(stripped, definition.choice), ''
    plain_numbers = _plain_numbers(stripped, value_type)
    numbers = plain_numbers or numbers_from_text(stripped, value_type)
    if not plain_numbers and not _is_of_type(stripped, numbers, value_type):
        return f'is not {value_type.description}', ''
    if value_type is ValueType.AXIS and math.hypot(*numbers) <= _SHORTEST_AXIS:
        return 'is not a valid axis: its length is zero', ''
    minimum, maximum = definition.minimum, definition.maximum
    # Like libsdformat, this accepts NaN.
    if numbers and (numbers[0] < minimum or numbers[0] > maximum):
        rule = (f'at least {minimum:g}' if maximum == math.inf
                else f'from {minimum:g} to {maximum:g}')
        return f'must be {rule}', ''
    is_integer = value_type in _INTEGER_RANGES and _C_INTEGER.fullmatch(stripped)
    return '', '' if plain_numbers or is_integer else _doubt(stripped, numbers)


def _doubt(text: str, numbers: Sequence[float]) -> str:
    """Return the numbers that were read, if they differ from the words of the text."""
    if not numbers:
        return ''
    try:
        words = [float(word) for word in text.split()]
    except ValueError:
        words = []
    if len(words) == len(numbers) and all(
            word == number or math.isnan(word)
            for word, number in zip(words, numbers, strict=True)):
        return ''
    return f'is read as {" ".join(map(repr, numbers))}'


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
    Return whether libsdformat accepts a text as a value of a type.

    :param text: the value, stripped and not empty.
    :param value_type: any type but ``POSE``; any text is accepted for a choice.
    """
    return _is_of_type(text, numbers_from_text(text, value_type), value_type)


def _is_of_type(text: str, numbers: Sequence[float], value_type: ValueType) -> bool:
    if value_type is ValueType.COLOR:
        return _FEWEST_COLOR_NUMBERS <= len(numbers) <= value_type.count and not [
            number for number in numbers if number < 0.0 or number > 1.0]
    if value_type.count > 0:
        return len(numbers) == value_type.count
    if value_type is ValueType.BOOLEAN:
        return boolean_from_text(text) is not None
    return value_type is not ValueType.FRAME or text != ROOT_FRAME


def numbers_from_text(text: str, value_type: ValueType) -> Sequence[float]:
    """
    Return the numbers of a value.

    :return: as many numbers as the type has, or three of a color; fewer if the text is not of the
        type.
    """
    if value_type.count == 0:
        return ()
    stripped = text.strip(WHITE_SPACE)
    plain_numbers = _plain_numbers(stripped, value_type)
    if plain_numbers:
        return plain_numbers
    if value_type is ValueType.COLOR:
        words = text.split()
        numbers = [number for word in words for number in number_from_word(word)]
        return numbers if len(numbers) == len(words) else ()
    boolean = None if value_type.count > 1 else boolean_from_text(stripped)
    if boolean is not None:
        return (float(boolean),)
    if value_type is ValueType.NUMBER:
        return number_from_word(stripped)
    if value_type in _INTEGER_RANGES:
        return _integer(stripped, *_INTEGER_RANGES[value_type])
    if value_type is ValueType.TIME:
        match = _STREAM_INTEGERS.match(stripped)
        integers = match.groups() if match else ()
        return [
            number for text in integers
            for number in _integer(text.strip(), *_INTEGER_RANGES[ValueType.INTEGER])]
    return _streamed_numbers(stripped, value_type.count)


def _plain_numbers(text: str, value_type: ValueType) -> Sequence[float]:
    """Return the numbers of a value that is plain numbers; none for any other text."""
    numbers = plain_numbers_from_text(text) if value_type in _FLOATING_TYPES else ()
    return numbers if numbers and _is_of_type(text, numbers, value_type) else ()


def plain_numbers_from_text(text: str) -> Sequence[float]:
    """Return the numbers of a text of short decimals without exponents; none for other texts."""
    if len(text) >= LONGEST_PLAIN or _NOT_IN_DECIMALS.search(text):
        return ()
    try:
        return [float(word) for word in text.split()]
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


def _integer(text: str, minimum: int, maximum: int) -> Sequence[float]:
    """Read an integer as ``std::stoi`` and ``std::stoul`` do."""
    match = _C_INTEGER.match(text)
    if match is None or len(match[0]) > LONGEST_PLAIN:
        return ()
    number = int(match[0], 16 if 'x' in match[0] or 'X' in match[0] else 10)
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


def numbers_of_child(
    parent: XmlElement, tag: str, default: tuple[float, ...],
) -> tuple[float, ...]:
    """
    Return the numbers in a child element.

    :param default: the numbers if there is no child, or if it has fewer numbers than these.
    :return: as many numbers as there are in the default.
    """
    numbers = tuple(numbers_from_text(child_value(parent, tag), _TYPES_BY_COUNT[len(default)]))
    return numbers if len(numbers) == len(default) else default


def number_of_child(parent: XmlElement, tag: str, default: float) -> float:
    """Return the number in a child element, or the default, as :func:`numbers_of_child`."""
    (number,) = numbers_of_child(parent, tag, (default,))
    return number
