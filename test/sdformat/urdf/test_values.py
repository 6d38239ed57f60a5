# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers and angles as libsdformat's conversion of URDF reads and writes them."""

import math

from lxml import etree
from matrices import matrix_from_rpy
import numpy as np
import pytest

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st

from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.sdformat.grammar import Definition
from sdf_pose_bridge.sdformat.urdf.values import (
    is_true,
    NotFiniteError,
    numbers_of,
    pose_from_xyz_rpy,
    rpy_by_gz_math,
    rpy_by_urdfdom,
    text_from_numbers,
)

ANGLES = st.floats(-4, 4) | st.sampled_from([0.0, math.pi / 2, -math.pi / 2, 1.5707963, 1.57])


def read(content, **attributes):
    rules = Definition('a', content).attributes.values()
    return numbers_of(etree.Element('a', attributes), rules)


@pytest.mark.parametrize(('text', 'numbers'), [
    ('1 2 3', [1, 2, 3]), (' 1.  -2e1   +3 ', [1, -20, 3]), ('1m 2 3', [1, 2, 3]),
    ('0x10 2 3', [16, 2, 3]),
])
def test_numbers_are_read_as_by_strtod(text, numbers):
    assert read('@x:vector3 @y:double', x=text) == {'x': numbers}


@pytest.mark.parametrize(('attributes', 'content', 'message'), [
    *(({'x': text}, '@x:vector3', 'is not three numbers')
      for text in ('', '1 2', '1 2 3 4', '1 2 x', '1 2 1e999')),
    *(({'x': text}, '@x:double', 'is not a number')
      for text in ('', ' ', 'x 1', '1e999', 'true')),
    ({}, '@x!:double', '<a> has no x'),
])
def test_what_is_no_number(attributes, content, message):
    with pytest.raises(ValueError, match=message):
        read(content, **attributes)


@pytest.mark.parametrize('text', ['1 2 nan', '-inf 0 0'])
def test_three_numbers_must_be_finite(text):
    with pytest.raises(NotFiniteError, match='must be finite'):
        read('@x:vector3', x=text)


@pytest.mark.parametrize(('text', 'number'), [
    (' 1  2 3', 1), ('\t0x10', 16), ('1.5kg', 1.5), ('1 x', 1), ('inf 0', math.inf)])
def test_single_number_is_what_the_text_begins_with(text, number):
    assert read('@x!:double', x=text) == {'x': [number]}


@pytest.mark.parametrize(('text', 'expected'), [
    ('<a>true</a>', True), ('<a> Yes\n</a>', True), ('<a value="1">0</a>', True),
    ('<a>on</a>', False), ('<a/>', False), ('<a value=""/>', False),
])
def test_options(text, expected):
    assert is_true(etree.fromstring(text)) is expected


@pytest.mark.parametrize(('digits', 'expected'), [
    (16, '0.3333333333333333 0 1e-05 inf'), (6, '0.333333 0 1e-05 inf'),
])
def test_text_of_numbers(digits, expected):
    assert text_from_numbers([1 / 3, 0.0, 1e-5, math.inf], digits) == expected


@pytest.mark.parametrize(('function', 'tolerance'), [
    (rpy_by_gz_math, 1e-7), (rpy_by_urdfdom, 6e-3)])
@given(rpy=st.tuples(ANGLES, ANGLES, ANGLES))
def test_angles_are_the_rotation(function, tolerance, rpy):
    angles = function(pose_from_xyz_rpy([0, 0, 0], list(rpy)))
    np.testing.assert_allclose(
        matrix_from_rpy(0, 0, 0, *angles), matrix_from_rpy(0, 0, 0, *rpy), atol=tolerance)


def test_rounding_decides_the_sign_of_half_a_turn_as_in_urdfdom():
    roll, pitch, yaw = rpy_by_urdfdom(pose_from_xyz_rpy([0, 0, 0], [0.0, 3.14, 3.14]))
    assert roll == math.pi
    assert (pitch, yaw) == pytest.approx((math.pi - 3.14, 3.14 - math.pi), abs=1e-15)


def test_quaternion_has_the_sign_of_libsdformat():
    assert pose_from_xyz_rpy([0, 0, 0], [0, 0, 5.0]).qw == pytest.approx(math.cos(2.5))


def test_pose_from_xyz_rpy():
    assert pose_from_xyz_rpy([1, 2, 3], [math.pi, 0, 0]) == pytest.approx(
        Pose(1, 2, 3, 1, 0, 0, 0))
