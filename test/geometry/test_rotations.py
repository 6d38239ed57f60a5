# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Rotations: invalid input, conventions, canonical results, gimbal lock, one and many alike."""

import itertools
import math

from matrices import assert_close, matrix_from_rpy
import numpy as np
import pytest
from rotation_sets import (
    exact_angle,
    exact_quaternion,
    half_turns,
    MAX_ANGLE,
    random_quaternions,
    random_rpy,
)

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st

from sdf_pose_bridge.geometry.rotations import (
    canonical_quaternion,
    matrix_from_quaternion,
    quaternion_from_matrix,
    quaternion_from_rotation_vector,
    quaternion_from_rpy,
    rotation_vector_from_quaternion,
    RotationError,
    rpy_from_quaternion,
)
from sdf_pose_bridge.geometry.sequences import ZYX

IDENTITY = (0.0, 0.0, 0.0, 1.0)
H = math.sqrt(0.5)
EYE = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
FROM_QUATERNION = (rpy_from_quaternion, matrix_from_quaternion, canonical_quaternion)

angles = st.floats(allow_nan=False, allow_infinity=False)
rpys = st.tuples(angles, angles, angles)
components = st.floats(-1.0, 1.0)
directions = st.tuples(components, components, components, components).filter(
    lambda quat: max(map(abs, quat)) > 1e-3
)


# Invalid input.

@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize(('function', 'place'), [
    *itertools.product((quaternion_from_rpy,), range(3)),
    *itertools.product(FROM_QUATERNION, range(4))])
def test_values_must_be_finite(function, place, bad):
    good = [0.1, 0.2, 0.3, 0.4][:3 if function is quaternion_from_rpy else 4]
    values = [*good[:place], bad, *good[place + 1:]]
    with pytest.raises(RotationError, match=f'{bad}.*not finite'):
        function(values)
    with pytest.raises(RotationError, match=f'row 5: .*{bad}.*not finite'):
        function(np.array([good] * 5 + [values]))


@pytest.mark.parametrize('function', FROM_QUATERNION)
def test_quaternions_must_not_be_zero(function):
    with pytest.raises(RotationError, match='zero'):
        function((0.0, -0.0, 0.0, 0.0))
    with pytest.raises(RotationError, match=r'row 9000: .*zero'):
        function(np.array([IDENTITY] * 9000 + [(0.0, 0.0, 0.0, 0.0)]))


@pytest.mark.parametrize('function', FROM_QUATERNION)
def test_the_first_invalid_row_is_named(function):
    zero, not_finite = (0.0, 0.0, 0.0, 0.0), (math.nan, 0.0, 0.0, 0.0)
    with pytest.raises(RotationError, match=r'row 1: .*zero'):
        function(np.array([IDENTITY, zero, not_finite]))
    with pytest.raises(RotationError, match=r'row 1: .*not finite'):
        function(np.array([IDENTITY, not_finite, zero]))


@pytest.mark.parametrize(('function', 'values'), [
    *itertools.product((quaternion_from_rpy, *FROM_QUATERNION), (
        (), (1.0,), (1.0, 2.0), (0.0,) * 5, 'abc', (1.0, 'x', 0.0), (1.0, None, 0.0))),
    *itertools.product((quaternion_from_matrix,), (
        (), ((1, 0, 0), (0, 1, 0)), ((1, 0), (0, 1), (0, 0)), 'abc')),
])
def test_wrong_shapes_are_errors(function, values):
    with pytest.raises(RotationError):
        function(values)


@pytest.mark.parametrize('shape', [(), (2,), (3, 2), (3, 3, 5)])
@pytest.mark.parametrize(('function', 'name'), [
    (quaternion_from_rpy, 'roll, pitch, yaw'), (quaternion_from_matrix, 'rotation matrix'),
    (quaternion_from_rotation_vector, 'rotation vector'),
    *((each, 'quaternion') for each in FROM_QUATERNION)])
def test_wrong_shapes_of_arrays_are_errors(function, name, shape):
    with pytest.raises(RotationError, match=f'^{name} must have shape'):
        function(np.zeros(shape))


