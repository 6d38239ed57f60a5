# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Poses as 4 x 4 matrices: a second way to compute, independent of the package."""

import math

import numpy as np

OPTICAL = np.array([[0.0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])
"""Pose of the optical frame of a camera in the frame of its sensor."""


def axis_rotation(axis, angle):
    """Return the rotation about one axis (0 x, 1 y, 2 z) by an angle in radians."""
    first, second = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(4)
    matrix[first, first] = matrix[second, second] = math.cos(angle)
    matrix[first, second] = -math.sin(angle)
    matrix[second, first] = math.sin(angle)
    return matrix


def matrix_from_rpy(x, y, z, roll=0.0, pitch=0.0, yaw=0.0):
    """Return the matrix of a pose: metres, and radians about fixed axes."""
    matrix = axis_rotation(2, yaw) @ axis_rotation(1, pitch) @ axis_rotation(0, roll)
    matrix[:3, 3] = x, y, z
    return matrix


def matrix_from_degrees(x, y, z, roll=0.0, pitch=0.0, yaw=0.0):
    return matrix_from_rpy(x, y, z, *map(math.radians, (roll, pitch, yaw)))


def matrix_from_pose(pose):
    """Return the matrix of x y z and a quaternion x y z w, by Rodrigues' formula."""
    *origin, qx, qy, qz, qw = pose
    cross = np.array([[0.0, -qz, qy], [qz, 0.0, -qx], [-qy, qx, 0.0]])
    matrix = np.eye(4)
    matrix[:3, :3] += 2.0 * (qw * cross + cross @ cross)
    matrix[:3, 3] = origin
    return matrix


def assert_close(found, expected, tolerance=1e-9, name=''):
    """Check numbers, with an absolute tolerance."""
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=tolerance, err_msg=name)


def assert_same_pose(pose, matrix, tolerance=1e-9, *, name=''):
    """Check a pose against a matrix, and that its quaternion x y z w is unit with w >= 0."""
    quaternion = np.array(pose[3:])
    assert abs(np.linalg.norm(quaternion) - 1.0) < 1e-12, name
    assert quaternion[3] >= 0.0, name
    scale = max(1.0, float(np.abs(matrix[:3, 3]).max()))
    assert_close(matrix_from_pose(pose), matrix, tolerance * scale, name)
