# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Draw small files with one or two odd values, in any element that SDFormat defines.

Which values libsdformat refuses is its own affair: these scenes are not meant to be valid or not.
"""

from __future__ import annotations

from functools import cache
from xml.etree import ElementTree

from differential.scene_text import sub_element
from sdf_pose_bridge.sdformat.grammar import definition_of, ValueType

NUMBERS = (
    '', ' ', '1', '-1', '0', '0.5', '.5', '5.', '+2', '1e3', '1E-3', 'nan', 'NaN', 'inf', '-inf',
    'infinity', '1e999', '-1e999', '1e-400', '1e-320', '0x10', '0XfF', '-0x10', '0x', '0x1p3',
    '1.5abc', '1abc', 'abc', '1,5', '1e', '1e+', '1_0', '--1', '+-1', '.', '-', '1.5.5', '1-2',
    'true', 'FALSE', 'truex', 'yes', '\u0661', '2147483647', '2147483648', '-2147483649',
    '4294967295', '4294967296', '18446744073709551615', '18446744073709551616', '1e39', '1e-40',
    '1\u00a02', '1;2',
)
VECTORS = (
    '1 2 3', '1 2', '0 0 0', '1 2 3 4', '0 0.5 1', '0 0.5 1 1', '0 0.5 1 2', '0 0 1 1 1',
    '1.22.28 0.26', '1.22.28.33', '1-2-3', '1e-7 0 0', '1e-6 0 0', '0 0 1e999', 'nan 0 1',
    '1 inf 1', '1,2,3', '1 2 3abc', '1abc 2 3', '1 2 0x10', '0x1 0 0', '1e 2 3', '1\n2\t3',
    '1 2 3e', '1 2 -', '5 5', '5 5.5', '5.5 5', '5 -5', '1 2147483648', '0 0 0 0 0 0',
    '1 2 3 4 5 6 7', '0 0 0 0 0 x',
)
TEXTS = ('', ' ', 'x', '__default__', '__root__', 'world', 'a::b', 'true', 'no such thing')
TYPES = {
    'joint': 'revolute', 'light': 'point', 'sensor': 'imu', 'particle_emitter': 'box',
    'atmosphere': 'adiabatic', 'physics': 'ode', 'shader': 'pixel', 'noise': 'none'}
ENDS = {'parent': 'l', 'child': 'k'}
NOT_READ = frozenset({
    ('population', 'model'), ('noise', '@type'), ('world', 'state'), ('model', 'model_state')})
"""What the package does not read as a part of its own, as no frame depends on it; and states,
whose elements have other names in later releases of libsdformat."""

def odd_scene(dice):
    """Draw a file."""
    root = ElementTree.Element('sdf', version=dice.choice(('1.7', '1.9', '1.11')))
    paths = _paths()
    place = dice.choice(paths)
    _add_odd_value(dice, root, place)
    if dice.random() < 0.3:
        # Two elements at the top of a file would exclude each other.
        places = [other for other in paths if other[0][0] == place[0][0]]
        _add_odd_value(dice, root, dice.choice(places))
    _complete(root)
    ElementTree.indent(root)
    return ElementTree.tostring(root, encoding='unicode')


@cache
def _paths():
    """Return the tags that lead to each value, and the attribute that has it; '' for the text."""
    found: list[tuple[tuple[str, ...], str]] = []
    _add_paths(definition_of('sdf', has_frames=True), (), found)
    return found


def _add_paths(definition, path, found):
    if path and definition.value_type is not None:
        found.append((path, ''))
    found += [(path, name) for name in definition.attributes
              if path and (*path[-1:], f'@{name}') not in NOT_READ]
    for tag, child in definition.children.items():
        # Each of these holds what has been seen in the one around it.
        if (tag not in path and tag not in ('include', 'plugin') and len(path) < 8
                and (*path[-1:], tag) not in NOT_READ):
            _add_paths(child, (*path, str(tag)), found)


def _add_odd_value(dice, root, place):
    path, attribute = place
    element, definition = root, definition_of('sdf', has_frames=True)
    for tag in path:
        definition = definition.children[tag]
        found = element.find(tag)
        element = sub_element(element, tag) if found is None else found
    value_type, texts = definition.value_type, [*NUMBERS, *VECTORS, *TEXTS]
    if attribute:
        value_type = definition.attributes[attribute].value_type
    if value_type in (ValueType.STRING, ValueType.FRAME, ValueType.CHOICE, ValueType.BOOLEAN):
        texts = [*NUMBERS[:3], 'true', 'FALSE', *TEXTS]
    elif value_type is not None and value_type.count == 1 and dice.random() < 0.8:
        texts = list(NUMBERS)
    elif dice.random() < 0.8:
        texts = list(VECTORS)
    value = dice.choice(texts)
    if attribute:
        element.set(attribute, value)
    else:
        element.text = value


def _complete(element, definition=None):
    """Add what has to be there beside the odd values."""
    definition = definition or definition_of('sdf', has_frames=True)
    for name, attribute in definition.attributes.items():
        if attribute.required and element.get(name) is None:
            is_type = name == 'type' and definition.identifier in TYPES
            element.set(name, TYPES[definition.identifier] if is_type else _name_of(element))
    tags = {child.tag for child in element}
    if element.tag in ('model', 'world') and definition.kind is not None:
        _add_joined(element)
    if definition.identifier == 'joint':
        for tag, name in ENDS.items():
            if tag not in tags:
                sub_element(element, tag, name)
    if element.tag == 'script' and definition.identifier == 'material/script':
        for tag in {'uri', 'name'} - tags:
            sub_element(element, tag, 'x')
    for child in element:
        child_definition = definition.children.get(child.tag)
        if child_definition is not None:
            _complete(child, child_definition)


def _add_joined(scope):
    """Add the links, or models in a world, that joints join, and the joint that axes follow."""
    tag = 'link' if scope.tag == 'model' else 'model'
    names = [child.get('name', _name_of(child)) for child in scope.findall(tag)]
    for name in ENDS.values():
        if name not in names:
            joined = sub_element(scope, tag, name=name)
            if tag == 'model':
                sub_element(joined, 'link', name='l')
    if scope.find('joint') is not None:
        leader = sub_element(scope, 'joint', name='a_mimic', type='universal')
        for axis in ('axis', 'axis2'):
            sub_element(leader, axis)


def _name_of(element):
    return 'l' if element.tag == 'link' else f'a_{element.tag}'
