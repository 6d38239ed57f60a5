# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Formats of poses: invalid input, what each format means, conversions between all of them."""

import array
import contextlib
import itertools
import math
import re

import numpy as np
import pytest
from rotation_sets import half_turns, largest_angle, lock_rpy, MAX_ANGLE, random_quaternions

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st

from sdf_pose_bridge.geometry.formats import (
    converted_poses,
    converted_rotations,
    POSE_FORMATS,
    PoseFormatError,
    ROTATION_FORMATS,
)
from sdf_pose_bridge.geometry.rotations import quaternion_from_rpy

LENGTHS = {
    'sdf_rpy': 6, 'sdf_rpy_degrees': 6, 'sdf_quat_xyzw': 7,
    'matrix_row_major': 16, 'franka_matrix': 16, 'franka_measured': 6, 'ur_pose': 6,
    'ur_pendant': 6, 'kuka_abc': 6, 'abb': 7, 'fanuc_wpr': 6, 'yaskawa': 6, 'staubli': 6,
    'kawasaki_oat': 6, 'doosan': 6, 'kinova_gen3': 6,
    'kinova_jaco': 6, 'mujoco': 7, 'mitsubishi': 6, 'denso': 6,
    'epson_uvw': 6, 'ufactory': 6,
}
IDENTITY_MATRIX = (1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)
GOOD = {
    name: IDENTITY_MATRIX if length == 16 else (1.0, 2.0, 3.0, 0.1, 0.2, 0.3, 0.4)[:length]
    for name, length in LENGTHS.items()}

every_format = pytest.mark.parametrize('name', LENGTHS)
matrix_formats = pytest.mark.parametrize('name', ['matrix_row_major', 'franka_matrix'])


def poses(quats):
    xyz = np.random.default_rng(7).uniform(-2.0, 2.0, (len(quats), 3))
    return np.concatenate((xyz, quats), axis=1)


def changed(values, replacements):
    row = list(values)
    for place, value in replacements.items():
        row[place] = value
    return row


# Invalid input.

@pytest.mark.parametrize('unknown', ['', 'SDF_RPY', 'sdf-rpy', 'rpy', None, 3, ['sdf_rpy']])
def test_an_unknown_format_is_an_error_that_names_the_list(unknown):
    message = rf'no pose format {re.escape(repr(unknown))}; .*all: docs/pose_formats.md'
    with pytest.raises(PoseFormatError, match=message):
        converted_poses(GOOD['sdf_rpy'], unknown, 'sdf_rpy')
    with pytest.raises(PoseFormatError, match=message):
        converted_poses(GOOD['sdf_rpy'], 'sdf_rpy', unknown)


@every_format
def test_lengths_must_be_multiples_of_a_pose(name):
    length = LENGTHS[name]
    for count in (1, length - 1, length + 1, 10 * length - 1):
        with pytest.raises(PoseFormatError, match=rf'{count} values.*each {name} has {length}'):
            converted_poses([0.0] * count, name, 'sdf_rpy')
    for shape in ((), (2, length - 1), (1, 2, length)):
        with pytest.raises(PoseFormatError, match=rf'each {name} has {length}'):
            converted_poses(np.zeros(shape), name, 'sdf_rpy')


def test_values_must_be_numbers():
    with pytest.raises(PoseFormatError, match="'x'"):
        converted_poses([0.0, 0.0, 0.0, 0.0, 0.0, 'x'], 'sdf_rpy', 'sdf_rpy')
    with pytest.raises(PoseFormatError, match='must be numbers'):
        converted_poses([[0.0] * 6, [0.0] * 5], 'sdf_rpy', 'sdf_rpy')


@every_format
@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
def test_values_must_be_finite(name, bad):
    for place in range(LENGTHS[name]):
        row = changed(GOOD[name], {place: bad})
        with pytest.raises(PoseFormatError, match=rf'{name}: value {place} is {bad}.*finite'):
            converted_poses(row, name, 'sdf_rpy')
        with pytest.raises(PoseFormatError, match=rf'{name}: row 2, value {place} is {bad}'):
            converted_poses([GOOD[name], GOOD[name], row], name, 'sdf_rpy')


