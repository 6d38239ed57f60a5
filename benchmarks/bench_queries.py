# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Poses of one element in another: asked of a scene in Python, and of the node."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from benchmarks.harness import AtMostTimes, benchmark, Function, TimesAsFast
from benchmarks.processes import calls

LINKS = ''.join(
    f'<link name="l{number}"><pose degrees="true">{number} 1 2 10 20 {number}</pose></link>'
    for number in range(100))
WORLD = (
    f'<sdf version="1.10"><world name="w"><model name="robot"><pose>1 2 0 0 0 0.7</pose>{LINKS}'
    '</model></world></sdf>')
FRAME = 'robot::l20'
RELATIVE_TO = 'robot::l70'


@benchmark(
    'Scene.pose(frame, relative_to)', counterpart='numpy: inverse of a 4x4 matrix times another',
    goal=TimesAsFast(longest_s=5e-6))
def query_and_matrices() -> Iterator[tuple[Function, Function | None]]:
    from sdf_pose_bridge.geometry.rotations import matrix_from_quaternion
    from sdf_pose_bridge.scene.loading import load_text
    scene = load_text(WORLD)
    first, second = np.eye(4), np.eye(4)
    for matrix, name in ((first, RELATIVE_TO), (second, FRAME)):
        pose = scene.pose(name)
        matrix[:3, 3] = pose[:3]
        matrix[:3, :3] = matrix_from_quaternion(pose[3:])
    yield lambda: scene.pose(FRAME, RELATIVE_TO), lambda: np.linalg.inv(first) @ second


def lookup_request() -> object:
    from sdf_pose_bridge_interfaces.srv import LookupPose
    return LookupPose.Request(frame=FRAME, relative_to=RELATIVE_TO)


@benchmark('~/lookup_pose', counterpart='an empty service', goal=AtMostTimes(1.15))
def lookup_and_empty_service() -> Iterator[tuple[Function, Function | None]]:
    from sdf_pose_bridge_interfaces.srv import LookupPose
    yield from calls(LookupPose, 'lookup_pose', lookup_request(), text=WORLD)


# What remains when rclpy's cost of converting messages with these fields is taken out.
@benchmark('~/lookup_pose', counterpart='an empty service of its type', goal=AtMostTimes(1.15))
def lookup_and_service_of_same_type() -> Iterator[tuple[Function, Function | None]]:
    from sdf_pose_bridge_interfaces.srv import LookupPose
    yield from calls(
        LookupPose, 'lookup_pose', lookup_request(), 'type_of_lookup', text=WORLD)
