# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Sequences of rotations about three axes, compared with products of matrices."""

import itertools
import math

from matrices import axis_rotation
import numpy as np
import pytest
from rotation_sets import largest_angle, MAX_ANGLE, RPY_SETS

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st

from sdf_pose_bridge.geometry.formats import format_from_name, POSE_FORMATS, ROTATION_FORMATS
from sdf_pose_bridge.geometry.rotations import matrix_from_quaternion, quaternion_from_rpy

AXES = {axes: format_from_name(f'r{axes}', ROTATION_FORMATS).sequence
        for axes in map(''.join, itertools.product('xyz', repeat=3))
        if axes[0] != axes[1] != axes[2]}
every_sequence = pytest.mark.parametrize('axes', AXES)
angle = st.floats(-7.0, 7.0)


@pytest.mark.parametrize('name', [*POSE_FORMATS, *ROTATION_FORMATS])
def test_a_format_has_one_of_these_sequences_or_none(name):
    sequence = {**POSE_FORMATS, **ROTATION_FORMATS}[name].sequence
    assert sequence is None or any(sequence is each for each in AXES.values())


@every_sequence
@given(first=angle, middle=angle, last=angle)
def test_each_rotation_is_about_an_axis_that_the_ones_before_have_turned(
        axes, first, middle, last):
    quats = AXES[axes].quaternions_from_numbers(np.array([[first, middle, last]]))
    expected = np.eye(4)
    for axis, value in zip(axes, (first, middle, last), strict=True):
        expected = expected @ axis_rotation('xyz'.index(axis), value)
    assert matrix_from_quaternion(quats)[0] == pytest.approx(expected[:3, :3], abs=4e-15)


@every_sequence
@pytest.mark.parametrize('rpy', RPY_SETS)
def test_angles_are_the_rotation_and_in_their_ranges(axes, rpy):
    sequence, quats = AXES[axes], quaternion_from_rpy(RPY_SETS[rpy](500))
    angles = sequence.numbers_from_quaternions(quats)
    assert largest_angle(quats, sequence.quaternions_from_numbers(angles)) <= 2 * MAX_ANGLE
    lowest = 0.0 if axes[0] == axes[2] else -0.5 * math.pi
    assert np.abs(angles).max() <= math.pi
    assert angles[:, 1].min() >= lowest
    assert angles[:, 1].max() <= lowest + math.pi


@every_sequence
@pytest.mark.parametrize('is_upper', [False, True])
def test_at_lock_the_first_angle_is_zero(axes, is_upper):
    sequence = AXES[axes]
    middle = (math.pi if axes[0] == axes[2] else 0.5 * math.pi) if is_upper else (
        0.0 if axes[0] == axes[2] else -0.5 * math.pi)
    quats = sequence.quaternions_from_numbers(np.array([[0.4, middle, 0.3]]))
    assert sequence.near_lock(quats[np.newaxis]).all()
    assert not sequence.are_canonical((0.4, middle, 0.3), math.pi)
    first, at_lock, last = sequence.numbers_from_quaternions(quats)[0]
    assert (first, at_lock) == (0.0, middle)
    assert min(abs(last - 0.7), abs(last + 0.1)) < 1e-15


@every_sequence
def test_other_angles_are_not_near_lock(axes):
    angles = np.array([[math.pi, 0.1, -math.pi]])
    assert not AXES[axes].near_lock(AXES[axes].quaternions_from_numbers(angles)).any()
    assert AXES[axes].are_canonical(tuple(angles[0]), math.pi)
