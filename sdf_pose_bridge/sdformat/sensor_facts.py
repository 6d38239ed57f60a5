# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read what only a sensor has: the frame ids that go with its messages."""

from __future__ import annotations

import itertools

from sdf_pose_bridge.sdformat.document import value_of
from sdf_pose_bridge.sdformat.document import WHITE_SPACE
from sdf_pose_bridge.sdformat.document import XmlElement
from sdf_pose_bridge.sdformat.elements import CAMERA_TYPES
from sdf_pose_bridge.sdformat.elements import SensorFacts


def sensor_facts_from_xml(xml: XmlElement) -> SensorFacts:
    """
    Read a sensor.

    :param xml: a ``<sensor>``.
    :return: its type and its frame ids.
    """
    frame_ids = itertools.chain(
        xml.iterchildren('gz_frame_id'), xml.iterchildren('ignition_frame_id'))
    camera = next(xml.iterchildren('camera'), None)
    optical = None if camera is None else next(camera.iterchildren('optical_frame_id'), None)
    sensor_type = xml.get('type', '').strip(WHITE_SPACE)
    return SensorFacts(
        sensor_type,
        next(filter(None, map(value_of, frame_ids)), ''),
        camera is not None or sensor_type in CAMERA_TYPES,
        '' if optical is None else value_of(optical))
