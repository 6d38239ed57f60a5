# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Values that no pose depends on, but that libsdformat refuses."""

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
from sdf_texts import codes_of
from sdf_texts import link_with
from sdf_texts import model_file
from sdf_texts import only_error
from sdf_texts import TWO_LINKS
from sdf_texts import world_file

from sdf_pose_bridge import load_text
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.sdformat.grammar import ValueType
from sdf_pose_bridge.sdformat.values import boolean_from_text
from sdf_pose_bridge.sdformat.values import is_of_type
from sdf_pose_bridge.sdformat.values import pose_from_text
from sdf_pose_bridge.sdformat.values import PoseFormat
from sdf_pose_bridge.sdformat.values import poses_from_texts
from sdf_pose_bridge.sdformat.values import PoseTextError


def visual(content):
    return link_with(f'<visual name="v">{content}</visual>')


def material(content):
    return visual(f'<material>{content}</material>')


def box(size):
    return visual(f'<geometry><box><size>{size}</size></box></geometry>')


def axis(content):
    return model_file(
        TWO_LINKS + '<joint name="j" type="revolute"><parent>a</parent><child>b</child>'
        f'<axis>{content}</axis></joint>')


def surface(content):
    return link_with(f'<collision name="c"><surface>{content}</surface></collision>')


def ode(content):
    return surface(f'<friction><ode>{content}</ode></friction>')


@pytest.mark.parametrize('text', [
    link_with('<inertial><mass>heavy</mass></inertial>'),
    link_with('<inertial><mass>,</mass></inertial>'),
    link_with('<inertial><mass>1e400</mass></inertial>'),
    link_with('<inertial><mass>-1e400</mass></inertial>'),
    link_with('<inertial><mass>1e-400</mass></inertial>'),
    link_with('<gravity>maybe</gravity>'),
    world_file('<gravity/>'),
    world_file('<physics type="ode"><max_step_size> </max_step_size></physics>'),
    world_file('<atmosphere type="thin"/>'),
    world_file('<gui><camera name="c"><pose rotation_format="x"/></camera></gui>'),
    box(''),
    box('1 1'),
    box('1 x 1 1'),
    box('1,1,1'),
    box('1 1 \u0661'),
    visual('<transparency>,</transparency>'),
    visual('<transparency>\u0661</transparency>'),
    visual('<transparency>\u00bd</transparency>'),
    visual('<visibility_flags>x1</visibility_flags>'),
    visual('<visibility_flags>.5</visibility_flags>'),
    visual('<visibility_flags>\u0661</visibility_flags>'),
    material('<ambient>1 1</ambient>'),
    material('<ambient>1 1 2 1</ambient>'),
    material('<ambient>1 1 5e-0_1</ambient>'),
    material('<ambient>1 1 1 1 1</ambient>'),
    material('<ambient>1 1 1 red</ambient>'),
    material('<ambient>1 1 -0.1</ambient>'),
    axis('<xyz>0 0 0</xyz>'),
    axis('<xyz>0 1</xyz>'),
    axis('<xyz>0 0 1</xyz><limit><lower>low</lower></limit>'),
    ode('<mu>-1</mu>'),
    surface('<bounce><restitution_coefficient>1.1</restitution_coefficient></bounce>'),
    model_file('<static>maybe</static><link name="l"/>'),
    model_file('<link name="l"/><static>2</static>'),
    model_file('<static>-1</static><link name="l"/>'),
])
def test_wrong_value_is_refused(text):
    assert codes_of(text) == ['ELEMENT_INVALID']


@pytest.mark.parametrize('text', [
    link_with('<light name="x"/>'),
    link_with('<sensor name="x"/>'),
    model_file('<link name="l"/><plugin name="p"/>'),
    model_file('<link name="l"/><gripper/>'),
    model_file(TWO_LINKS + '<joint name="j"><parent>a</parent><child>b</child></joint>'),
])
def test_missing_attribute_is_refused(text):
    assert codes_of(text) == ['ATTRIBUTE_MISSING']