@pytest.mark.parametrize(('replacements', 'rule'), [
    ({0: 2.0}, r'not orthonormal: column 0 has norm 2\.0'),
    ({15: 0.0}, r'last row of the matrix is \(0\.0, 0\.0, 0\.0, 0\.0\)'),
    ({15: 1.0 + 1e-15}, r'last row of the matrix is .*exactly \(0\.0, 0\.0, 0\.0, 1\.0\)'),
])
@matrix_formats
def test_matrices_must_be_poses(name, replacements, rule):
    bad = changed(IDENTITY_MATRIX, replacements)
    with pytest.raises(PoseFormatError, match=f'{name}: [^:]*{rule}'):
        converted_poses(bad, name, 'sdf_rpy')
    with pytest.raises(PoseFormatError, match=f'{name}: row 3: .*{rule}'):
        converted_poses([IDENTITY_MATRIX] * 3 + [bad], name, 'sdf_rpy')


@pytest.mark.parametrize(('name', 'places'), [
    ('matrix_row_major', (12, 13, 14)), ('franka_matrix', (3, 7, 11)),
])
def test_the_last_row_of_matrices_must_be_exact(name, places):
    for place in places:
        with pytest.raises(PoseFormatError, match=r'last row of the matrix is .*1e-300'):
            converted_poses(changed(IDENTITY_MATRIX, {place: 1e-300}), name, 'sdf_rpy')
        minus_zero = changed(IDENTITY_MATRIX, {place: -0.0})
        assert converted_poses(minus_zero, name, 'sdf_rpy').tolist() == [0.0] * 6


@matrix_formats
def test_matrices_are_checked_as_in_libfranka(name):
    coarse = changed(IDENTITY_MATRIX, {0: 0.707, 1: -0.707, 4: 0.707, 5: 0.707})
    with pytest.raises(PoseFormatError, match='not orthonormal'):
        converted_poses(coarse, name, 'sdf_rpy')
    fine = changed(IDENTITY_MATRIX, {0: 0.7071, 1: -0.7071, 4: 0.7071, 5: 0.7071})
    yaw = converted_poses(fine, name, 'sdf_rpy')[5]
    assert abs(yaw) == pytest.approx(math.pi / 4, abs=1e-15)


def test_results_must_be_finite():
    with pytest.raises(PoseFormatError, match=r'1e\+306.*too large a number for franka_measured'):
        converted_poses(changed(GOOD['sdf_rpy'], {1: 1e306}), 'sdf_rpy', 'franka_measured')


# What the formats mean.

def test_the_formats_and_their_lengths():
    assert {name: entry.row_length for name, entry in POSE_FORMATS.items()} == LENGTHS
    assert all(entry.name == name and entry.meaning for name, entry in POSE_FORMATS.items())


@every_format
def test_one_pose_in_all_formats(name):
    # 90 degrees of yaw, then 30 degrees of roll on the child's own x: by hand.
    half, root = 0.5, math.sqrt(0.75)
    sine, cosine = (
        math.sqrt(half) * function(math.pi / 12) for function in (math.sin, math.cos))
    angle = 2.0 * math.acos(cosine)
    vector = angle / math.sin(angle / 2.0) * np.array((sine, sine, cosine))
    same = {
        'sdf_rpy': (1, 2, 3, math.pi / 6, 0, math.pi / 2),
        'sdf_rpy_degrees': (1, 2, 3, 30, 0, 90),
        'sdf_quat_xyzw': (1, 2, 3, sine, sine, cosine, cosine),
        'mujoco': (1, 2, 3, cosine, sine, sine, cosine),
        'ur_pose': (1, 2, 3, *vector),
        'matrix_row_major': (
            0, -root, half, 1,
            1, 0, 0, 2,
            0, half, root, 3,
            0, 0, 0, 1,
        ),
        'franka_matrix': (
            0, 1, 0, 0,
            -root, 0, half, 0,
            half, 0, root, 0,
            1, 2, 3, 1,
        ),
    }
    same['kinova_gen3'] = same['sdf_rpy_degrees']
    same['kinova_jaco'] = (1, 2, 3, 0, 30, 90)
    for each, angles in (
        ('franka_measured', (30, 0, 90)), ('kuka_abc', (90, 0, 30)), ('fanuc_wpr', (30, 0, 90)),
        ('yaskawa', (30, 0, 90)), ('staubli', (0, 30, 90)), ('kawasaki_oat', (0, 30, 90)),
        ('doosan', (0, 30, 90)), ('mitsubishi', (30, 0, 90)), ('denso', (30, 0, 90)),
        ('epson_uvw', (90, 0, 30)), ('ufactory', (30, 0, 90)), ('ur_pendant', same['ur_pose'][3:]),
        ('abb', same['mujoco'][3:]),
    ):
        same[each] = (1000, 2000, 3000, *angles)
    for target, expected in same.items():
        answer = converted_poses(same[name], name, target)
        assert answer == pytest.approx(expected, abs=3e-14), target