@pytest.mark.parametrize(('rows', 'rule'), [
    ('1 0 0, 0 1 0, 0 0 nan', 'not finite'),
    ('1 0 0, 0 1 0, 0 0 inf', 'not finite'),
    ('0 0 0, 0 0 0, 0 0 0', r'not orthonormal: column 0 has norm 0\.0'),
    ('1 0 0, 0 1.00002 0, 0 0 1', r'not orthonormal: column 1 has norm 1\.00002'),
    ('1 0 1e-2, 0 1 0, 0 0 1', 'not orthonormal: column 2'),
    ('1 2e-5 0, 0 1 0, 0 0 1', r'columns 0 and 1 have scalar product 2e-05'),
    ('1e200 0 0, 0 1 0, 0 0 1', 'not orthonormal: column 0 has norm inf'),
    ('1 0 0, 0 1 0, 0 0 -1', 'determinant -1'),
    ('0 -1e-3 0, 1e-3 0 0, 0 0 1e-3', 'has the scale 0.001; divide it by that'),
    ('2 0 0, 0 2 0, 0 0 1', 'column 0 has norm 2'),
])
def test_matrices_must_be_rotations(rows, rule):
    matrix = [[*map(float, row.split())] for row in rows.split(',')]
    with pytest.raises(RotationError, match=rule):
        quaternion_from_matrix(matrix)
    with pytest.raises(RotationError, match=f'row 2: .*{rule}'):
        quaternion_from_matrix(np.array([EYE, EYE, matrix]))


@pytest.mark.parametrize('place', range(9))
def test_every_element_of_a_matrix_is_checked(place):
    wrong = np.eye(3)
    wrong.flat[place] += 2e-5
    with pytest.raises(RotationError, match='row 1: '):
        quaternion_from_matrix(np.array([EYE, wrong]))


# Conventions.

@given(st.tuples(*[st.floats(-10.0, 10.0)] * 3))
def test_roll_pitch_yaw_rotate_about_fixed_axes_in_this_order(rpy):
    assert_close(
        matrix_from_quaternion(quaternion_from_rpy(rpy)), matrix_from_rpy(0, 0, 0, *rpy)[:3, :3],
        2e-15)


# Canonical results.

@given(rpys)
def test_quaternions_of_angles_of_any_size_are_canonical(rpy):
    x, y, z, w = quaternion_from_rpy(rpy)
    assert w >= 0.0
    assert abs(math.hypot(x, y, z, w) - 1.0) < 4e-16
    assert exact_angle((x, y, z, w), exact_quaternion(rpy)) <= MAX_ANGLE


@given(directions, st.floats(1e-300, 1e300))
def test_canonical_quaternions_are_returned_bit_for_bit(quat, scale):
    canonical = canonical_quaternion(tuple(scale * value for value in quat))
    assert canonical_quaternion(canonical) == canonical
    assert canonical_quaternion(np.array(canonical)).tolist() == list(canonical)


@pytest.mark.parametrize(('quat', 'canonical'), [
    ('0 0 0 -3', '0 0 0 1'),
    ('-1 0 0 0', '1 0 0 0'),
    ('0 -2 0 -0', '0 1 0 0'),
    ('-0 0 -1e-300 0', '0 0 1 0'),
    ('0 -0.6 0.8 0', '0 0.6 -0.8 0'),
    ('0.6 -0.8 0 -0', '0.6 -0.8 0 0'),
    ('5e-324 0 0 0', '1 0 0 0'),
])
def test_the_first_component_of_a_half_turn_is_positive(quat, canonical):
    given, expected = ([*map(float, text.split())] for text in (quat, canonical))
    assert canonical_quaternion(given) == tuple(expected)
    assert canonical_quaternion(np.array([given, IDENTITY])).tolist() == [expected, [*IDENTITY]]


@pytest.mark.parametrize('function', [quaternion_from_rpy, *FROM_QUATERNION])
def test_results_have_no_negative_zeros(function):
    size = 3 if function is quaternion_from_rpy else 4
    rows = [row for row in itertools.product((0.0, -0.0, 1.0, -1.0, math.pi), repeat=size)
            if size == 3 or any(row)]
    for answer in ([function(row) for row in rows], function(np.array(rows))):
        flat = np.ravel(answer)
        assert not np.signbit(flat[flat == 0.0]).any()


# Gimbal lock; the numbers are those of gz-math.

@pytest.mark.parametrize(('rpy', 'expected', 'lock'), [
    ((0.3, math.pi / 2, 0.1), (0.2, math.pi / 2, 0.0), True),
    ((0.3, -math.pi / 2, 0.1), (0.4, -math.pi / 2, 0.0), True),
    ((0.3, 2.0, 0.1), (-2.841592653590, 1.141592653590, -3.041592653590), False),
    ((0.3, 1.5708, 0.1), (-2.841592653576, 1.570792653606, -3.041592653580), False),
])
def test_angles_at_and_near_lock_are_those_of_gz_math(rpy, expected, lock):
    quat = quaternion_from_rpy(rpy)
    # The pitch of gz-math is off by 1.6e-11 at 1.5708 because it uses an arc sine.
    assert rpy_from_quaternion(quat) == pytest.approx(expected, abs=2e-11)
    assert rpy_from_quaternion(np.array([quat]))[0] == pytest.approx(expected, abs=2e-11)
    assert ZYX.near_lock(np.array([quat])).tolist() == [lock]