@pytest.mark.parametrize('text', [
    link_with('<sensor name="x" type=""/>'),
    link_with('<light name="x" type=" "/>'),
    model_file('<link name="l"/><plugin name="p" filename=""/>'),
    model_file('<link name="l"/><gripper name=""/>'),
])
def test_empty_attribute_that_is_required_is_refused(text):
    assert codes_of(text) == ['ATTRIBUTE_INVALID']


@pytest.mark.parametrize('text', [
    link_with('<inertial auto="maybe"/>'),
    '<sdf version="1.10"><world name="w"><gui fullscreen="2"/></world></sdf>',
])
def test_attribute_of_another_type_is_refused(text):
    assert codes_of(text) == ['ATTRIBUTE_INVALID']


@pytest.mark.parametrize('text', [
    link_with('<inertial><mass> 1.5kg </mass></inertial>'),
    link_with('<inertial><mass/></inertial>'),
    link_with('<inertial><mass> \n </mass></inertial>'),
    link_with('<inertial><mass>true</mass></inertial>'),
    link_with('<inertial><mass>1_000</mass></inertial>'),
    link_with('<gravity>1</gravity>'),
    box('1 1 1 1'),
    visual('<visibility_flags>0x0F</visibility_flags>'),
    visual('<transparency>-.5</transparency>'),
    visual('<transparency>5.</transparency>'),
    material('<ambient>1 1 0.5</ambient>'),
    material('<ambient>1 1 nan</ambient>'),
    link_with('<inertial><mass>inf</mass></inertial>'),
    link_with('<inertial><mass>1e-300</mass></inertial>'),
    material('<ambient>1 1_0 0.5x</ambient>'),
    material('<ambient>1 1_0 0.5</ambient>'),
    axis('<xyz>0 0 1e-3</xyz>'),
    ode('<mu>1e9</mu>'),
    surface('<bounce><restitution_coefficient>1_0</restitution_coefficient></bounce>'),
    link_with('<unknown><mass>heavy</mass></unknown>'),
    model_file('<link name="l"/><plugin name="p" filename="f"><inertial><mass>x</mass></inertial>'
               '<plugin/></plugin>'),
    model_file('<link name="l"/><x:inertial><mass>heavy</mass></x:inertial>'),
])
def test_value_that_libsdformat_accepts_is_accepted(text):
    assert load_text(text).names


@pytest.mark.parametrize('text', [
    link_with(f'<inertial><mass>{" " * 100_000}</mass></inertial>'),
    axis(f'<xyz>{" " * 100_000}1 0 0</xyz>'),
], ids=['a number', 'an axis'])
def test_long_runs_of_white_space_are_read_fast(text):
    assert load_text(text).names


def test_message_has_the_value_and_the_rule():
    error = only_error(model_file('<link name="l"/><static>maybe</static>'))
    assert error.message == '"maybe" is not a boolean (true, false, 1 or 0)'


def test_message_has_the_range():
    assert only_error(ode('<mu>-1</mu>')).message == '"-1" must be at least 0'


def test_long_value_is_cut_in_the_message():
    assert len(only_error(visual(f'<transparency>{"x" * 10_000}</transparency>')).message) < 200


# Booleans

@pytest.mark.parametrize('text', [
    'yes', 'no', 't', '2', '-1', '01', '1.0', 'tru e', '\u0661', '\u00a01', ''])
def test_text_that_is_no_boolean(text):
    assert boolean_from_text(text) is None


@pytest.mark.parametrize('text', ['true', 'True', 'TRUE', '1', ' true\n'])
def test_true(text):
    assert boolean_from_text(text) is True


@pytest.mark.parametrize('text', ['false', 'False', 'FALSE', '0', '\t0 '])
def test_false(text):
    assert boolean_from_text(text) is False


# Types

@pytest.mark.parametrize(('text', 'value_type'), [
    ('x', ValueType.NUMBER), ('.', ValueType.NUMBER), ('.5', ValueType.INTEGER),
    ('1 2', ValueType.THREE_NUMBERS), ('1', ValueType.TWO_NUMBERS), ('yes', ValueType.BOOLEAN),
    ('1 2', ValueType.COLOR), ('0 0 0 0 0', ValueType.COLOR), ('1 1 1.5', ValueType.COLOR),
])
def test_text_that_is_not_of_a_type(text, value_type):
    assert not is_of_type(text, value_type)