def test_libfranka_accepts_the_matrices():
    quats = np.concatenate((random_quaternions(5000), half_turns(), 1e-200 * half_turns(1e-9)))
    matrices = converted_poses(poses(quats), 'sdf_quat_xyzw', 'franka_matrix')
    assert (matrices[:, [3, 7, 11]] == 0.0).all()
    assert (matrices[:, 15] == 1.0).all()
    square = matrices.reshape(-1, 4, 4)[:, :3, :3]
    assert np.abs(np.linalg.norm(square, axis=1) - 1.0).max() < 1e-12
    assert np.abs(np.linalg.norm(square, axis=2) - 1.0).max() < 1e-12


def test_translations_are_exact():
    row = changed(GOOD['sdf_rpy'], {0: 1e-300, 1: -123456.789, 2: 1e300})
    for target in ('sdf_quat_xyzw', 'sdf_rpy_degrees'):
        assert converted_poses(row, 'sdf_rpy', target)[:3].tolist() == row[:3]
    metres = converted_poses((1.1, 2.2, 3.3, 0, 0, 0), 'franka_measured', 'sdf_rpy')
    assert metres[:3].tolist() == [0.0011, 0.0022, 0.0033]


@pytest.mark.parametrize(
    ('source', 'target'), [*itertools.product(LENGTHS, [*LENGTHS][:7]), ('staubli', 'abb'),
                           ('doosan', 'kawasaki_oat'), ('epson_uvw', 'denso')])
def test_every_format_converts_to_every_other_and_back(source, target):
    quats = np.concatenate(
        (random_quaternions(200), half_turns()[::5], quaternion_from_rpy(lock_rpy(200)))
    )
    rows = converted_poses(poses(quats), 'sdf_quat_xyzw', source)
    again = converted_poses(converted_poses(rows, source, target), target, source)
    common = converted_poses(rows, source, 'sdf_quat_xyzw')
    common_again = converted_poses(again, source, 'sdf_quat_xyzw')
    assert np.abs(common - common_again)[:, :3].max() <= 2e-15
    assert largest_angle(common[:, 3:], common_again[:, 3:]) <= 8 * MAX_ANGLE


def test_largest_angles_are_wrapped():
    row = (0.0, 0.0, 0.0, 1e308, 0.0, 0.0)
    assert abs(converted_poses(row, 'sdf_rpy', 'sdf_rpy_degrees')[3]) < 180.0


@pytest.mark.filterwarnings('error')
@every_format
@pytest.mark.parametrize('number', [1e308, -1.7e308, 5e-324])
def test_numbers_at_the_ends_of_the_range_cause_no_warning_of_numpy(name, number):
    row = [number] * LENGTHS[name]
    for target in (name, 'sdf_rpy', 'franka_matrix', 'franka_measured'):
        with contextlib.suppress(PoseFormatError):  # a matrix is none, or the result is too large
            assert np.isfinite(converted_poses(row, name, target)).all()
    assert isinstance(POSE_FORMATS[name].doubt(row, is_written=True), str)


@every_format
def test_results_have_no_negative_zeros(name):
    row = (-0.0, -0.0, -0.0, -0.0, -0.0, -0.0, -1.0)
    answer = converted_poses(row, 'sdf_quat_xyzw', name)
    assert not np.signbit(answer[answer == 0.0]).any()


