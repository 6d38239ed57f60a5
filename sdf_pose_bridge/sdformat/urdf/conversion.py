# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Convert URDF to SDFormat: in an include as libsdformat does, otherwise as ROS reads it.

In an include, a robot has the poses of Gazebo. The child link of a fixed joint is lumped into its
parent link: its content moves there, and two frames with the names of the joint and of the link
remain. A link without a mass is left out. ``<gazebo>`` elements contain SDFormat for the link or
joint that they refer to, or for the model. Source: libsdformat's ``parser_urdf.cc``.

A file that is not included keeps its tree: every link stays a link, below the parent of its joint,
and a joint may have the name of a link. Of ``<gazebo>`` elements, only children of links and
joints are added.

Materials, and values that only physics needs, are not converted.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain
import math
from typing import NamedTuple

from lxml import etree

from sdf_pose_bridge.errors import RelativeToError
from sdf_pose_bridge.geometry.poses import Pose, pose_product
from sdf_pose_bridge.names import WORLD_FRAME
from sdf_pose_bridge.sdformat.inertials import Inertial as SdfInertial
from sdf_pose_bridge.sdformat.inertials import MOMENTS, warn_of_inertial
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.specification import JOINT_TYPES, URDF_JOINT_TYPES
from sdf_pose_bridge.sdformat.urdf.element_writer import ElementWriter
from sdf_pose_bridge.sdformat.urdf.lumping import lumped_inertial
from sdf_pose_bridge.sdformat.urdf.robot import (
    gazebo_elements_of,
    Inertial,
    Joint,
    Link,
    Robot,
    robot_from_tree,
    robot_with_different_names,
    SHAPES,
)
from sdf_pose_bridge.sdformat.urdf.values import (
    leading_numbers,
    numbers_of,
    pose_from_xyz_rpy,
    rpy_by_gz_math,
    rpy_by_urdfdom,
    text_from_numbers,
)
from sdf_pose_bridge.sdformat.xml_tree import (
    child_elements,
    first_child,
    text_of,
    WHITE_SPACE,
    written_tag,
    XmlElement,
)

_GAZEBO_TAGS = ('include', 'joint', 'link', 'model')
"""Children of ``<gazebo>`` for the model that would change the tree of a robot."""

_MOVED_TAGS = ('light', 'projector', 'sensor')
"""Children of ``<gazebo>`` whose poses change when their link is lumped."""

_LUMP_PREFIX = '_fixed_joint_lump__'


class ConvertedRobot(NamedTuple):
    """A URDF file as SDFormat."""

    root: XmlElement
    """The ``sdf`` element."""
    root_link: str
    """The name of the link without a parent."""


class _Base(NamedTuple):
    """The link that another one is lumped into; for other links, the link itself."""

    link: Link
    pose: Pose
    """Pose of the lumped link in it."""
    members: list[Link]
    """The link itself and those that are lumped into it."""


def sdf_from_urdf(root: XmlElement, sources: Sources, *, is_included: bool) -> ConvertedRobot:
    """
    Convert a file.

    :param root: the ``robot`` element; the children of ``<gazebo>`` elements are removed from it.
    :param sources: has the lines of its elements, and takes those of the new ones.
    :param is_included: whether to convert as libsdformat does, instead of reading as ROS does.
    :raises SdfError: if the file is not valid; its ``errors`` has all errors.
    """
    robot = robot_from_tree(root, sources)
    if not is_included:
        robot = robot_with_different_names(robot, sources)
    return ConvertedRobot(
        _Conversion(root, robot, sources, for_ros=not is_included).result(),
        robot.links_in_order[0].name)


