# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The frames of TF while their tree is made, and those that no element of the file has.

These are the optical frames of cameras, and frames at joints for which URDF needs links that
SDFormat does not have. In URDF a joint is where its child link is, and has one axis.
"""

from __future__ import annotations

from collections.abc import Collection, Container, Iterable, Mapping, Sequence
from functools import partial
import itertools
import math
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.chains import Indices
from sdf_pose_bridge.geometry.poses import (
    canonical_poses,
    canonical_relative_poses,
    distance_and_angle,
    OPTICAL_POSE,
    Pose,
    pose_product,
    PoseArray,
    relative_pose,
)
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.tf.frame_ids import FrameNaming, misplacement
from sdf_pose_bridge.tf.joint_motion import JointMotion
from sdf_pose_bridge.tf.joint_positions import SLIDE_SUFFIX
from sdf_pose_bridge.tf.parents import NO_PARENT, ROOT_IS_PARENT, TfParents

OPTICAL_SUFFIX = '_optical'
"""Appended to a camera's frame id for its optical frame, unless the file names that frame."""

LINK_SUFFIX = '_frame'
"""Appended to the name of a joint for the name of such a link."""

_SAME_PLACE = 1e-12
"""Frames that differ by less, in metres and halves of radians, are the same."""


class Frame(NamedTuple):
    """A frame that is added to those of the elements; its fields are as in :class:`Frames`."""

    frame_id: str
    owner: int
    parent: int
    pose: Pose


class Frames(NamedTuple):
    """The frames to publish; entry i of each sequence and array is about frame i."""

    ids: Sequence[str]
    owners: Indices
    """The element that each frame moves with: its own, or the camera of an optical frame; for a
    frame at a joint that moves as in ``JointMotion.last_dofs``."""
    parents: Indices
    """Index of the parent of each frame, or :data:`ROOT_IS_PARENT`, or :data:`NO_PARENT`."""
    poses: PoseArray
    """Shape (n, 7): pose of each frame in the root frame."""

    def with_frames(self, frames: Sequence[Frame]) -> Frames:
        """Return these frames, and others after them."""
        if not frames:
            return self
        ids, owners, parents, poses = zip(*frames, strict=True)
        return Frames(
            [*self.ids, *ids], np.append(self.owners, np.array(owners, np.int32)),
            np.append(self.parents, np.array(parents, np.int32)),
            np.concatenate([self.poses, canonical_poses(np.array(poses))]))

    def transforms(self) -> PoseArray:
        """Return the pose of each frame in its parent; the identity if it has none."""
        # The last pose is for ROOT_IS_PARENT; frames without a parent get theirs below.
        transforms = canonical_relative_poses(
            np.concatenate([self.poses, [Pose()]])[self.parents], self.poses)
        transforms[self.parents == NO_PARENT] = Pose()
        return transforms


def optical_frames_of_cameras(
    frames: Frames, sensor_names: Mapping[int, str], optical_names: Mapping[int, str],
    scene: Scene, naming: FrameNaming,
) -> list[Frame]:
    """
    Make the optical frames of cameras.

    :param frames: the frames of elements.
    :param sensor_names: the name of the frame of each published sensor.
    :param optical_names: the names of optical frames that frame ids of cameras mean.
    :return: the optical frames, without those that the file has already.
    """
    indices = {frame_id: index for index, frame_id in enumerate(frames.ids)}
    poses: dict[str, Pose] = {}
    optical_frames = []
    cameras = [sensor for sensor in sensor_names if scene.sensors[sensor].is_camera]
    for camera in cameras:
        name = (naming.name_from_frame_id(scene.sensors[camera].optical_frame_id)
                or optical_names.get(camera, ''))
        frame_id = naming.frame_id_from_name(name or sensor_names[camera] + OPTICAL_SUFFIX)
        pose = pose_product(scene.pose_of(camera), OPTICAL_POSE)
        other = frames.owners.item(indices[frame_id]) if frame_id in indices else None
        if name and other is not None and other not in scene.sensors:
            continue
        if pose != (poses.get(frame_id) if other is None else scene.pose_of(other)):
            poses.setdefault(frame_id, pose)
            # A camera without a frame of its own uses the root frame.
            camera_id = naming.frame_id_from_name(sensor_names[camera])
            parent = indices.get(camera_id, ROOT_IS_PARENT)
            optical_frames.append(Frame(frame_id, camera, parent, pose))
    return optical_frames


