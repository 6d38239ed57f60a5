# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Conversion of one rotation, as in the service ConvertRotation."""

import math

import pytest
from rotation_sets import exact_angle

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st

from sdf_pose_bridge.geometry.converted_rotation import converted_rotation, RotationForm
from sdf_pose_bridge.geometry.rotations import quaternion_from_rpy, RotationError

NO_RPY = (0.0, 0.0, 0.0)
NO_QUATERNION = (0.0, 0.0, 0.0, 1.0)

angles = st.floats(allow_nan=False, allow_infinity=False)


def converted_rpy(*rpy, degrees=False):
    return converted_rotation(RotationForm.RPY, rpy, NO_QUATERNION, degrees=degrees)


def converted_quaternion(*quat_xyzw, degrees=False):
    return converted_rotation(RotationForm.QUATERNION, NO_RPY, quat_xyzw, degrees=degrees)


@pytest.mark.parametrize('unknown', [2, 255, -1])
def test_an_unknown_representation_is_an_error_that_lists_the_known_ones(unknown):
    with pytest.raises(RotationError, match=rf'given is {unknown}.*0 \(RPY\), 1 \(QUATERNION\)'):
        converted_rotation(unknown, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), degrees=False)


@pytest.mark.parametrize(('given', 'rpy', 'quat_xyzw'), [
    (RotationForm.RPY, NO_RPY, (0.0, 0.0, 0.7, 0.7)),
    (RotationForm.RPY, NO_RPY, (0.0, 0.0, math.nan, 1.0)),
    (RotationForm.RPY, (0.0, 0.0, 1.0), (0.0, 0.0, 0.7, 0.7)),
    (RotationForm.QUATERNION, (0.0, 0.0, 1.0), NO_QUATERNION),
    (RotationForm.QUATERNION, (0.0, math.nan, 0.0), NO_QUATERNION)])
def test_a_value_that_would_be_ignored_is_an_error_with_the_cure(given, rpy, quat_xyzw):
    with pytest.raises(RotationError, match=rf'given is {given.value} .*set given to {1 - given}'):
        converted_rotation(given, rpy, quat_xyzw, degrees=False)


def test_a_quaternion_of_zeros_is_unset():
    zeros = (0.0, 0.0, 0.0, 0.0)
    answer = converted_rotation(RotationForm.RPY, (0.0, 0.0, 1.0), zeros, degrees=False)
    assert answer.rpy == (0.0, 0.0, 1.0)


def test_yaw_alone():
    answer = converted_rpy(0.0, 0.0, 1.5708)
    assert answer.rpy == (0.0, 0.0, 1.5708)
    assert answer.quat_xyzw == pytest.approx((0.0, 0.0, 0.7071081, 0.7071055), abs=1e-7)
    assert not answer.gimbal_lock


def test_degrees_apply_to_input_and_output():
    answer = converted_rpy(0.0, 0.0, 90.0, degrees=True)
    assert answer.rpy == (0.0, 0.0, 90.0)
    assert answer.quat_xyzw == pytest.approx((0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))
    assert converted_quaternion(0.0, 0.0, 3.0, 3.0, degrees=True).rpy == (0.0, 0.0, 90.0)


@pytest.mark.parametrize(('rpy', 'expected'), [
    ((0.0, 0.0, 370.0), (0.0, 0.0, 10.0)),
    ((0.0, 0.0, 200.0), (0.0, 0.0, -160.0)),
    ((10.0, 100.0, 20.0), (-170.0, 80.0, -160.0)),
    ((0.0, 0.0, 3.6e17 + 64.0), (0.0, 0.0, 64.0)),
])
def test_angles_are_returned_in_their_ranges(rpy, expected):
    assert converted_rpy(*rpy, degrees=True).rpy == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize(('rpy', 'expected'), [
    ((10.0, 90.0, 20.0), (-10.0, 90.0, 0.0)),
    ((10.0, -90.0, 20.0), (30.0, -90.0, 0.0)),
])
def test_at_lock_yaw_is_zero_and_the_flag_is_set(rpy, expected):
    answer = converted_rpy(*rpy, degrees=True)
    assert answer.rpy == pytest.approx(expected, abs=1e-13)
    assert answer.rpy[1:] == expected[1:]
    assert answer.gimbal_lock


@pytest.mark.parametrize(('distance', 'expected'), [(2e-8, True), (7e-8, False)])
def test_the_flag_is_set_as_near_to_lock_as_by_gz_math(distance, expected):
    assert converted_rpy(0.1, 0.5 * math.pi - distance, 0.2).gimbal_lock is expected


@given(angles, angles, angles)
def test_both_representations_are_the_same_rotation(roll, pitch, yaw):
    answer = converted_rpy(roll, pitch, yaw)
    assert exact_angle(answer.quat_xyzw, quaternion_from_rpy(answer.rpy)) <= 2e-15
    assert all(type(value) is float for value in (*answer.rpy, *answer.quat_xyzw))
    assert max(abs(answer.rpy[0]), 2.0 * abs(answer.rpy[1]), abs(answer.rpy[2])) <= math.pi


@given(st.floats(-180.0, 180.0), st.floats(-89.0, 89.0), st.floats(-180.0, 180.0))
def test_angles_in_their_ranges_keep_their_digits(roll, pitch, yaw):
    assert converted_rpy(roll, pitch, yaw, degrees=True).rpy == (roll, pitch, yaw)
