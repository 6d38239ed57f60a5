# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Draw files that few people write: parameters over merges, deep models, includes in odd places.

What is valid among them is libsdformat's affair: they are not meant to be valid or not.
"""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import NamedTuple
from xml.etree import ElementTree

from differential.scene_parts import SCENE, SceneFiles
from differential.scene_values import ODD_VALUES

Element = ElementTree.Element

STEMS = ('arm', 'base', 'cup', 'disk', 'elbow', 'fork', 'grip', 'hub')
"""Names, none of which begins with another one; libsdformat compares beginnings."""
ACTIONS = ('add', 'modify', 'replace', 'remove')
VERSIONS = ('1.8', '1.9', '1.10', '1.11')
ODD_CHILDREN: tuple[tuple[str, str, dict[str, str]], ...] = (
    ('pose', '1 x', {}), ('pose', '1 2 3 0 0 0', {}), ('pose', '1 2 3', {}),
    ('pose', '0 0 0 0 0 0 1', {'rotation_format': 'quat_xyzw', 'degrees': 'true'}),
    ('pose', '0 0 0 0 0 90', {'degrees': 'true'}), ('pose', '0 0 0 0 0 0', {'degrees': 'maybe'}),
    ('pose', '0 0 0 0 0 0 1', {'rotation_format': 'quat_xyzw'}),
    ('static', 'maybe', {}), ('static', 'false', {}), ('gravity', '2', {}))
"""Elements that an include may override, some of them with wrong values."""
OLD_VERSIONS = ('1.5', '1.6', '1.7')


class Known(NamedTuple):
    """An element that can be named."""

    tag: str
    name: str


def chain_scene(dice: Random) -> SceneFiles:
    """
    Draw a scene of one of several families.

    :param dice: what is drawn.
    :return: the scene; its defect names the family.
    """
    family = dice.choice(FAMILIES)
    files = {path: text_of(root) for path, root in family(dice).items()}
    return SceneFiles(files, frozenset({ODD_VALUES, family.__name__}), family.__name__)


# Families

def parameters(dice: Random) -> dict[str, Element]:
    """Files that include one another, merge, place and change by parameters."""
    files: dict[str, Element] = {}
    names = [f'{stem}{number}' for number in range(4) for stem in STEMS]
    dice.shuffle(names)
    model, known = _leaf(dice, names)
    for level in range(dice.randint(1, 3)):
        path = f'level_{level}.sdf'
        files[path] = _sdf(dice, model)
        model, known = _around(dice, names, path, known, level)
    top = model
    if dice.random() < 0.3:
        top = Element('world', name='w')
        files['level_9.sdf'] = _sdf(dice, model)
        merge = {'merge': 'true'} if dice.random() < 0.2 else {}
        include = ElementTree.SubElement(top, 'include', merge)
        _fill_include(dice, include, 'level_9.sdf', known, [])
    files['scene.sdf'] = _sdf(dice, top)
    return files


def odd_overrides(dice: Random) -> dict[str, Element]:
    """Included files with odd values, which includes and parameters may override."""
    files = parameters(dice)
    for path in sorted(files.keys() - {'scene.sdf'}):
        scopes = [each for each in files[path].iter() if each.tag in ('model', 'link', 'frame')]
        scope = dice.choice([scopes[0], *scopes])
        tag, text, attributes = dice.choice(ODD_CHILDREN)
        child = Element(tag, attributes)
        child.text = text
        scope.insert(0 if dice.random() < 0.7 else len(scope), child)
    return files


def includes_anywhere(dice: Random) -> dict[str, Element]:
    """Lights, models, actors and worlds that are included in any element."""
    model, _ = _leaf(dice, [*STEMS])
    link = model.find('link')
    assert link is not None
    visual = ElementTree.SubElement(link, 'visual', name='v')
    ElementTree.SubElement(visual, 'geometry')
    ElementTree.SubElement(link, 'sensor', name='s', type='imu')
    world = Element('world', name='w')
    world.append(model)
    actor = ElementTree.SubElement(world, 'actor', name='walker')
    ElementTree.SubElement(actor, 'link', name='l')
    for _ in range(dice.randint(1, 2)):
        parents = [each for each in world.iter() if each.tag not in ('pose', 'include', 'uri')]
        include = ElementTree.SubElement(dice.choice(parents), 'include')
        if dice.random() < 0.2:
            include.set('merge', 'true')
        uri = dice.choice(('light', 'model', 'actor', 'world', 'model', 'light', 'nothing'))
        if dice.random() < 0.9:
            ElementTree.SubElement(include, 'uri').text = f'{SCENE}/{uri}.sdf'
        if dice.random() < 0.5:
            ElementTree.SubElement(include, 'pose').text = _numbers(dice)
    light = Element('light', name='lamp', type='point')
    inner = Element('model', name='inner')
    ElementTree.SubElement(inner, 'link', name='l')
    return {
        'light.sdf': _sdf(dice, light), 'model.sdf': _sdf(dice, inner),
        'actor.sdf': _sdf(dice, Element('actor', name='extra')),
        'world.sdf': _sdf(dice, Element('world', name='other')), 'scene.sdf': _sdf(dice, world)}


def deep_models(dice: Random) -> dict[str, Element]:
    """Models in models, 8 to 40 levels deep, with references into the depth."""
    depth = dice.randint(8, 40)
    model = Element('model', name='m')
    ElementTree.SubElement(model, 'link', name='l')
    inner: list[str] = ['l']
    for _ in range(depth):
        outer = Element('model', name='m')
        if dice.random() < 0.5:
            ElementTree.SubElement(outer, 'link', name='k')
        _pose(dice, model, [])
        if dice.random() < 0.3:
            model.set('placement_frame', dice.choice(inner))
        outer.append(model)
        inner = [f'm::{name}' for name in dice.sample(inner, min(3, len(inner)))] + ['m']
        if dice.random() < 0.3:
            frame = ElementTree.SubElement(
                outer, 'frame', name='f', attached_to=dice.choice(inner))
            _pose(dice, frame, inner)
            inner.append('f')
        model = outer
    return {'scene.sdf': _sdf(dice, model)}


def old_names(dice: Random) -> dict[str, Element]:
    """Models of old versions with scoped names, beside models that are nested already."""
    model = Element('model', name='top')
    children: list[Element] = [Element('link', name='own')]
    for scope in dice.sample(STEMS[:4], dice.randint(1, 3)):
        names = [f'{scope}::{stem}' for stem in dice.sample(STEMS[4:], 2)]
        if dice.random() < 0.3:
            names.append(f'{scope}::{STEMS[0]}x::{STEMS[5]}')
        for name in names:
            link = Element('link', name=name)
            _pose(dice, link, names if dice.random() < 0.3 else [])
            children.append(link)
        if dice.random() < 0.5:
            frame = Element('frame', name=f'{scope}::__model__', attached_to=names[0])
            ElementTree.SubElement(frame, 'pose').text = _numbers(dice)
            children.append(frame)
        if dice.random() < 0.4:
            children.append(_joint(dice, f'{scope}::j', names[0], names[1]))
    for name in dice.sample(('nest', 'oval'), dice.randint(0, 2)):
        nested = Element('model', name=name)
        ElementTree.SubElement(nested, 'link', name='l')
        if dice.random() < 0.5:
            ElementTree.SubElement(nested, 'link', name=f'{STEMS[7]}::l')
        children.append(nested)
    dice.shuffle(children)
    model.extend(children)
    if dice.random() < 0.3:
        return {'scene.sdf': _sdf(dice, model, OLD_VERSIONS)}
    world = Element('world', name='w')
    world.append(model)
    return {'scene.sdf': _sdf(dice, world, OLD_VERSIONS)}


def cycles(dice: Random) -> dict[str, Element]:
    """Frames, links and joints that refer to one another without order."""
    names = list(STEMS[:6])
    model = Element('model', name='m')
    for name in names[:3]:
        _pose(dice, ElementTree.SubElement(model, 'link', name=name), names)
    for name in names[3:5]:
        attached = {'attached_to': dice.choice(names)} if dice.random() < 0.6 else {}
        _pose(dice, ElementTree.SubElement(model, 'frame', {'name': name, **attached}), names)
    joint = _joint(dice, names[5], dice.choice([*names[:5], 'world']), dice.choice(names[:5]))
    _pose(dice, joint, names)
    model.append(joint)
    if dice.random() < 0.3:
        model.set('placement_frame', dice.choice(names))
    if dice.random() < 0.3:
        model.set('canonical_link', dice.choice(names))
    return {'scene.sdf': _sdf(dice, model)}


def mutated(dice: Random) -> dict[str, Element]:
    """A scene of another family in which a few things were moved, doubled or taken away."""
    files = dice.choice(FAMILIES[:-1])(dice)
    for _ in range(dice.randint(1, 3)):
        root = files[dice.choice(sorted(files))]
        pairs = [(parent, child) for parent in root.iter() for child in parent]
        if not pairs:
            continue
        (parent, child), (other, another) = dice.choice(pairs), dice.choice(pairs)
        change = dice.randrange(5)
        if change == 0:
            parent.remove(child)
        elif change == 1:
            parent.append(ElementTree.fromstring(ElementTree.tostring(child)))
        elif change == 2:
            child.text, another.text = another.text, child.text
        elif change == 3 and child.attrib and another.attrib:
            child.set(dice.choice(sorted(child.attrib)),
                      another.attrib[dice.choice(sorted(another.attrib))])
        elif child not in list(other.iter()) and other not in list(child.iter()):
            parent.remove(child)
            other.append(child)
    return files


FAMILIES: tuple[Callable[[Random], dict[str, Element]], ...] = (
    parameters, odd_overrides, includes_anywhere, deep_models, old_names, cycles, mutated)


# Parts

def _leaf(dice: Random, names: list[str]) -> tuple[Element, list[Known]]:
    model = Element('model', name=names.pop())
    known: list[Known] = []
    for tag in ('link', *dice.choices(('link', 'frame'), k=dice.randint(1, 2))):
        known.append(_child(dice, model, tag, names.pop(), known))
    if dice.random() < 0.2:
        model.set('placement_frame', dice.choice(known).name)
    if dice.random() < 0.4:
        _pose(dice, model, [])
    return model, known


def _around(
    dice: Random, names: list[str], path: str, inside: list[Known], level: int,
) -> tuple[Element, list[Known]]:
    """Draw a model that includes another file; return what can be named in it."""
    model = Element('model', name=names.pop())
    known: list[Known] = []
    if dice.random() < 0.7:
        known.append(_child(dice, model, 'link', names.pop(), known))
    merge = dice.random() < 0.6
    include = ElementTree.SubElement(model, 'include', {'merge': 'true'} if merge else {})
    name = f'part{level}'
    ElementTree.SubElement(include, 'name').text = name
    _fill_include(dice, include, path, inside, known)
    if merge:
        known += [*inside, Known('frame', f'_merged__{name}__model__')]
    else:
        known += [Known('model', name), *(Known(tag, f'{name}::{each}') for tag, each in inside)]
    if dice.random() < 0.4:
        known.append(_child(dice, model, 'frame', names.pop(), known))
    return model, known


def _fill_include(
    dice: Random, include: Element, path: str, inside: list[Known], outside: list[Known],
) -> None:
    ElementTree.SubElement(include, 'uri').text = f'{SCENE}/{path}'
    if dice.random() < 0.7:
        _pose(dice, include, [name for _, name in outside], always=True)
        if dice.random() < 0.5:
            frame = dice.choice([*inside, *outside]).name
            ElementTree.SubElement(include, 'placement_frame').text = frame
    if dice.random() < 0.6:
        params = ElementTree.SubElement(include, 'experimental_params')
        for _ in range(dice.randint(1, 2)):
            _add_parameter(dice, params, inside)


def _add_parameter(dice: Random, params: Element, inside: list[Known]) -> None:
    tag, name = dice.choice(inside)
    action = dice.choice(ACTIONS)
    references = [each for _, each in inside if '::' not in each]
    if dice.random() < 0.6:
        target = ElementTree.SubElement(params, tag, element_id=name)
        pose = _pose(dice, target, references if dice.random() < 0.3 else [], always=True)
        pose.set('action', action)
        return
    scope, _, own_name = name.rpartition('::')
    if action == 'add':
        target = ElementTree.SubElement(
            params, 'frame', element_id=scope, action=action, name=f'added_{len(params)}')
    else:
        target = ElementTree.SubElement(params, tag, element_id=name, action=action)
        if action == 'replace':
            target.set('name', own_name)
    if action != 'remove':
        _pose(dice, target, [])


def _child(
    dice: Random, model: Element, tag: str, name: str, known: list[Known],
) -> Known:
    _pose(dice, ElementTree.SubElement(model, tag, name=name), [each for _, each in known])
    return Known(tag, name)


def _joint(dice: Random, name: str, parent: str, child: str) -> Element:
    joint = Element('joint', name=name, type=dice.choice(('fixed', 'revolute')))
    ElementTree.SubElement(joint, 'parent').text = parent
    ElementTree.SubElement(joint, 'child').text = child
    axis = ElementTree.SubElement(joint, 'axis')
    ElementTree.SubElement(axis, 'xyz').text = '0 0 1'
    return joint


def _pose(
    dice: Random, element: Element, references: list[str], *, always: bool = False,
) -> Element:
    pose = Element('pose')
    if always or dice.random() < 0.6:
        element.append(pose)
    pose.text = _numbers(dice)
    if references and dice.random() < 0.4:
        pose.set('relative_to', dice.choice(references))
    return pose


def _numbers(dice: Random) -> str:
    """Draw a pose with few digits, so that nobody rounds it."""
    lengths = [dice.randint(-20, 20) / 2 for _ in range(3)]
    angles = [dice.choice((0.0, 0.0, 0.5, -1.25)) for _ in range(3)]
    return ' '.join(map(repr, lengths + angles))


def _sdf(dice: Random, top: Element, versions: tuple[str, ...] = VERSIONS) -> Element:
    root = Element('sdf', version=dice.choice(versions))
    root.append(top)
    return root


def text_of(root: Element) -> str:
    """Return the text of a file; its parameters have a prefix there."""
    text = ElementTree.tostring(root, encoding='unicode')
    return text.replace('experimental_params', 'experimental:params')
