# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Warn of what Gazebo ignores, or what only some of its supported releases read.

Sources: ``SystemLoader.cc`` of gz-sim 8 to 10, ``Sensor.cc``, ``CameraSensor.cc`` of gz-sensors.
"""

from __future__ import annotations

from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.xml_tree import value_at, XmlElement

_FACTS = (
    ('self::sdf[@version="1.12"]',
     'Gazebo Harmonic refuses version 1.12; for it, write 1.11'),
    ('.//plugin[starts-with(@filename, "libignition-gazebo")]',
     'Gazebo from Ionic on does not find a library of this name; write gz-sim-...-system'),
    ('.//sensor/camera/pose[1]',
     'Gazebo does not read a <pose> in <camera>; write it in <sensor>'),
    (('.//sensor[string(gz_frame_id)][string(frame_id)]'
      '[normalize-space(gz_frame_id) != normalize-space(frame_id)]'),
     ('Gazebo Harmonic sends data of the sensor with the frame id "{gz_frame_id}", later releases '
      'with "{frame_id}", so both are frames; write one name in both elements')),
)
"""XPaths of elements, and messages, in which tags in braces stand for values."""


def warn_of_releases(root: XmlElement, sources: Sources) -> None:
    """Warn of elements of a file as it is written."""
    for path, message in _FACTS:
        for xml in root.xpath(f'{path}[not(ancestor::plugin)]'):
            values = {tag: value_at(xml, tag) for tag in ('gz_frame_id', 'frame_id')}
            sources.warning(xml, message.format(**values), is_for_gazebo=True)
