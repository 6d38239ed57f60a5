# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Change scenes: by parameters of includes, and at random.

Which changed scenes are valid is libsdformat's affair.
"""

from __future__ import annotations

from copy import deepcopy
from xml.etree import ElementTree

from differential.scene_text import new_pose, sub_element

Element = ElementTree.Element

ACTIONS = ('add', 'modify', 'replace', 'remove')
NAMES = ('no such frame', 'world', '__model__', '__root__', '__mine__', '', ' ')
TEXTS = (
    *NAMES, '1 2 3', '1 2 3 4 5 6 7', '1 2 3 0 0 nan', 'inf 0 0 0 0 0', '1 x', '1,2,3,0,0,0',
    '1e999 0 0 0 0 0', '0 0 0 0 0 0 1', 'maybe', 'true', '2')
ATTRIBUTES = (
    ('relative_to', NAMES), ('attached_to', NAMES), ('name', NAMES), ('placement_frame', NAMES),
    ('canonical_link', NAMES), ('expressed_in', NAMES), ('degrees', ('true', 'maybe')),
    ('rotation_format', ('quat_xyzw', 'euler_rpy', 'rpy')), ('merge', ('true', 'false', 'maybe')))


def add_param(dice, params, inner, links):
    """
    Add a parameter of an include.

    :param inner: the frames of the included model.
    :param links: its links.
    """
    name = dice.choice(links if dice.random() < 0.6 else inner)
    tag = 'link' if name in links else dice.choice(('frame', 'joint', 'model', 'visual'))
    action = dice.choice(ACTIONS)
    scope, _, own_name = name.rpartition('::')
    if dice.random() < 0.6:
        element = sub_element(params, tag, element_id=name)
        pose = new_pose(dice, dice.choice(inner)) if dice.random() < 0.3 else new_pose(dice)
        if pose is not None:
            pose.set('action', action)
            element.append(pose)
        return
    if action == 'add':
        tag, name, own_name = 'frame', scope, f'added_{len(params)}'
    element = sub_element(params, tag, element_id=name, action=action, name=own_name)
    pose = new_pose(dice)
    if action != 'remove' and pose is not None:
        element.append(pose)


def change_at_random(dice, root):
    """Remove, copy, move or change one or two elements."""
    for _ in range(dice.randint(1, 2)):
        pairs = [(parent, child) for parent in root.iter() for child in parent]
        if not pairs:
            return
        (parent, child), (other, another) = dice.choice(pairs), dice.choice(pairs)
        change = dice.randrange(8)
        if change == 0:
            parent.remove(child)
        elif change == 1:
            other = parent if dice.random() < 0.5 else other
            other.append(deepcopy(child))
        elif change == 2:
            child.text, another.text = another.text, child.text
        elif change == 3:
            child.text = dice.choice(TEXTS)
        elif change == 4 and child not in list(other.iter()) and other not in list(child.iter()):
            parent.remove(child)
            other.append(child)
        elif change == 5 and child.attrib:
            del child.attrib[dice.choice(sorted(child.attrib))]
        elif change == 6 and child.attrib and another.attrib:
            value = another.get(dice.choice(sorted(another.attrib)), '')
            child.set(dice.choice(sorted(child.attrib)), value)
        else:
            attribute, values = dice.choice(ATTRIBUTES)
            child.set(attribute, dice.choice(values))
