# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Compose and invert poses, one or many, as a group; move them about axes."""

from joint_trees import exponential
from matrices import assert_close, assert_same_pose, matrix_from_pose
import numpy as np
import pytest

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st

from sdf_pose_bridge import Pose
from sdf_pose_bridge.geometry.poses import (
    canonical_poses,
    canonical_relative_pose,
    canonical_relative_poses,
    pose_inverse,
    pose_product,
    pose_products,
    relative_pose,
    relative_poses,
    ScrewMotions,
    transformed_points,
)
from sdf_pose_bridge.geometry.rotations import canonical_quaternion

NUMBERS = st.floats(-100.0, 100.0, allow_subnormal=False)
QUATERNIONS = st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(
    lambda q: sum(value * value for value in q) > 1e-4)


def unit(quaternion):
    norm = np.linalg.norm(quaternion)
    return tuple(float(value / norm) for value in quaternion)


POSES = st.builds(
    lambda origin, quaternion: Pose(*origin, *unit(quaternion)),
    st.tuples(NUMBERS, NUMBERS, NUMBERS), QUATERNIONS)


TURNS = st.floats(-3.0, 3.0)
VECTORS = st.tuples(*[TURNS] * 3)
AXES = VECTORS.filter(lambda axis: np.linalg.norm(axis) > 1e-3).map(
    lambda axis: np.array(axis) / np.linalg.norm(axis))


def rows(poses):
    return np.array(list(poses), dtype=float).reshape(-1, 7)


def test_a_pose_rotates_before_it_translates():
    quarter = Pose(1.0, 0.0, 0.0, 0.0, 0.0, 0.5 ** 0.5, 0.5 ** 0.5)
    assert_close(pose_product(quarter, Pose(1.0, 0.0, 0.0))[:3], (1, 1, 0))


@given(POSES, POSES)
def test_the_product_is_that_of_the_matrices(a, b):
    assert_close(matrix_from_pose(pose_product(a, b)), matrix_from_pose(a) @ matrix_from_pose(b))


@given(POSES)
def test_the_inverse_is_that_of_the_matrix(a):
    assert_close(matrix_from_pose(pose_inverse(a)), np.linalg.inv(matrix_from_pose(a)))


@given(POSES)
def test_the_identity_changes_nothing(a):
    assert pose_product(a, Pose()) == a
    assert_close(pose_product(Pose(), a), a)


@given(POSES, POSES)
def test_a_relative_pose_leads_back_to_the_pose(a, b):
    assert_close(pose_product(a, relative_pose(a, b)), b)


ONE_AND_MANY = pytest.mark.parametrize(('one', 'many'), [
    (pose_product, pose_products), (relative_pose, relative_poses)])


@ONE_AND_MANY
@given(pairs=st.lists(st.tuples(POSES, POSES), max_size=12))
def test_many_are_the_same_as_one_by_one(one, many, pairs):
    found = many(rows([a for a, _ in pairs]), rows([b for _, b in pairs]))
    np.testing.assert_array_equal(found, rows([one(a, b) for a, b in pairs]))


@given(POSES, st.lists(POSES, min_size=1, max_size=12))
def test_many_poses_in_one_frame_are_canonical_as_one_by_one(a, poses):
    relative = canonical_relative_poses(np.array(a), rows(poses))
    assert_close(relative, rows([canonical_relative_pose(a, b) for b in poses]))


def test_canonical_poses_have_no_negative_zero_and_w_is_positive():
    poses = canonical_poses(rows([Pose(-0.0, 1.0, -2.0, -0.0, 0.6, -0.0, -0.8)]))
    assert str(poses.tolist()) == '[[0.0, 1.0, -2.0, 0.0, -0.6, 0.0, 0.8]]'


@given(POSES, st.tuples(NUMBERS, NUMBERS, NUMBERS))
def test_a_transformed_point_is_that_of_the_matrix(a, point):
    expected = matrix_from_pose(a) @ (*point, 1.0)
    assert_close(transformed_points(rows([a]), np.array([point])), [expected[:3]])


def more_poses_than_a_block():
    generator = np.random.default_rng(1)
    poses = generator.uniform(-1.0, 1.0, (2, 9001, 7))
    poses[..., 3:] /= np.linalg.norm(poses[..., 3:], axis=-1, keepdims=True)
    return poses


def test_the_product_of_one_pose_and_several_blocks():
    (first, *_), second = more_poses_than_a_block()
    expected = rows(pose_product(Pose(*first), Pose(*each)) for each in second)
    np.testing.assert_array_equal(pose_products(first[np.newaxis], second), expected)


@pytest.mark.parametrize('count', [1, 5])
def test_arguments_are_not_modified(count):
    a = rows([Pose(1.0, 2.0, 3.0, 0.0, 0.0, 0.6, 0.8)] * count)
    a.setflags(write=False)
    pose_products(a, a)
    relative_poses(a, a)


@given(POSES, AXES, VECTORS, TURNS, TURNS, POSES, TURNS)
def test_a_motion_is_the_exponential_of_its_twist(
    before, axis, point, rad_per_unit, m_per_unit, after, position,
):
    motions = ScrewMotions(
        rows([before]), axis[np.newaxis], np.array([point]), np.array([rad_per_unit]),
        np.array([m_per_unit]), rows([after]))
    pose, = motions.poses(np.array([position]))
    twist = np.zeros((4, 4))
    twist[:3, :3] = rad_per_unit * np.cross(np.eye(3), axis)
    twist[:3, 3] = m_per_unit * axis - twist[:3, :3] @ point
    motion = exponential(twist * position)
    pose[3:] = canonical_quaternion(pose[3:])
    assert_same_pose(pose, matrix_from_pose(before) @ motion @ matrix_from_pose(after))


def test_several_motions_are_those_of_each():
    before, after = more_poses_than_a_block()[:, :500]
    axes, points = before[:, 3:6], after[:, :3]
    parts = (before, axes / np.linalg.norm(axes, axis=1, keepdims=True), points[::-1],
             points[:, 0], points[:, 1], after)
    found = ScrewMotions(*parts).poses(points[:, 2])
    each = [ScrewMotions(*(part[row:row + 1] for part in parts)).poses(points[row:row + 1, 2])[0]
            for row in range(0, 500, 100)]
    assert_close(found[::100], each)


def test_no_motions():
    none = np.empty((0, 7))
    motions = ScrewMotions(none, none[:, :3], none[:, :3], none[:, 0], none[:, 0], none)
    assert motions.poses(none[:, 0]).shape == (0, 7)
