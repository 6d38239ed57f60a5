# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read the robot of a URDF file: links, joints and the content of ``<gazebo>`` elements.

Values that poses do not need are not read.

Files are accepted as by urdfdom, the parser of libsdformat: a joint with a fault is an
error, but in a link the parser stops at the fault and keeps the part that it has read.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from itertools import count
from typing import NamedTuple

from sdf_pose_bridge.errors import DuplicateNameError, ElementInvalidError, ParsingError
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.names import JOINT_SUFFIX
from sdf_pose_bridge.sdformat.inertials import MOMENTS
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.specification import URDF_JOINT_TYPES
from sdf_pose_bridge.sdformat.urdf.values import (
    is_true,
    NotFiniteError,
    numbers_of,
    pose_from_xyz_rpy,
)
from sdf_pose_bridge.sdformat.xml_tree import child_elements, first_child, written_tag, XmlElement

_JOINT_PARTS = {
    'axis': 'xyz:3',
    'limit': 'lower upper effort! velocity!',
    'dynamics': 'damping friction',
    'mimic': 'multiplier offset',
    'safety_controller': 'k_velocity! soft_lower_limit soft_upper_limit k_position',
    'calibration': 'rising falling',
}
"""Elements in a joint, and their attributes that are numbers; see :func:`numbers_of`."""

SHAPES = {
    'box': 'size:3!', 'cylinder': 'length! radius!', 'mesh': 'scale:3', 'sphere': 'radius!'}
"""Shapes, and their attributes that are numbers."""

_INERTIA = ' '.join(f'{name}!' for name in MOMENTS)

_SETTINGS = frozenset({
    'canonicalBody', 'cfmDamping', 'collision', 'dampingFactor', 'disableFixedJointLumping',
    'fdir1', 'fudgeFactor', 'implicitSpringDamper', 'kd', 'kp', 'laserRetro', 'material',
    'maxContacts', 'maxVel', 'minDepth', 'mu1', 'mu2', 'preserveFixedJoint', 'provideFeedback',
    'selfCollide', 'springReference', 'springStiffness', 'static', 'stopCfm', 'stopErp',
    'turnGravityOff', 'visual',
})
"""Children of ``<gazebo>`` that are not SDFormat."""


class Inertial(NamedTuple):
    """Mass, center of mass and moments of inertia of a link."""

    mass: float = 0.0
    origin: Pose = Pose()
    """The inertial frame in the link."""
    moments: tuple[float, ...] = (0.0,) * len(MOMENTS)
    """Those of ``MOMENTS`` in that frame."""


class Shape(NamedTuple):
    """A visual or a collision."""

    name: str
    """Its name as written; empty if it has none."""
    origin: Pose
    """Its pose in its link."""
    geometry: XmlElement
    """The shape, such as ``<box>``."""


class Link(NamedTuple):
    """A link."""

    xml: XmlElement
    name: str
    inertial: Inertial | None
    shapes: Mapping[str, Sequence[Shape]]
    """By ``visual`` and ``collision``."""


class Joint(NamedTuple):
    """A joint; its frame is the frame of its child link."""

    xml: XmlElement
    name: str
    type: str
    origin: Pose
    """The joint in its parent link."""
    parent: str
    child: str
    values: Mapping[str, Mapping[str, Sequence[float]]]
    """The numbers of its ``axis``, ``limit`` and so on, by element and attribute."""


class Robot(NamedTuple):
    """A tree of links and joints."""

    name: str
    origin: Pose
    """Its pose in the file."""
    links: Mapping[str, Link]
    links_in_order: Sequence[Link]
    """The links in the tree, each before its children, which are in the order of their joints."""
    parent_joints: Mapping[str, Joint]
    """By the name of the child link, ordered by their own names."""
    joint_names: Mapping[str, str]
    """The name of each joint by its name in the file."""


class GazeboElements(NamedTuple):
    """The content of the ``<gazebo>`` elements of a robot."""

    static: str | None
    """The text of ``<static>`` of the model; None if there is none."""
    kept_joints: Set[str]
    """Names of fixed joints that remain joints."""
    revolute_joints: Set[str]
    """The kept joints that become revolute joints."""
    extensions: dict[str, list[XmlElement]]
    """Elements of SDFormat by the name of their link or joint; the name is empty for the model."""


def robot_from_tree(root: XmlElement, sources: Sources) -> Robot:
    """
    Read a robot from the ``robot`` element.

    :raises SdfError: if it is not valid; its ``errors`` has all errors.
    """
    return _RobotReader(root, sources).robot()


