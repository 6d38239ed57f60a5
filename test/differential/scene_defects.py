# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Break a valid scene in one place.

Only defects that every release of libsdformat from 12.3 on refuses are here: those that it passes
over in deeply nested models, or that later releases judge otherwise, are not.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from xml.etree import ElementTree

from hypothesis import strategies as st

from differential.scene_text import Draw

Element = ElementTree.Element
FRAMES = ('link', 'joint', 'frame')
BAD_POSES = ('1 2 3', '1 2 3 4 5 6 7', 'a b c d e f', '1 2 3 0 0 nan', 'inf 0 0 0 0 0',
             '1,2,3,0,0,0', '1 2 3 0 0 <!-- cut --> 0', '1e999 0 0 0 0 0')


def scopes(content: list[Element]) -> list[Element]:
    """Return every world and model in the file itself."""
    found = []
    for element in content:
        found += [scope for scope in element.iter() if scope.tag in ('world', 'model')]
    return found


def frames(content: list[Element], *kinds: str) -> list[tuple[Element, Element]]:
    """Return pairs of a scope and a child of one of the kinds."""
    return [(scope, child) for scope in scopes(content) for child in scope if child.tag in kinds]


def outer_joints(content: list[Element]) -> list[Element]:
    """Return the joints of top models and of models in worlds, whose parents are checked."""
    outer = [model for element in content
             for model in (element.findall('model') if element.tag == 'world' else [element])]
    return [joint for model in outer for joint in model.findall('joint')]


def set_reference(element: Element, reference: str) -> None:
    """Make the pose of an element relative to something else."""
    pose = element.find('pose')
    if pose is None:
        pose = ElementTree.SubElement(element, 'pose')
    pose.set('relative_to', reference)


def add_frame(scope: Element, name: str, **attributes: str) -> Element:
    """Add an explicit frame to a scope."""
    return ElementTree.SubElement(scope, 'frame', name=name, **attributes)


# Each returns False where the scene offers no place for the defect.

def unknown_reference(draw: Any, content: list[Element]) -> bool:
    """Give a frame from one that does not exist."""
    places = frames(content, *FRAMES)
    if not places:
        return False
    set_reference(draw(st.sampled_from(places))[1], 'no such frame')
    return True


def unknown_model_reference(draw: Any, content: list[Element]) -> bool:
    """Give a model that is in something from a frame that does not exist."""
    places = frames(content, 'model')
    if not places:
        return False
    set_reference(draw(st.sampled_from(places))[1], 'no such frame')
    return True


def unknown_inner_reference(draw: Any, content: list[Element]) -> bool:
    """Name something in a nested model that has nothing of that name."""
    places = frames(content, 'model')
    if not places:
        return False
    scope, model = draw(st.sampled_from(places))
    set_reference(add_frame(scope, 'extra'), f'{model.get("name")}::nothing')
    return True


def reference_to_self(draw: Any, content: list[Element]) -> bool:
    """Give a frame from itself."""
    places = frames(content, *FRAMES)
    if not places:
        return False
    element = draw(st.sampled_from(places))[1]
    set_reference(element, element.get('name', ''))
    return True


def reference_cycle(draw: Any, content: list[Element]) -> bool:
    """Give two to four frames from one another in a ring."""
    scope = draw(st.sampled_from(scopes(content)))
    count = draw(st.integers(2, 4))
    for number in range(count):
        set_reference(add_frame(scope, f'ring{number}'), f'ring{(number + 1) % count}')
    return True


def cycle_through_content(draw: Any, content: list[Element]) -> bool:
    """Place a model relative to its own content."""
    places = [(scope, model) for scope, model in frames(content, 'model')
              if any(child.tag in FRAMES for child in model)]
    if not places:
        return False
    model = draw(st.sampled_from(places))[1]
    inner = draw(st.sampled_from([child for child in model if child.tag in FRAMES]))
    set_reference(model, f'{model.get("name")}::{inner.get("name")}')
    return True


def reference_upwards(draw: Any, content: list[Element]) -> bool:
    """Name a model from within itself."""
    models = [scope for scope in scopes(content) if scope.tag == 'model'
              and all(child.get('name') != scope.get('name') for child in scope)
              and scope.find('include') is None]
    if not models:
        return False
    model = draw(st.sampled_from(models))
    set_reference(add_frame(model, 'extra'), model.get('name', ''))
    return True


