# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers and angles as libsdformat's conversion of URDF reads and writes them."""

import math

from lxml import etree
from matrices import assert_close, matrix_from_rpy
import pytest

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st

from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.sdformat.grammar import Definition
from sdf_pose_bridge.sdformat.urdf.values import (
    is_true,
    numbers_of_attributes,
    pose_from_xyz_rpy,
    rpy_by_gz_math,
    rpy_by_urdfdom,
    text_from_numbers,
)

ANGLES = st.floats(-4, 4) | st.sampled_from([0.0, math.pi / 2, -math.pi / 2, 1.5707963, 1.57])

NO_NUMBERS = ('x', '1m', '1,5', '0x1', '1_0', '1e', '1.5.2', '1e999', 'inf', 'nan', '--1', '.',
              'true', '1\t', '\u0661', '\xa01')


def read(content, **attributes):
    rules = Definition('a', content).attributes.values()
    return numbers_of_attributes(etree.Element('a', attributes), rules)


@pytest.mark.parametrize(('text', 'numbers'), [
    ('1 2 3', [1, 2, 3]), (' 1.  -2e1   +3 ', [1, -20, 3]), ('\t1 .5 \n2E+1', [1, 0.5, 20]),
    ('1e-400 -0 007', [0, 0, 7]),
])
def test_numbers_are_read_as_by_urdfdom(text, numbers):
    assert read('@x:vector3 @y:double', x=text) == {'x': numbers}
    words = [word for word in text.split(' ') if word]
    assert [read('@x!:double', x=word)['x'] for word in words] == [[each] for each in numbers]


@pytest.mark.parametrize(('attributes', 'content', 'message'), [
    *(({'x': text}, '@x:vector3', 'must be three numbers such as')
      for text in ('', '1 2', '1 2 3 4', '1 x 2 3', '1, 2, 3', '1\t2 3 4', '1\n 2 3',
                   *(f'1 2 {text}' for text in NO_NUMBERS))),
    *(({'x': text}, '@x:double', 'must be a number such as')
      for text in ('', ' ', '1 ', '1 2', *NO_NUMBERS)),
    ({}, '@x!:double', '<a> has no x'),
])
def test_what_is_no_number(attributes, content, message):
    with pytest.raises(ValueError, match=message):
        read(content, **attributes)


@pytest.mark.parametrize(('text', 'expected'), [
    ('<a>true</a>', True), ('<a> Yes\n</a>', True), ('<a value="1">0</a>', True),
    ('<a>on</a>', False), ('<a/>', False), ('<a value=""/>', False),
    ('<a><!-- c -->true</a>', False), ('<a> <!-- c -->true</a>', False),
    ('<a>true<!-- c --></a>', True), ('<a><!---->1<?end?></a>', True),
])
def test_options(text, expected):
    assert is_true(etree.fromstring(text)) is expected


@pytest.mark.parametrize(('digits', 'expected'), [
    ([], '0.3333333333333333 0 1e-05 inf'), ([6], '0.333333 0 1e-05 inf'),
])
def test_text_of_numbers(digits, expected):
    assert text_from_numbers([1 / 3, 0.0, 1e-5, math.inf], *digits) == expected


@pytest.mark.parametrize(('function', 'tolerance'), [
    (rpy_by_gz_math, 1e-7), (rpy_by_urdfdom, 6e-3)])
@given(rpy=st.tuples(ANGLES, ANGLES, ANGLES))
def test_angles_are_the_rotation(function, tolerance, rpy):
    angles = function(pose_from_xyz_rpy([0, 0, 0], list(rpy)))
    assert_close(
        matrix_from_rpy(0, 0, 0, *angles), matrix_from_rpy(0, 0, 0, *rpy), tolerance)


def test_rounding_decides_the_sign_of_half_a_turn_as_in_urdfdom():
    roll, pitch, yaw = rpy_by_urdfdom(pose_from_xyz_rpy([0, 0, 0], [0.0, 3.14, 3.14]))
    assert roll == math.pi
    assert (pitch, yaw) == pytest.approx((math.pi - 3.14, 3.14 - math.pi), abs=1e-15)


def test_quaternion_has_the_sign_of_libsdformat():
    assert pose_from_xyz_rpy([0, 0, 0], [0, 0, 5.0]).qw == pytest.approx(math.cos(2.5))


def test_pose_from_xyz_rpy():
    assert pose_from_xyz_rpy([1, 2, 3], [math.pi, 0, 0]) == pytest.approx(
        Pose(1, 2, 3, 1, 0, 0, 0))
