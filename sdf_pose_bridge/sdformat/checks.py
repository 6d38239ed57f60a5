# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Refuse values that libsdformat refuses, wherever in a file they stand.

No pose depends on a friction coefficient. But a file that Gazebo does not load should not be
published as if it did; so numbers have to be numbers, and materials whole.
"""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence
import math
import re

from sdf_pose_bridge.errors import AttributeMissingError
from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.errors import ElementMissingError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.sdformat.document import boolean_from_text
from sdf_pose_bridge.sdformat.document import Document
from sdf_pose_bridge.sdformat.document import is_data
from sdf_pose_bridge.sdformat.document import text_of
from sdf_pose_bridge.sdformat.document import value_of
from sdf_pose_bridge.sdformat.document import XmlElement
from sdf_pose_bridge.sdformat.elements import step
from sdf_pose_bridge.sdformat.grammar import AXES
from sdf_pose_bridge.sdformat.grammar import CHECKED_TAGS
from sdf_pose_bridge.sdformat.grammar import COUNTS_OF_NUMBERS
from sdf_pose_bridge.sdformat.grammar import HOLDERS_OF_POSES
from sdf_pose_bridge.sdformat.grammar import LARGEST_VALUES
from sdf_pose_bridge.sdformat.grammar import MATERIAL_TAGS
from sdf_pose_bridge.sdformat.grammar import REQUIRED_ATTRIBUTES
from sdf_pose_bridge.sdformat.grammar import SMALLEST_VALUES
from sdf_pose_bridge.sdformat.grammar import VALUE_TYPES
from sdf_pose_bridge.sdformat.grammar import ValueType
from sdf_pose_bridge.sdformat.pose_text import pose_from_text
from sdf_pose_bridge.sdformat.pose_text import PoseText
from sdf_pose_bridge.sdformat.pose_text import PoseTextError

# What C's strtod takes: a number, and then whatever follows it.
_NUMBER = r'[+-]?(?:[0-9]|\.[0-9]|inf|nan)'
_INTEGER = r'[+-]?[0-9]'
_DIGITS = '0123456789'
_TRUTH = 'true|false'
"""Goes for a number, too."""
_LEADING_NUMBER = r'[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?'
_ODD_IN_NUMBERS = frozenset('_nN')
_SMALLEST_AXIS = 1e-6
_NO_TYPES: Mapping[str, ValueType] = {}
# An enum takes its time to hand out its members.
_BOOLEAN, _COLOR = ValueType.BOOLEAN, ValueType.COLOR
_ONE_NUMBER, _ONE_INTEGER = ValueType.NUMBER, ValueType.INTEGER
_SHADERS = frozenset({'pixel', 'vertex', 'normal_map_object_space', 'normal_map_tangent_space'})
_NOT_ONLY_VALUES = frozenset((*REQUIRED_ATTRIBUTES, *MATERIAL_TAGS, *HOLDERS_OF_POSES, 'state'))


def check_values(document: Document, problems: Problems) -> None:
    """
    Check what no other stage reads.

    :param document: a file in the newest grammar; what it includes is not looked at.
    :param problems: takes what is wrong.
    """
    check = _Check(document, problems)
    for xml in document.root.iter(*CHECKED_TAGS):
        check.all_of(xml)


class _Check:

    def __init__(self, document: Document, problems: Problems) -> None:
        self._document = document
        self._problems = problems

    def all_of(self, xml: XmlElement) -> None:
        tag = str(xml.tag)
        self._value(xml, tag)
        if tag not in _NOT_ONLY_VALUES:
            return
        if tag in REQUIRED_ATTRIBUTES:
            self._attribute(xml)
        if tag in MATERIAL_TAGS:
            self._material(xml)
        if tag in HOLDERS_OF_POSES:
            for pose in xml.iterchildren('pose'):
                self._pose(pose)
        elif tag == 'state':
            for pose in xml.iter('pose'):
                self._pose(pose)

    def _value(self, xml: XmlElement, tag: str) -> None:
        holder = xml.getparent()
        if holder is None:
            return
        holder_tag = str(holder.tag)
        value_type = VALUE_TYPES.get(holder_tag, _NO_TYPES).get(tag)
        if value_type is None:
            return
        text = text_of(xml).strip()
        if not text:
            return
        if not _is_of_type(text, value_type):
            msg = f'"{text[:80]}" is not {value_type.value}'
            self._error(ElementInvalidError, xml, msg)
            return
        key = (holder_tag, tag)
        if key in SMALLEST_VALUES:
            self._check_range(xml, text, key)
        if key in AXES:
            self._check_axis(xml, text)

    def _check_range(self, xml: XmlElement, text: str, key: tuple[str, str]) -> None:
        smallest, largest = SMALLEST_VALUES[key], LARGEST_VALUES.get(key, math.inf)
        if any(not smallest <= number <= largest for number in _numbers(text)[:1]):
            rule = f'at least {smallest:g}' if largest == math.inf else (
                f'from {smallest:g} to {largest:g}')
            self._error(ElementInvalidError, xml, f'"{text}" must be {rule}')

    def _pose(self, xml: XmlElement) -> None:
        is_quaternion = xml.get('rotation_format', '').strip() == 'quat_xyzw'
        try:
            pose_from_text(PoseText(text_of(xml), is_quaternion, False))
        except PoseTextError as error:
            self._error(ElementInvalidError, xml, str(error))

    def _attribute(self, xml: XmlElement) -> None:
        attribute = REQUIRED_ATTRIBUTES[str(xml.tag)]
        if xml.get(attribute) is None:
            tag = str(xml.tag)
            self._error(AttributeMissingError, xml, f'<{tag}> has no {attribute}')

    def _material(self, xml: XmlElement) -> None:
        material = xml.getparent()
        visual = None if material is None else material.getparent()
        if material is None or material.tag != 'material' or visual is None or (
                visual.tag != 'visual'):
            return
        if xml.tag == 'shader':
            self._check_shader(xml)
            return
        for part, error in (('uri', ElementInvalidError), ('name', ElementMissingError)):
            values = [value_of(child) for child in xml.iterchildren(part)]
            if not values or values[0] in ('', '__default__'):
                msg = f'the <script> of a material has no <{part}>, or an empty one'
                self._error(error, xml, msg)

    def _check_shader(self, shader: XmlElement) -> None:
        kind = shader.get('type', '').strip()
        if kind not in _SHADERS:
            msg = f'type="{kind}" of a shader must be one of {", ".join(sorted(_SHADERS))}'
            self._error(ElementInvalidError, shader, msg)
        elif kind.startswith('normal_map') and shader.find('normal_map') is None:
            msg = f'a shader of type="{kind}" needs a <normal_map>'
            self._error(ElementMissingError, shader, msg)

    def _check_axis(self, xml: XmlElement, text: str) -> None:
        if math.hypot(*_numbers(text)) <= _SMALLEST_AXIS:
            self._error(ElementInvalidError, xml, f'"{text}" is no axis: its length is zero')

    def _error(self, error_class: type[SdfError], xml: XmlElement, message: str) -> None:
        data = xml.getparent() if xml.tag == 'plugin' else xml
        if data is not None and not is_data(data):
            return
        steps = [step(str(e.tag), name) if (name := e.get('name')) else str(e.tag)
                 for e in (xml, *xml.iterancestors())]
        file = self._document.origin(xml).path
        place = Place(file, xml.sourceline or 0, '/' + '/'.join(reversed(steps)))
        self._problems.error(error_class(message, place))


def _is_of_type(text: str, value_type: ValueType) -> bool:
    is_single = value_type is _ONE_NUMBER or value_type is _ONE_INTEGER
    # Mostly a look at the first character is enough.
    if is_single and text[0] in _DIGITS:
        return True
    if value_type is _BOOLEAN:
        return boolean_from_text(text) is not None
    words = text.split()
    numbers = _numbers(text)
    if value_type is _COLOR:
        return len(numbers) == len(words) and len(words) in (3, 4) and all(
            0.0 <= number <= 1.0 for number in numbers)
    count = COUNTS_OF_NUMBERS.get(value_type, 1)
    if value_type is not _ONE_INTEGER and len(words) == len(numbers) >= count:
        return True
    start = _INTEGER if value_type is _ONE_INTEGER else _NUMBER
    if len(words) >= count and all(
            re.match(start, word, re.IGNORECASE) for word in words[:count]):
        return True
    return is_single and re.match(_TRUTH, text, re.IGNORECASE) is not None


def _numbers(text: str) -> list[float]:
    """Return the number that each word begins with, without those of words that have none."""
    words = text.split()
    # Of such words Python and C think alike, if they are numbers as a whole.
    is_plain = _ODD_IN_NUMBERS.isdisjoint(text) and text.isascii()
    try:
        return list(map(float, words)) if is_plain else _leading_numbers(words)
    except ValueError:
        return _leading_numbers(words)


def _leading_numbers(words: Sequence[str]) -> list[float]:
    matches = (re.match(_LEADING_NUMBER, word) for word in words)
    return [float(number.group()) for number in matches if number]
