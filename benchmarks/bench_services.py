# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Services of the node, called from another process as its clients do."""

from __future__ import annotations

import array
from collections.abc import Iterator
import random

from benchmarks.harness import AtMostTimes, benchmark, Function, PerSecond
from benchmarks.processes import bridge_and_minimal_node, calls

POSES = 100_000


def rotation_request() -> object:
    from sdf_pose_bridge_interfaces.srv import ConvertRotation
    request = ConvertRotation.Request(given=ConvertRotation.Request.RPY)
    request.rpy.x, request.rpy.y, request.rpy.z = 0.1, -0.2, 2.3
    return request


@benchmark('~/convert_rotation', counterpart='an empty service', goal=AtMostTimes(1.15))
def rotation_and_empty_service() -> Iterator[tuple[Function, Function | None]]:
    from sdf_pose_bridge_interfaces.srv import ConvertRotation
    yield from calls(ConvertRotation, 'convert_rotation', rotation_request())


# What remains when rclpy's cost of converting messages with these fields is taken out.
@benchmark(
    '~/convert_rotation', counterpart='an empty service of its type', goal=AtMostTimes(1.15))
def rotation_and_service_of_same_type() -> Iterator[tuple[Function, Function | None]]:
    from sdf_pose_bridge_interfaces.srv import ConvertRotation
    yield from calls(ConvertRotation, 'convert_rotation', rotation_request(), 'same_type')


@benchmark(
    f'~/convert_poses, {POSES:,} poses', counterpart='-', goal=PerSecond(3e5, POSES, 'poses'))
def batch_of_poses() -> Iterator[tuple[Function, Function | None]]:
    from sdf_pose_bridge_interfaces.srv import ConvertPoses
    rng = random.Random(1)
    values = array.array('d', (rng.uniform(-3.0, 3.0) for _ in range(6 * POSES)))
    request = ConvertPoses.Request(
        from_format='sdf_rpy', to_format='sdf_quat_xyzw', values=values)
    with bridge_and_minimal_node() as client:
        yield client.caller(ConvertPoses, '/sdf_pose_bridge/convert_poses', request), None
