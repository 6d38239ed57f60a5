# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Values of poses: what is a number, how many there are, and what they mean."""

import math
import re

from hypothesis import given
from hypothesis import strategies as st
from matrices import assert_same_pose
from matrices import matrix_from_degrees
from matrices import matrix_from_pose
from matrices import matrix_from_rpy
import numpy as np
import pytest

from sdf_pose_bridge.sdformat.pose_text import IDENTITY
from sdf_pose_bridge.sdformat.pose_text import pose_from_text
from sdf_pose_bridge.sdformat.pose_text import poses_from_texts
from sdf_pose_bridge.sdformat.pose_text import PoseText
from sdf_pose_bridge.sdformat.pose_text import PoseTextError

NUMBERS = st.floats(-1e3, 1e3, allow_subnormal=False)
ODD_TOKENS = st.sampled_from([
    'nan', 'inf', '-inf', '1e999', '1e-320', '1e-400', '-0', '+0.0', '.5', '5.', '1e3', '1E-3',
    '0x10', '1_0', '1e', '.', '-', 'e5', '--1', '1,', 'abc', '\u0661', '1\u00a02', '1e200',
])
TOKENS = st.one_of(NUMBERS.map(repr), NUMBERS.map(repr), NUMBERS.map(repr), ODD_TOKENS)
TEXTS = st.builds(
    PoseText,
    st.one_of(
        st.lists(TOKENS, max_size=8).map(' '.join),
        st.lists(NUMBERS.map(repr), min_size=6, max_size=7).map('\n '.join),
        st.sampled_from([
            '', ' ', '\n', '0 0 0 0 0 0 0', '0 0 0 1e-10 0 0 0', '0 0 0 0 0 0 1e160']),
    ),
    st.booleans(),
    st.just(False),
).flatmap(lambda text: st.booleans().map(
    lambda is_degrees: text._replace(is_degrees=is_degrees and not text.is_quaternion)))

PLAIN_TEXTS = st.lists(
    st.one_of(NUMBERS.map(repr), st.sampled_from(['1e999', '1e-320', '1e-400', '-0'])),
    min_size=5, max_size=8).map(' '.join)


def rpy(text, *, is_degrees=False):
    return pose_from_text(PoseText(text, False, is_degrees))


def quaternion(text):
    return pose_from_text(PoseText(text, True, False))


@pytest.mark.parametrize('token', [
    'nan', 'NaN', 'inf', '-inf', 'infinity', '1e999', '-1e999', '1e-320', '-1e-320', '1e-400',
    '0x10', '0x1p3', '1.5abc', '1,', '1_000', '1e', '1e+', '1d3', 'true', ',', 'x', '.', '+', '-',
    '+-1', '--1', '.e1', '1.2.3', '1e1.5', '1/2', '\u0661', '1\u00a0', '\u22121', '1f', '(1)',
])
def test_what_is_no_number(token):
    with pytest.raises(PoseTextError) as caught:
        rpy(f'0 {token} 0 0 0 0')
    assert f'"{token}"' in str(caught.value)


@pytest.mark.parametrize(('token', 'value'), [
    ('1e3', 1000.0), ('-2.5E-1', -0.25), ('+3', 3.0), ('.5', 0.5), ('5.', 5.0), ('-0', 0.0),
    ('007', 7.0), ('0e-400', 0.0), ('0e999', 0.0), ('1e308', 1e308),
    ('2.2250738585072014e-308', 2.2250738585072014e-308), ('-.5e+01', -5.0),
    ('0.1000000000000000055511151231257827021181583404541015625', 0.1),
])
def test_numbers(token, value):
    assert rpy(f'0 0 {token} 0 0 0')[2] == value


@pytest.mark.parametrize('count', [1, 2, 3, 4, 5, 7, 8, 12])
def test_roll_pitch_yaw_are_three(count):
    with pytest.raises(PoseTextError, match=f'6 values .x y z roll pitch yaw.*has {count}'):
        rpy(' '.join(['1'] * count))


@pytest.mark.parametrize('count', [1, 3, 4, 6, 8, 14])
def test_quaternions_are_four(count):
    with pytest.raises(PoseTextError, match=f'7 values .x y z qx qy qz qw.*has {count}'):
        quaternion(' '.join(['1'] * count))


def test_commas_do_not_part_numbers():
    with pytest.raises(PoseTextError):
        rpy('1,2,3,0,0,0')


def test_a_long_text_is_cut_in_the_message():
    with pytest.raises(PoseTextError) as caught:
        rpy('1 ' * 10_000)
    assert len(str(caught.value)) < 250


@pytest.mark.parametrize('text', ['0 0 0 0 0 0 0', '1 2 3 1e-10 0 0 0', '0 0 0 0 -0 0 +0'])
def test_a_zero_quaternion_is_no_rotation(text):
    with pytest.raises(PoseTextError, match='zero'):
        quaternion(text)


