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

from collections.abc import Callable, Sequence
from functools import cache
from itertools import chain
import math
from types import MappingProxyType

from lxml import etree

from sdf_pose_bridge.errors import RelativeToError
from sdf_pose_bridge.geometry.poses import Pose, pose_product
from sdf_pose_bridge.names import MODEL_FRAME, WORLD_FRAME
from sdf_pose_bridge.sdformat.inertials import Inertial, MOMENTS, warn_of_inertial
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.specification import JOINT_TYPES, URDF_JOINT_TYPES
from sdf_pose_bridge.sdformat.urdf.lumping import (
    Base,
    bases_of_links,
    is_reducible,
    lumped_inertials,
)
from sdf_pose_bridge.sdformat.urdf.robot import (
    Robot,
    robot_from_tree,
    RobotInertial,
    RobotJoint,
    RobotLink,
)
from sdf_pose_bridge.sdformat.urdf.values import (
    Numbers,
    pose_from_xyz_rpy,
    rpy_by_gz_math,
    rpy_by_urdfdom,
    text_from_numbers,
)
from sdf_pose_bridge.sdformat.values import number_from_word
from sdf_pose_bridge.sdformat.xml_tree import (
    child_elements,
    first_child,
    text_of,
    words_of,
    written_tag,
    XmlElement,
)

_GAZEBO_TAGS = ('include', 'joint', 'link', 'model')
"""Children of ``<gazebo>`` for the model that would change the tree of a robot."""

_MOVED_TAGS = ('light', 'projector', 'sensor')
"""Children of ``<gazebo>`` whose poses change when their link is lumped."""

_LUMP_PREFIX = '_fixed_joint_lump__'


def sdf_from_urdf(
    root: XmlElement, sources: Sources, *, is_included: bool,
) -> tuple[XmlElement, str]:
    """
    Convert a file.

    :param root: the ``robot`` element; the children of ``<gazebo>`` elements are removed from it.
    :param is_included: whether to convert as libsdformat does, instead of reading as ROS does.
    :return: the ``sdf`` element, and the name of the link without a parent.
    :raises SdfError: if the file is not valid; its ``errors`` has all errors.
    """
    robot = robot_from_tree(root, sources, is_included=is_included)
    conversion = _Conversion(root, robot, sources, for_ros=not is_included)
    return conversion.result(), robot.links[0].name


