# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The supported versions of SDFormat, and the conversion of older ones to the newest one.

Features of newer versions work in every file, whatever version it declares. The declared version
decides the meaning of names and attributes that newer versions changed. Source: libsdformat's
``Converter.cc`` and ``sdf/*.convert``.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple, TypeAlias

from lxml import etree

from sdf_pose_bridge.errors import ConversionError, FileReadError, Place
from sdf_pose_bridge.names import MODEL_FRAME, SEPARATOR, WORLD_FRAME
from sdf_pose_bridge.sdformat.grammar import PARTS_OF_MODEL, REFERENCE_ATTRIBUTES
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.values import TRUE_TEXTS
from sdf_pose_bridge.sdformat.xml_tree import (
    attribute_of,
    child_elements,
    first_child,
    is_foreign,
    text_of,
    value_of,
    XmlElement,
)


class Version(NamedTuple):
    """A version of SDFormat."""

    major: int
    minor: int

    def __str__(self) -> str:
        return f'{self.major}.{self.minor}'


OLDEST = Version(1, 2)
NEWEST = Version(1, 12)

_SUPPORTED = {f'1.{minor}': Version(1, minor) for minor in range(OLDEST.minor, NEWEST.minor + 1)}

_MOVED_ELEMENTS = (
    ((1, 4), 'world/physics', 'update_rate', 'real_time_update_rate'),
    ((1, 4), 'world/physics', 'ode/solver/dt', 'max_step_size'),
    ((1, 4), 'world/physics', 'bullet/dt', 'max_step_size'),
    ((1, 6), 'world', 'physics/gravity', 'gravity'),
    ((1, 6), 'world', 'physics/magnetic_field', 'magnetic_field'),
)
"""Elements without poses that have moved: first version without them, path of their parent, their
tag in the parent, and their new tag."""

_DEPRECATED = (
    ((1, 10), 'joint', 'thread_pitch', '<screw_thread_pitch>, in metres per turn'),
    ((1, 12), 'sensor', 'gz_frame_id', '<frame_id>'),
    ((1, 12), 'camera', 'optical_frame_id', '<frame_id> of the sensor'),
    ((1, 12), 'link_state', 'velocity', '<linear_velocity> and <angular_velocity>'),
    ((1, 12), 'link_state', 'acceleration', '<linear_acceleration> and <angular_acceleration>'),
    ((1, 12), 'link_state', 'wrench', '<force> and <torque>'),
    ((1, 12), 'joint_state', 'angle', '<axis_state>'),
)
"""Elements that are deprecated from a version on: their parent, their tag, and the new element."""

_MODELS = '(model | world/model)'
"""The models that are not in another model."""

_ELEMENTS_WITH_REFERENCES = etree.XPath(
    f'descendant-or-self::*[{" or ".join(f"@{name}" for name in REFERENCE_ATTRIBUTES)}]')


def version_numbers(text: str) -> tuple[int, ...]:
    """
    Read the numbers of a version, whether it is supported or not.

    :param text: such as ``1.10``.
    :return: its numbers, most significant first; empty if the text is not numbers with dots.
    """
    parts = text.split('.')
    if all(part.isascii() and part.isdigit() and len(part) < 6 for part in parts):
        return tuple(map(int, parts))
    return ()


def version_of(root: XmlElement, place: Place) -> Version:
    """
    Read the version of a file, such as ``1.10``.

    :raises FileReadError: if it is not declared.
    :raises ConversionError: if it is older than :data:`OLDEST`, or newer than :data:`NEWEST`.
    """
    text = root.get('version')
    if text is None:
        msg = '<sdf> declares no version, such as version="1.10"'
        raise FileReadError(msg, place)
    if text in _SUPPORTED:
        return _SUPPORTED[text]
    msg = f'version="{text}" is not supported; versions {OLDEST} to {NEWEST} are'
    raise ConversionError(msg, place)


def allows_scoped_names(version: tuple[int, int]) -> bool:
    """Return whether names in a file may contain ``::``, as before version 1.8."""
    return version < (1, 8)


def renames_duplicates(version: tuple[int, int]) -> bool:
    """Return whether an element with the name of another kind is renamed, as below 1.7."""
    return version < (1, 7)


def convert(root: XmlElement, version: Version, sources: Sources) -> None:
    """
    Convert a file to the newest version, in place.

    :param root: the ``sdf`` element.
    :raises ConversionError: if names in it cannot be converted.
    """
    _report_deprecated(root, version, sources)
    _move_elements(root, version)
    if version < (1, 7):
        _convert_axes(root, version, sources)
        for pose in root.xpath('.//pose[@frame][not(parent::waypoint)]'):
            if not is_foreign(pose):
                pose.set('relative_to', pose.attrib.pop('frame'))
    if version < (1, 8):
        # An <inertial> can only be relative to its link, which an empty attribute meant.
        for pose in root.xpath('.//inertial/pose[@relative_to=""]'):
            del pose.attrib['relative_to']
    if allows_scoped_names(version) and sources.may_hold_scoped_names:
        for model in root.iterfind('world/model'):
            _nest_scoped_elements(model, sources, {})


def _report_deprecated(root: XmlElement, version: Version, sources: Sources) -> None:
    for since, parent, tag, new in _DEPRECATED:
        for xml in root.xpath(f'//{parent}/{tag}') if version >= since else ():
            if not is_foreign(xml):
                msg = f'<{tag}> in <{parent}> is deprecated; the new element is {new}'
                sources.warning(xml, msg)


def _move_elements(root: XmlElement, version: Version) -> None:
    for first_version, path, old, new_tag in _MOVED_ELEMENTS:
        for parent in root.iterfind(path) if version < first_version else ():
            element = parent.find(old)
            if element is not None:
                element.tag = new_tag
                parent.append(element)
    if version < (1, 6):
        # The noise of each axis gets its values.
        for noise in root.xpath(f'{_MODELS}/link/sensor/imu/noise[1]'):
            noise.getparent().remove(noise)


def _convert_axes(root: XmlElement, version: Version, sources: Sources) -> None:
    """
    Mark axes in the model frame by ``xyz/@expressed_in``; one without ``<xyz>`` gets an empty one.

    Before 1.5, axes are in it by default; before 1.7, by ``use_parent_model_frame``.
    """
    axes: dict[XmlElement, None] = {}
    if version < (1, 5):
        axes = dict.fromkeys(root.xpath(
            f'{_MODELS}/joint/*[self::axis or self::axis2][not(use_parent_model_frame)]'))
    for flag in list(root.iter('use_parent_model_frame')):
        axis = flag.getparent()
        if axis is not None and not is_foreign(flag):
            if text_of(flag) in TRUE_TEXTS:
                axes[axis] = None
            axis.remove(flag)
    for axis in axes:
        xyz = first_child(axis, 'xyz')
        if xyz is None:
            xyz = etree.SubElement(axis, 'xyz')
            sources.set_parsed_line(xyz, axis)
        xyz.set('expressed_in', MODEL_FRAME)


_References: TypeAlias = dict[XmlElement, list[tuple[XmlElement, str]]]
"""For each element that was moved, the elements in it with a reference that may have a further
scope, and the attribute with the reference; '' for the text."""


def _nest_scoped_elements(
    model: XmlElement, sources: Sources, references: _References, depth: int = 1,
) -> None:
    """
    1.7 to 1.8: move elements named ``nested::name`` into a new model ``nested``, recursively.

    Old libraries could not nest models. They wrote the content of an included model into the model
    around it, with such names, and a frame ``nested::__model__`` for its model frame. libsdformat
    stops at the first model that is nested already: it converts this model, but no later elements
    of the outer model, unless an earlier element has the same ``nested``.

    :raises ConversionError: if a moved element refers to something outside its new model.
    """
    sources.check_depth(depth, model)
    nested_models: dict[str, XmlElement] = {}
    is_stopped = False
    for child in list(child_elements(model)):
        scope, separator, name = attribute_of(child, 'name').partition(SEPARATOR)
        if child.tag == 'model' and scope and not separator and not is_stopped:
            _nest_scoped_elements(child, sources, references, depth + 1)
            is_stopped = True
        part = PARTS_OF_MODEL.get(child.tag)
        if part is None or not part.has_name or not separator or (
                is_stopped and scope not in nested_models):
            continue
        if not scope or not name:
            msg = f'the name "{scope}{SEPARATOR}{name}" is empty before or behind "{SEPARATOR}"'
            raise ConversionError(msg, sources.place(child))
        if scope not in nested_models:
            nested_models[scope] = etree.Element('model', {'name': scope})
            sources.set_source(nested_models[scope], child)
        prefix = scope + SEPARATOR
        if child.tag == 'frame' and name == MODEL_FRAME:
            _replace_model_frame(child, nested_models[scope], prefix)
            continue
        _remove_prefix_from_references(child, prefix, references, sources)
        child.set('name', name)
        nested_models[scope].append(child)
    for nested_model in nested_models.values():
        model.append(nested_model)
        _nest_scoped_elements(nested_model, sources, references, depth + 1)


def _replace_model_frame(frame: XmlElement, nested_model: XmlElement, prefix: str) -> None:
    """Give the pose and the attachment of ``nested::__model__`` to the nested model."""
    parent = frame.getparent()
    attached_to = attribute_of(frame, 'attached_to')
    if attached_to.startswith(prefix):
        nested_model.set('canonical_link', attached_to[len(prefix):])
    pose = frame.find('pose')
    if pose is not None:
        nested_model.insert(0, pose)
    if parent is not None:
        parent.remove(frame)


def _remove_prefix_from_references(
    xml: XmlElement, prefix: str, references: _References, sources: Sources,
) -> None:
    pose = xml.find('pose')
    if pose is not None:
        # If it is relative to another frame, that is looked up in the new model.
        relative_to = attribute_of(pose, 'relative_to')
        if relative_to.startswith(prefix):
            pose.set('relative_to', relative_to[len(prefix):])
    before = references[xml] if xml in references else _references_in(xml, pose)
    references[xml] = []
    for element, attribute in before:
        name = attribute_of(element, attribute) if attribute else value_of(element)
        if name in (WORLD_FRAME, MODEL_FRAME, ''):
            continue
        if not name.startswith(prefix):
            nested = prefix.removesuffix(SEPARATOR)
            msg = (f'"{name}" cannot be converted: "{nested}" becomes a nested model, in which '
                   'names of the model around it are not visible')
            raise ConversionError(msg, sources.place(element))
        if attribute:
            element.set(attribute, name[len(prefix):])
        else:
            element.text = name[len(prefix):]
        references[xml].append((element, attribute))


def _references_in(xml: XmlElement, pose: XmlElement | None) -> Iterator[tuple[XmlElement, str]]:
    if xml.tag == 'model':
        # References in it are to names in it.
        return
    for element in _ELEMENTS_WITH_REFERENCES(xml):
        yield from ((element, each) for each in REFERENCE_ATTRIBUTES if element is not pose)
    for path, attribute in PARTS_OF_MODEL[xml.tag].references:
        yield from ((end, '') for end in xml.iterfind(path) if not attribute)
