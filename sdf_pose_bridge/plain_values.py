# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Leave out elements whose values are certainly good, which is quick where nearly all are.

What is left has to be looked at one by one: :mod:`sdf_pose_bridge.value_checks` knows the rules.
"""

from __future__ import annotations

from collections.abc import Iterator
import functools
import re
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.grammar import AXES
from sdf_pose_bridge.grammar import COUNTS_OF_NUMBERS
from sdf_pose_bridge.grammar import HOLDERS_OF_POSES
from sdf_pose_bridge.grammar import LARGEST_VALUES
from sdf_pose_bridge.grammar import MATERIAL_TAGS
from sdf_pose_bridge.grammar import REQUIRED_ATTRIBUTES
from sdf_pose_bridge.grammar import SMALLEST_VALUES
from sdf_pose_bridge.grammar import VALUE_TAGS
from sdf_pose_bridge.grammar import VALUE_TYPES
from sdf_pose_bridge.grammar import ValueType
from sdf_pose_bridge.known_tags import KNOWN_TAGS
from sdf_pose_bridge.markup import Markup
from sdf_pose_bridge.tag_search import Positions

# Patterns are left for `re` to compile when they are first needed, which for some is never.

_TYPES_OF_TAG: dict[str, set[ValueType]] = {}
for _types in VALUE_TYPES.values():
    for _tag, _type in _types.items():
        _TYPES_OF_TAG.setdefault(_tag, set()).add(_type)
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

_ATTRIBUTES = r'(?:\s+[^\s=]+\s*=\s*(?:"[^"]*"|\'[^\']*\'))*?'
_PLAIN_POSE = r'[ \t\n\r]*(?:[+-]?[0-9]{1,9}(?:\.[0-9]{0,20})?[ \t\n\r]+){6}'


def doubtful_elements(markup: Markup) -> dict[str, Positions]:
    """
    Find the elements with values that no other stage reads, and leave out what is surely good.

    :param markup: the elements of a document.
    :return: for each tag, the indices of elements that have to be looked at one by one.
    """
    found: dict[str, Positions] = {}
    for tag, elements in _doubts(markup):
        found[tag] = np.append(found[tag], elements) if tag in found else elements
    return {tag: np.sort(elements) for tag, elements in found.items() if len(elements)}


def _doubts(markup: Markup) -> Iterator[tuple[str, Positions]]:
    for tag in markup.present(VALUE_TAGS):
        yield tag, _with_doubtful_value(tag, markup)
    for tag in markup.present(REQUIRED_ATTRIBUTES):
        yield tag, _without_attribute(tag, markup)
    for tag in markup.present((*MATERIAL_TAGS, 'state')):
        yield tag, markup.of(tag)
    for tag in markup.present(HOLDERS_OF_POSES):
        yield tag, _with_doubtful_pose(tag, markup)


def _with_doubtful_value(tag: str, markup: Markup) -> Positions:
    elements = markup.of(tag)
    rule = _plain_rule(tag)
    if rule is None:
        return elements
    if rule.value_type in _PLAIN_IF_BEGUN:
        elements = elements[~markup.begins_with_digit(elements)]
    elif rule.value_type in COUNTS_OF_NUMBERS and not rule.is_axis:
        # They are good if all words begin with digits, and there are enough of them.
        count = COUNTS_OF_NUMBERS[rule.value_type]
        elements = elements[markup.counts_of_numbers(elements) < count]
    texts = markup.texts(elements)
    pattern = _pattern(rule)
    if not texts or pattern.fullmatch(_END.join(set(texts)) + _END):
        return elements[:0]
    is_doubtful = [not pattern.fullmatch(text + _END) for text in texts]
    return elements[is_doubtful]


def _without_attribute(tag: str, markup: Markup) -> Positions:
    elements = markup.of(tag)
    pattern = re.compile(rf'{tag}{_ATTRIBUTES}\s+{REQUIRED_ATTRIBUTES[tag]}\s*=')
    is_doubtful = [not pattern.match(written) for written in markup.tags(elements)]
    return elements[is_doubtful]


def _with_doubtful_pose(tag: str, markup: Markup) -> Positions:
    poses = markup.of('pose')
    holders = markup.holders(poses)
    is_held = np.append(markup.numbers, -1)[holders] == KNOWN_TAGS.number_of[tag]
    poses, holders = poses[is_held], holders[is_held]
    is_doubtful = [not re.fullmatch(_PLAIN_POSE, f'{text} ') for text in markup.texts(poses)]
    found: Positions = holders[
        markup.has_attributes(poses) | np.array(is_doubtful, dtype=bool)]
    return found


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
    return _PlainRule(strictest, bool(smallest), any(each == tag for _, each in AXES))


@functools.cache
def _pattern(rule: _PlainRule) -> re.Pattern[str]:
    """Make the pattern of a run of good values."""
    conditions = (_NOT_NEGATIVE if rule.is_not_negative else '') + (
        _NOT_ALL_ZERO if rule.is_axis else '')
    # Conditions look far ahead, and so only where white space has ended.
    return re.compile(rf'(?:\s*(?=\S){conditions}{_PLAIN_PATTERNS[rule.value_type]}\0)*')
