# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The conversions agree with scipy where that is defined."""

import math
import warnings

import numpy as np
import pytest
from rotation_sets import (
    half_turns,
    large_rpy,
    largest_angle,
    lock_rpy,
    random_quaternions,
    random_rpy,
    tiny_rpy,
)

from sdf_pose_bridge.geometry import rotations
from sdf_pose_bridge.geometry.poses import pose_products

# Rounding in scipy is included.
ROTATION_LIMIT = 4e-15
ANGLE_LIMIT = 2e-14


def difficult_rpy(count):
    parts = (random_rpy(count), lock_rpy(count), tiny_rpy(count), large_rpy(count))
    return np.concatenate(parts)


def difficult_quaternions(count):
    return np.concatenate(
        (random_quaternions(count), half_turns(), rotations.quaternion_from_rpy(lock_rpy(count)))
    )


def far_from_lock(rpy):
    return np.abs(rpy[:, 1]) < math.pi / 2 - 0.01


def largest_difference(a, b):
    """Return the largest difference of angles; -pi and pi are the same angle."""
    return np.abs(np.remainder(a - b + math.pi, 2.0 * math.pi) - math.pi).max()


def test_scipy_agrees_on_quaternions_from_rpy():
    spatial = pytest.importorskip('scipy.spatial.transform')
    rpy = difficult_rpy(2000)
    theirs = spatial.Rotation.from_euler('xyz', rpy).as_quat()
    assert largest_angle(rotations.quaternion_from_rpy(rpy), theirs) <= ROTATION_LIMIT


def test_scipy_agrees_on_rpy_from_quaternions():
    spatial = pytest.importorskip('scipy.spatial.transform')
    quats = difficult_quaternions(2000)
    ours = rotations.rpy_from_quaternion(quats)
    with warnings.catch_warnings():
        warnings.filterwarnings('ignore', message='Gimbal lock')
        theirs = spatial.Rotation.from_quat(quats).as_euler('xyz')
    far = far_from_lock(ours)
    assert far.sum() > 2000
    assert largest_difference(ours[far], theirs[far]) <= ANGLE_LIMIT


def test_scipy_agrees_on_matrices():
    spatial = pytest.importorskip('scipy.spatial.transform')
    quats = difficult_quaternions(2000)
    ours = rotations.matrix_from_quaternion(quats)
    theirs = spatial.Rotation.from_quat(quats).as_matrix()
    assert np.abs(ours - theirs).max() <= 1e-15
    again = spatial.Rotation.from_matrix(theirs).as_quat()
    assert largest_angle(rotations.quaternion_from_matrix(theirs), again) <= ROTATION_LIMIT


def test_scipy_agrees_on_rotation_vectors():
    spatial = pytest.importorskip('scipy.spatial.transform')
    quats = difficult_quaternions(2000)
    ours = rotations.rotation_vector_from_quaternion(quats)
    theirs = spatial.Rotation.from_rotvec(ours).as_quat()
    assert largest_angle(quats, theirs) <= ROTATION_LIMIT
    assert largest_angle(rotations.quaternion_from_rotation_vector(ours), theirs) <= ROTATION_LIMIT


def test_scipy_composes_poses_the_same_way():
    spatial = pytest.importorskip('scipy.spatial.transform')
    a, b = random_quaternions(500, seed=1), random_quaternions(500, seed=2)
    origins = np.random.default_rng(3).normal(size=(500, 3))
    products = pose_products(
        np.column_stack((np.zeros((500, 3)), a)), np.column_stack((origins, b)))
    theirs = spatial.Rotation.from_quat(a) * spatial.Rotation.from_quat(b)
    assert largest_angle(products[:, 3:], theirs.as_quat()) <= ROTATION_LIMIT
    rotated = spatial.Rotation.from_quat(a).apply(origins)
    assert np.allclose(products[:, :3], rotated, atol=1e-14)