def world_from_model(draw: Any, content: list[Element]) -> bool:
    """Name the world from within a model."""
    model = draw(st.sampled_from([scope for scope in scopes(content) if scope.tag == 'model']))
    set_reference(add_frame(model, 'extra'), 'world')
    return True


def unknown_attachment(draw: Any, content: list[Element]) -> bool:
    """Attach a frame to nothing, whether or not its pose depends on it."""
    scope = draw(st.sampled_from(scopes(content)))
    frame = add_frame(scope, 'extra', attached_to='nothing')
    if draw(st.booleans()):
        set_reference(frame, 'world' if scope.tag == 'world' else '__model__')
    return True


def attachment_cycle(draw: Any, content: list[Element]) -> bool:
    """Attach frames to one another in a ring while their poses are fine."""
    scope = draw(st.sampled_from(scopes(content)))
    count = draw(st.integers(1, 4))
    root = 'world' if scope.tag == 'world' else '__model__'
    for number in range(count):
        frame = add_frame(scope, f'ring{number}', attached_to=f'ring{(number + 1) % count}')
        set_reference(frame, root)
    return True


def duplicate_name(draw: Any, content: list[Element]) -> bool:
    """Give two children of a model that are of one kind the same name."""
    models = [scope for scope in scopes(content) if scope.tag == 'model']
    model = draw(st.sampled_from(models))
    add_frame(model, 'twice')
    add_frame(model, 'twice')
    return True


def reserved_name(draw: Any, content: list[Element]) -> bool:
    """Use a name that is SDFormat's own."""
    scope = draw(st.sampled_from(scopes(content)))
    add_frame(scope, draw(st.sampled_from(('world', '__mine__', '____', '__model__'))))
    return True


def joint_child(draw: Any, content: list[Element]) -> bool:
    """Give a joint a child that cannot be one."""
    joints = [joint for _, joint in frames(content, 'joint')]
    if not joints:
        return False
    joint = draw(st.sampled_from(joints))
    joint.find('child').text = draw(st.sampled_from(('nothing', 'world')))
    return True


def joint_parent(draw: Any, content: list[Element]) -> bool:
    """Give a joint a parent that does not exist, or is its child."""
    joints = outer_joints(content)
    if not joints:
        return False
    joint = draw(st.sampled_from(joints))
    same = draw(st.booleans())
    joint.find('parent').text = joint.find('child').text if same else 'nothing'
    return True


def joint_on_one_link(draw: Any, content: list[Element]) -> bool:
    """Join a frame to the link that it is attached to."""
    joints = outer_joints(content)
    if not joints:
        return False
    joint = draw(st.sampled_from(joints))
    model = next(scope for scope in scopes(content) if joint in list(scope))
    add_frame(model, 'shadow', attached_to=joint.find('child').text or '')
    joint.find('parent').text = 'shadow'
    return True


def bad_pose(draw: Any, content: list[Element]) -> bool:
    """Write a pose that is none."""
    scope = draw(st.sampled_from(scopes(content)))
    text = draw(st.sampled_from(BAD_POSES))
    pose = ElementTree.fromstring(f'<pose>{text}</pose>', _parser_with_comments())
    add_frame(scope, 'extra').append(pose)
    return True


def bad_pose_attributes(draw: Any, content: list[Element]) -> bool:
    """Combine attributes of a pose that exclude each other, or do not exist."""
    frame = add_frame(draw(st.sampled_from(scopes(content))), 'extra')
    pose = ElementTree.SubElement(frame, 'pose')
    kind = draw(st.integers(0, 3))
    pose.text = '0 0 0 0 0 0' if kind in (1, 2) else '0 0 0 0 0 0 1'
    if kind != 2:
        pose.set('rotation_format', 'rpy' if kind == 1 else 'quat_xyzw')
    if kind == 0:
        pose.set('degrees', 'true')
    if kind == 2:
        pose.set('degrees', 'maybe')
    if kind == 3:
        pose.text = '0 0 0 0 0 0'
    return True


