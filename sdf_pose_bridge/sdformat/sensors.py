# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read what only sensors have besides a name and a pose."""

from __future__ import annotations

from itertools import chain
from typing import NamedTuple

from sdf_pose_bridge.sdformat.specification import CAMERA_TYPES
from sdf_pose_bridge.sdformat.xml_tree import attribute_of
from sdf_pose_bridge.sdformat.xml_tree import child_elements
from sdf_pose_bridge.sdformat.xml_tree import first_child
from sdf_pose_bridge.sdformat.xml_tree import value_of
from sdf_pose_bridge.sdformat.xml_tree import XmlElement


class SensorDetails(NamedTuple):
    """What only a sensor has."""

    type: str
    """As written: ``camera``, ``gpu_lidar``, ..."""
    frame_id: str
    """The frame id of the messages of Gazebo, where the file sets it; else empty."""
    is_camera: bool
    """Whether an optical frame belongs to it."""
    optical_frame_id: str
    """The id of the optical frame, where the file sets it; else empty."""


def sensor_details_from_element(xml: XmlElement) -> SensorDetails:
    """
    Read a sensor.

    :return: its details.
    """
    frame_ids = chain(
        child_elements(xml, 'gz_frame_id'), child_elements(xml, 'ignition_frame_id'))
    camera = first_child(xml, 'camera')
    optical = None if camera is None else first_child(camera, 'optical_frame_id')
    sensor_type = attribute_of(xml, 'type')
    return SensorDetails(
        sensor_type, next(filter(None, map(value_of, frame_ids)), ''),
        camera is not None or sensor_type in CAMERA_TYPES,
        '' if optical is None else value_of(optical))
