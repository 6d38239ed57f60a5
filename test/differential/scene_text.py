# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Strategies for the smallest pieces of an SDFormat file: names, numbers and pose elements."""

from __future__ import annotations

import math
from xml.etree import ElementTree

Element = ElementTree.Element

NAMES = (
    'base', 'arm', 'tool', 'l', 'a', 'b', 'cam', 'left arm', 'größe', '関節', 'a/b', 'v1.2',
    'tcp-1', '_x', 'x__', '___', "o'clock", 'R&D', 'x<y', 'a:b', 'Arm', '0', 'link',
    'no\u00a0break', 'pose', 'été/2', '🤖', 'world_', 'default', '"q"', '[0]', '%s', '{}',
)
"""
Stems of names, from what people write and from what a careless reader trips over.

Names with white space in a row are not among them: it is one blank in the text of an element, such
as a joint's child, but not in the attribute that gives the name, so they cannot be referred to.
"""

BOOLEANS = {True: ('true', '1', 'True', 'TRUE'), False: ('false', '0', 'False')}
LENGTHS = (0.0, 1.0, -1.0, 0.1, 0.5, 2.0, 1e-3, -0.25, 10.0)
TURNS = (0.0, math.pi / 2, -math.pi / 2, math.pi, -math.pi, math.pi / 4, 1.5708, -1.57079632679,
         3.14159, 2 * math.pi, 1e-9, 7.0)
DEGREES = (0.0, 90.0, -90.0, 180.0, -180.0, 45.0, 360.0, 30.0, 89.9999, 270.0, -720.5)
FORMATS = ('rpy', 'rpy', 'rpy', 'degrees', 'degrees', 'quaternion', 'quaternion', 'empty')


def sub_element(parent, tag, text=None, **attributes):
    """Add a child, and return it."""
    child = ElementTree.SubElement(parent, tag, attributes)
    child.text = text
    return child


def new_name(dice, taken):
    """Draw a name that is not taken, and take it."""
    stem = dice.choice(NAMES)
    name, number = stem, 1
    while name in taken:
        number += 1
        name = f'{stem}{number}'
    taken.add(name)
    return name


def text_from_number(dice, value):
    """Write a number in one of the forms that C and SDFormat read."""
    form = dice.randrange(12)
    if form == 0:
        return f'{value:.17e}'
    if form == 1 and math.copysign(1, value) > 0:
        return f'+{value!r}'
    if form == 2 and value == int(value):
        return f'{int(value)}.'
    if form == 3 and 0.1 <= abs(value) < 1:
        return repr(value).replace('0.', '.', 1)
    if form == 4 and value == int(value):
        return str(int(value))
    if form == 5:
        return repr(value).replace('e', 'E')
    return repr(value)


def number_from(dice, often, limit):
    """Choose a number that people write, or any other up to a limit."""
    if dice.random() < 0.5:
        return dice.choice(often)
    value = dice.uniform(-limit, limit)
    return value if dice.random() < 0.7 else round(value, 3)


def new_pose(dice, reference=''):
    """
    Draw a pose element, or None for no element.

    :param reference: what ``relative_to`` says; nothing where it is empty.
    """
    if not reference and dice.randrange(5) == 0:
        return None
    pose = Element('pose')
    if reference:
        padding = dice.choice(('', '', '', '', '', '', ' ', '\t'))
        pose.set('relative_to', padding + reference + padding)
    elif dice.randrange(10) == 0:
        pose.set('relative_to', dice.choice(('', ' ')))
    kind = dice.choice(FORMATS)
    numbers = [text_from_number(dice, number_from(dice, LENGTHS, 10)) for _ in range(3)]
    if kind == 'quaternion':
        parts = [number_from(dice, (0.0, 0.5, -0.5, 1.0), 1) for _ in range(4)]
        norm = math.hypot(*parts)
        if norm < 1e-3:
            parts, norm = [0.0, 0.0, 0.0, 1.0], 1.0
        numbers += [repr(part / norm) for part in parts]
        pose.set('rotation_format', 'quat_xyzw')
    else:
        often, limit = (DEGREES, 400) if kind == 'degrees' else (TURNS, 7)
        numbers += [text_from_number(dice, number_from(dice, often, limit)) for _ in range(3)]
        if dice.randrange(5) == 0:
            pose.set('rotation_format', 'euler_rpy')
    if kind == 'degrees':
        pose.set('degrees', dice.choice(BOOLEANS[True]))
    elif dice.randrange(7) == 0:
        pose.set('degrees', dice.choice(BOOLEANS[False]))
    if kind == 'empty':
        pose.text = dice.choice(('', ' ', '\n'))
        return pose
    gap = dice.choice((' ', ' ', ' ', '  ', '\n', '\t', ' \r\n '))
    edge = dice.choice(('', '', '', ' ', '\n'))
    pose.text = edge + gap.join(numbers) + edge
    if dice.randrange(16) == 0:
        # A comment in front of the numbers is harmless; only one between them cuts.
        comment = ElementTree.Comment(' x y z ')
        comment.tail, pose.text = pose.text, ''
        pose.append(comment)
    return pose