@pytest.mark.parametrize('pitch', [math.pi / 2, -math.pi / 2])
def test_yaw_is_zero_at_lock_and_pitch_exactly_a_right_angle(pitch):
    rpy = random_rpy(20_000)
    rpy[:, 1] = pitch
    quats = quaternion_from_rpy(rpy)
    answer = rpy_from_quaternion(quats)
    assert (answer[:, 2] == 0.0).all()
    assert (answer[:, 1] == pitch).all()
    ones = [rpy_from_quaternion(quat) for quat in quats[:200].tolist()]
    assert {one[1:] for one in ones} == {(pitch, 0.0)}


# One and many.

@pytest.mark.parametrize(('function', 'row'), [
    (quaternion_from_rpy, (3,)), (quaternion_from_matrix, (3, 3)),
    *((function, (4,)) for function in FROM_QUATERNION)])
@pytest.mark.parametrize('leading', [(), (0,), (1,), (7,), (2, 3), (4097,)])
def test_arrays_keep_their_leading_shape(function, row, leading):
    values = np.empty(leading + row)
    values[...] = EYE if row == (3, 3) else np.arange(1.0, 1.0 + row[0])
    answer = function(values)
    single = function(values[(0,) * len(leading)].tolist() if values.size else (
        EYE if row == (3, 3) else tuple(np.arange(1.0, 1.0 + row[0]))
    ))
    assert answer.shape == leading + np.shape(single)
    assert np.allclose(answer, single, rtol=0.0, atol=1e-15)


def test_input_is_not_modified():
    quats = -3.0 * random_quaternions(100)
    before = quats.copy()
    for function in FROM_QUATERNION:
        function(quats)
    assert np.array_equal(quats, before)


# The rotation nearest to a matrix.

def test_the_rotation_nearest_to_a_disturbed_matrix_is_returned():
    rng = np.random.default_rng(4)
    quats = np.concatenate((random_quaternions(500), half_turns()))
    disturbed = matrix_from_quaternion(quats)
    disturbed += rng.uniform(-2.5e-6, 2.5e-6, disturbed.shape)
    left, _, right = np.linalg.svd(disturbed)
    nearest = left @ right
    answer = quaternion_from_matrix(disturbed)
    assert np.allclose(matrix_from_quaternion(answer), nearest, rtol=0.0, atol=1e-14)
    for matrix, expected in zip(disturbed[::9].tolist(), answer[::9], strict=False):
        assert quaternion_from_matrix(matrix) == pytest.approx(expected, abs=1e-15)


# Rotation vectors

@pytest.mark.parametrize('bad', [(math.nan, 0, 0), (0, math.inf, 0), (0, 0, 1e80), (1e200, 0, 0)])
def test_rotation_vector_must_be_finite(bad):
    with pytest.raises(RotationError, match=r'rotation vector .* is not finite, or longer than'):
        quaternion_from_rotation_vector(bad)
    with pytest.raises(RotationError, match='row 1: rotation vector '):
        quaternion_from_rotation_vector([(0, 0, 1), bad])


@pytest.mark.parametrize(('vector', 'quat'), [
    ((0, 0, 0), IDENTITY), ((1e-200, 0, 0), (5e-201, 0, 0, 1)),
    ((math.pi, 0, 0), (1, 0, 0, 0)), ((0, 0, -math.pi / 2), (0, 0, -H, H)),
    ((0, 3 * math.pi / 2, 0), (0, -H, 0, H)), ((0, 0, 2 * math.pi), IDENTITY),
])
def test_rotation_vector_is_an_axis_times_an_angle(vector, quat):
    assert quaternion_from_rotation_vector(vector) == pytest.approx(quat, abs=3e-16)


def test_rotation_vector_of_half_a_turn_has_a_positive_first_component():
    assert rotation_vector_from_quaternion((-1, 1, 0, 0)) == pytest.approx(
        (math.pi * H, -math.pi * H, 0))


@given(rpys)
def test_rotation_vector_is_at_most_half_a_turn_long(rpy):
    vector = rotation_vector_from_quaternion(quaternion_from_rpy(rpy))
    assert math.hypot(*vector) <= math.pi * (1 + 1e-15)
