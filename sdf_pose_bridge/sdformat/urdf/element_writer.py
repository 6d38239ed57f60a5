# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Write elements of SDFormat with the lines of their URDF elements."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from lxml import etree

from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.names import MODEL_FRAME, WORLD_FRAME
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.specification import URDF_JOINT_TYPES
from sdf_pose_bridge.sdformat.urdf.robot import Joint
from sdf_pose_bridge.sdformat.urdf.values import rpy_by_gz_math, text_from_numbers
from sdf_pose_bridge.sdformat.xml_tree import XmlElement


class ElementWriter:
    """
    Adds elements to a tree.

    :param sources: takes the lines of the elements.
    :param for_ros: whether rotations keep all their digits, which libsdformat rounds.
    """

    def __init__(self, sources: Sources, *, for_ros: bool) -> None:
        self._sources = sources
        self._for_ros = for_ros

    def add(
        self, parent: XmlElement, tag: str, source: XmlElement, *, text: str | None = None,
        **attributes: str,
    ) -> XmlElement:
        """
        Add an element.

        :param source: the element of URDF that it comes from.
        :return: the new element.
        """
        element = etree.SubElement(parent, tag, attributes)
        element.text = text
        self._sources.set_parsed_line(element, source)
        return element

    def add_pose(
        self, xml: XmlElement, source: XmlElement, pose: Pose,
        rpy_from_pose: Callable[[Pose], Sequence[float]],
    ) -> XmlElement:
        """
        Add a ``<pose>`` to an element.

        :param rpy_from_pose: makes the angles that are written unless rotations keep all digits.
        """
        if self._for_ros:  # angles would lose digits near gimbal lock
            return self.add(
                xml, 'pose', source, text=text_from_numbers(pose, 17),
                rotation_format='quat_xyzw')
        text = text_from_numbers([*pose[:3], *rpy_from_pose(pose)])
        return self.add(xml, 'pose', source, text=text)

    def add_pose_in_link(
        self, xml: XmlElement, source: XmlElement, pose: Pose, link: str,
    ) -> None:
        """Add a ``<pose>`` relative to a link, or to the model for the link ``world``."""
        self.add_pose(xml, source, pose, rpy_by_gz_math).set(
            'relative_to', MODEL_FRAME if link == WORLD_FRAME else link)

    def add_numbers(
        self, xml: XmlElement, source: XmlElement, numbers: Mapping[str, Sequence[float]],
    ) -> None:
        """Add an element for each tag, with its numbers."""
        for tag, values in numbers.items():
            self.add(xml, tag, source, text=text_from_numbers(values))

    def add_axis(self, xml: XmlElement, joint: Joint) -> XmlElement:
        """
        Add the ``<axis>`` of a joint, with its limits and its damping.

        :param xml: the joint in SDFormat.
        :return: the new element.
        """
        values = {tag: dict(part) for tag, part in joint.values.items()}
        xyz = values.get('axis', {'xyz': [1.0, 0.0, 0.0]}).get('xyz', [0.0, 0.0, 0.0])
        limit = values.get('limit', {})
        if joint.type == 'fixed':
            # It has the axis of SDFormat, as URDF gives it none.
            xyz, values, limit = [0.0, 0.0, 1.0], {}, {'lower': [0.0], 'upper': [0.0]}
        elif 'limit' in values:
            ends = sorted((*limit.pop('lower', [0.0]), *limit.pop('upper', [0.0])))
            if URDF_JOINT_TYPES[joint.type].has_limit:
                limit.update({'lower': ends[:1], 'upper': ends[1:]})
        axis = self.add(xml, 'axis', joint.xml)
        self.add_numbers(axis, joint.xml, {'xyz': xyz})
        self.add_numbers(self.add(axis, 'limit', joint.xml), joint.xml, limit)
        if 'dynamics' in values:
            dynamics = self.add(axis, 'dynamics', joint.xml)
            self.add_numbers(dynamics, joint.xml, values['dynamics'])
        return axis
