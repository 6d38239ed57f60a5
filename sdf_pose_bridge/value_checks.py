# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Refuse values that libsdformat refuses, wherever in a file they stand.

No pose depends on a friction coefficient. But a file that Gazebo does not load should not be
published as if it did; so numbers have to be numbers, and materials whole.
"""

from __future__ import annotations

import functools
import math
import re
from typing import NamedTuple

from sdf_pose_bridge.document import boolean_from_text
from sdf_pose_bridge.document import Document
from sdf_pose_bridge.document import is_data
from sdf_pose_bridge.document import text_of
from sdf_pose_bridge.document import value_of
from sdf_pose_bridge.document import XmlElement
from sdf_pose_bridge.elements import step
from sdf_pose_bridge.errors import AttributeMissingError
from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.errors import ElementMissingError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.grammar import LARGEST_VALUES
from sdf_pose_bridge.grammar import REQUIRED_ATTRIBUTES
from sdf_pose_bridge.grammar import SMALLEST_VALUES
from sdf_pose_bridge.grammar import VALUE_TYPES
from sdf_pose_bridge.grammar import ValueType
from sdf_pose_bridge.known_tags import HOLDERS_OF_POSES
from sdf_pose_bridge.markup_index import MarkupIndex
from sdf_pose_bridge.pose_text import pose_from_text
from sdf_pose_bridge.pose_text import PoseText
from sdf_pose_bridge.pose_text import PoseTextError
from sdf_pose_bridge.problems import Problems

# Patterns are left for `re` to compile when they are first needed, which for some is never.

# What C's strtod takes: a number, and then whatever follows it.
_NUMBER = r'[+-]?(?:[0-9]|\.[0-9]|inf|nan)'
_INTEGER = r'[+-]?[0-9]'
_TRUTH = 'true|false'
"""Goes for a number, too."""
_COUNTS = {ValueType.TWO_NUMBERS: 2, ValueType.THREE_NUMBERS: 3}
_LEADING_NUMBER = r'[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?'
_AXES = frozenset({('axis', 'xyz'), ('axis2', 'xyz')})
_SMALLEST_AXIS = 1e-6
_SHADERS = frozenset({'pixel', 'vertex', 'normal_map_object_space', 'normal_map_tangent_space'})
_TYPES_OF_TAG: dict[str, set[ValueType]] = {}
for _types in VALUE_TYPES.values():
    for _tag, _type in _types.items():
        _TYPES_OF_TAG.setdefault(_tag, set()).add(_type)
_VALUE_TAGS = sorted(_TYPES_OF_TAG)
# What is certainly a good value of any element with the tag: without comments in it, which are
# characters with the number 1 here. A space and a character with the number 0 follow each value.
_PLAIN_NUMBER = r'[+-]?(?:[0-9]|\.[0-9])'
_PLAIN_PATTERNS = {
    ValueType.BOOLEAN: r'(?:true|false|0|1)\s*',
    ValueType.INTEGER: r'[+-]?[0-9][^\0\1]*',
    ValueType.NUMBER: rf'{_PLAIN_NUMBER}[^\0\1]*',
    ValueType.TWO_NUMBERS: rf'(?:{_PLAIN_NUMBER}[^\s\0\1]*\s+){{2}}[^\0\1]*',
    ValueType.THREE_NUMBERS: rf'(?:{_PLAIN_NUMBER}[^\s\0\1]*\s+){{3}}[^\0\1]*',
    ValueType.COLOR: r'(?:(?:0|1|0?\.[0-9]+|[01]\.0*)\s+){3,4}',
}
_END = ' \0'
_NOT_NEGATIVE = '(?!-)'
_NOT_ALL_ZERO = r'(?=[^eE\0]*\0)(?=[^\0]*?(?<![.0-9])(?:0*[1-9]|0*\.0{0,3}[1-9]))'
_STRICTEST_FIRST = (
    ValueType.THREE_NUMBERS, ValueType.TWO_NUMBERS, ValueType.INTEGER, ValueType.NUMBER)
_PLAIN_IF_BEGUN = (ValueType.NUMBER, ValueType.INTEGER)
"""Types of values that are good if only they begin with a digit."""


class _PlainRule(NamedTuple):
    """What is known to be good at once, of elements with some tag."""

    value_type: ValueType
    is_not_negative: bool
    is_axis: bool


@functools.cache
def _plain_rule(tag: str) -> _PlainRule | None:
    """Return a rule that is as strict as any for elements with a tag; None if there is none."""
    types = _TYPES_OF_TAG[tag]
    smallest = {value for (_, each), value in SMALLEST_VALUES.items() if each == tag}
    if smallest - {0.0} or any(each == tag for _, each in LARGEST_VALUES):
        return None
    if types <= set(_STRICTEST_FIRST):
        strictest = next(each for each in _STRICTEST_FIRST if each in types)
    elif len(types) == 1:
        strictest = next(iter(types))
    else:
        return None
    return _PlainRule(strictest, bool(smallest), any(each == tag for _, each in _AXES))


@functools.cache
def _pattern(rule: _PlainRule) -> re.Pattern[str]:
    """Make the pattern of a run of good values."""
    conditions = (_NOT_NEGATIVE if rule.is_not_negative else '') + (
        _NOT_ALL_ZERO if rule.is_axis else '')
    return re.compile(rf'(?:\s*{conditions}{_PLAIN_PATTERNS[rule.value_type]}\0)*')


def check_values(document: Document, index: MarkupIndex, problems: Problems) -> None:
    """
    Check what no other stage reads.

    :param document: a file in the newest grammar; what it includes is not looked at.
    :param index: its elements.
    :param problems: takes what is wrong.
    """
    check = _Check(document, problems)
    for tag in index.markup.present(_VALUE_TAGS):
        for xml in _doubtful(tag, index):
            check.value(xml)
    for tag in index.markup.present(REQUIRED_ATTRIBUTES):
        for xml in index.xmls(tag):
            check.attribute(xml)
    for tag in index.markup.present(('script', 'shader')):
        for xml in index.xmls(tag):
            check.material(xml)
    for tag in index.markup.present((*HOLDERS_OF_POSES, 'state')):
        for xml in index.xmls(tag):
            for pose in xml.iter('pose') if tag == 'state' else xml.iterchildren('pose'):
                check.pose(pose)


def _doubtful(tag: str, index: MarkupIndex) -> list[XmlElement]:
    """Leave out elements whose values are certainly good, which is quick where all are."""
    elements = index.markup.of(tag)
    rule = _plain_rule(tag)
    if rule is None:
        return index.xmls(tag)
    if rule.value_type in _PLAIN_IF_BEGUN:
        elements = elements[~index.markup.begins_with_digit(elements)]
        if not len(elements):
            return []
    texts = index.markup.texts(elements)
    pattern = _pattern(rule)
    if pattern.fullmatch(_END.join(set(texts)) + _END):
        return []
    is_doubtful = [not pattern.fullmatch(text + _END) for text in texts]
    return index.xmls_of(tag, elements[is_doubtful])


class _Check:

    def __init__(self, document: Document, problems: Problems) -> None:
        self._document = document
        self._problems = problems

    def value(self, xml: XmlElement) -> None:
        holder = xml.getparent()
        types = None if holder is None else VALUE_TYPES.get(str(holder.tag))
        value_type = None if types is None else types.get(str(xml.tag))
        if holder is None or value_type is None:
            return
        text = text_of(xml).strip()
        if not text:
            return
        if not _is_of_type(text, value_type):
            msg = f'"{text[:80]}" is not {value_type.value}'
            self._error(ElementInvalidError, xml, msg)
            return
        key = (str(holder.tag), str(xml.tag))
        if key in SMALLEST_VALUES:
            self._check_range(xml, text, key)
        if key in _AXES:
            self._check_axis(xml, text)

    def _check_range(self, xml: XmlElement, text: str, key: tuple[str, str]) -> None:
        number = re.match(_LEADING_NUMBER, text)
        smallest, largest = SMALLEST_VALUES[key], LARGEST_VALUES.get(key, math.inf)
        if number and not smallest <= float(number.group()) <= largest:
            rule = f'at least {smallest:g}' if largest == math.inf else (
                f'from {smallest:g} to {largest:g}')
            self._error(ElementInvalidError, xml, f'"{text}" must be {rule}')

    def pose(self, xml: XmlElement) -> None:
        is_quaternion = xml.get('rotation_format', '').strip() == 'quat_xyzw'
        try:
            pose_from_text(PoseText(text_of(xml), is_quaternion, False))
        except PoseTextError as error:
            self._error(ElementInvalidError, xml, str(error))

    def attribute(self, xml: XmlElement) -> None:
        attribute = REQUIRED_ATTRIBUTES[str(xml.tag)]
        if xml.get(attribute) is None:
            tag = str(xml.tag)
            self._error(AttributeMissingError, xml, f'<{tag}> has no {attribute}')

    def material(self, xml: XmlElement) -> None:
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
        numbers = [re.match(_LEADING_NUMBER, word) for word in text.split()]
        if math.hypot(*(float(number.group()) for number in numbers if number)) <= _SMALLEST_AXIS:
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
    if value_type is ValueType.BOOLEAN:
        return boolean_from_text(text) is not None
    if value_type is ValueType.COLOR:
        numbers = [re.match(_LEADING_NUMBER, word) for word in text.split()]
        values = [float(number.group()) for number in numbers if number]
        return (len(values) == len(numbers) and len(values) in (3, 4)
                and all(0.0 <= value <= 1.0 for value in values))
    count = _COUNTS.get(value_type, 1)
    words = text.split()[:count]
    number = _INTEGER if value_type is ValueType.INTEGER else _NUMBER
    if len(words) == count and all(re.match(number, word, re.IGNORECASE) for word in words):
        return True
    return count == 1 and re.match(_TRUTH, text, re.IGNORECASE) is not None

