# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read one ``<joint>``: its type, the frames that it joins, and those of its axes."""

from __future__ import annotations

from collections.abc import Callable

from sdf_pose_bridge.errors import AttributeInvalidError
from sdf_pose_bridge.errors import AttributeMissingError
from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.errors import ElementMissingError
from sdf_pose_bridge.errors import JointChildError
from sdf_pose_bridge.errors import JointParentError
from sdf_pose_bridge.errors import ReservedNameError
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.sdformat.document import value_of
from sdf_pose_bridge.sdformat.document import WHITE_SPACE
from sdf_pose_bridge.sdformat.document import XmlElement
from sdf_pose_bridge.sdformat.element_builder import ElementBuilder
from sdf_pose_bridge.sdformat.elements import JOINT_TYPES
from sdf_pose_bridge.sdformat.elements import JointFacts
from sdf_pose_bridge.sdformat.elements import Reference

_NO_REFERENCE = Reference('', 0)


def joint_facts_from_xml(
    xml: XmlElement, table: ElementBuilder, joint: int, name_in_scope: Callable[[str], str],
) -> JointFacts:
    """
    Read a joint.

    :param xml: the element.
    :param table: takes what is wrong with it.
    :param joint: its index.
    :param name_in_scope: turns a reference as written into one that its scope knows.
    :return: what only a joint has; names are empty where they are missing or reserved.
    """
    expressed_in = [
        Reference(name_in_scope(xyz.get('expressed_in', '').strip(WHITE_SPACE)),
                  xyz.sourceline or 0)
        for axis in xml.iterchildren('axis', 'axis2') for xyz in axis.iterchildren('xyz')]
    joint_type = _joint_type(xml, table, joint)
    parent, child = (
        reference._replace(name=name_in_scope(reference.name)) for reference in (
            _joint_end(xml, end, table, joint, joint_type) for end in ('parent', 'child')))
    return JointFacts(
        joint_type, parent, child,
        tuple(reference for reference in expressed_in if reference.name))


def _joint_type(xml: XmlElement, table: ElementBuilder, joint: int) -> str:
    written = xml.get('type')
    if written is None:
        table.error(AttributeMissingError, xml, 'the joint has no type', joint, '')
        return ''
    joint_type = written.strip(WHITE_SPACE).lower()
    if joint_type not in JOINT_TYPES:
        known = ', '.join(sorted(JOINT_TYPES))
        msg = f'"{written}" is no type of joint; known are {known}'
        table.error(AttributeInvalidError, xml, msg, joint, '')
    return joint_type


def _joint_end(
    xml: XmlElement, end: str, table: ElementBuilder, joint: int, joint_type: str,
) -> Reference:
    element = next(xml.iterchildren(end), None)
    name = '' if element is None else value_of(element)
    if element is not None and not name:
        msg = f'<{end}> is empty; it must name a frame'
        table.error(ElementInvalidError, element, msg, joint, end)
        return _NO_REFERENCE
    if element is None:
        missing = JointParentError if end == 'parent' else JointChildError
        table.error(
            missing if joint_type == 'ball' else ElementMissingError,
            xml, f'the joint has no <{end}>; it must name a frame', joint, '')
        return _NO_REFERENCE
    if name == ROOT_FRAME:
        msg = f'"{name}" is reserved; it cannot be the {end} of a joint'
        table.error(ReservedNameError, element, msg, joint, end)
        return _NO_REFERENCE
    return Reference(name, element.sourceline or 0)
