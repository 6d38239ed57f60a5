# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read the robot of a URDF file: links, joints and the content of ``<gazebo>`` elements.

Values that poses do not need are not read.

Files are accepted as by urdfdom, the parser of ROS and libsdformat: a joint with a fault is an
error, but in a link the parser stops at the fault and keeps the part that it has read.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
import math
from typing import NamedTuple

from sdf_pose_bridge.errors import DuplicateNameError, ElementInvalidError, ParsingError
from sdf_pose_bridge.geometry.poses import distance_and_angle, OPTICAL_POSE, Pose
from sdf_pose_bridge.geometry.units import LARGEST_ANGLE_RAD
from sdf_pose_bridge.names import JOINT_SUFFIX, unused_name
from sdf_pose_bridge.printed_text import shortened
from sdf_pose_bridge.sdformat.grammar import definition_of, Item
from sdf_pose_bridge.sdformat.inertials import MOMENTS
from sdf_pose_bridge.sdformat.source_formats import SourceFormat
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.specification import URDF_JOINT_TYPES
from sdf_pose_bridge.sdformat.undefined import UndefinedReporter
from sdf_pose_bridge.sdformat.urdf.values import (
    is_true,
    Numbers,
    numbers_of_attributes,
    pose_from_xyz_rpy,
    text_from_numbers,
)
from sdf_pose_bridge.sdformat.values import number_from_word
from sdf_pose_bridge.sdformat.xml_tree import child_elements, first_child, written_tag, XmlElement

_SHAPES = ('box', 'cylinder', 'mesh', 'sphere')
_SETTINGS = frozenset({
    'canonicalBody', 'cfmDamping', 'collision', 'dampingFactor', 'disableFixedJointLumping',
    'fdir1', 'fudgeFactor', 'implicitSpringDamper', 'kd', 'kp', 'laserRetro', 'material',
    'maxContacts', 'maxVel', 'minDepth', 'mu1', 'mu2', 'preserveFixedJoint', 'provideFeedback',
    'selfCollide', 'springReference', 'springStiffness', 'static', 'stopCfm', 'stopErp',
    'turnGravityOff', 'visual',
})
"""Children of ``<gazebo>`` that are not SDFormat."""

_OPTICAL_TOLERANCE = 2e-3
"""Largest difference of an optical frame from ``OPTICAL_POSE``, as files round right angles."""


class RobotInertial(NamedTuple):
    """Mass, center of mass and moments of inertia of a link."""

    mass: float = 0.0
    origin: Pose = Pose()
    """The inertial frame in the link."""
    moments: tuple[float, ...] = (0.0,) * len(MOMENTS)
    """Those of ``MOMENTS`` in that frame."""


class RobotShape(NamedTuple):
    """A visual or a collision."""

    xml: XmlElement
    origin: Pose
    """Its pose in its link."""
    geometry: XmlElement
    """The shape, such as ``<box>``."""
    numbers: Numbers
    """Its dimensions."""


class RobotLink(NamedTuple):
    """A link."""

    xml: XmlElement
    name: str
    inertial: RobotInertial | None
    shapes: Sequence[RobotShape]


class RobotJoint(NamedTuple):
    """A joint; its frame is the frame of its child link."""

    xml: XmlElement
    name: str
    """Its name in SDFormat, which may differ from the one in the file."""
    type: str
    origin: Pose
    """The joint in its parent link."""
    parent: str
    child: str
    values: Mapping[str, Numbers]
    """The numbers of its ``axis``, ``limit`` and so on, by element and attribute."""


class Robot(NamedTuple):
    """A tree of links and joints."""

    name: str
    origin: Pose
    """Its pose in the file."""
    links: Sequence[RobotLink]
    """The links in the tree, each before its children, which are in the order of their joints."""
    parent_joints: Mapping[str, RobotJoint]
    """By the name of the child link, ordered by their own names in the file."""
    static: str | None
    """The text of ``<static>`` of the model in ``<gazebo>``; None if there is none."""
    kept_joints: Mapping[str, str]
    """Names of fixed joints that remain joints for Gazebo, and the types that they get."""
    extensions: Mapping[str, list[XmlElement]]
    """The elements of SDFormat in ``<gazebo>`` by the name of their link or joint; the name is
    empty for the model."""

    def joints_to_move(self, name: str) -> Sequence[RobotJoint]:
        """
        Find the joints that can move a link or a joint; for an optical frame first its camera's.

        :param name: the name of the link, or of the joint in SDFormat.
        """
        joint = self.parent_joints.get(name) or next(
            (each for each in self.parent_joints.values() if each.name == name), None)
        found: list[RobotJoint] = []
        while joint is not None and (not found or joint.type == 'fixed'):
            found.insert(0, joint)
            is_optical = joint.type == 'fixed' and max(
                distance_and_angle(joint.origin, OPTICAL_POSE)) < _OPTICAL_TOLERANCE
            joint = self.parent_joints.get(joint.parent) if is_optical else None
        return found


