# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The text of a pose."""

import math

from matrices import assert_same_pose, matrix_from_degrees, matrix_from_rpy
import numpy as np
import pytest

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st

from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.sdformat.poses import (
    pose_doubts,
    pose_from_text,
    pose_numbers_from_text,
    PoseFormat,
    PoseTextError,
)

RPY = PoseFormat()
RPY_DEGREES = PoseFormat(is_degrees=True)
QUATERNION = PoseFormat(is_quaternion=True)
FORMATS = st.sampled_from([RPY, RPY_DEGREES, QUATERNION])

NUMBERS = st.floats(-1e3, 1e3, allow_subnormal=False)
UNUSUAL_WORDS = st.sampled_from([
    'nan', 'inf', '-inf', '1e999', '1e-320', '1e-400', '-0', '+0.0', '.5', '5.', '1e3', '1E-3',
    '0x10', '1_0', '1e', '.', '-', 'e5', '--1', '1,', 'abc', '\u0661', '1\u00a02', '1e200',
])
WORDS = st.one_of(NUMBERS.map(repr), NUMBERS.map(repr), NUMBERS.map(repr), UNUSUAL_WORDS)
TEXTS = st.one_of(
    st.lists(WORDS, max_size=8).map(' '.join),
    st.lists(NUMBERS.map(repr), min_size=6, max_size=7).map('\n '.join),
    st.sampled_from(['', ' ', '\n', '0 0 0 0 0 0 0', '0 0 0 1e-10 0 0 0', '0 0 0 0 0 0 1e160']),
)


def rpy(text):
    return [*pose_from_text(text, RPY)[0]]


def quaternion(text):
    return [*pose_from_text(text, QUATERNION)[0]]


# One text

@pytest.mark.parametrize('word', [
    'nan', 'NaN', 'inf', '-inf', 'infinity', '1e999', '-1e999', '1e-320', '-1e-320', '1e-400',
    '1e999m', '0x1p1024', ',1', 'true', ',', 'x', 'm1', '.', '+', '-', '+-1', '--1', '.e1',
    '\u0661', '\u22121', '(1)', '1e-400,',
])
def test_word_that_is_not_a_number_is_refused(word):
    with pytest.raises(PoseTextError) as caught:
        rpy(f'0 {word} 0 0 0 0')
    assert f'"{word}"' in str(caught.value)


@pytest.mark.parametrize(('pose_format', 'rule', 'counts'), [
    (RPY, '6 values .x y z roll pitch yaw', (1, 2, 3, 4, 5, 7, 8, 12)),
    (QUATERNION, '7 values .x y z qx qy qz qw', (1, 3, 4, 6, 8, 14))])
def test_other_count_than_that_of_the_format_is_refused(pose_format, rule, counts):
    for count in counts:
        with pytest.raises(PoseTextError, match=f'{rule}.*has {count}'):
            pose_from_text(' '.join(['1'] * count), pose_format)


@pytest.mark.parametrize(('word', 'number'), [
    ('-1.92s', '-1.92'), ('-0.125.75', '-0.125'), ('1.5m', '1.5'), ('1.2.3', '1.2'), ('1,5', '1'),
    ('1,', '1'), ('5deg', '5'), ('1e', '1'), ('1e+', '1'), ('1d3', '1'), ('0x10', '16'),
    ('0x1p3', '8'), ('0x', '0'), ('1_0', '1'), ('1-2', '1'), ('1/2', '1'), ('1e1.5', '10'),
    ('-1.57;', '-1.57'), ('1e-5x', '1e-05'),
])
def test_what_is_behind_a_number_is_ignored_with_a_warning(word, number):
    numbers, doubt = pose_numbers_from_text(f'0 0 {word} 0\n0 0', RPY)
    assert numbers == [0, 0, float(number), 0, 0, 0]
    assert doubt == f'the pose "0 0 {word} 0 0 0" is read as 0 0 {number} 0 0 0, as by Gazebo'


@pytest.mark.parametrize('text', [
    '', ' \n', '1 2 3 0 0 +1', '1e2 007 -0 0 0 0', f'{"1" * 300} 0 0 0 0 0'])
def test_numbers_that_are_read_as_written_are_not_doubted(text):
    assert pose_numbers_from_text(text, RPY)[1] == ''


