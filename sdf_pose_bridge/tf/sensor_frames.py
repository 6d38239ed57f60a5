# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The frames of sensors: their frame ids, and the optical frames of cameras.

Gazebo stamps a sensor's messages with the frame id that the file sets (``gz_frame_id``), or with
one made of the sensor's name. A camera's optical frame is named by ``optical_frame_id``, or like
the camera with ``_optical`` appended.
"""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.poses import pose_product
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.elements import Indices
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.frame_ids import FrameNaming

OPTICAL_SUFFIX = '_optical'
"""Appended to a camera's frame id for its optical frame, unless the file names that frame."""

OPTICAL_POSE = Pose(0.0, 0.0, 0.0, -0.5, 0.5, -0.5, 0.5)
"""Pose of an optical frame (REP 103: z forward, x right, y down) in its camera (x forward)."""


class OpticalFrame(NamedTuple):
    """The frame of a camera's image, beside that of the camera itself."""

    frame_id: str
    camera: int
    """The element of the camera."""
    pose: Pose
    """Pose in the root frame."""
    parent: int | None
    """Index of the camera's frame; None if the camera uses the root frame."""


def with_ids_of_sensors(
    elements: Indices, frame_ids: list[str], scene: Scene, naming: FrameNaming, root_frame: str,
) -> tuple[Indices, list[str], dict[int, str]]:
    """
    Use the frame ids that the file sets for sensors.

    :param elements: the published elements.
    :param frame_ids: the frame id of each, made of its name.
    :param scene: the scene.
    :param naming: how frame ids are made of names.
    :param root_frame: frame id of the root.
    :return: the elements and frame ids without those of sensors whose id is that of another kind
        of element, or of a sensor in the same place; and the frame id of each published sensor.
    """
    sensor_ids = {
        int(elements[index]): frame_ids[index]
        for index in np.flatnonzero(scene.kinds[elements] == int(Kind.SENSOR)).tolist()}
    names = {sensor: scene.sensors[sensor].frame_id for sensor in sensor_ids}
    if not any(names.values()):
        return elements, frame_ids, sensor_ids
    pairs = list(zip(elements.tolist(), frame_ids, strict=True))
    other_ids = {frame_id for element, frame_id in pairs if element not in sensor_ids}
    other_ids.add(root_frame)
    first_sensors: dict[str, int] = {}
    without_frame: set[int] = set()
    for sensor, name in names.items():
        if name:
            frame_id = sensor_ids[sensor] = naming.frame_id_from_name(name)
            first = first_sensors.get(frame_id)
            if frame_id in other_ids or (
                    first is not None and scene.parents[first] == scene.parents[sensor]
                    and scene.pose_of(first) == scene.pose_of(sensor)):
                without_frame.add(sensor)
                continue
        first_sensors.setdefault(sensor_ids[sensor], sensor)
    return (
        elements[~np.isin(elements, list(without_frame))],
        [sensor_ids.get(element, frame_id) for element, frame_id in pairs
         if element not in without_frame],
        sensor_ids)


def optical_frames_of_cameras(
    elements: Sequence[int], frame_ids: Sequence[str], sensor_ids: Mapping[int, str],
    scene: Scene, naming: FrameNaming,
) -> list[OpticalFrame]:
    """
    Make the optical frames of cameras.

    :param elements: the elements that have a frame.
    :param frame_ids: the frame id of each.
    :param sensor_ids: the frame id of each published sensor.
    :param scene: the scene.
    :param naming: how frame ids are made of names.
    :return: the optical frames, without those that the file has already.
    """
    cameras = [sensor for sensor in sensor_ids if scene.sensors[sensor].is_camera]
    if not cameras:
        return []
    indices: dict[str, int] = {}
    for index, frame_id in enumerate(frame_ids):
        indices.setdefault(frame_id, index)
    poses: dict[str, Pose] = {}
    frames = []
    for camera in cameras:
        name = scene.sensors[camera].optical_frame_id
        frame_id = naming.frame_id_from_name(name) if name else sensor_ids[camera] + OPTICAL_SUFFIX
        pose = pose_product(scene.pose_of(camera), OPTICAL_POSE)
        other = elements[indices[frame_id]] if frame_id in indices else None
        if name and other is not None and other not in scene.sensors:
            continue
        if pose != (poses.get(frame_id) if other is None else scene.pose_of(other)):
            poses.setdefault(frame_id, pose)
            frames.append(
                OpticalFrame(frame_id, camera, pose, indices.get(sensor_ids[camera])))
    return frames
