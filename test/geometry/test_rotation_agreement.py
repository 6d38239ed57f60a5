# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The conversions agree with scipy, transforms3d and Drake where these are defined."""

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

# Rounding in the other libraries is included.
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


def test_transforms3d_agrees_on_quaternions_and_matrices_from_rpy():
    euler = pytest.importorskip('transforms3d.euler')
    rpy = difficult_rpy(100)
    quats = np.array([euler.euler2quat(*angles, axes='sxyz') for angles in rpy.tolist()])
    theirs = quats[:, [1, 2, 3, 0]]
    assert largest_angle(rotations.quaternion_from_rpy(rpy), theirs) <= ROTATION_LIMIT
    matrices = np.array([euler.euler2mat(*angles, axes='sxyz') for angles in rpy.tolist()])
    assert np.abs(rotations.matrix_from_rpy(rpy) - matrices).max() <= 1e-15


def test_transforms3d_agrees_on_rpy_from_quaternions():
    euler = pytest.importorskip('transforms3d.euler')
    quats = difficult_quaternions(100)
    ours = rotations.rpy_from_quaternion(quats)
    far = far_from_lock(ours)
    theirs = np.array(
        [euler.quat2euler(quat, axes='sxyz') for quat in quats[:, [3, 0, 1, 2]].tolist()]
    )
    # It goes by way of the matrix, which loses digits near lock.
    assert largest_difference(ours[far], theirs[far]) <= 1e-13


def test_drake_agrees_on_quaternions_from_rpy():
    drake = pytest.importorskip('pydrake.math', reason='Drake (PyPI: drake) is not installed')
    rpy = difficult_rpy(300)
    quats = np.array([drake.RollPitchYaw(angles).ToQuaternion().wxyz() for angles in rpy])
    theirs = quats[:, [1, 2, 3, 0]]
    assert largest_angle(rotations.quaternion_from_rpy(rpy), theirs) <= ROTATION_LIMIT


def test_drake_agrees_on_rpy_from_quaternions():
    drake = pytest.importorskip('pydrake.math', reason='Drake (PyPI: drake) is not installed')
    eigen = pytest.importorskip('pydrake.common.eigen_geometry')
    quats = rotations.canonical_quaternion(difficult_quaternions(300))
    theirs = np.array([
        drake.RollPitchYaw(eigen.Quaternion(wxyz=quat)).vector() for quat in quats[:, [3, 0, 1, 2]]
    ])
    ours = rotations.rpy_from_quaternion(quats)
    far = far_from_lock(ours)
    assert largest_difference(ours[far], theirs[far]) <= ANGLE_LIMIT
    assert largest_angle(rotations.quaternion_from_rpy(theirs), quats) <= ROTATION_LIMIT
