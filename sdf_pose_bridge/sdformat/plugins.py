# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read plugins of Gazebo, and details of sensors. Source of names of plugins: gz-sim 8 to 10."""

from __future__ import annotations

import re
from typing import NamedTuple

from sdf_pose_bridge.sdformat.gazebo_topics import SENSOR_PATHS
from sdf_pose_bridge.sdformat.specification import CAMERA_TYPES
from sdf_pose_bridge.sdformat.xml_tree import (
    attribute_of,
    child_elements,
    first_child,
    value_at,
    value_of,
    XmlElement,
)

_CLASS = re.compile(r'(?:gz::sim|ignition::gazebo)::systems::(\w+)')
_LIBRARY = re.compile(r'(?:lib)?(?:gz-sim|ignition-gazebo)\d*-(.+)-system(?:\.so)?')


class Plugin(NamedTuple):
    """A ``<plugin>``; the content is not SDFormat, and has a meaning for its class only."""

    filename: str
    """The library, as written."""
    name: str
    """The name of its class, as written; empty for the first class of the library."""
    parameters: tuple[tuple[str, str], ...]
    """The tag and the value of each child element, in the order of the file."""

    @property
    def system(self) -> str:
        """The class without its name space, such as ``DiffDrive``; empty if it is not Gazebo's."""
        if found := _CLASS.fullmatch(self.name):
            return found[1]
        found = _LIBRARY.fullmatch(self.filename)
        return ''.join(map(str.capitalize, found[1].split('-'))) if found else ''


def plugins_of(xml: XmlElement) -> tuple[Plugin, ...]:
    """Return the plugins of an element."""
    return tuple(
        Plugin(
            attribute_of(plugin, 'filename'), attribute_of(plugin, 'name'),
            tuple((str(each.tag), value_of(each)) for each in child_elements(plugin)))
        for plugin in child_elements(xml, 'plugin'))


class SensorDetails(NamedTuple):
    """Details of a sensor."""

    type: str
    """As written: ``camera``, ``gpu_lidar``, ..."""
    frame_id: str
    """The frame id of Gazebo's messages from gz-sensors 9 on if the file sets it; else empty."""
    older_frame_id: str
    """That of gz-sensors 8, of Harmonic."""
    is_camera: bool
    """Whether it has an optical frame."""
    optical_frame_id: str
    """The id of the optical frame if the file sets it; else empty."""
    topics: tuple[tuple[str, str], ...] = ()
    """The path and the value of each element on which its topics depend, such as ``topic``; none
    unless plugins were requested."""


def sensor_details_from_element(xml: XmlElement, *, reads_topics: bool) -> SensorDetails:
    """Return the details of a sensor."""
    # As in the constructor of gz::sensors::Sensor.
    older_frame_id = value_at(xml, 'gz_frame_id')
    sensor_type = attribute_of(xml, 'type')
    values = ((path, value_at(xml, path)) for path in SENSOR_PATHS if reads_topics)
    return SensorDetails(
        sensor_type, value_at(xml, 'frame_id') or older_frame_id, older_frame_id,
        first_child(xml, 'camera') is not None or sensor_type in CAMERA_TYPES,
        value_at(xml, 'camera/optical_frame_id'), tuple(each for each in values if each[1]))
