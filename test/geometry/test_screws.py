# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Screw motions, against exponentials of matrices."""

from joint_trees import exponential
from matrices import assert_same_pose, matrix_from_pose
import numpy as np
import pytest

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st

from sdf_pose_bridge.geometry.rotations import canonical_quaternion, quaternion_from_rpy
from sdf_pose_bridge.geometry.screws import ScrewMotions

NUMBERS = st.floats(-3.0, 3.0)
VECTORS = st.tuples(*[NUMBERS] * 3)
POSES = st.tuples(VECTORS, VECTORS).map(
    lambda pair: np.array([[*pair[0], *quaternion_from_rpy(pair[1])]]))
AXES = VECTORS.filter(lambda axis: np.linalg.norm(axis) > 1e-3).map(
    lambda axis: np.array(axis) / np.linalg.norm(axis))


@given(POSES, AXES, VECTORS, NUMBERS, NUMBERS, POSES, NUMBERS)
def test_a_motion_is_the_exponential_of_its_twist(
    before, axis, point, rad_per_unit, m_per_unit, after, position,
):
    motions = ScrewMotions(
        before, axis[np.newaxis], np.array([point]), np.array([rad_per_unit]),
        np.array([m_per_unit]), after)
    pose, = motions.poses(np.array([position]))
    twist = np.zeros((4, 4))
    twist[:3, :3] = rad_per_unit * np.cross(np.eye(3), axis)
    twist[:3, 3] = m_per_unit * axis - twist[:3, :3] @ point
    motion = exponential(twist * position)
    pose[3:] = canonical_quaternion(pose[3:])
    assert_same_pose(pose, matrix_from_pose(before[0]) @ motion @ matrix_from_pose(after[0]))


def test_no_motions():
    none = np.empty((0, 7))
    motions = ScrewMotions(none, none[:, :3], none[:, :3], none[:, 0], none[:, 0], none)
    assert motions.poses(none[:, 0]).shape == (0, 7)