@pytest.mark.parametrize(('text', 'value_type'), [
    ('-1.5e3', ValueType.NUMBER), ('true', ValueType.NUMBER), ('+5x', ValueType.INTEGER),
    ('false', ValueType.INTEGER), ('1 2 3 4', ValueType.THREE_NUMBERS), ('1', ValueType.BOOLEAN),
    ('1 2', ValueType.TWO_NUMBERS), ('0 0.5 1', ValueType.COLOR), ('0 0.5 1 1', ValueType.COLOR),
    ('any', ValueType.STRING),
])
def test_text_that_is_of_a_type(text, value_type):
    assert is_of_type(text, value_type)


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
PLAIN_TEXTS = st.lists(
    st.one_of(NUMBERS.map(repr), st.sampled_from(['1e999', '1e-320', '1e-400', '-0'])),
    min_size=5, max_size=8).map(' '.join)


def rpy(text):
    return pose_from_text(text, RPY)


def quaternion(text):
    return pose_from_text(text, QUATERNION)


# One text

@pytest.mark.parametrize('word', [
    'nan', 'NaN', 'inf', '-inf', 'infinity', '1e999', '-1e999', '1e-320', '-1e-320', '1e-400',
    '0x10', '0x1p3', '1.5abc', '1,', '1_000', '1e', '1e+', '1d3', 'true', ',', 'x', '.', '+', '-',
    '+-1', '--1', '.e1', '1.2.3', '1e1.5', '1/2', '\u0661', '1\u00a0', '\u22121', '1f', '(1)',
])
def test_word_that_is_not_a_number_is_refused(word):
    with pytest.raises(PoseTextError) as caught:
        rpy(f'0 {word} 0 0 0 0')
    assert f'"{word}"' in str(caught.value)


@pytest.mark.parametrize('count', [1, 2, 3, 4, 5, 7, 8, 12])
def test_other_count_than_six_is_refused(count):
    with pytest.raises(PoseTextError, match=f'6 values .x y z roll pitch yaw.*has {count}'):
        rpy(' '.join(['1'] * count))


@pytest.mark.parametrize('count', [1, 3, 4, 6, 8, 14])
def test_other_count_than_seven_is_refused_with_a_quaternion(count):
    with pytest.raises(PoseTextError, match=f'7 values .x y z qx qy qz qw.*has {count}'):
        quaternion(' '.join(['1'] * count))


def test_commas_do_not_separate_numbers():
    with pytest.raises(PoseTextError):
        rpy('1,2,3,0,0,0')


@pytest.mark.parametrize('text', ['1 ' * 10_000, '1' * 2_000_000 + ' 0 0 0 0 0', '1' * 300])
def test_long_text_is_cut_in_the_message(text):
    with pytest.raises(PoseTextError) as caught:
        rpy(text)
    assert len(str(caught.value)) < 250


@pytest.mark.parametrize('text', ['0 0 0 0 0 0 0', '1 2 3 1e-10 0 0 0', '0 0 0 0 -0 0 +0'])
def test_zero_quaternion_is_refused(text):
    with pytest.raises(PoseTextError, match='zero'):
        quaternion(text)


def test_quaternion_beyond_the_range_of_a_double_is_refused():
    with pytest.raises(PoseTextError, match='range of a double'):
        quaternion('0 0 0 1.7e308 1.7e308 1.7e308 1.7e308')


@pytest.mark.parametrize('separator', ['\u00a0', '\u2003', '\u3000', '\u0085', ','])
def test_only_ascii_white_space_separates_numbers(separator):
    with pytest.raises(PoseTextError):
        rpy(separator.join('123000'))


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


def test_w_is_the_last_number_of_a_quaternion():
    assert quaternion('1 2 3 0 0 0 1') == [1, 2, 3, 0, 0, 0, 1]