@given(st.floats(-180.0, 180.0), st.floats(-89.9, 89.9), st.floats(-180.0, 180.0))
def test_angles_in_their_ranges_keep_their_digits(roll, pitch, yaw):
    angles = [roll, pitch, yaw]
    row = [1.0, 2.0, 3.0, *angles]
    assert converted_poses(row, 'sdf_rpy_degrees', 'franka_measured')[3:].tolist() == angles
    assert converted_poses(row, 'sdf_rpy_degrees', 'sdf_rpy')[3:].tolist() == [
        angle * math.pi / 180.0 for angle in angles
    ]


def test_angles_keep_their_digits_in_another_order():
    assert converted_poses((1, 2, 3, 10.1, 20, 30.3), 'kuka_abc', 'denso').tolist() == [
        1.0, 2.0, 3.0, 30.3, 20.0, 10.1]
    assert converted_poses((1, 2, 3, 10.1, 20, 30.3), 'kawasaki_oat', 'doosan').tolist() == [
        1.0, 2.0, 3.0, 10.1, 20.0, 30.3]


# Names and units.

def test_a_name_belongs_to_one_format():
    names = [
        name for each in (*POSE_FORMATS.values(), *ROTATION_FORMATS.values())
        for name in (each.name, *each.synonyms)]
    assert [name for name in {*names} if names.count(name) > 1] == []


@pytest.mark.parametrize(('synonym', 'name'), [
    ('sdf_quat_wxyz', 'mujoco'), ('matrix_column_major', 'franka_matrix'),
    ('matrix_col_major', 'franka_matrix'), ('abb_quaternion', 'abb')])
def test_a_synonym_is_accepted(synonym, name):
    assert np.array_equal(converted_poses(GOOD[name], synonym, 'sdf_rpy'),
                          converted_poses(GOOD[name], name, 'sdf_rpy'))


@pytest.mark.parametrize(('wrong', 'hint'), [
    ('sdf_quat_xzyw', ''), ('sdf_quat_wxyzz', 'sdf_quat_wxyz'),
    ('matrix_major', 'matrix_row_major, franka_matrix'),
    ('matrix_row', 'matrix_row_major'), ('sdf_rpy_degree', 'sdf_rpy_degrees'), ('sdf_ypr', ''),
    ('ur_pose_degrees', ''), ('franka_pose', 'franka_matrix, franka_measured'),
    ('kuka_acb', 'kuka_abc'),
    ('yaskava', 'yaskawa')])
def test_a_hint_has_the_order_and_the_unit_of_the_wrong_name(wrong, hint):
    with pytest.raises(PoseFormatError) as error:
        converted_poses(GOOD['sdf_rpy'], wrong, 'sdf_rpy')
    assert str(error.value).partition('; near: ')[2].partition(';')[0] == hint


@pytest.mark.parametrize(('name', 'row', 'likely_unit'), [
    ('sdf_rpy', (1, 2, 3, 0, 0, 90), 'degrees'), ('ur_pose', (1, 2, 3, 0, 8, 0), 'degrees'),
    ('sdf_rpy_degrees', (1, 2, 1197, 0, 0, 90), 'mm'),
    ('matrix_row_major', (1, 0, 0, 0, 0, 1, 0, -100, 0, 0, 1, 0, 0, 0, 0, 1), 'mm'),
    ('sdf_rpy', (99, 2, 3, 0, 0, 7.8), ''), ('kuka_abc', (1197, 0, 0, 90, 0, 0), ''),
    ('kuka_abc', (0.3, 0, 1, 90, 0, 0), 'metres'), ('kuka_abc', (0, 0, 0, 1.57, 0, 3), 'radians'),
    ('kuka_abc', (0, 0, 0, 0.42, 0, 0), ''), ('kuka_abc', (0, 0, 0, -1.2, 0, 0.5), ''),
    ('ur_pose', (300, 0, 0, 0, 90, 0), 'degrees mm'),
    ('kuka_abc', (0.3, 0, 0, 1.57, 0, 0), 'radians metres')])
