# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Rotations and pose formats, compared with sine and cosine of numpy and with other libraries."""

from __future__ import annotations

import math

import numpy as np

from benchmarks.harness import AtMostTimes, benchmark, TimesAsFast
from sdf_pose_bridge.geometry.formats import converted_poses
from sdf_pose_bridge.geometry.rotations import (
    matrix_from_quaternion,
    quaternion_from_matrix,
    quaternion_from_rpy,
    rpy_from_quaternion,
)

MANY = 1_000_000
ONE_RPY = (0.1, -0.2, 2.3)
ONE_QUATERNION = quaternion_from_rpy(ONE_RPY)


def random_rpy(count):
    return np.random.default_rng(1).uniform(-math.pi, math.pi, (count, 3))


def quaternion_and_scipy(rpy):
    from scipy.spatial.transform import Rotation
    yield lambda: quaternion_from_rpy(rpy), lambda: Rotation.from_euler('xyz', rpy).as_quat()


def rpy_and_scipy(quats):
    from scipy.spatial.transform import Rotation
    yield lambda: rpy_from_quaternion(quats), lambda: Rotation.from_quat(quats).as_euler('xyz')


@benchmark('rpy to quaternion, 1e6', counterpart="numpy's sin and cos", goal=AtMostTimes(2.0))
def many_to_quaternion_and_sines():
    rpy = random_rpy(MANY)
    yield lambda: quaternion_from_rpy(rpy), lambda: (np.sin(rpy), np.cos(rpy))


@benchmark('quaternion to rpy, 1e6', counterpart="numpy's sin and cos", goal=AtMostTimes(2.0))
def many_to_rpy_and_sines():
    rpy = random_rpy(MANY)
    quats = quaternion_from_rpy(rpy)
    yield lambda: rpy_from_quaternion(quats), lambda: (np.sin(rpy), np.cos(rpy))


@benchmark('rpy to quaternion, 1e6', counterpart='scipy', goal=TimesAsFast(3.0))
def many_to_quaternion_and_scipy():
    yield from quaternion_and_scipy(random_rpy(MANY))


@benchmark('quaternion to rpy, 1e6', counterpart='scipy', goal=TimesAsFast(3.0))
def many_to_rpy_and_scipy():
    yield from rpy_and_scipy(quaternion_from_rpy(random_rpy(MANY)))


@benchmark('quaternion to matrix, 1e6', counterpart='scipy', goal=TimesAsFast())
def many_to_matrix_and_scipy():
    from scipy.spatial.transform import Rotation
    quats = quaternion_from_rpy(random_rpy(MANY))
    yield (
        lambda: matrix_from_quaternion(quats),
        lambda: Rotation.from_quat(quats).as_matrix(),
    )


@benchmark('matrix to quaternion, 1e6', counterpart='scipy', goal=TimesAsFast())
def many_from_matrix_and_scipy():
    from scipy.spatial.transform import Rotation
    matrices = matrix_from_quaternion(quaternion_from_rpy(random_rpy(MANY)))
    yield (
        lambda: quaternion_from_matrix(matrices),
        lambda: Rotation.from_matrix(matrices).as_quat(),
    )


@benchmark('rpy to quaternion, one', counterpart='scipy', goal=TimesAsFast(10.0, 3e-6))
def one_to_quaternion_and_scipy():
    yield from quaternion_and_scipy(ONE_RPY)


@benchmark('quaternion to rpy, one', counterpart='scipy', goal=TimesAsFast(10.0, 3e-6))
def one_to_rpy_and_scipy():
    yield from rpy_and_scipy(ONE_QUATERNION)


@benchmark('rpy to quaternion, one', counterpart='transforms3d', goal=TimesAsFast())
def one_to_quaternion_and_transforms3d():
    from transforms3d.euler import euler2quat
    yield lambda: quaternion_from_rpy(ONE_RPY), lambda: euler2quat(*ONE_RPY, axes='sxyz')


@benchmark('quaternion to rpy, one', counterpart='transforms3d', goal=TimesAsFast())
def one_to_rpy_and_transforms3d():
    from transforms3d.euler import quat2euler
    x, y, z, w = ONE_QUATERNION
    yield (
        lambda: rpy_from_quaternion(ONE_QUATERNION),
        lambda: quat2euler((w, x, y, z), axes='sxyz'),
    )


@benchmark('sdf_rpy to franka_matrix, 1e5 poses', counterpart='scipy', goal=TimesAsFast())
def poses_and_scipy():
    from scipy.spatial.transform import Rotation
    rows = np.concatenate((random_rpy(100_000), random_rpy(100_000)), axis=1)
    values = rows.ravel()

    def with_scipy():
        poses = values.reshape(-1, 6)
        matrices = np.zeros((len(poses), 4, 4))
        matrices[:, :3, :3] = np.swapaxes(
            Rotation.from_euler('xyz', poses[:, 3:]).as_matrix(), 1, 2
        )
        matrices[:, 3, :3] = poses[:, :3]
        matrices[:, 3, 3] = 1.0
        return matrices.ravel()

    yield lambda: converted_poses(values, 'sdf_rpy', 'franka_matrix'), with_scipy


@benchmark('franka_matrix to sdf_rpy, 1e5 poses', counterpart='scipy', goal=TimesAsFast())
def poses_back_and_scipy():
    from scipy.spatial.transform import Rotation
    rows = np.concatenate((random_rpy(100_000), random_rpy(100_000)), axis=1)
    values = converted_poses(rows.ravel(), 'sdf_rpy', 'franka_matrix')

    def with_scipy():
        matrices = np.swapaxes(values.reshape(-1, 4, 4), 1, 2)
        rpy = Rotation.from_matrix(matrices[:, :3, :3]).as_euler('xyz')
        return np.concatenate((matrices[:, :3, 3], rpy), axis=1).ravel()

    yield lambda: converted_poses(values, 'franka_matrix', 'sdf_rpy'), with_scipy
