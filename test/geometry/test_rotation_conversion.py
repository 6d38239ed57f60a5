# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""One rotation asked for and answered, as the service does it."""

import math

from hypothesis import given
from hypothesis import strategies as st
import pytest
from rotation_sets import exact_turn

from sdf_pose_bridge.geometry.rotation import quaternion_from_rpy
from sdf_pose_bridge.geometry.rotation import RotationError
from sdf_pose_bridge.geometry.rotation_conversion import converted_rotation
from sdf_pose_bridge.geometry.rotation_conversion import Given

NO_RPY = (math.nan, math.nan, math.nan)
NO_QUATERNION = (0.0, 0.0, 0.0, 0.0)

angles = st.floats(allow_nan=False, allow_infinity=False)


def of_rpy(*rpy, degrees=False):
    return converted_rotation(Given.RPY, rpy, NO_QUATERNION, degrees)


def of_quaternion(*quat_xyzw, degrees=False):
    return converted_rotation(Given.QUATERNION, NO_RPY, quat_xyzw, degrees)


@pytest.mark.parametrize('unknown', [2, 255, -1])
def test_an_unknown_kind_is_refused_with_the_known_ones(unknown):
    with pytest.raises(RotationError, match=rf'given is {unknown}.*0 \(RPY\), 1 \(QUATERNION\)'):
        converted_rotation(unknown, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), degrees=False)


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize('degrees', [False, True])
def test_angles_must_be_finite(bad, degrees):
    with pytest.raises(RotationError, match=f'{bad}.*not finite'):
        of_rpy(0.0, bad, 0.0, degrees=degrees)


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
def test_quaternions_must_be_finite(bad):
    with pytest.raises(RotationError, match=f'{bad}.*not finite'):
        of_quaternion(0.0, 0.0, bad, 1.0)


def test_a_zero_quaternion_is_refused():
    with pytest.raises(RotationError, match='zero'):
        of_quaternion(0.0, 0.0, 0.0, 0.0)


def test_the_commonest_question():
    answer = of_rpy(0.0, 0.0, 1.5708)
    assert answer.rpy == (0.0, 0.0, 1.5708)
    assert answer.quat_xyzw == pytest.approx((0.0, 0.0, 0.7071081, 0.7071055), abs=1e-7)
    assert not answer.gimbal_lock


def test_degrees_hold_for_what_is_given_and_what_comes_back():
    answer = of_rpy(0.0, 0.0, 90.0, degrees=True)
    assert answer.rpy == (0.0, 0.0, 90.0)
    assert answer.quat_xyzw == pytest.approx((0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))
    assert of_quaternion(0.0, 0.0, 3.0, 3.0, degrees=True).rpy == (0.0, 0.0, 90.0)


@pytest.mark.parametrize(('rpy', 'expected'), [
    ((0.0, 0.0, 370.0), (0.0, 0.0, 10.0)),
    ((0.0, 0.0, 200.0), (0.0, 0.0, -160.0)),
    ((10.0, 100.0, 20.0), (-170.0, 80.0, -160.0)),
    ((0.0, 0.0, 3.6e17 + 64.0), (0.0, 0.0, 64.0)),
])
def test_angles_come_back_in_their_ranges(rpy, expected):
    assert of_rpy(*rpy, degrees=True).rpy == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize(('rpy', 'expected'), [
    ((10.0, 90.0, 20.0), (-10.0, 90.0, 0.0)),
    ((10.0, -90.0, 20.0), (30.0, -90.0, 0.0)),
])
def test_at_lock_roll_takes_the_sum_and_the_flag_is_set(rpy, expected):
    answer = of_rpy(*rpy, degrees=True)
    assert answer.rpy == pytest.approx(expected, abs=1e-13)
    assert answer.rpy[1:] == expected[1:]
    assert answer.gimbal_lock


def test_a_quaternion_comes_back_unit_with_w_not_negative():
    assert of_quaternion(0.0, -2.0, 0.0, -0.0).quat_xyzw == (0.0, 1.0, 0.0, 0.0)
    assert of_quaternion(1e-300, 0.0, 0.0, -1e-300).quat_xyzw == pytest.approx(
        (-math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
    )


@given(angles, angles, angles)
def test_both_answers_are_the_same_rotation(roll, pitch, yaw):
    answer = of_rpy(roll, pitch, yaw)
    assert exact_turn(answer.quat_xyzw, quaternion_from_rpy(answer.rpy)) <= 2e-15
    assert all(type(value) is float for value in (*answer.rpy, *answer.quat_xyzw))
    assert max(abs(answer.rpy[0]), 2.0 * abs(answer.rpy[1]), abs(answer.rpy[2])) <= math.pi


@given(st.floats(-180.0, 180.0), st.floats(-89.0, 89.0), st.floats(-180.0, 180.0))
def test_angles_within_their_ranges_come_back_as_they_are(roll, pitch, yaw):
    assert of_rpy(roll, pitch, yaw, degrees=True).rpy == (roll, pitch, yaw)
