# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read the details of joints.

Source: ``Joint::Load`` and ``JointAxis::Load`` of libsdformat 14.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import math
from typing import NamedTuple

from sdf_pose_bridge.errors import ElementMissingError, MimicError, ReservedNameError
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.specification import JOINT_TYPES, Motion
from sdf_pose_bridge.sdformat.values import number_of_child, numbers_of
from sdf_pose_bridge.sdformat.xml_tree import (
    attribute_of,
    first_child,
    first_children,
    value_of,
    XmlElement,
)

AXIS_TAGS = ('axis', 'axis2')
"""The tags of the axes of a joint."""

DEFAULT_END = '__default__'
"""Stands for a missing parent or child of a ball joint; no frame has this name."""


class Reference(NamedTuple):
    """A name by which an element refers to a frame."""

    name: str
    """As written; empty for none."""
    line: int = 0


NO_REFERENCE = Reference('')


class Mimic(NamedTuple):
    """
    The joint axis that an axis follows.

    Its position is ``multiplier * (position of the leader - reference) + offset``.
    """

    leader: Reference
    """The joint of the leader."""
    axis: int
    """The axis of that joint: 0 for ``<axis>``, 1 for ``<axis2>``."""
    multiplier: float
    offset: float
    reference: float = 0.0
    joint: int = -1
    """In a scene the index of that joint."""


class JointAxis(NamedTuple):
    """
    An axis of a joint.

    Its forces are in newtons if the joint slides, and torques in newton metres if it turns. They
    and the largest velocity are read together with shapes only.
    """

    xyz: tuple[float, float, float]
    """As written and not zero; in a scene a unit vector in the frame of the joint."""
    expressed_in: Reference = NO_REFERENCE
    """The frame that the vector is expressed in; empty for the frame of the joint."""
    lower: float = -math.inf
    """Lower limit of the position, in radians or metres."""
    upper: float = math.inf
    """Upper limit of the position, in radians or metres."""
    mimic: Mimic | None = None
    effort: float = math.inf
    """Largest force; not negative."""
    velocity: float = math.inf
    """Largest velocity, in metres or radians per second; not negative."""
    damping: float = 0.0
    """Force for a velocity of 1."""
    friction: float = 0.0
    """Force without a velocity."""


class JointDetails(NamedTuple):
    """Details of a joint."""

    type: str
    """As SDFormat spells it: ``revolute``, ``fixed``, ..."""
    parent: Reference
    child: Reference
    axes: tuple[JointAxis | None, JointAxis | None]
    """``<axis>`` and ``<axis2>``, if they are given."""
    screw_pitch_m: float
    """Movement of a screw joint along its axis in one turn; positive for a right-handed thread."""


def joint_details_from_element(
    xml: XmlElement, sources: Sources, *, reads_dynamics: bool,
) -> JointDetails:
    """
    Read a joint.

    :param reads_dynamics: whether to read effort, velocity, damping and friction.
    :return: its details. References are empty where they are missing or reserved.
    """
    joint_type = attribute_of(xml, 'type').lower()
    children = first_children(xml)
    parent, child = (
        _end(xml, tag, children.get(tag), joint_type, sources) for tag in ('parent', 'child'))
    axis, axis2 = (
        None if tag not in children else
        _axis(xml, children[tag], sources, reads_dynamics=reads_dynamics) for tag in AXIS_TAGS)
    return JointDetails(
        joint_type, parent, child, (axis, axis2),
        _screw_pitch_m(children) if _has_dof(joint_type, Motion.SCREW) else 0.0)


def check_children_of_joint(xml: XmlElement, sources: Sources, tags: Sequence[str]) -> None:
    """Check that a joint without a frame, such as one in a state, has its required children."""
    for tag in tags:
        if attribute_of(xml, 'type') != 'ball' and first_child(xml, tag) is None:
            sources.error(ElementMissingError, xml, f'the joint has no <{tag}>')


