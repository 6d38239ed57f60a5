# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Break a valid scene in one place.

Only defects that every release of libsdformat from 14 on refuses are here: those that it passes
over in deeply nested models, or that later releases judge otherwise, are not.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from random import Random
from typing import Any, NamedTuple
from xml.etree import ElementTree

Element = ElementTree.Element
FRAMES = ('link', 'joint', 'frame')
NOTHING = 'no such frame'
BAD_POSES = (
    '1 2 3', '1 2 3 4 5 6 7', 'a b c d e f', '1 2 3 0 0 nan', 'inf 0 0 0 0 0', '1,2,3,0,0,0',
    '1 2 3 0 0 <!-- cut --> 0', '1e999 0 0 0 0 0')
BAD_POSE_ATTRIBUTES = (
    ('0 0 0 0 0 0 1', {'rotation_format': 'quat_xyzw', 'degrees': 'true'}),
    ('0 0 0 0 0 0', {'rotation_format': 'rpy'}),
    ('0 0 0 0 0 0', {'degrees': 'maybe'}),
    ('0 0 0 0 0 0', {'rotation_format': 'quat_xyzw'}))


class Place(NamedTuple):
    """An element of the file itself, and the world or model that it is in."""

    scope: Element
    element: Element


# Places

def scopes(content: Sequence[Element]) -> list[Element]:
    """Return every world and model."""
    return [each for top in content for each in top.iter() if each.tag in ('world', 'model')]


def models(content: Sequence[Element]) -> list[Element]:
    """Return every model."""
    return [scope for scope in scopes(content) if scope.tag == 'model']


def children(*tags: str) -> Callable[[Sequence[Element]], list[Place]]:
    """Return a function for the places of elements with one of the tags."""
    return lambda content: [
        Place(scope, child) for scope in scopes(content) for child in scope if child.tag in tags]


def outer_joints(content: Sequence[Element]) -> list[Place]:
    """Return the joints of top models and of models in worlds, whose parents are checked."""
    return [Place(model, joint) for top in content
            for model in (top.findall('model') if top.tag == 'world' else [top])
            for joint in model.findall('joint')]


# Damage

def set_reference(element: Element, reference: str) -> None:
    """Make the pose of an element relative to something else."""
    pose = element.find('pose')
    if pose is None:
        pose = ElementTree.SubElement(element, 'pose')
    pose.set('relative_to', reference)


def add_frame(scope: Element, reference: str = '', **attributes: str) -> None:
    """Add a frame, which may be relative to something."""
    frame = ElementTree.SubElement(scope, 'frame', {'name': 'extra', **attributes})
    if reference:
        set_reference(frame, reference)


def add_ring(dice: Random, scope: Element) -> None:
    """Give two to four frames from one another in a ring."""
    count = dice.randint(2, 4)
    for number in range(count):
        add_frame(scope, f'ring{(number + 1) % count}', name=f'ring{number}')


def add_attached_ring(dice: Random, scope: Element) -> None:
    """Attach frames to one another in a ring while their poses are fine."""
    count = dice.randint(1, 4)
    for number in range(count):
        add_frame(scope, root_of(scope), name=f'ring{number}',
                  attached_to=f'ring{(number + 1) % count}')


def root_of(scope: Element) -> str:
    """Return how the frame of a world or model is named in it."""
    return 'world' if scope.tag == 'world' else '__model__'


def place_relative_to_content(dice: Random, place: Place) -> None:
    """Place a model relative to its own content."""
    model = place.element
    inner = dice.choice([child for child in model if child.tag in FRAMES])
    set_reference(model, f'{model.get("name")}::{inner.get("name")}')


def add_pose(scope: Element, text: str, attributes: dict[str, str]) -> None:
    """Add a frame with a pose, in which comments stay."""
    builder = ElementTree.TreeBuilder(insert_comments=True)
    pose = ElementTree.fromstring(f'<pose>{text}</pose>', ElementTree.XMLParser(target=builder))
    pose.attrib.update(attributes)
    ElementTree.SubElement(scope, 'frame', name='extra').append(pose)


def add_twice(_dice: Random, model: Element) -> None:
    """Give two children of a model that are of one kind the same name."""
    add_frame(model)
    add_frame(model)


def join_to_itself(_dice: Random, place: Place) -> None:
    """Join a frame to the link that it is attached to."""
    joint = place.element
    add_frame(place.scope, name='shadow', attached_to=joint.findtext('child', ''))
    joint.find('parent').text = 'shadow'


def add_model_without_link(dice: Random, scope: Element) -> None:
    """Add a model that has nothing and is not static."""
    model = ElementTree.SubElement(scope, 'model', name='empty')
    if dice.random() < 0.5:
        add_frame(model)


def add_nameless(dice: Random, scope: Element) -> None:
    """Add a frame without a name."""
    add_frame(scope, name='')
    if dice.random() < 0.5:
        del scope[-1].attrib['name']