class _Conversion:
    """Converts one file."""

    def __init__(
        self, root: XmlElement, robot: Robot, sources: Sources, *, for_ros: bool,
    ) -> None:
        self._for_ros = for_ros
        self._root = root
        self._robot = robot
        self._sources = sources
        self._write = ElementWriter(sources, for_ros=for_ros)
        # libsdformat reads the content of <gazebo> elements in this version.
        self._sdf = etree.Element('sdf', version='1.11')
        sources.set_parsed_line(self._sdf, root)
        self._model = self._write.add(self._sdf, 'model', root, name=robot.name)
        self._gazebo = gazebo_elements_of(root)
        self._links = robot.links_in_order
        self._bases: dict[str, _Base] = {}
        self._find_bases()
        self._inertials = {link.name: link.inertial for link in self._links}
        for link in reversed(self._links):
            self._lump_inertial(link)
        self._left_out = self._links_left_out()
        if for_ros:
            self._warn_of_inertials()
            self._keep_tree()

    def result(self) -> XmlElement:
        self._replace_lumped_ends_of_joints()
        self._add_links()
        static = self._gazebo.static
        if self._for_ros:
            # Its joints move. A model without links, as of the link "world" alone, has to be
            # static.
            static = None if first_child(self._model, 'link') is not None else 'true'
        if static is not None:
            self._write.add(self._model, 'static', self._root, text=static)
        self._add_extensions(self._model, '')
        self._add_frames()
        self._add_robot_origin()
        self._report_unused_extensions()
        return self._sdf

    # Reading

    def _is_reducible(self, joint: Joint) -> bool:
        return joint.type == 'fixed' and joint.name not in self._gazebo.kept_joints

    def _find_bases(self) -> None:
        for link in self._links:
            joint = self._robot.parent_joints.get(link.name)
            if joint is None or joint.parent == WORLD_FRAME or not self._is_reducible(joint):
                base = _Base(link, Pose(), [])
            else:
                base = self._bases[joint.parent]
                base = base._replace(pose=pose_product(base.pose, joint.origin))
            base.members.append(link)
            self._bases[link.name] = base

    def _is_lumped(self, link: Link) -> bool:
        return self._bases[link.name].link is not link

    def _lump_inertial(self, link: Link) -> None:
        """Add the mass of a lumped link to the mass of its parent."""
        inertial = self._inertials[link.name]
        if inertial is None or not self._is_lumped(link):
            return
        joint = self._robot.parent_joints[link.name]
        old = self._inertials[joint.parent] or Inertial()
        joint_pose = pose_from_xyz_rpy(joint.origin[:3], rpy_by_urdfdom(joint.origin))
        if self._for_ros and not old.mass + inertial.mass:
            return
        self._inertials[joint.parent] = lumped_inertial(
            old, inertial._replace(origin=pose_product(joint_pose, inertial.origin)))

    def _links_left_out(self) -> set[str]:
        """Return the links that Gazebo leaves out, with a warning about each that has no mass."""
        left_out = set()
        for link in self._links:
            joint = self._robot.parent_joints.get(link.name)
            inertial = self._inertials[link.name]
            if joint is not None and joint.parent in left_out:
                left_out.add(link.name)
            elif (inertial is None or inertial.mass <= 0.0) and link.name != WORLD_FRAME and not (
                    joint is not None and self._is_reducible(joint)):
                left_out.add(link.name)
                self._sources.warning(
                    link.xml, f'link "{link.name}" has no mass, so Gazebo leaves it out with all '
                    f'links and joints below it{"" if self._for_ros else "; here, too"}',
                    'LINK_INERTIA_INVALID', is_for_gazebo=self._for_ros)
        return left_out

    def _warn_of_inertials(self) -> None:
        """Warn of inertials that Gazebo rejects; included robots are read later."""
        for link in self._links:
            inertial = self._inertials[link.name]
            if inertial is not None and inertial.mass > 0.0 and not (
                    self._is_lumped(link) or link.name in self._left_out
                    or SdfInertial(inertial.mass, inertial.moments).is_valid):
                warn_of_inertial(link.xml, link.name, self._sources, is_for_gazebo=True)

    def _keep_tree(self) -> None:
        """Lump no links, and leave out elements that would change the tree of the robot."""
        self._bases = {link.name: _Base(link, Pose(), [link]) for link in self._links}
        self._inertials = {link.name: link.inertial for link in self._links}
        kept = []
        for xml in self._gazebo.extensions.pop('', ()):
            if xml.tag in _GAZEBO_TAGS:
                self._sources.warning(
                    xml, f'<{written_tag(xml)}> is for Gazebo alone, as ROS has only the tree of '
                    'the robot', is_for_gazebo=True)
            else:
                kept.append(xml)
        self._gazebo.extensions[''] = kept

    # Writing

    def _add_links(self) -> None:
        for link in self._links:
            name = link.name
            joint = self._robot.parent_joints.get(name)
            inertial = self._inertials[name]
            is_massless = inertial is None or inertial.mass <= 0.0
            is_kept = self._for_ros or not (is_massless or name in self._left_out)
            if is_kept and not self._is_lumped(link) and (
                    joint is not None or name != WORLD_FRAME):
                self._add_link(link, None if is_massless else inertial, joint)

    def _add_link(self, link: Link, inertial: Inertial | None, joint: Joint | None) -> None:
        is_joined = joint is not None and self._add_joint(joint)
        xml = self._write.add(self._model, 'link', link.xml, name=link.name)
        if joint is not None and is_joined:
            self._write.add(xml, 'pose', joint.xml, relative_to=joint.name)
        elif joint is not None:
            self._write.add_pose_in_link(xml, joint.xml, joint.origin, joint.parent)
        if inertial is not None:
            inertial_xml = self._write.add(xml, 'inertial', link.xml)
            self._write.add_pose(inertial_xml, link.xml, inertial.origin, rpy_by_gz_math)
            self._write.add_numbers(inertial_xml, link.xml, {'mass': [inertial.mass]})
            if not self._for_ros:
                self._write.add_numbers(
                    self._write.add(inertial_xml, 'inertia', link.xml), link.xml,
                    {name: [moment] for name, moment in zip(
                        MOMENTS, inertial.moments, strict=True)})
        members = self._bases[link.name].members
        for tag in ('collision', 'visual'):
            self._add_shapes(xml, tag, link, members)
        for member in members:
            for child in self._gazebo.extensions.get(member.name, ()):
                self._move_extension(child, member)
            self._add_extensions(xml, member.name)

    def _add_shapes(self, xml: XmlElement, tag: str, link: Link, members: Sequence[Link]) -> None:
        index = 0
        for member in members:
            for shape in member.shapes[tag]:
                name = f'{shape.name or member.name}_{tag}{f"_{index}" if index else ""}'
                if not name.startswith(link.name):
                    name = f'{link.name}{_LUMP_PREFIX}{name}'
                index += 1
                element = self._write.add(xml, tag, shape.geometry, name=name)
                pose = pose_product(self._bases[member.name].pose, shape.origin)
                self._write.add_pose(element, shape.geometry, pose, rpy_by_urdfdom)
                self._add_geometry(element, shape.geometry)

    def _add_geometry(self, xml: XmlElement, geometry: XmlElement) -> None:
        shape = self._write.add(
            self._write.add(xml, 'geometry', geometry), str(geometry.tag), geometry)
        if shape.tag == 'mesh':
            # Gazebo reads package:// as model://. Here meshes of packages are found in both ways.
            self._write.add(shape, 'uri', geometry, text=geometry.get('filename', ''))
        self._write.add_numbers(shape, geometry, numbers_of(geometry, SHAPES[str(shape.tag)]))

    def _add_joint(self, joint: Joint) -> bool:
        joint_type = URDF_JOINT_TYPES[joint.type].sdformat
        if not joint_type:
            msg = f'joint "{joint.name}" is {joint.type}, which SDFormat does not have'
            if not self._for_ros:
                msg += f', so link "{joint.child}" has no place'
                self._sources.error(RelativeToError, joint.xml, msg)
                return False
            if joint.type == 'floating':
                self._sources.warning(
                    joint.xml, f'joint "{joint.name}" is floating; somebody else has to publish '
                    f'where link "{joint.child}" is')
                return False
            self._sources.warning(joint.xml, f'{msg}; it is fixed here')
            joint_type = 'fixed'
        elif (joint.type == 'fixed' and joint.name in self._gazebo.revolute_joints
                and not self._for_ros):
            joint_type = 'revolute'
        base = self._bases[joint.parent]
        parent = base.link.name
        xml = self._write.add(self._model, 'joint', joint.xml, name=joint.name, type=joint_type)
        self._write.add_pose_in_link(
            xml, joint.xml, pose_product(base.pose, joint.origin), parent)
        self._write.add(xml, 'parent', joint.xml, text=parent)
        self._write.add(xml, 'child', joint.xml, text=joint.child)
        if JOINT_TYPES[joint_type]:
            self._add_axis(xml, joint)
        elif joint.name in self._gazebo.kept_joints and not self._for_ros:
            # Other joints may mimic it, as libsdformat gives it the axis of a default.
            self._write.add(xml, 'axis', joint.xml)
        self._add_extensions(xml, joint.name)
        return True

    def _add_axis(self, xml: XmlElement, joint: Joint) -> None:
        axis = self._write.add_axis(xml, joint)
        mimic = first_child(joint.xml, 'mimic')
        if mimic is not None and 'mimic' in joint.values and joint.type != 'fixed':
            name = mimic.get('joint', '')
            leader = self._robot.joint_names.get(name)
            if leader is None and self._for_ros:
                msg = f'the mimic is left out: there is no joint "{name}"'
                self._sources.warning(mimic, msg)
                return
            self._write.add_numbers(
                self._write.add(axis, 'mimic', mimic, joint=leader or name), mimic,
                {'multiplier': [1.0], 'offset': [0.0], **joint.values['mimic']})

    def _add_frames(self) -> None:
        for name, (base, *_) in self._bases.items():
            if base.name != name:
                joint = self._robot.parent_joints[name]
                frame = self._write.add(
                    self._model, 'frame', joint.xml, name=joint.name, attached_to=joint.parent)
                self._write.add_pose(frame, joint.xml, joint.origin, rpy_by_gz_math)
                self._write.add(
                    self._model, 'frame', self._robot.links[name].xml, name=name,
                    attached_to=joint.name)

    def _add_robot_origin(self) -> None:
        origin = first_child(self._root, 'origin')
        if origin is None:
            return
        pose = first_child(self._model, 'pose')
        if pose is not None:
            self._model.remove(pose)
        self._write.add_pose(self._model, origin, self._robot.origin, rpy_by_urdfdom)

    # Content of <gazebo> elements

    def _add_extensions(self, xml: XmlElement, reference: str) -> None:
        for child in self._gazebo.extensions.pop(reference, ()):
            child.tail = None
            xml.append(child)

    def _move_extension(self, xml: XmlElement, link: Link) -> None:
        """Change the pose of an element of a lumped link."""
        pose = first_child(xml, 'pose')
        if xml.tag not in _MOVED_TAGS or not self._is_lumped(link) or (
                pose is not None and pose.get('relative_to') is not None):
            return
        if pose is None:
            pose = self._write.add(xml, 'pose', xml)
        elif pose.keys():
            self._sources.warning(
                pose, 'the attributes of this <pose> are ignored, as libsdformat ignores them '
                'where a fixed joint is removed')
            pose.attrib.clear()
        numbers = list(leading_numbers(text_of(pose) or '0 0 0 0 0 0', 6))
        name = link.name
        while self._bases[name].link.name != name:
            if len(numbers) != 6 or not all(map(math.isfinite, numbers)):
                return
            joint = self._robot.parent_joints[name]
            moved = pose_product(joint.origin, pose_from_xyz_rpy(numbers[:3], numbers[3:]))
            # libsdformat writes six digits at each step.
            pose.text = text_from_numbers([*moved[:3], *rpy_by_urdfdom(moved)], 6)
            numbers = list(map(float, pose.text.split()))
            name = joint.parent

    def _replace_lumped_ends_of_joints(self) -> None:
        for joint in chain.from_iterable(self._gazebo.extensions.values()):
            for end in child_elements(joint, 'parent', 'child') if joint.tag == 'joint' else ():
                base = self._bases.get(text_of(end).strip(WHITE_SPACE))
                if base is not None:
                    end.text = base.link.name

    def _report_unused_extensions(self) -> None:
        for reference, children in self._gazebo.extensions.items():
            self._sources.warning(
                children[0], f'the content of <gazebo reference="{reference}"> is left out: the '
                'converted model has no link or joint of that name', is_for_gazebo=self._for_ros)