@pytest.mark.parametrize(('text', 'pose_format', 'message'), [
    ('0 0 0 0 0 90', RPY, 'did you mean degrees="true"?'),
    ('0 0 0 0 0 0 2', QUATERNION, 'is not of length 1'),
])
def test_pose_that_may_mean_another_is_doubted(text, pose_format, message):
    numbers = np.array([pose_numbers_from_text(text, pose_format)[0]])
    ((_, doubt),) = pose_doubts([text], numbers, pose_format)
    assert message in doubt


@pytest.mark.parametrize('text', ['1 ' * 10_000, '1' * 2_000_000 + ' 0 0 0 0 0', '1' * 300])
def test_long_text_is_cut_in_the_message(text):
    with pytest.raises(PoseTextError) as caught:
        rpy(text)
    assert len(str(caught.value)) < 250


@pytest.mark.parametrize(('text', 'pose_format', 'message'), [
    *((text, QUATERNION, 'zero') for text in (
        '0 0 0 0 0 0 0', '1 2 3 1e-10 0 0 0', '0 0 0 0 -0 0 +0')),
    ('0 0 0 1.7e308 1.7e308 1.7e308 1.7e308', QUATERNION, 'range of a double'),
    *((f'{tiny} 0 0 0 0 0', RPY, 'range of a double') for tiny in (
        '1e-400', '1E-0400', '0.' + 400 * '0' + '1')),
    ('1 2 3 0 0 0 1', RPY, 'did you mean rotation_format="quat_xyzw"'),
    # Only ASCII white space separates numbers.
    *((separator.join('123000'), RPY, 'has 1') for separator in '\u00a0\u2003\u3000\u0085,'),
])
def test_wrong_numbers_are_refused_with_the_rule(text, pose_format, message):
    with pytest.raises(PoseTextError, match=message):
        pose_from_text(text, pose_format)


@pytest.mark.parametrize(('word', 'value'), [
    ('1e3', 1000.0), ('-2.5E-1', -0.25), ('+3', 3.0), ('.5', 0.5), ('5.', 5.0), ('-0', 0.0),
    ('007', 7.0), ('0e-400', 0.0), ('0e999', 0.0), ('1e308', 1e308),
    ('2.2250738585072014e-308', 2.2250738585072014e-308), ('-.5e+01', -5.0),
    ('0.1000000000000000055511151231257827021181583404541015625', 0.1),
])
def test_decimal_numbers(word, value):
    assert rpy(f'0 0 {word} 0 0 0')[2] == value


@pytest.mark.parametrize('text', ['', ' ', '\n\t\r '])
def test_blank_text_is_the_identity(text):
    assert rpy(text) == quaternion(text) == list(Pose())


@pytest.mark.parametrize('separator', ['  ', '\t', '\n', '\r\n', ' \n\t '])
def test_white_space_separates_numbers(separator):
    assert rpy(separator + separator.join('123000') + separator)[:3] == [1.0, 2.0, 3.0]


@pytest.mark.parametrize('size', ['1e-8', '1e150', '3e153', '1e200', '1e307'])
def test_length_of_a_quaternion_does_not_matter(size):
    assert quaternion(f'0 0 0 0 {size} 0 0')[3:] == pytest.approx((0, 1, 0, 0))


def test_roll_comes_first_and_about_fixed_axes():
    assert_same_pose(rpy('1 2 3 0.3 -0.4 1.2'), matrix_from_rpy(1, 2, 3, 0.3, -0.4, 1.2), 1e-15)


def test_only_angles_are_in_degrees():
    pose = [*pose_from_text('10 20 30 10 90 30', RPY_DEGREES)[0]]
    assert_same_pose(pose, matrix_from_degrees(10, 20, 30, 10, 90, 30), 1e-15)


# Any texts

@given(TEXTS, FORMATS)
def test_pose_that_is_read_has_the_numbers_of_its_words(text, pose_format):
    try:
        numbers, doubt = pose_numbers_from_text(text, pose_format)
    except PoseTextError:
        return
    words = text.split() or '0 0 0 0 0 0 1'.split()[:len(numbers)]
    assert doubt or list(numbers) == [*map(float, words)] or (
        pose_format.is_quaternion and math.hypot(*numbers[3:]) == pytest.approx(1.0))