class _RobotReader:
    """Reads one file; collects its errors."""

    def __init__(self, root: XmlElement, sources: Sources) -> None:
        self._root = root
        self._sources = sources
        self._errors = sources.with_own_problems()

    def robot(self) -> Robot:
        if self._root.get('name') is None:
            self._errors.error(ParsingError, self._root, 'the robot has no name')
        self._check_names('material')
        links = {name: self._link(xml) for name, xml in self._check_names('link')}
        if not links:
            self._errors.error(ParsingError, self._root, 'the robot has no <link>')
        joints = [self._joint(name, xml, links) for name, xml in self._check_names('joint')]
        origin = self._robot_origin()
        self._errors.problems.raise_errors()
        parent_joints: dict[str, Joint] = {}
        child_joints: dict[str, list[Joint]] = {}
        for joint in sorted(filter(None, joints), key=lambda joint: joint.name.encode()):
            if joint.child in parent_joints:
                other = parent_joints[joint.child].name
                self._errors.error(
                    DuplicateNameError, joint.xml,
                    f'link "{joint.child}" is already the child of joint "{other}"')
            parent_joints[joint.child] = joint
            child_joints.setdefault(joint.parent, []).append(joint)
        roots = [link for name, link in links.items() if name not in parent_joints]
        if len(roots) != 1:
            shown = ', '.join(f'"{link.name}"' for link in roots[:10])
            self._errors.error(
                ParsingError, self._root, 'the links must be one tree, in which one link has no '
                f'parent; here these have none: {shown or "no link"}')
        self._errors.problems.raise_errors()
        in_order: dict[str, Link] = {}
        names = [roots[0].name]
        while names:
            name = names.pop()
            in_order[name] = links[name]
            names += [joint.child for joint in reversed(child_joints.get(name, ()))]
        for name, link in links.items():
            if name not in in_order:
                self._sources.warning(
                    link.xml, f'link "{name}" is left out: its joints form a cycle')
        return Robot(
            self._root.get('name', ''), origin, links, list(in_order.values()), parent_joints,
            {joint.name: joint.name for joint in parent_joints.values()})

    def _check_names(self, tag: str) -> list[tuple[str, XmlElement]]:
        named: dict[str, XmlElement] = {}
        for xml in child_elements(self._root, tag):
            name = xml.get('name')
            if name is None:
                self._errors.error(ParsingError, xml, f'the {tag} has no name')
            elif name in named:
                self._errors.error(ParsingError, xml, f'there is another {tag} named "{name}"')
            else:
                named[name] = xml
        return list(named.items())

    def _robot_origin(self) -> Pose:
        numbers: dict[str, list[float]] = {}
        origin = first_child(self._root, 'origin')
        if origin is None:
            return Pose()
        for attribute in ('xyz:3', 'rpy:3'):
            try:
                numbers.update(numbers_of(origin, attribute))
            except NotFiniteError as error:
                self._errors.error(ElementInvalidError, origin, str(error))
            except ValueError as error:
                self._sources.warning(origin, f'{error}; libsdformat takes zeros for it')
        return pose_from_xyz_rpy(**numbers)

    def _link(self, xml: XmlElement) -> Link:
        inertial = None
        shapes: dict[str, list[Shape]] = {'visual': [], 'collision': []}
        try:
            inertial_xml = first_child(xml, 'inertial')
            if inertial_xml is not None:
                inertial = Inertial()
                inertial = Inertial(origin=_origin(inertial_xml))
                mass = numbers_of(_required_child(inertial_xml, 'mass'), 'value!')
                inertial = inertial._replace(mass=mass['value'][0])
                inertia = numbers_of(_required_child(inertial_xml, 'inertia'), _INERTIA)
                inertial = inertial._replace(
                    moments=tuple(inertia[name][0] for name in MOMENTS))
            for tag, shapes_of_tag in shapes.items():
                for shape in child_elements(xml, tag):
                    shapes_of_tag.append(_shape(shape))
        except NotFiniteError as error:
            self._errors.error(ElementInvalidError, xml, str(error))
        except ValueError as error:
            self._sources.warning(
                xml, f'link "{xml.get("name", "")}": {error}; libsdformat reads it no further')
        return Link(xml, xml.get('name', ''), inertial, shapes)

    def _joint(self, name: str, xml: XmlElement, links: Mapping[str, Link]) -> Joint | None:
        ends = {}
        for tag in ('parent', 'child'):
            end = first_child(xml, tag)
            link = '' if end is None else end.get('link', '')
            if link not in links:
                self._errors.error(
                    ParsingError, xml if end is None else end,
                    f'"{link}" is not a link' if link else f'the joint names no {tag} link')
            ends[tag] = link
        type_name = xml.get('type', '')
        joint_type = URDF_JOINT_TYPES.get(type_name)
        if joint_type is None:
            msg = f'type="{type_name}" of <joint> must be one of {", ".join(URDF_JOINT_TYPES)}'
            self._errors.error(ParsingError, xml, msg)
        elif joint_type.has_limit and first_child(xml, 'limit') is None:
            self._errors.error(ParsingError, xml, f'the {type_name} joint has no <limit>')
        values = {}
        try:
            for tag, attributes in _JOINT_PARTS.items():
                part = first_child(xml, tag)
                if part is None or (
                        tag == 'axis' and joint_type is not None and not joint_type.has_axis):
                    continue
                values[tag] = numbers_of(part, attributes)
                if tag == 'mimic' and part.get('joint') is None:
                    self._errors.error(ParsingError, part, 'the <mimic> names no joint')
                if tag == 'dynamics' and not values[tag]:
                    msg = 'the <dynamics> has neither damping nor friction'
                    self._errors.error(ParsingError, part, msg)
            return Joint(
                xml, name, type_name, _origin(xml), ends['parent'], ends['child'], values)
        except ValueError as error:
            is_finite = not isinstance(error, NotFiniteError)
            self._errors.error(
                ParsingError if is_finite else ElementInvalidError, xml, str(error))
            return None