def robot_from_tree(root: XmlElement, sources: Sources, *, is_included: bool) -> Robot:
    """
    Read a robot from the ``robot`` element.

    :param is_included: whether to keep the names of joints and of the robot. Otherwise those that
        are the name of a link change, each with a warning.
    :raises SdfError: if it is not valid; its ``errors`` has all errors.
    """
    UndefinedReporter(sources, SourceFormat.URDF).report_tree(root, definition_of('robot'))
    errors = sources.with_own_problems()
    if root.get('name') is None:
        errors.error(ParsingError, root, 'the robot has no name')
    _named_children(root, 'material', errors)
    links = {
        name: _link(name, xml, sources)
        for name, xml in _named_children(root, 'link', errors).items()}
    if not links:
        errors.error(ParsingError, root, 'the robot has no <link>')
    joints = [
        _joint(name, xml, links, sources, errors)
        for name, xml in _named_children(root, 'joint', errors).items()]
    origin = _robot_origin(root, sources, errors)
    errors.problems.raise_errors()
    parent_joints: dict[str, RobotJoint] = {}
    children: dict[str, list[str]] = {}
    for joint in sorted(joints, key=lambda joint: joint.name.encode()):
        if joint.child in parent_joints:
            other = parent_joints[joint.child].name
            errors.error(
                DuplicateNameError, joint.xml,
                f'link "{joint.child}" is already the child of joint "{other}"')
        parent_joints[joint.child] = joint
        children.setdefault(joint.parent, []).append(joint.child)
    names = [name for name in links if name not in parent_joints]
    if len(names) != 1:
        shown = ', '.join(f'"{name}"' for name in names[:10])
        errors.error(
            ParsingError, root, 'the links must be one tree, in which one link has no parent; '
            f'here these have none: {shown or "no link"}')
    errors.problems.raise_errors()
    in_order: dict[str, RobotLink] = {}
    while names:
        name = names.pop()
        in_order[name] = links[name]
        names += reversed(children.get(name, ()))
    for name, link in links.items():
        if name not in in_order:
            sources.warning(link.xml, f'link "{name}" is left out: its joints form a cycle')
    name = root.get('name', '')
    if not is_included:
        used = dict.fromkeys((*links, *(joint.name for joint in parent_joints.values())), 0)
        for child, joint in parent_joints.items():
            if joint.name in links:
                new_name = unused_name(f'{joint.name}{JOINT_SUFFIX}', used, '')
                sources.warning(
                    joint.xml, f'the joint has the name of link "{joint.name}"; it is called '
                    f'"{new_name}" here', is_for_gazebo=True)
                parent_joints[child] = joint._replace(name=new_name)
        if name in used:
            name = unused_name(f'{name}_model', used, '')
    return Robot(name, origin, list(in_order.values()), parent_joints, *_gazebo_elements_of(root))


def _gazebo_elements_of(
    root: XmlElement,
) -> tuple[str | None, dict[str, str], dict[str, list[XmlElement]]]:
    static = None
    kept_joints: dict[str, str] = {}
    extensions: dict[str, list[XmlElement]] = {}
    for gazebo in child_elements(root, 'gazebo'):
        reference = gazebo.get('reference', '')
        for child in child_elements(gazebo):
            if child.tag not in _SETTINGS:
                extensions.setdefault(reference, []).append(child)
            elif child.tag == 'static' and not reference:
                static = str(is_true(child)).lower()
            elif child.tag == 'preserveFixedJoint' and is_true(child):
                kept_joints[reference] = 'fixed'
            elif child.tag == 'disableFixedJointLumping' and is_true(child):
                kept_joints.setdefault(reference, 'revolute')
    return static, kept_joints, extensions


def _named_children(root: XmlElement, tag: str, errors: Sources) -> Mapping[str, XmlElement]:
    named: dict[str, XmlElement] = {}
    for xml in child_elements(root, tag):
        name = xml.get('name')
        if name is None:
            errors.error(ParsingError, xml, f'the {tag} has no name')
        elif named.setdefault(name, xml) is not xml:
            errors.error(ParsingError, xml, f'there is another {tag} named "{name}"')
    return named


def _robot_origin(root: XmlElement, sources: Sources, errors: Sources) -> Pose:
    """Return the pose of the robot, which urdfdom does not read."""
    numbers: dict[str, list[float]] = {}
    origin = first_child(root, 'origin')
    if origin is None:
        return Pose()
    for rule in _rules('urdf_origin'):
        try:
            numbers.update(numbers_of_attributes(origin, [rule]))
        except ValueError as error:
            words = [*filter(None, origin.get(rule.name, '').split(' '))]
            read = [number for word in words for number in number_from_word(word)]
            numbers[rule.name] = read = read if len(read) == len(words) == 3 else [0.0] * 3
            msg = f'{error}; Gazebo reads it as {text_from_numbers(read)}'
            if all(map(math.isfinite, read)):
                sources.warning(origin, msg)
            else:
                errors.error(ElementInvalidError, origin, msg)
    return _pose_of_origin(origin, numbers, sources)


