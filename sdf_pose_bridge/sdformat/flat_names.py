# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Give nested models back to worlds written before version 1.8.

Old libraries could not nest models. They wrote an included model's content into the model around
it, with names such as ``kid::link``, and a frame ``kid::__model__`` for its model frame.
"""

from __future__ import annotations

from lxml import etree

from sdf_pose_bridge.errors import ConversionError
from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.names import MODEL_FRAME
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.names import WORLD_FRAME
from sdf_pose_bridge.sdformat.document import value_of
from sdf_pose_bridge.sdformat.document import WHITE_SPACE
from sdf_pose_bridge.sdformat.document import XmlElement
from sdf_pose_bridge.sdformat.elements import step

_MOVED_TAGS = frozenset({'link', 'joint', 'frame', 'model', 'gripper'})
_REFERENCE_ATTRIBUTES = ('relative_to', 'attached_to', 'expressed_in')


def unflatten_model(model: XmlElement, path: str) -> None:
    """
    Move elements named ``kid::...`` into a nested model ``kid``, and so on within it.

    :param model: a ``<model>``; it is changed in place.
    :param path: the file, for errors.
    :raises ConversionError: if what is moved refers to something outside its new model.
    """
    kids: dict[str, XmlElement] = {}
    for child in list(model.iterchildren(etree.Element)):
        name = child.get('name', '').strip(WHITE_SPACE)
        kid, separator, own_name = name.partition(SEPARATOR)
        if child.tag not in _MOVED_TAGS or not separator or not kid or not own_name:
            continue
        if kid not in kids:
            kids[kid] = etree.Element('model', {'name': kid})
            kids[kid].sourceline = child.sourceline  # type: ignore[misc]  # lxml can set it
        _move(child, kids[kid], own_name, path)
    for kid_model in kids.values():
        model.append(kid_model)
        unflatten_model(kid_model, path)


def _move(child: XmlElement, kid_model: XmlElement, own_name: str, path: str) -> None:
    prefix = kid_model.get('name', '') + SEPARATOR
    if child.tag == 'frame' and own_name == MODEL_FRAME:
        _take_frame_for_model(child, kid_model, prefix)
        return
    kid_model.append(child)
    for element in child.iter(etree.Element):
        for attribute in _REFERENCE_ATTRIBUTES:
            name = element.get(attribute, '').strip(WHITE_SPACE)
            if name:
                element.set(attribute, _cut(name, prefix, element, path))
    if child.tag == 'joint':
        for end in child.iterchildren('parent', 'child'):
            end.text = _cut(value_of(end), prefix, end, path)
    child.set('name', own_name)


def _take_frame_for_model(frame: XmlElement, kid_model: XmlElement, prefix: str) -> None:
    """Place the model where the frame that stands for it is."""
    parent = frame.getparent()
    attached_to = frame.get('attached_to', '').strip(WHITE_SPACE)
    if attached_to.startswith(prefix):
        kid_model.set('canonical_link', attached_to[len(prefix):])
    pose = frame.find('pose')
    if pose is not None:
        kid_model.insert(0, pose)
    if parent is not None:
        parent.remove(frame)


def _cut(name: str, prefix: str, element: XmlElement, path: str) -> str:
    if name.startswith(prefix):
        return name[len(prefix):]
    if name in (WORLD_FRAME, MODEL_FRAME) or not name:
        return name
    steps = [step(str(e.tag), e.get('name', '')) if e.get('name') else str(e.tag)
             for e in (*reversed(list(element.iterancestors())), element)]
    msg = (f'"{name}" cannot be converted: "{prefix[:-len(SEPARATOR)]}" becomes a nested model, '
           'and names of the model around it cannot be used there')
    raise ConversionError(msg, Place(path, element.sourceline or 0, '/' + '/'.join(steps)))