def _end(
    xml: XmlElement, tag: str, element: XmlElement | None, joint_type: str, sources: Sources,
) -> Reference:
    if element is None and joint_type == 'ball':
        return Reference(DEFAULT_END)
    if element is None:
        msg = f'the joint has no <{tag}>; it must name a frame'
        sources.error(ElementMissingError, xml, msg)
        return NO_REFERENCE
    name = value_of(element)
    if name == ROOT_FRAME:
        msg = f'"{name}" is reserved; it cannot be the {tag} of a joint'
        sources.error(ReservedNameError, element, msg)
        name = ''
    return Reference(name, sources.line(element))


def _axis(
    joint: XmlElement, axis: XmlElement, sources: Sources, *, reads_dynamics: bool,
) -> JointAxis:
    children = first_children(axis)
    expressed_in = NO_REFERENCE
    xyz = children.get('xyz')
    if xyz is not None and xyz.keys():
        expressed_in = Reference(attribute_of(xyz, 'expressed_in'), sources.line(xyz))
    x, y, z = numbers_of(xyz, (0.0, 0.0, 1.0))
    lower = number_of_child(axis, 'limit/lower', -math.inf)
    upper = number_of_child(axis, 'limit/upper', math.inf)
    if lower > upper:
        msg = f'the lower limit {lower:g} is above the upper one, {upper:g}'
        sources.warning(children['limit'], msg)
    if any(map(_may_be_degrees, (lower, upper))) and _has_dof(
            attribute_of(joint, 'type').lower(), Motion.TURN):
        msg = (f'the limits {lower:g} to {upper:g} of joint "{attribute_of(joint, "name")}" are '
               'radians; they look like degrees')
        sources.warning(children['limit'], msg)
    mimic = _mimic(joint, axis, children.get('mimic'), sources)
    dynamics = _dynamics(axis) if reads_dynamics else ()
    return JointAxis((x, y, z), expressed_in, lower, upper, mimic, *dynamics)


def _has_dof(joint_type: str, motion: Motion) -> bool:
    return any(dof.motion is motion for dof in JOINT_TYPES.get(joint_type, ()))


def _may_be_degrees(limit: float) -> bool:
    """Return whether a limit is a whole number from four turns in radians to three in degrees."""
    return 8.0 * math.pi < abs(limit) <= 1080.0 and limit.is_integer()


def _dynamics(axis: XmlElement) -> Sequence[float]:
    largest = (number_of_child(axis, f'limit/{name}', math.inf) for name in ('effort', 'velocity'))
    # In older files, a limit below zero means no limit.
    effort, velocity = (math.inf if value < 0.0 else value for value in largest)
    return (
        effort, velocity, number_of_child(axis, 'dynamics/damping', 0.0),
        number_of_child(axis, 'dynamics/friction', 0.0))


def _mimic(
    joint: XmlElement, axis: XmlElement, xml: XmlElement | None, sources: Sources,
) -> Mimic | None:
    if xml is None:
        return None
    leader = attribute_of(xml, 'joint')
    leader_tag = attribute_of(xml, 'axis') or AXIS_TAGS[0]
    msg = ''
    if leader_tag not in AXIS_TAGS:
        msg = f'mimic axis="{leader_tag}" must be one of {", ".join(AXIS_TAGS)}'
    elif leader and (leader, leader_tag) == (attribute_of(joint, 'name'), axis.tag):
        msg = 'an axis cannot mimic itself'
    if msg:
        sources.error(MimicError, xml, msg)
        return None
    return Mimic(
        Reference(leader, sources.line(xml)), AXIS_TAGS.index(leader_tag),
        number_of_child(xml, 'multiplier', 1.0), number_of_child(xml, 'offset', 0.0),
        number_of_child(xml, 'reference', 0.0))


def _screw_pitch_m(children: Mapping[object, XmlElement]) -> float:
    """
    Return how far a screw joint moves in one turn.

    ``<thread_pitch>``, which older files have, is in radians per metre and positive for a
    left-handed thread.
    """
    if 'thread_pitch' in children and 'screw_thread_pitch' not in children:
        (rad_per_m,) = numbers_of(children['thread_pitch'], (1.0,))
        return -2.0 * math.pi / rad_per_m if rad_per_m else 0.0
    (pitch_m,) = numbers_of(children.get('screw_thread_pitch'), (1.0,))
    return pitch_m