def test_quaternion_is_normalised():
    assert quaternion('0 0 0 0 0 2 2')[3:] == pytest.approx((0, 0, math.sqrt(0.5), math.sqrt(0.5)))


@pytest.mark.parametrize('size', ['1e-8', '1e150', '3e153', '1e200', '1e307'])
def test_length_of_a_quaternion_does_not_matter(size):
    assert quaternion(f'0 0 0 0 {size} 0 0')[3:] == pytest.approx((0, 1, 0, 0))


def test_roll_comes_first_and_about_fixed_axes():
    assert_same_pose(rpy('1 2 3 0.3 -0.4 1.2'), matrix_from_rpy(1, 2, 3, 0.3, -0.4, 1.2), 1e-15)


def test_formula_of_the_specification():
    half = [angle / 2 for angle in (0.3, -0.4, 1.2)]
    cr, cp, cy = map(math.cos, half)
    sr, sp, sy = map(math.sin, half)
    assert rpy('0 0 0 0.3 -0.4 1.2')[3:] == pytest.approx((
        sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy, cr * cp * cy + sr * sp * sy), abs=1e-15)


def test_only_angles_are_in_degrees():
    pose = pose_from_text('10 20 30 10 90 30', RPY_DEGREES)
    assert_same_pose(pose, matrix_from_degrees(10, 20, 30, 10, 90, 30), 1e-15)


@given(st.tuples(*[NUMBERS] * 6))
def test_any_roll_pitch_yaw(values):
    matrix = matrix_from_pose(rpy(' '.join(map(repr, values))))
    np.testing.assert_allclose(matrix, matrix_from_rpy(*values), atol=1e-12)


# Many texts

def read_one_by_one(texts, pose_format):
    """Return what :func:`poses_from_texts` should return."""
    poses, failures = [], []
    for index, text in enumerate(texts):
        try:
            poses.append(pose_from_text(text, pose_format))
        except PoseTextError as error:
            failures.append((index, str(error)))
            poses.append(Pose())
    return np.array(poses).reshape(-1, 7), failures


@pytest.mark.parametrize('tiny', ['1e-400', '1E-0400', '0.' + 400 * '0' + '1'])
def test_number_that_is_too_small_is_refused_among_others(tiny):
    good = '1 2 3 0 0 0'
    poses, failures, _ = poses_from_texts([good, f'{tiny} 0 0 0 0 0', good], RPY)
    assert [index for index, _ in failures] == [1]
    assert poses[2, :3].tolist() == [1, 2, 3]


def test_failures_have_index_and_reason():
    good = '1 2 3 0 0 0'
    poses, failures, _ = poses_from_texts([good, '1 2', good, '1 2 x 0 0 0'], RPY)
    assert [index for index, _ in failures] == [1, 3]
    assert re.search('"1 2".*has 2', failures[0][1])
    assert '"x"' in failures[1][1]
    assert poses[1].tolist() == poses[3].tolist() == list(Pose())
    assert poses[2, :3].tolist() == [1, 2, 3]


@pytest.mark.parametrize('pose_format', [RPY, RPY_DEGREES, QUATERNION])
def test_no_texts(pose_format):
    poses, failures, _ = poses_from_texts([], pose_format)
    assert poses.shape == (0, 7)
    assert failures == []


@given(st.lists(TEXTS, max_size=40), FORMATS)
def test_many_texts_are_read_as_one_by_one(texts, pose_format):
    poses, failures, _ = poses_from_texts(texts, pose_format)
    expected, expected_failures = read_one_by_one(texts, pose_format)
    assert failures == expected_failures
    np.testing.assert_allclose(poses, expected, rtol=1e-15, atol=1e-15)


@given(st.lists(PLAIN_TEXTS, min_size=1, max_size=40), FORMATS)
def test_many_plain_texts_are_read_as_one_by_one(texts, pose_format):
    poses, failures, _ = poses_from_texts(texts, pose_format)
    expected, expected_failures = read_one_by_one(texts, pose_format)
    assert failures == expected_failures
    np.testing.assert_allclose(poses, expected, rtol=1e-15, atol=1e-15)
