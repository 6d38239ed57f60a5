# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Assign poses of models to streams, and report poses that cannot be used."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
import math
import time
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.poses import Pose, pose_product
from sdf_pose_bridge.geometry.rotations import canonical_quaternion
from sdf_pose_bridge.ros.cdr import LONGEST_READ_S, StampedPose
from sdf_pose_bridge.ros.following.state_messages import KnownStreams, Message, StateSource
from sdf_pose_bridge.ros.log_lines import names_in_line
from sdf_pose_bridge.tf.joint_motion import NO_DOF
from sdf_pose_bridge.tf.joint_positions import LARGEST_POSITION

MOST_OFF_UNIT = 0.01
"""Largest difference of the norm of a quaternion from 1; it is made 1."""


class _Group(NamedTuple):
    """The stamp and the frame of some poses of a message."""

    stamp_ns: int
    frame_id: str
    placed: str
    frame_dof: int
    """The first degree of freedom that moves the frame."""


def messages_from_poses(
    poses: Iterable[StampedPose], source: StateSource, streams: KnownStreams,
    dof: int | None = None, placements: Mapping[int, str] | None = None,
) -> list[Message]:
    """
    Assign poses to streams of messages; log those that cannot be used.

    :param dof: the free model whose poses they are; None if their child frame ids name it.
    :param placements: the frames that they are of, by free models, whatever child frame ids say.
    """
    doubts, streams.doubts = streams.doubts, []
    for line in doubts:
        source.warn(line, partial(str, line))
    # Poses of one stamp in one frame become one message.
    groups: dict[_Group, dict[int, Sequence[float]]] = {}
    unknown, others, carried = list[str](), list[str](), dict[tuple[int, str], str]()
    invalid = list[tuple[float, ...]]()
    ends_at = time.thread_time() + LONGEST_READ_S
    for stamp_ns, frame_id, child, numbers in poses:
        model, placed = streams.placed_frame(child, dof)
        sender = dof if dof is not None else streams.models_of_odometry.get(
            (source.name, frame_id), model)
        odometry = None if sender is None else streams.odometry_in(frame_id, sender, source)
        if odometry:
            model = sender
        if model is None:
            # PosePublisher may send visuals and collisions, too, each in what contains it.
            if not (child.startswith(f'{frame_id}/') and streams.lookup.knows(frame_id)):
                unknown.append(child)
            continue
        found = ('', NO_DOF) if odometry else streams.pose_frame(frame_id, ends_at, source)
        if found is None:
            pass  # there is time when the next message comes
        elif found[0] is None:
            others.append(frame_id)
        elif found[1] == model:
            carried[model, placed] = frame_id
        elif not (abs(math.hypot(*numbers[3:]) - 1.0) <= MOST_OFF_UNIT
                  and all(abs(number) <= LARGEST_POSITION for number in numbers[:3])):
            invalid.append(numbers)
        else:
            x, y, z, *quat = numbers
            pose = Pose(x, y, z, *canonical_quaternion(quat))
            if odometry:
                pose = pose_product(odometry.pose, pose_product(pose, odometry.model))
            placed = odometry.nested_model if odometry else (placements or {}).get(model, placed)
            groups.setdefault(_Group(stamp_ns, found[0], placed, found[1]), {})[model] = pose
    models = {model for group in groups.values() for model in group}
    # The pose of the model may come in another message.
    names = [frame_id for key, frame_id in carried.items()
             if key in source.carried and key[0] not in models]
    source.carried = {key for key in source.carried.union(carried) if key[0] not in models}
    if unknown:
        reason = f'the topic is for the model "{source.model}"' if dof is not None else (
            'no model has this name, or it is static, or a joint connects it to another body')
        source.warn_once('models', unknown, lambda: (
            f'{source.name} has poses of {names_in_line(unknown)}, which are ignored: {reason}'
            f'{"" if source.model else streams.hint(unknown[0])}'))
    if others:
        source.warn_once('frames', others, lambda: (
            f'{source.name} has poses in {names_in_line(others)}, which are ignored: there is '
            'no such frame; if it is the same as the root frame, name it in model_pose_frames'))
    if names:
        source.warn_once('carried', names, lambda: (
            f'{source.name} has poses in {names_in_line(names)}, which are ignored: such a frame '
            "moves with the model, and does not say where it is; Gazebo's PosePublisher sends "
            'poses of models with <publish_model_pose> and <publish_nested_model_pose>'))
    if invalid:
        source.warn('pose', lambda: (
            f'a pose from {source.name} is ignored: {invalid[0]} has no quaternion of length 1, '
            f'or a position that is not finite or beyond {LARGEST_POSITION:g}'))
    return [
        Message(
            streams.of_models(tuple(sorted(group)), source),
            np.array([group[dof] for dof in sorted(group)]), *key[:3])
        for key, group in _in_order(groups)]


def _in_order(
    groups: Mapping[_Group, dict[int, Sequence[float]]],
) -> Iterator[tuple[_Group, dict[int, Sequence[float]]]]:
    """Put poses in a frame that moves with a model after the pose of that model."""
    places = {(key.stamp_ns, model): key for key, group in groups.items() for model in group}
    done = set[_Group]()
    for key in groups:
        path = list[_Group]()
        last: _Group | None = key
        while last is not None and last not in done:
            done.add(last)
            path.append(last)
            last = places.get((last.stamp_ns, last.frame_dof))
        yield from ((each, groups[each]) for each in reversed(path))
