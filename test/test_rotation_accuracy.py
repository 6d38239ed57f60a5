# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Rotations keep their last digits: against references of 50 digits, and a million of them."""

import pytest
from rotation_sets import exact_matrix
from rotation_sets import exact_norm
from rotation_sets import exact_quaternion
from rotation_sets import exact_turn
from rotation_sets import extended_quaternions
from rotation_sets import half_turns
from rotation_sets import LARGEST_TURN
from rotation_sets import largest_turn
from rotation_sets import LONG_DOUBLE_HELPS
from rotation_sets import random_quaternions
from rotation_sets import random_rpy
from rotation_sets import RPY_SETS

from sdf_pose_bridge.geometry import rotation

all_sets = pytest.mark.parametrize('rpy_set', RPY_SETS.values(), ids=RPY_SETS)
needs_long_double = pytest.mark.skipif(
    not LONG_DOUBLE_HELPS, reason="this machine's long double is no longer than its double"
)

def one_by_one(function, rows):
    return [function(tuple(row)) for row in rows.tolist()]


def sample(rows, count=60):
    return rows[:: max(1, len(rows) // count)]


@all_sets
def test_quaternion_from_rpy_is_right_to_the_last_digits(rpy_set):
    rpy = sample(rpy_set(60))
    for given, one, many in zip(
        rpy, one_by_one(rotation.quaternion_from_rpy, rpy), rotation.quaternion_from_rpy(rpy),
        strict=True,
    ):
        expected = exact_quaternion(given)
        assert exact_turn(expected, one) <= LARGEST_TURN
        assert exact_turn(expected, many) <= LARGEST_TURN


@all_sets
def test_rpy_from_quaternion_is_right_to_the_last_digits(rpy_set):
    quats = rotation.quaternion_from_rpy(sample(rpy_set(60)))
    for given, one, many in zip(
        quats, one_by_one(rotation.rpy_from_quaternion, quats),
        rotation.rpy_from_quaternion(quats), strict=True,
    ):
        assert exact_turn(given, exact_quaternion(one)) <= LARGEST_TURN
        assert exact_turn(given, exact_quaternion(many)) <= LARGEST_TURN


@all_sets
def test_quaternions_are_unit_to_the_last_digit(rpy_set):
    rpy = sample(rpy_set(100), 100)
    quats = [*one_by_one(rotation.quaternion_from_rpy, rpy), *rotation.quaternion_from_rpy(rpy)]
    assert max(abs(exact_norm(quat) - 1) for quat in quats) <= 2e-16


@pytest.mark.parametrize('scale', [1e-300, 1e-150, 0.7, 1.0, 3e77, 1e300])
def test_canonical_quaternions_of_any_norm_are_unit_to_the_last_digit(scale):
    given = random_quaternions(50) * scale
    for quat, one, many in zip(
        given, one_by_one(rotation.canonical_quaternion, given),
        rotation.canonical_quaternion(given), strict=True,
    ):
        assert abs(exact_norm(one) - 1) <= 2e-16
        assert abs(exact_norm(many) - 1) <= 2e-16
        assert exact_turn(quat, one) <= LARGEST_TURN
        assert exact_turn(quat, many) <= LARGEST_TURN


@pytest.mark.parametrize('scale', [1e-300, 1.0, 1e300])
def test_rpy_and_matrix_of_a_quaternion_do_not_depend_on_its_norm(scale):
    given = random_quaternions(50) * scale
    for quat, rpy, matrix in zip(
        given, rotation.rpy_from_quaternion(given), rotation.matrix_from_quaternion(given),
        strict=True,
    ):
        assert exact_turn(quat, exact_quaternion(rpy)) <= LARGEST_TURN
        assert [float(value) for value in exact_matrix(quat)] == pytest.approx(
            matrix.ravel().tolist(), abs=5e-16
        )
        assert rotation.rpy_from_quaternion(quat.tolist()) == pytest.approx(rpy, abs=1e-15)


@all_sets
def test_matrix_from_rpy_is_right_to_the_last_digits(rpy_set):
    rpy = sample(rpy_set(60))
    for given, one, many in zip(
        rpy, one_by_one(rotation.matrix_from_rpy, rpy), rotation.matrix_from_rpy(rpy), strict=True
    ):
        expected = [float(value) for value in exact_matrix(exact_quaternion(given))]
        assert [value for row in one for value in row] == pytest.approx(expected, abs=6e-16)
        assert many.ravel().tolist() == pytest.approx(expected, abs=6e-16)


@all_sets
def test_quaternion_from_matrix_finds_the_rotation_again(rpy_set):
    quats = rotation.quaternion_from_rpy(sample(rpy_set(60)))
    matrices = rotation.matrix_from_quaternion(quats)
    ones = [rotation.quaternion_from_matrix(matrix.tolist()) for matrix in matrices]
    for given, one, many in zip(
        quats, ones, rotation.quaternion_from_matrix(matrices), strict=True
    ):
        assert exact_turn(given, one) <= LARGEST_TURN
        assert exact_turn(given, many) <= LARGEST_TURN


@pytest.mark.parametrize('short', [0.0, 1e-16, 1e-12, 1e-8, 1e-3])
def test_half_turns_about_all_axes_survive_every_representation(short):
    quats = half_turns() if short == 0.0 else half_turns(3.141592653589793 - short)
    through_matrix = rotation.quaternion_from_matrix(rotation.matrix_from_quaternion(quats))
    through_rpy = rotation.quaternion_from_rpy(rotation.rpy_from_quaternion(quats))
    assert largest_turn(quats, through_matrix) <= LARGEST_TURN
    assert largest_turn(quats, through_rpy) <= LARGEST_TURN
    for quat in quats[::7]:
        one = rotation.rpy_from_matrix(rotation.matrix_from_quaternion(tuple(quat)))
        assert exact_turn(quat, exact_quaternion(one)) <= LARGEST_TURN


@needs_long_double
def test_a_million_rotations_come_back():
    rpy = random_rpy(1_000_000)
    quats = rotation.quaternion_from_rpy(rpy)
    expected = extended_quaternions(rpy)
    assert largest_turn(expected, quats) <= LARGEST_TURN
    again = extended_quaternions(rotation.rpy_from_quaternion(quats))
    assert largest_turn(expected, again) <= LARGEST_TURN


@needs_long_double
@all_sets
def test_many_hard_rotations_come_back(rpy_set):
    rpy = rpy_set(40_000)
    quats = rotation.quaternion_from_rpy(rpy)
    expected = extended_quaternions(rpy)
    assert largest_turn(expected, quats) <= LARGEST_TURN
    again = extended_quaternions(rotation.rpy_from_quaternion(quats))
    assert largest_turn(expected, again) <= LARGEST_TURN


@needs_long_double
def test_a_hundred_thousand_matrices_come_back():
    quats = random_quaternions(100_000)
    again = rotation.quaternion_from_matrix(rotation.matrix_from_quaternion(quats))
    assert largest_turn(quats, again) <= LARGEST_TURN