def _link(name: str, xml: XmlElement, sources: Sources) -> RobotLink:
    inertial = None
    shapes: list[RobotShape] = []
    try:
        inertial_xml = first_child(xml, 'inertial')
        if inertial_xml is not None:
            inertial = RobotInertial()
            inertial = RobotInertial(origin=_origin(inertial_xml, sources))
            mass = numbers_of_attributes(
                _required_child(inertial_xml, 'mass'), _rules('urdf_mass'))
            inertial = inertial._replace(mass=mass['value'][0])
            inertia = numbers_of_attributes(
                _required_child(inertial_xml, 'inertia'), _rules('urdf_inertia'))
            inertial = inertial._replace(moments=tuple(inertia[name][0] for name in MOMENTS))
        for shape in (*child_elements(xml, 'visual'), *child_elements(xml, 'collision')):
            shapes.append(_shape(shape, sources))  # noqa: PERF401  # those before a fault are kept
    except ValueError as error:
        sources.warning(xml, f'link "{name}": {error}; ROS and Gazebo read it no further')
    return RobotLink(xml, name, inertial, shapes)


def _joint(
    name: str, xml: XmlElement, links: Mapping[str, RobotLink], sources: Sources, errors: Sources,
) -> RobotJoint:
    ends = []
    for tag in ('parent', 'child'):
        end = first_child(xml, tag)
        link = '' if end is None else end.get('link', '')
        if link not in links:
            errors.error(
                ParsingError, xml if end is None else end,
                f'"{link}" is not a link' if link else f'the joint names no {tag} link')
        ends.append(link)
    type_name = xml.get('type', '')
    joint_type = URDF_JOINT_TYPES.get(type_name)
    if joint_type is None:
        msg = f'type="{type_name}" of <joint> must be one of {", ".join(URDF_JOINT_TYPES)}'
        errors.error(ParsingError, xml, msg)
    elif joint_type.has_limit and first_child(xml, 'limit') is None:
        errors.error(ParsingError, xml, f'the {type_name} joint has no <limit>')
    values: dict[str, Numbers] = {}
    for each, definition in definition_of('urdf_joint').children.items():
        tag = str(each)
        part = first_child(xml, tag)
        if part is None or (tag == 'axis' and joint_type is not None and not joint_type.has_axis):
            continue
        try:
            values[tag] = numbers_of_attributes(part, definition.attributes.values())
        except ValueError as error:
            errors.error(ParsingError, part, str(error))
            continue
        if tag == 'dynamics' and not values[tag]:
            errors.error(ParsingError, part, 'the <dynamics> has neither damping nor friction')
    origin = _pose_of_origin(first_child(xml, 'origin'), values.get('origin', {}), sources)
    return RobotJoint(xml, name, type_name, origin, ends[0], ends[1], values)


def _rules(identifier: str) -> Iterable[Item]:
    """Return the rules of the grammar for the attributes of an element."""
    return definition_of(identifier).attributes.values()


def _required_child(xml: XmlElement, tag: str) -> XmlElement:
    child = first_child(xml, tag)
    if child is None:
        msg = f'<{written_tag(xml)}> has no <{tag}>'
        raise ValueError(msg)
    return child


def _origin(xml: XmlElement, sources: Sources) -> Pose:
    origin = first_child(xml, 'origin')
    numbers = {} if origin is None else numbers_of_attributes(origin, _rules('urdf_origin'))
    return _pose_of_origin(origin, numbers, sources)


def _pose_of_origin(origin: XmlElement | None, numbers: Numbers, sources: Sources) -> Pose:
    if origin is not None and any(
            abs(angle) > LARGEST_ANGLE_RAD for angle in numbers.get('rpy', ())):
        sources.warning(
            origin, f'the angles rpy="{shortened(origin.get("rpy", ""))}" of <origin> are '
            'radians; they look like degrees')
    return pose_from_xyz_rpy(**numbers)


def _shape(xml: XmlElement, sources: Sources) -> RobotShape:
    origin = _origin(xml, sources)
    geometry = next(child_elements(_required_child(xml, 'geometry')), None)
    if geometry is None or geometry.tag not in _SHAPES:
        msg = f'the <geometry> of <{written_tag(xml)}> must hold one of {", ".join(_SHAPES)}'
        raise ValueError(msg)
    numbers = numbers_of_attributes(geometry, _rules(f'urdf_{geometry.tag}'))
    material = first_child(xml, 'material')
    if xml.tag == 'visual' and material is not None and material.get('name') is None:
        msg = '<material> has no name'
        raise ValueError(msg)
    return RobotShape(xml, origin, geometry, numbers)