class _Conversion:

    def __init__(self, root: XmlElement, robot: Robot, sources: Sources, *, for_ros: bool) -> None:
        self._for_ros = for_ros
        self._root = root
        self._robot = robot
        self._sources = sources
        # libsdformat reads the content of <gazebo> elements in this version.
        self._sdf = etree.Element('sdf', version='1.11')
        sources.set_parsed_line(self._sdf, root)
        self._joint_names = {
            joint.xml.get('name'): joint.name for joint in robot.parent_joints.values()}
        self._model = self._add(self._sdf, 'model', root, name=robot.name)
        self._extensions = dict(robot.extensions)
        # Most elements of a link have the same pose, which is moved along many links.
        self._pose_in_base = cache(self._pose_in_base)  # type: ignore[method-assign]
        self._bases = bases_of_links(robot)
        self._inertials = lumped_inertials(robot, self._bases, skips_massless=for_ros)
        self._leave_out_content_of_lumped_joints()
        self._left_out = self._links_left_out()
        if for_ros:
            # Links are lumped only to find the warnings about Gazebo.
            self._bases = {link.name: Base(link, Pose(), [link]) for link in robot.links}
            self._inertials = {link.name: link.inertial for link in robot.links}
            self._leave_out_trees()

    def result(self) -> XmlElement:
        self._replace_lumped_ends_of_joints()
        self._add_links()
        static = self._robot.static
        if self._for_ros:
            # Its joints move. A model without links, as of the link "world" alone, has to be
            # static.
            static = None if first_child(self._model, 'link') is not None else 'true'
        if static is not None:
            self._add(self._model, 'static', self._root, static)
        self._add_extensions(self._model, '')
        self._add_frames()
        origin, pose = first_child(self._root, 'origin'), first_child(self._model, 'pose')
        if origin is not None:
            if pose is not None:
                self._model.remove(pose)
            self._add_pose(self._model, origin, self._robot.origin, rpy_by_urdfdom)
        for reference, children in self._extensions.items():
            self._sources.warning(
                children[0], f'the content of <gazebo reference="{reference}"> is left out: the '
                'converted model has no link or joint of that name', is_for_gazebo=self._for_ros)
        return self._sdf

    # What Gazebo leaves out

    def _leave_out_trees(self) -> None:
        children = self._extensions.get('', ())
        self._extensions[''] = [xml for xml in children if xml.tag not in _GAZEBO_TAGS]
        for xml in children:
            if xml.tag in _GAZEBO_TAGS:
                self._sources.warning(
                    xml, f'<{written_tag(xml)}> is for Gazebo alone, as ROS has only the tree of '
                    'the robot', is_for_gazebo=True)

    def _leave_out_content_of_lumped_joints(self) -> None:
        """Leave out what ``<gazebo>`` has for joints that Gazebo removes, or warn of it."""
        joints = {self._robot.parent_joints[link.name].name
                  for link in self._robot.links if self._is_lumped(link)}
        for name in joints.intersection(self._extensions) - self._bases.keys():
            child = self._extensions[name][0]
            if not self._for_ros:
                del self._extensions[name]
            self._sources.warning(child, (
                f'Gazebo leaves out <{written_tag(child)}>, as it removes the fixed joint '
                f'"{name}"; <preserveFixedJoint>true</preserveFixedJoint> in this <gazebo> '
                'keeps the joint'), is_for_gazebo=self._for_ros)

    def _is_lumped(self, link: RobotLink) -> bool:
        return self._bases[link.name].link is not link

    def _links_left_out(self) -> set[str]:
        """Return the links that Gazebo leaves out; warn of these, and of inertials it rejects."""
        left_out, robot = set(), self._robot
        for link in robot.links:
            joint = robot.parent_joints.get(link.name)
            inertial = self._inertials[link.name]
            if joint is not None and joint.parent in left_out:
                left_out.add(link.name)
            elif inertial is None or inertial.mass <= 0.0:
                if link.name != WORLD_FRAME and (joint is None or not is_reducible(joint, robot)):
                    left_out.add(link.name)
                    self._sources.warning(
                        link.xml, f'link "{link.name}" has no mass, so Gazebo leaves it out with '
                        f'all links and joints below it{"" if self._for_ros else "; here, too"}',
                        'LINK_INERTIA_INVALID', is_for_gazebo=self._for_ros)
            elif self._for_ros and inertial.mass > 0.0 and not (
                    self._is_lumped(link)
                    or Inertial(inertial.mass, inertial.moments).is_valid):
                # Those of an included robot are judged when it is read.
                warn_of_inertial(link.xml, link.name, self._sources, is_for_gazebo=True)
        return left_out

    # Writing

    def _add_links(self) -> None:
        for link in self._robot.links:
            name = link.name
            joint = self._robot.parent_joints.get(name)
            inertial = self._inertials[name]
            if inertial is not None and inertial.mass <= 0.0:
                inertial = None
            is_kept = self._for_ros or not (inertial is None or name in self._left_out)
            if not is_kept or self._is_lumped(link) or (joint is None and name == WORLD_FRAME):
                continue
            is_joined = joint is not None and self._add_joint(joint)
            xml = self._add(self._model, 'link', link.xml, name=name)
            if joint is not None and is_joined:
                self._add(xml, 'pose', joint.xml, relative_to=joint.name)
            elif joint is not None:
                self._add_pose_in_link(xml, joint.xml, joint.origin, joint.parent)
            if inertial is not None:
                self._add_inertial(xml, link, inertial)
            members = self._bases[name].members
            for tag in ('collision', 'visual'):
                self._add_shapes(xml, tag, link, members)
            for member in members:
                for child in self._extensions.get(member.name, ()):
                    self._move_extension(child, member)
                self._add_extensions(xml, member.name)

    def _add_inertial(
        self, link_xml: XmlElement, link: RobotLink, inertial: RobotInertial,
    ) -> None:
        xml = self._add(link_xml, 'inertial', link.xml)
        self._add_pose(xml, link.xml, inertial.origin, rpy_by_gz_math)
        self._add(xml, 'mass', link.xml, text_from_numbers([inertial.mass]))
        if not self._for_ros:
            self._add(xml, 'inertia', link.xml, numbers={
                name: [moment] for name, moment in zip(MOMENTS, inertial.moments, strict=True)})

    def _add_shapes(
        self, xml: XmlElement, tag: str, link: RobotLink, members: Sequence[RobotLink],
    ) -> None:
        shapes = [
            (member.name, shape) for member in members for shape in member.shapes
            if shape.xml.tag == tag]
        for index, (member, shape) in enumerate(shapes):
            geometry = shape.geometry
            name = f'{shape.xml.get("name") or member}_{tag}{f"_{index}" if index else ""}'
            if not name.startswith(link.name):
                name = f'{link.name}{_LUMP_PREFIX}{name}'
            element = self._add(xml, tag, geometry, name=name)
            pose = pose_product(self._bases[member].pose, shape.origin)
            self._add_pose(element, geometry, pose, rpy_by_urdfdom)
            new = self._add(
                self._add(element, 'geometry', geometry), str(geometry.tag), geometry,
                numbers=shape.numbers)
            if new.tag == 'mesh':
                # Gazebo reads package:// as model://. Here meshes of packages are found in both
                # ways.
                self._add(new, 'uri', geometry, geometry.get('filename', ''))

    def _add_joint(self, joint: RobotJoint) -> bool:
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
        elif joint.type == 'fixed' and not self._for_ros:
            joint_type = self._robot.kept_joints.get(joint.name, joint_type)
        base = self._bases[joint.parent]
        parent = base.link.name
        xml = self._add(self._model, 'joint', joint.xml, name=joint.name, type=joint_type)
        self._add_pose_in_link(xml, joint.xml, pose_product(base.pose, joint.origin), parent)
        self._add(xml, 'parent', joint.xml, parent)
        self._add(xml, 'child', joint.xml, joint.child)
        if JOINT_TYPES[joint_type]:
            self._add_axis(xml, joint)
        elif joint.name in self._robot.kept_joints and not self._for_ros:
            # Other joints may mimic it, because libsdformat gives it a default axis.
            self._add(xml, 'axis', joint.xml)
        self._add_extensions(xml, joint.name)
        return True

    def _add_axis(self, xml: XmlElement, joint: RobotJoint) -> None:
        # URDF gives a fixed joint no axis, so it gets the default of SDFormat.
        is_fixed = joint.type == 'fixed'
        values = {} if is_fixed else joint.values
        xyz = values.get('axis', {'xyz': [0.0, 0.0, 1.0] if is_fixed else [1.0, 0.0, 0.0]}).get(
            'xyz', [0.0, 0.0, 0.0])
        limit = dict(values.get('limit', {}))
        lower, upper = *limit.pop('lower', [0.0]), *limit.pop('upper', [0.0])
        if is_fixed or URDF_JOINT_TYPES[joint.type].has_limit:
            if lower > upper and not self._for_ros:
                msg = f'Gazebo swaps the lower and the upper limit of joint "{joint.name}"'
                self._sources.warning(joint.xml, msg)
                lower, upper = upper, lower
            limit.update(lower=[lower], upper=[upper])
        axis = self._add(xml, 'axis', joint.xml)
        self._add(axis, 'xyz', joint.xml, text_from_numbers(xyz))
        self._add(axis, 'limit', joint.xml, numbers=limit)
        if 'dynamics' in values:
            self._add(axis, 'dynamics', joint.xml, numbers=values['dynamics'])
        mimic = first_child(joint.xml, 'mimic')
        if mimic is None or 'mimic' not in values:
            return
        name = mimic.get('joint', '')
        leader = self._joint_names.get(name)
        if leader is None and self._for_ros:
            self._sources.warning(mimic, f'the mimic is left out: there is no joint "{name}"')
        else:
            self._add(
                axis, 'mimic', mimic, joint=leader or name,
                numbers={'multiplier': [1.0], 'offset': [0.0], **values['mimic']})

    def _add_frames(self) -> None:
        for link in self._robot.links:
            if self._is_lumped(link):
                joint = self._robot.parent_joints[link.name]
                frame = self._add(
                    self._model, 'frame', joint.xml, name=joint.name, attached_to=joint.parent)
                self._add_pose(frame, joint.xml, joint.origin, rpy_by_gz_math)
                self._add(self._model, 'frame', link.xml, name=link.name, attached_to=joint.name)

    def _add(
        self, parent: XmlElement, tag: str, source: XmlElement, text: str | None = None, *,
        numbers: Numbers = MappingProxyType({}), **attributes: str,
    ) -> XmlElement:
        """Add an element with the line of one of URDF, and child elements with numbers."""
        element = etree.SubElement(parent, tag, attributes)
        element.text = text
        self._sources.set_parsed_line(element, source)
        for name, values in numbers.items():
            self._add(element, name, source, text_from_numbers(values))
        return element

    def _add_pose(
        self, xml: XmlElement, source: XmlElement, pose: Pose,
        rpy_from_pose: Callable[[Pose], Sequence[float]],
    ) -> XmlElement:
        if self._for_ros:  # angles would lose digits near gimbal lock
            return self._add(
                xml, 'pose', source, text_from_numbers(pose, 17), rotation_format='quat_xyzw')
        return self._add(xml, 'pose', source, text_from_numbers([*pose[:3], *rpy_from_pose(pose)]))

    def _add_pose_in_link(
        self, xml: XmlElement, source: XmlElement, pose: Pose, link: str,
    ) -> None:
        self._add_pose(xml, source, pose, rpy_by_gz_math).set(
            'relative_to', MODEL_FRAME if link == WORLD_FRAME else link)

    # Content of <gazebo> elements

    def _add_extensions(self, xml: XmlElement, reference: str) -> None:
        for child in self._extensions.pop(reference, ()):
            xml.append(child)

    def _move_extension(self, xml: XmlElement, link: RobotLink) -> None:
        pose = first_child(xml, 'pose')
        if xml.tag not in _MOVED_TAGS or not self._is_lumped(link) or (
                pose is not None and pose.get('relative_to') is not None):
            return
        if pose is None:
            pose = self._add(xml, 'pose', xml)
        elif pose.keys():
            self._sources.warning(
                pose, 'the attributes of this <pose> are ignored, as libsdformat ignores them '
                'where a fixed joint is removed')
            pose.attrib.clear()
        words = words_of(text_of(pose) or '0 0 0 0 0 0')[:6]
        numbers = tuple(number for word in words for number in number_from_word(word))
        pose.text = self._pose_in_base(link.name, numbers) or pose.text

    def _pose_in_base(self, name: str, numbers: Sequence[float]) -> str:
        """Return a pose in a lumped link as one in the link that this is lumped into, or ''."""
        text = ''
        while self._bases[name].link.name != name and len(numbers) == 6 and (
                all(map(math.isfinite, numbers))):
            joint = self._robot.parent_joints[name]
            moved = pose_product(joint.origin, pose_from_xyz_rpy(numbers[:3], numbers[3:]))
            # libsdformat writes six digits at each step.
            text = text_from_numbers([*moved[:3], *rpy_by_urdfdom(moved)], 6)
            numbers = list(map(float, words_of(text)))
            name = joint.parent
        return text

    def _replace_lumped_ends_of_joints(self) -> None:
        for joint in chain.from_iterable(self._extensions.values()):
            for end in child_elements(joint, 'parent', 'child') if joint.tag == 'joint' else ():
                base = self._bases.get(text_of(end))
                if base is not None:
                    end.text = base.link.name
