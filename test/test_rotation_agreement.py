# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Rotations are those of scipy, transforms3d and Drake, wherever these define them."""

import math
import warnings

import numpy as np
import pytest
from rotation_sets import half_turns
from rotation_sets import large_rpy
from rotation_sets import largest_turn
from rotation_sets import lock_rpy
from rotation_sets import random_quaternions
from rotation_sets import random_rpy
from rotation_sets import tiny_rpy

from sdf_pose_bridge.geometry import rotation

# The other libraries' rounding adds to ours.
TURN = 4e-15
ANGLE = 2e-14


def hard_rpy(count):
    parts = (random_rpy(count), lock_rpy(count), tiny_rpy(count), large_rpy(count))
    return np.concatenate(parts)


def hard_quaternions(count):
    return np.concatenate(
        (random_quaternions(count), half_turns(), rotation.quaternion_from_rpy(lock_rpy(count)))
    )


def far_from_lock(rpy):
    return np.abs(rpy[:, 1]) < math.pi / 2 - 0.01


def angles_apart(a, b):
    """Return the largest difference of angles; -pi and pi are the same one."""
    return np.abs(np.remainder(a - b + math.pi, 2.0 * math.pi) - math.pi).max()


def test_scipy_makes_the_same_quaternions_of_rpy():
    spatial = pytest.importorskip('scipy.spatial.transform')
    rpy = hard_rpy(2000)
    theirs = spatial.Rotation.from_euler('xyz', rpy).as_quat()
    assert largest_turn(rotation.quaternion_from_rpy(rpy), theirs) <= TURN


def test_scipy_makes_the_same_rpy_of_quaternions():
    spatial = pytest.importorskip('scipy.spatial.transform')
    quats = hard_quaternions(2000)
    ours = rotation.rpy_from_quaternion(quats)
    with warnings.catch_warnings():
        warnings.filterwarnings('ignore', message='Gimbal lock')
        theirs = spatial.Rotation.from_quat(quats).as_euler('xyz')
    far = far_from_lock(ours)
    assert far.sum() > 2000
    assert angles_apart(ours[far], theirs[far]) <= ANGLE


def test_scipy_makes_the_same_matrices_and_quaternions_of_them():
    spatial = pytest.importorskip('scipy.spatial.transform')
    quats = hard_quaternions(2000)
    ours = rotation.matrix_from_quaternion(quats)
    theirs = spatial.Rotation.from_quat(quats).as_matrix()
    assert np.abs(ours - theirs).max() <= 1e-15
    again = spatial.Rotation.from_matrix(theirs).as_quat()
    assert largest_turn(rotation.quaternion_from_matrix(theirs), again) <= TURN


def test_scipy_composes_and_turns_the_same_way():
    spatial = pytest.importorskip('scipy.spatial.transform')
    a, b = random_quaternions(500, seed=1), random_quaternions(500, seed=2)
    vectors = np.random.default_rng(3).normal(size=(500, 3))
    theirs = spatial.Rotation.from_quat(a) * spatial.Rotation.from_quat(b)
    assert largest_turn(rotation.quaternion_product(a, b), theirs.as_quat()) <= TURN
    turned = rotation.rotated_vectors(a, vectors)
    assert np.allclose(turned, spatial.Rotation.from_quat(a).apply(vectors), atol=1e-14)


def test_transforms3d_makes_the_same_rotations():
    euler = pytest.importorskip('transforms3d.euler')
    rpy = hard_rpy(100)
    quats_wxyz = np.array([euler.euler2quat(*angles, axes='sxyz') for angles in rpy.tolist()])
    assert largest_turn(rotation.quaternion_from_rpy(rpy), quats_wxyz[:, [1, 2, 3, 0]]) <= TURN
    matrices = np.array([euler.euler2mat(*angles, axes='sxyz') for angles in rpy.tolist()])
    assert np.abs(rotation.matrix_from_rpy(rpy) - matrices).max() <= 1e-15


def test_transforms3d_makes_the_same_rpy_of_quaternions():
    euler = pytest.importorskip('transforms3d.euler')
    quats = hard_quaternions(100)
    ours = rotation.rpy_from_quaternion(quats)
    far = far_from_lock(ours)
    theirs = np.array(
        [euler.quat2euler(quat, axes='sxyz') for quat in quats[:, [3, 0, 1, 2]].tolist()]
    )
    # Its detour by the matrix costs it some digits where pitch is steep.
    assert angles_apart(ours[far], theirs[far]) <= 1e-13


def test_drake_makes_the_same_quaternions_of_rpy():
    drake = pytest.importorskip('pydrake.math', reason='Drake (PyPI: drake) is not installed')
    rpy = hard_rpy(300)
    theirs = np.array([drake.RollPitchYaw(angles).ToQuaternion().wxyz() for angles in rpy])
    assert largest_turn(rotation.quaternion_from_rpy(rpy), theirs[:, [1, 2, 3, 0]]) <= TURN


def test_drake_makes_the_same_rpy_of_quaternions():
    drake = pytest.importorskip('pydrake.math', reason='Drake (PyPI: drake) is not installed')
    eigen = pytest.importorskip('pydrake.common.eigen_geometry')
    quats = rotation.canonical_quaternion(hard_quaternions(300))
    theirs = np.array([
        drake.RollPitchYaw(eigen.Quaternion(wxyz=quat)).vector() for quat in quats[:, [3, 0, 1, 2]]
    ])
    ours = rotation.rpy_from_quaternion(quats)
    far = far_from_lock(ours)
    assert angles_apart(ours[far], theirs[far]) <= ANGLE
    assert largest_turn(rotation.quaternion_from_rpy(theirs), quats) <= TURN