def _required_child(xml: XmlElement, tag: str) -> XmlElement:
    child = first_child(xml, tag)
    if child is None:
        msg = f'<{written_tag(xml)}> has no <{tag}>'
        raise ValueError(msg)
    return child


def _origin(xml: XmlElement) -> Pose:
    origin = first_child(xml, 'origin')
    numbers = {} if origin is None else numbers_of(origin, 'xyz:3 rpy:3')
    return pose_from_xyz_rpy(**numbers)


def _shape(xml: XmlElement) -> Shape:
    origin = _origin(xml)
    geometry = next(child_elements(_required_child(xml, 'geometry')), None)
    if geometry is None or geometry.tag not in SHAPES:
        msg = f'the <geometry> of <{written_tag(xml)}> must hold one of {", ".join(SHAPES)}'
        raise ValueError(msg)
    numbers_of(geometry, SHAPES[str(geometry.tag)])
    if geometry.tag == 'mesh' and geometry.get('filename') is None:
        msg = '<mesh> has no filename'
        raise ValueError(msg)
    material = first_child(xml, 'material')
    if xml.tag == 'visual' and material is not None and material.get('name') is None:
        msg = '<material> has no name'
        raise ValueError(msg)
    return Shape(xml.get('name', ''), origin, geometry)


def robot_with_different_names(robot: Robot, sources: Sources) -> Robot:
    """
    Rename joints that have the name of a link, and a robot that has the name of either.

    Links keep their names, which robot_state_publisher gives to frames.
    Each new name gives a warning.
    """
    used = {*robot.links, *robot.joint_names}
    names = {name: name for name in robot.joint_names}
    for joint in robot.parent_joints.values():
        if joint.name in robot.links:
            names[joint.name] = _unused_name(f'{joint.name}{JOINT_SUFFIX}', used)
            sources.warning(
                joint.xml, f'the joint has the name of link "{joint.name}"; it is called '
                f'"{names[joint.name]}" here', is_for_gazebo=True)
    return robot._replace(
        name=_unused_name(f'{robot.name}_model', used) if robot.name in used else robot.name,
        joint_names=names,
        parent_joints={
            child: joint._replace(name=names[joint.name])
            for child, joint in robot.parent_joints.items()})


def _unused_name(name: str, used: set[str]) -> str:
    candidates = (f'{name}{number or ""}' for number in count())
    new_name = next(each for each in candidates if each not in used)
    used.add(new_name)
    return new_name


def gazebo_elements_of(root: XmlElement) -> GazeboElements:
    """Read all ``<gazebo>`` elements of a ``robot`` element."""
    static: str | None = None
    preserved: set[str] = set()
    revolute: set[str] = set()
    extensions: dict[str, list[XmlElement]] = {}
    for gazebo in child_elements(root, 'gazebo'):
        reference = gazebo.get('reference', '')
        for child in child_elements(gazebo):
            if child.tag not in _SETTINGS:
                extensions.setdefault(reference, []).append(child)
            elif child.tag == 'static' and not reference:
                static = str(is_true(child)).lower()
            elif child.tag == 'preserveFixedJoint' and is_true(child):
                preserved.add(reference)
            elif child.tag == 'disableFixedJointLumping' and is_true(child):
                revolute.add(reference)
    return GazeboElements(static, preserved | revolute, revolute - preserved, extensions)