def test_a_row_in_another_unit_is_doubted(name, row, likely_unit):
    identity = converted_poses((0, 0, 0, 0, 0, 0, 1), 'sdf_quat_xyzw', name)
    question = POSE_FORMATS[name].doubt([*identity, *row])
    assert question.partition('; did you mean ')[2].removesuffix('?') == likely_unit


@pytest.mark.parametrize(('quat', 'reason'), [
    ((0, 0, 45, 1), 'the quaternion 0 0 45 1 has the length 45.0111, not 1'),
    ((0, 0, 0.7, 0.7), 'the length 0.989949'), ((0, 0, 0.707, 0.707), '')])
def test_a_quaternion_that_is_written_has_unit_length(quat, reason):
    quat_format = POSE_FORMATS['sdf_quat_xyzw']
    doubt = quat_format.doubt((1, 2, 3, *quat), is_written=True)
    assert reason in doubt if reason else not doubt
    assert not quat_format.doubt((1, 2, 3, *quat))


# Shapes.

@every_format
def test_results_are_shaped_like_the_values(name):
    rows = np.tile(GOOD[name], (5, 1))
    for target, length in LENGTHS.items():
        answer = converted_poses(rows, name, target)
        flat = converted_poses(rows.ravel(), name, target)
        assert answer.shape == (5, length)
        assert flat.shape == (5 * length,)
        assert np.array_equal(flat, answer.ravel())
        assert flat.flags.c_contiguous


@every_format
def test_no_poses_convert_to_no_poses(name):
    assert converted_poses([], name, 'franka_matrix').shape == (0,)
    assert converted_poses(np.empty((0, LENGTHS[name])), name, 'sdf_rpy').shape == (0, 6)


@pytest.mark.parametrize('kind', [tuple, list, np.array, lambda row: array.array('d', row)])
def test_values_may_be_any_sequence(kind):
    row = GOOD['sdf_rpy']
    assert np.array_equal(
        converted_poses(kind(row), 'sdf_rpy', 'sdf_quat_xyzw'),
        converted_poses(np.array(row), 'sdf_rpy', 'sdf_quat_xyzw'),
    )


@every_format
def test_the_result_shares_no_memory_with_the_values(name):
    rows = np.tile(GOOD[name], (3, 1))
    before = rows.copy()
    converted_poses(rows, name, name)[:] = -1.0
    assert np.array_equal(rows, before)


# Rotations without translation.

@pytest.mark.parametrize(
    ('source', 'target'), [*itertools.product(ROTATION_FORMATS, repeat=2)])
def test_rotations_convert_between_all_formats(source, target):
    quarter = {
        'rpy': (0, 0, math.pi / 2),
        'rpy_degrees': (0, 0, 90),
        'ypr': (math.pi / 2, 0, 0),
        'ypr_degrees': (90, 0, 0),
        'quaternion': (0, 0, math.sqrt(0.5), math.sqrt(0.5)),
        'quaternion_wxyz': (math.sqrt(0.5), 0, 0, math.sqrt(0.5)),
        'matrix': (0, -1, 0, 1, 0, 0, 0, 0, 1),
        'rotation_vector': (0, 0, math.pi / 2),
        'rotation_vector_degrees': (0, 0, 90),
    }
    answer = converted_rotations(quarter[source], source, target)
    assert answer == pytest.approx(quarter[target], abs=3e-14)


def test_rotations_do_not_convert_to_poses():
    with pytest.raises(PoseFormatError, match="no rotation format 'sdf_rpy'; near: rpy"):
        converted_rotations((0.0, 0.0, 0.0), 'rpy', 'sdf_rpy')


# Rounding errors


@pytest.mark.parametrize(('source', 'given', 'same'), [
    ('rotation_vector_degrees', (0, 400, 300), (0, 112, 84)),
    ('rpy_degrees', (0, 0, 3.6e17 + 64), (0, 0, 64))])
def test_whole_turns_do_not_count(source, given, same):
    assert np.allclose(
        *(converted_rotations(each, source, 'quaternion') for each in (given, same)))