def set_text(place: Place, tag: str, text: str) -> None:
    """Change the text of a child."""
    place.element.find(tag).text = text


def misplace(dice: Random, place: Place) -> None:
    """Place an included model by a frame that it does not have, or without a pose."""
    if dice.random() < 0.5:
        place.element.remove(place.element.find('pose'))
    else:
        set_text(place, 'placement_frame', 'nothing')


class Defect(NamedTuple):
    """Something that can be wrong with a scene."""

    places: Callable[[Sequence[Element]], Sequence[Any]]
    """Finds where it can be; it may be nowhere."""
    add: Callable[[Any, Any], object]
    """Adds it at one of these places."""


DEFECTS = {
    'unknown reference': Defect(
        children(*FRAMES), lambda _, place: set_reference(place.element, NOTHING)),
    'unknown reference of a model': Defect(
        children('model'), lambda _, place: set_reference(place.element, NOTHING)),
    'unknown reference into a model': Defect(
        children('model'),
        lambda _, place: add_frame(place.scope, f'{place.element.get("name")}::nothing')),
    'reference to itself': Defect(
        children(*FRAMES),
        lambda _, place: set_reference(place.element, place.element.get('name', ''))),
    'cycle of references': Defect(scopes, add_ring),
    'cycle through content': Defect(
        lambda content: [place for place in children('model')(content)
                         if any(child.tag in FRAMES for child in place.element)],
        place_relative_to_content),
    'reference upwards': Defect(
        lambda content: [model for model in models(content) if model.find('include') is None
                         and all(child.get('name') != model.get('name') for child in model)],
        lambda _, model: add_frame(model, model.get('name', ''))),
    'world from a model': Defect(models, lambda _, model: add_frame(model, 'world')),
    'unknown attachment': Defect(
        scopes, lambda dice, scope: add_frame(
            scope, dice.choice(('', root_of(scope))), attached_to='nothing')),
    'cycle of attachments': Defect(scopes, add_attached_ring),
    'duplicate name': Defect(models, add_twice),
    'reserved name': Defect(
        scopes, lambda dice, scope: add_frame(
            scope, name=dice.choice(('world', '__mine__', '____', '__model__')))),
    'wrong child': Defect(
        children('joint'),
        lambda dice, place: set_text(place, 'child', dice.choice(('nothing', 'world')))),
    'wrong parent': Defect(
        outer_joints, lambda dice, place: set_text(
            place, 'parent', dice.choice((place.element.findtext('child'), 'nothing')))),
    'joint on one link': Defect(outer_joints, join_to_itself),
    'bad pose': Defect(scopes, lambda dice, scope: add_pose(scope, dice.choice(BAD_POSES), {})),
    'bad attributes of a pose': Defect(
        scopes, lambda dice, scope: add_pose(scope, *dice.choice(BAD_POSE_ATTRIBUTES))),
    'unknown placement frame': Defect(
        models, lambda _, model: model.set('placement_frame', 'nothing')),
    'unknown canonical link': Defect(
        lambda content: [model for model in models(content) if model.find('static') is None],
        lambda _, model: model.set('canonical_link', 'nothing')),
    'model without a link': Defect(scopes, add_model_without_link),
    'reference of the root': Defect(
        lambda content: [top for top in content[:1] if top.tag == 'model'],
        lambda dice, model: set_reference(model, dice.choice(('world', 'x', '__root__')))),
    'missing name': Defect(scopes, add_nameless),
    'missing end of a joint': Defect(
        lambda content: [
            place for place in outer_joints(content) if place.element.get('type') != 'ball'],
        lambda dice, place: place.element.remove(
            place.element.find(dice.choice(('parent', 'child'))))),
    'unknown URI': Defect(
        children('include'), lambda _, place: set_text(place, 'uri', 'model://no_such_model')),
    'wrong placement of an include': Defect(
        lambda content: [place for place in children('include')(content)
                         if place.element.find('placement_frame') is not None],
        misplace),
    'bad merge': Defect(
        lambda content: [
            place for place in children('include')(content) if place.scope.tag == 'model'],
        lambda _, place: place.element.set('merge', 'maybe')),
}

CHOICES = ('',) * 4 * len(DEFECTS) + tuple(DEFECTS)
"""Four of five scenes stay valid."""


def add_defect(dice: Random, content: list[Element]) -> str:
    """
    Break one scene in five in one place.

    :param content: the elements below ``sdf``; changed in place.
    :return: the name of the defect, or nothing if the scene has no place for it, or stays valid.
    """
    name = dice.choice(CHOICES)
    if not name:
        return ''
    places = DEFECTS[name].places(content)
    if not places:
        return ''
    DEFECTS[name].add(dice, dice.choice(places))
    return name
