# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Accuracy of the conversions: against references with 50 digits, and for many rotations."""

import math

import numpy as np
import pytest
from rotation_sets import (
    exact_angle,
    exact_matrix,
    exact_norm,
    exact_quaternion,
    extended_quaternions,
    half_turns,
    HAS_LONG_DOUBLE,
    largest_angle,
    MAX_ANGLE,
    random_quaternions,
    RPY_SETS,
)
from sizes import size

from sdf_pose_bridge.geometry.rotations import (
    canonical_quaternion,
    matrix_from_quaternion,
    quaternion_from_matrix,
    quaternion_from_rotation_vector,
    quaternion_from_rpy,
    rotation_vector_from_quaternion,
    rpy_from_quaternion,
)

LAST_BIT = 1.2e-16
"""Largest error of the norm of a quaternion that is unit to the last bit."""

all_sets = pytest.mark.parametrize('rpy_set', RPY_SETS.values(), ids=RPY_SETS)
needs_long_double = pytest.mark.skipif(
    not HAS_LONG_DOUBLE, reason='long double has no more digits than double on this machine')


def one_and_many(function, rows):
    """Give each row, its conversion by itself, and the one among all."""
    ones = (function(tuple(row)) for row in rows.tolist())
    return zip(rows, ones, function(rows), strict=True)


def sample(rows, count=60):
    return rows[:: max(1, len(rows) // count)]


@all_sets
def test_quaternion_from_rpy_is_exact_to_the_last_digits(rpy_set):
    for given, one, many in one_and_many(quaternion_from_rpy, sample(rpy_set(60))):
        expected = exact_quaternion(given)
        assert exact_angle(expected, one) <= MAX_ANGLE
        assert exact_angle(expected, many) <= MAX_ANGLE


@all_sets
def test_rpy_from_quaternion_is_exact_to_the_last_digits(rpy_set):
    quats = quaternion_from_rpy(sample(rpy_set(60)))
    for given, one, many in one_and_many(rpy_from_quaternion, quats):
        assert exact_angle(given, exact_quaternion(one)) <= MAX_ANGLE
        assert exact_angle(given, exact_quaternion(many)) <= MAX_ANGLE


@pytest.mark.parametrize('scale', [1e-300, 1e-150, 0.7, 1.0, 3e77, 1e300])
def test_canonical_quaternions_of_any_norm_are_unit_to_the_last_digit(scale):
    given = random_quaternions(50) * scale
    for quat, one, many in one_and_many(canonical_quaternion, given):
        assert abs(exact_norm(one) - 1) <= LAST_BIT
        assert abs(exact_norm(many) - 1) <= LAST_BIT
        assert exact_angle(quat, one) <= MAX_ANGLE
        assert exact_angle(quat, many) <= MAX_ANGLE


@pytest.mark.parametrize('scale', [1e-300, 1.0, 1e300])
def test_rpy_and_matrix_of_a_quaternion_do_not_depend_on_its_norm(scale):
    given = random_quaternions(50) * scale
    for quat, rpy, matrix in zip(
        given, rpy_from_quaternion(given), matrix_from_quaternion(given),
        strict=True,
    ):
        assert exact_angle(quat, exact_quaternion(rpy)) <= MAX_ANGLE
        assert [float(value) for value in exact_matrix(quat)] == pytest.approx(
            matrix.ravel().tolist(), abs=5e-16
        )
        assert rpy_from_quaternion(quat.tolist()) == pytest.approx(rpy, abs=1e-15)


@pytest.mark.parametrize('missing', [0.0, 1e-16, 1e-12, 1e-8, 1e-3])
def test_half_turns_about_all_axes_survive_every_representation(missing):
    quats = half_turns(math.pi - missing)
    through_matrix = quaternion_from_matrix(matrix_from_quaternion(quats))
    through_rpy = quaternion_from_rpy(rpy_from_quaternion(quats))
    assert largest_angle(quats, through_matrix) <= MAX_ANGLE
    assert largest_angle(quats, through_rpy) <= MAX_ANGLE


@needs_long_double
@all_sets
def test_many_difficult_rotations_survive_a_round_trip(rpy_set):
    rpy = rpy_set(size(10_000, 100_000))
    quats = quaternion_from_rpy(rpy)
    assert (abs(np.linalg.norm(quats.astype(np.longdouble), axis=1) - 1) <= LAST_BIT).all()
    expected = extended_quaternions(rpy)
    assert largest_angle(expected, quats) <= MAX_ANGLE
    again = extended_quaternions(rpy_from_quaternion(quats))
    assert largest_angle(expected, again) <= MAX_ANGLE


@needs_long_double
def test_very_many_matrices_survive_a_round_trip():
    quats = random_quaternions(size(20_000, 1_000_000))
    again = quaternion_from_matrix(matrix_from_quaternion(quats))
    assert largest_angle(quats, again) <= MAX_ANGLE


@all_sets
def test_rotation_vectors_survive_a_round_trip(rpy_set):
    quats = quaternion_from_rpy(rpy_set(2000))
    vectors = rotation_vector_from_quaternion(quats)
    assert largest_angle(quaternion_from_rotation_vector(vectors), quats) <= MAX_ANGLE
    for quat, vector in zip(sample(quats), sample(vectors), strict=True):
        assert exact_angle(quaternion_from_rotation_vector(tuple(vector)), quat) <= (
            MAX_ANGLE)