def unknown_placement(draw: Any, content: list[Element]) -> bool:
    """Place a model by a frame that it does not have."""
    models = [scope for scope in scopes(content) if scope.tag == 'model']
    draw(st.sampled_from(models)).set('placement_frame', 'nothing')
    return True


def unknown_canonical_link(draw: Any, content: list[Element]) -> bool:
    """Name a canonical link that does not exist, in a model that is not static."""
    models = [scope for scope in scopes(content)
              if scope.tag == 'model' and scope.find('static') is None]
    if not models:
        return False
    draw(st.sampled_from(models)).set('canonical_link', 'nothing')
    return True


def model_without_link(draw: Any, content: list[Element]) -> bool:
    """Add a model that has nothing and is not static."""
    model = ElementTree.SubElement(draw(st.sampled_from(scopes(content))), 'model', name='empty')
    if draw(st.booleans()):
        add_frame(model, 'extra')
    return True


def root_reference(draw: Any, content: list[Element]) -> bool:
    """Give the model of a model file from something."""
    if content[0].tag != 'model':
        return False
    set_reference(content[0], draw(st.sampled_from(('world', 'x', '__root__'))))
    return True


def missing_name(draw: Any, content: list[Element]) -> bool:
    """Leave a frame without a name."""
    frame = add_frame(draw(st.sampled_from(scopes(content))), '')
    if draw(st.booleans()):
        del frame.attrib['name']
    return True


def missing_joint_end(draw: Any, content: list[Element]) -> bool:
    """Leave out a joint's parent or child."""
    joints = [joint for joint in outer_joints(content) if joint.get('type') != 'ball']
    if not joints:
        return False
    joint = draw(st.sampled_from(joints))
    joint.remove(joint.find(draw(st.sampled_from(('parent', 'child')))))
    return True


def includes(content: list[Element]) -> list[Element]:
    """Return the includes in the file itself."""
    return [include for _, include in frames(content, 'include')]


def unknown_uri(draw: Any, content: list[Element]) -> bool:
    """Include what is not there."""
    found = includes(content)
    if not found:
        return False
    draw(st.sampled_from(found)).find('uri').text = 'model://no_such_model'
    return True


def unknown_include_placement(draw: Any, content: list[Element]) -> bool:
    """Place what is included by a frame that it does not have, or without a pose."""
    models = [include for include in includes(content)
              if include.find('placement_frame') is not None]
    if not models:
        return False
    include = draw(st.sampled_from(models))
    if draw(st.booleans()):
        include.remove(include.find('pose'))
    else:
        include.find('placement_frame').text = 'nothing'
    return True


def bad_merge(draw: Any, content: list[Element]) -> bool:
    """Write a truth value that is none; libsdformat 12 does not look at it in a world."""
    found = [include for scope, include in frames(content, 'include') if scope.tag == 'model']
    if not found:
        return False
    draw(st.sampled_from(found)).set('merge', 'maybe')
    return True


DEFECTS: tuple[Callable[[Any, list[Element]], bool], ...] = (
    unknown_reference, unknown_model_reference, unknown_inner_reference, reference_to_self,
    reference_cycle, cycle_through_content, reference_upwards, world_from_model,
    unknown_attachment, attachment_cycle, duplicate_name, reserved_name, joint_child, joint_parent,
    joint_on_one_link, bad_pose, bad_pose_attributes, unknown_placement, unknown_canonical_link,
    model_without_link, root_reference, missing_name, missing_joint_end, unknown_uri,
    unknown_include_placement, bad_merge,
)


SOUND = 4 * len(DEFECTS)
CHOICES: tuple[Callable[[Any, list[Element]], bool] | None, ...] = (None,) * SOUND + DEFECTS


def add_defect(draw: Draw, content: list[Element]) -> str:
    """
    Break one scene in five in one place.

    :param content: the elements below ``sdf``; changed in place.
    :return: the name of what was done, or nothing where the scene stayed sound.
    """
    defect: Any = draw(st.sampled_from(CHOICES))
    return defect.__name__ if defect and defect(draw, content) else ''


def _parser_with_comments() -> ElementTree.XMLParser:
    return ElementTree.XMLParser(target=ElementTree.TreeBuilder(insert_comments=True))