def older_frames_of_sensors(
    older_ids: Mapping[int, str], used: Container[str], nearest_frames: Indices, scene: Scene,
) -> list[Frame]:
    """
    Make a frame for each further frame id of sensors, unless it is used already.

    :param nearest_frames: the frame of each element, or the one that it is in.
    """
    sensors = {frame_id: sensor for sensor, frame_id in reversed([*older_ids.items()])}
    return [
        Frame(frame_id, sensor, nearest_frames.item(sensor), scene.pose_of(sensor))
        for frame_id, sensor in sensors.items() if frame_id not in used]


def check_frames_of_sensors(
    frames: Frames, sensor_names: Iterable[int], older_ids: Mapping[int, str], scene: Scene,
    root_frame: str, naming: FrameNaming, problems: Problems,
) -> None:
    """
    Warn about each sensor whose data have the frame id of another element in another place.

    Images of a camera may have the frame id of its optical frame.

    :param frames: the frames of elements.
    """
    owners = {root_frame: 0, **dict(zip(frames.ids, frames.owners.tolist(), strict=True))}
    for sensor in sensor_names:
        details, pose = scene.sensors[sensor], scene.pose_of(sensor)
        optical_pose = pose_product(pose, OPTICAL_POSE)
        data_poses = (pose, optical_pose) if details.is_camera else (pose,)
        for what, name, poses in (
                ('frame id', details.frame_id, data_poses),
                ('frame id in Gazebo Harmonic', older_ids.get(sensor, ''), data_poses),
                ('optical frame id', details.optical_frame_id, (optical_pose,))):
            other = owners.get(naming.frame_id_from_name(naming.name_from_frame_id(name)))
            # Two sensors with one frame id are an error, unless only Harmonic sends it.
            if other in (None, sensor) or (other in scene.sensors and 'Harmonic' not in what):
                continue
            named = scene.pose_of(other)
            nearest = min(poses, key=partial(misplacement, named))
            if misplacement(named, nearest) > 1.0:
                distance_m, angle_rad = distance_and_angle(named, nearest)
                away = f'{round(distance_m, 4):g} m and {round(math.degrees(angle_rad), 2):g}'
                msg = (f'the {what} "{name}" of sensor "{scene.names[sensor]}" is that of a frame '
                       f'{away} degrees away, where its data will appear; name a frame in the '
                       'place of the sensor')
                problems.warning(msg, scene.place(sensor))


def is_same_place(pose: Pose) -> bool:
    """Return whether a pose is the identity, except for rounding errors."""
    return math.hypot(*pose[:6]) < _SAME_PLACE


def frames_at_joints(
    frames: Frames, scene: Scene, motion: JointMotion, tf_parents: TfParents,
    naming: FrameNaming, root_frame: str, moving_bodies: Collection[int],
) -> list[Frame]:
    """
    Make a frame for each link that URDF needs and SDFormat has not.

    The frame between the turning and the sliding of a screw joint is left out, and so are those of
    joints to links that are not published, which are not in the URDF.

    :param frames: all other frames, which keep their ids.
    :param moving_bodies: the bodies in which frames at their joints can move.
    """
    rows = {owner: row for row, owner in enumerate(frames.owners.tolist())}
    used = {root_frame, *frames.ids}
    found, moving = [], itertools.count(len(scene.kinds))
    for index, (dof, body) in enumerate(zip(motion.dofs, motion.moved_bodies, strict=True)):
        owner = next(moving) if body in moving_bodies else body
        pose = scene.pose_of(dof.joint.element)
        is_last = motion.last_dofs[body] == index
        if is_last and is_same_place(relative_pose(pose, scene.pose_of(body))):
            continue
        parent_body = tf_parents.parents.item(body)
        is_published = body in rows and (parent_body in rows or scene.parents[parent_body] < 0)
        parent = frames.parents.item(rows[body]) if is_published else NO_PARENT
        slide = SLIDE_SUFFIX if dof.is_screw else ''
        frame_id = naming.frame_id_from_name(f'{dof.name}{slide}{LINK_SUFFIX}')
        if parent != NO_PARENT and frame_id not in used:
            used.add(frame_id)
            found.append(Frame(frame_id, owner, parent, pose))
    return found