@pytest.mark.parametrize('text', ['', ' ', '\n\t\r '])
def test_nothing_is_the_identity(text):
    assert rpy(text) == quaternion(text) == IDENTITY


@pytest.mark.parametrize('gap', ['  ', '\t', '\n', '\r\n', ' \n\t '])
def test_white_space_parts_numbers(gap):
    assert rpy(gap + gap.join('123000') + gap)[:3] == (1.0, 2.0, 3.0)


@pytest.mark.parametrize('gap', ['\u00a0', '\u2003', '\u3000', '\u0085', ','])
def test_nothing_else_parts_numbers(gap):
    with pytest.raises(PoseTextError):
        rpy(gap.join('123000'))


def test_w_is_the_last_of_a_quaternion():
    assert quaternion('1 2 3 0 0 0 1') == (1, 2, 3, 0, 0, 0, 1)


def test_quaternions_are_normalised():
    assert quaternion('0 0 0 0 0 2 2')[3:] == pytest.approx((0, 0, math.sqrt(0.5), math.sqrt(0.5)))


@pytest.mark.parametrize('size', ['1e-8', '1e150', '3e153', '1e200', '1e307'])
def test_the_length_of_a_quaternion_does_not_matter(size):
    assert quaternion(f'0 0 0 0 {size} 0 0')[3:] == pytest.approx((0, 1, 0, 0))


def test_roll_comes_first_and_about_fixed_axes():
    assert_same_pose(rpy('1 2 3 0.3 -0.4 1.2'), matrix_from_rpy(1, 2, 3, 0.3, -0.4, 1.2), 1e-15)


def test_the_formula_of_the_specification():
    half = [angle / 2 for angle in (0.3, -0.4, 1.2)]
    cr, cp, cy = map(math.cos, half)
    sr, sp, sy = map(math.sin, half)
    assert rpy('0 0 0 0.3 -0.4 1.2')[3:] == pytest.approx((
        sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy), abs=1e-15)


def test_degrees_are_for_angles_only():
    pose = rpy('10 20 30 10 90 30', is_degrees=True)
    assert_same_pose(pose, matrix_from_degrees(10, 20, 30, 10, 90, 30), 1e-15)


@given(st.tuples(*[NUMBERS] * 6))
def test_any_roll_pitch_yaw(values):
    matrix = matrix_from_pose(rpy(' '.join(map(repr, values))))
    np.testing.assert_allclose(matrix, matrix_from_rpy(*values), atol=1e-12)


def one_by_one(texts):
    """Return what :func:`poses_from_texts` should: poses, and reasons by index."""
    poses = []
    reasons = {}
    for index, text in enumerate(texts):
        try:
            poses.append(pose_from_text(text))
        except PoseTextError as error:
            reasons[index] = str(error)
            poses.append(IDENTITY)
    return np.array(poses).reshape(-1, 7), reasons


def assert_read_as_one_by_one(texts):
    poses, failures = poses_from_texts(
        [pose.text for pose in texts],
        quaternions=[index for index, pose in enumerate(texts) if pose.is_quaternion],
        degrees=[index for index, pose in enumerate(texts) if pose.is_degrees])
    expected, reasons = one_by_one(texts)
    assert failures == sorted(reasons.items())
    np.testing.assert_allclose(poses, expected, rtol=1e-15, atol=1e-15)


@given(st.lists(TEXTS, max_size=40))
def test_many_are_read_as_one_by_one(texts):
    assert_read_as_one_by_one(texts)


@given(st.lists(PLAIN_TEXTS, min_size=1, max_size=40), st.booleans(), st.booleans())
def test_many_plain_ones_are_read_as_one_by_one(texts, is_quaternion, is_degrees):
    assert_read_as_one_by_one([
        PoseText(text, is_quaternion, is_degrees and not is_quaternion) for text in texts])


@pytest.mark.parametrize('tiny', ['1e-400', '1E-0400', '0.' + 400 * '0' + '1'])
def test_what_became_zero_is_told_among_good_ones(tiny):
    good = '1 2 3 0 0 0'
    poses, failures = poses_from_texts([good, f'{tiny} 0 0 0 0 0', good])
    assert [index for index, _ in failures] == [1]
    assert poses[2, :3].tolist() == [1, 2, 3]


def test_failures_stand_in_order_and_tell_the_text():
    good = '1 2 3 0 0 0'
    poses, failures = poses_from_texts([good, '1 2', good, '1 2 x 0 0 0'])
    assert [index for index, _ in failures] == [1, 3]
    assert re.search('"1 2".*has 2', failures[0][1])
    assert '"x"' in failures[1][1]
    assert poses[1].tolist() == poses[3].tolist() == list(IDENTITY)
    assert poses[2, :3].tolist() == [1, 2, 3]


def test_no_poses():
    poses, failures = poses_from_texts([])
    assert poses.shape == (0, 7)
    assert failures == []
