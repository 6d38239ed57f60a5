# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Rotations: what is refused, conventions, canonical answers, gimbal lock, one and many alike."""

import math

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest
from rotation_sets import exact_quaternion
from rotation_sets import exact_turn
from rotation_sets import half_turns
from rotation_sets import LARGEST_TURN
from rotation_sets import largest_turn
from rotation_sets import lock_rpy
from rotation_sets import random_quaternions
from rotation_sets import random_rpy

from sdf_pose_bridge.geometry import rotation
from sdf_pose_bridge.geometry.rotation import RotationError
from sdf_pose_bridge.geometry.rotation_checks import check_matrix
from sdf_pose_bridge.geometry.rotation_checks import check_quaternion
from sdf_pose_bridge.geometry.rotation_checks import check_rpy

IDENTITY = (0.0, 0.0, 0.0, 1.0)
EYE = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
FROM_RPY = (rotation.quaternion_from_rpy, rotation.matrix_from_rpy)
FROM_QUATERNION = (
    rotation.rpy_from_quaternion, rotation.matrix_from_quaternion, rotation.canonical_quaternion,
    rotation.quaternion_inverse, rotation.near_gimbal_lock,
)
FROM_MATRIX = (rotation.quaternion_from_matrix, rotation.rpy_from_matrix)

angles = st.floats(allow_nan=False, allow_infinity=False)
rpys = st.tuples(angles, angles, angles)
components = st.floats(-1.0, 1.0)
directions = st.tuples(components, components, components, components).filter(
    lambda quat: max(map(abs, quat)) > 1e-3
)


def product_of_matrices(a, b):
    return np.array(a) @ np.array(b)


def turn_about(axis, angle):
    """Return the textbook matrix of a turn about a coordinate axis."""
    cosine, sine = math.cos(angle), math.sin(angle)
    if axis == 'x':
        return [[1, 0, 0], [0, cosine, -sine], [0, sine, cosine]]
    if axis == 'y':
        return [[cosine, 0, sine], [0, 1, 0], [-sine, 0, cosine]]
    return [[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]]


# What is refused.

@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize('place', [0, 1, 2])
@pytest.mark.parametrize('function', FROM_RPY)
def test_angles_must_be_finite(function, place, bad):
    rpy = [0.1, 0.2, 0.3]
    rpy[place] = bad
    with pytest.raises(RotationError, match=f'{bad}.*not finite'):
        function(rpy)
    with pytest.raises(RotationError, match=f'row 5: .*{bad}.*not finite'):
        function(np.array([[0.0, 0.0, 0.0]] * 5 + [rpy]))


@pytest.mark.parametrize('bad', [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize('place', [0, 1, 2, 3])
@pytest.mark.parametrize('function', FROM_QUATERNION)
def test_quaternions_must_be_finite(function, place, bad):
    quat = [0.1, 0.2, 0.3, 0.4]
    quat[place] = bad
    with pytest.raises(RotationError, match=f'{bad}.*not finite'):
        function(quat)
    with pytest.raises(RotationError, match=f'row 5: .*{bad}.*not finite'):
        function(np.array([IDENTITY] * 5 + [quat]))


@pytest.mark.parametrize('function', FROM_QUATERNION)
def test_a_zero_quaternion_is_no_rotation(function):
    with pytest.raises(RotationError, match='zero'):
        function((0.0, -0.0, 0.0, 0.0))
    with pytest.raises(RotationError, match=r'row 9000: .*zero'):
        function(np.array([IDENTITY] * 9000 + [(0.0, 0.0, 0.0, 0.0)]))


@pytest.mark.parametrize('values', [(), (1.0,), (1.0, 2.0), (0.0,) * 5, 'abc', (1.0, 'x', 0.0)])
@pytest.mark.parametrize('function', [*FROM_RPY, *FROM_QUATERNION])
def test_wrong_shapes_are_refused(function, values):
    with pytest.raises(RotationError):
        function(values)


@pytest.mark.parametrize('shape', [(), (2,), (3, 2), (3, 3, 5)])
@pytest.mark.parametrize('function', [*FROM_RPY, *FROM_QUATERNION, *FROM_MATRIX])
def test_wrong_shapes_of_arrays_are_refused(function, shape):
    with pytest.raises(RotationError, match='must have shape'):
        function(np.zeros(shape))


@pytest.mark.parametrize(('matrix', 'rule'), [
    ([[1, 0, 0], [0, 1, 0], [0, 0, math.nan]], 'not finite'),
    ([[1, 0, 0], [0, 1, 0], [0, 0, math.inf]], 'not finite'),
    ([[0, 0, 0], [0, 0, 0], [0, 0, 0]], r'not orthonormal: column 0 has norm 0\.0'),
    ([[1, 0, 0], [0, 1.00002, 0], [0, 0, 1]], r'not orthonormal: column 1 has norm 1\.00002'),
    ([[1, 0, 1e-2], [0, 1, 0], [0, 0, 1]], 'not orthonormal: column 2'),
    ([[1, 2e-5, 0], [0, 1, 0], [0, 0, 1]], r'columns 0 and 1 have scalar product 2e-05'),
    ([[1e200, 0, 0], [0, 1, 0], [0, 0, 1]], 'not orthonormal: column 0 has norm inf'),
    ([[1, 0, 0], [0, 1, 0], [0, 0, -1]], 'determinant -1'),
    ([[0, 1, 0], [1, 0, 0], [0, 0, 1]], 'determinant -1'),
])
@pytest.mark.parametrize('function', [*FROM_MATRIX, check_matrix])
def test_matrices_must_be_rotations(function, matrix, rule):
    with pytest.raises(RotationError, match=rule):
        function(matrix)
    if function is not check_matrix:
        with pytest.raises(RotationError, match=f'row 2: .*{rule}'):
            function(np.array([EYE, EYE, matrix]))


@pytest.mark.parametrize('matrix', [(), ((1, 0, 0), (0, 1, 0)), ((1, 0), (0, 1), (0, 0)), 'abc'])
@pytest.mark.parametrize('function', [*FROM_MATRIX, check_matrix])
def test_matrices_must_be_three_by_three(function, matrix):
    with pytest.raises(RotationError):
        function(matrix)


def test_vectors_must_have_three_components():
    with pytest.raises(RotationError, match='vector must have shape'):
        rotation.rotated_vectors(IDENTITY, (1.0, 2.0))
    with pytest.raises(RotationError, match='vectors must have shape'):
        rotation.rotated_vectors(IDENTITY, np.zeros((5, 2)))


@pytest.mark.parametrize(('check', 'good', 'bad', 'rule'), [
    (check_rpy, (0.0, 1e300, -1.0), (0.0, math.nan, 0.0), 'not finite'),
    (check_quaternion, (0.0, 0.0, 0.0, 1e-300), (0.0, 0.0, 0.0, 0.0), 'zero'),
    (check_matrix, EYE, np.zeros((2, 2)), 'shape'),
])
def test_checks_take_what_is_right_and_name_what_is_not(check, good, bad, rule):
    assert np.array_equal(check(good), good)
    with pytest.raises(RotationError, match=rule):
        check(bad)


# Conventions.

@given(st.tuples(*[st.floats(-10.0, 10.0)] * 3))
def test_roll_pitch_yaw_turn_about_fixed_axes_in_this_order(rpy):
    roll, pitch, yaw = rpy
    by_definition = product_of_matrices(
        turn_about('z', yaw), product_of_matrices(turn_about('y', pitch), turn_about('x', roll))
    )
    assert np.allclose(rotation.matrix_from_rpy(rpy), by_definition, rtol=0.0, atol=1e-15)
    through_quaternion = rotation.matrix_from_quaternion(rotation.quaternion_from_rpy(rpy))
    assert np.allclose(through_quaternion, by_definition, rtol=0.0, atol=2e-15)


def test_quaternions_are_x_y_z_w():
    half = math.sqrt(0.5)
    assert rotation.quaternion_from_rpy((math.pi / 2, 0, 0)) == pytest.approx((half, 0, 0, half))
    assert rotation.quaternion_from_rpy((0, math.pi / 2, 0)) == pytest.approx((0, half, 0, half))
    assert rotation.quaternion_from_rpy((0, 0, math.pi / 2)) == pytest.approx((0, 0, half, half))


def test_a_product_turns_by_its_second_factor_first():
    quarter_x = rotation.quaternion_from_rpy((math.pi / 2, 0.0, 0.0))
    quarter_z = rotation.quaternion_from_rpy((0.0, 0.0, math.pi / 2))
    turned = rotation.rotated_vectors(rotation.quaternion_product(quarter_z, quarter_x), (0, 1, 0))
    assert turned == pytest.approx((0.0, 0.0, 1.0))


@given(directions, directions)
def test_a_product_is_the_product_of_the_matrices(a, b):
    product = rotation.matrix_from_quaternion(rotation.quaternion_product(a, b))
    expected = product_of_matrices(
        rotation.matrix_from_quaternion(a), rotation.matrix_from_quaternion(b)
    )
    assert np.allclose(product, expected, rtol=0.0, atol=2e-15)


@given(directions)
def test_an_inverse_turns_back(quat):
    inverse = rotation.quaternion_inverse(quat)
    assert rotation.quaternion_product(quat, inverse) == pytest.approx(IDENTITY, abs=1e-15)
    assert rotation.quaternion_product(inverse, quat) == pytest.approx(IDENTITY, abs=1e-15)


@given(directions, st.tuples(*[st.floats(-1e3, 1e3)] * 3))
def test_vectors_are_turned_by_the_matrix(quat, vector):
    expected = np.array(rotation.matrix_from_quaternion(quat)) @ vector
    assert rotation.rotated_vectors(quat, vector) == pytest.approx(expected, abs=1e-12)


# Canonical answers.

@given(rpys)
def test_quaternions_of_angles_of_any_size_are_canonical(rpy):
    x, y, z, w = rotation.quaternion_from_rpy(rpy)
    assert w >= 0.0
    assert abs(math.hypot(x, y, z, w) - 1.0) < 4e-16
    assert exact_turn((x, y, z, w), exact_quaternion(rpy)) <= LARGEST_TURN


@given(directions)
def test_angles_are_in_their_ranges(quat):
    roll, pitch, yaw = rotation.rpy_from_quaternion(quat)
    assert -math.pi <= roll <= math.pi
    assert -math.pi / 2 <= pitch <= math.pi / 2
    assert -math.pi <= yaw <= math.pi


@given(directions)
def test_rpy_comes_back_to_the_same_rotation(quat):
    again = rotation.quaternion_from_rpy(rotation.rpy_from_quaternion(quat))
    assert exact_turn(quat, again) <= LARGEST_TURN


@given(directions, st.floats(1e-300, 1e300))
def test_canonical_quaternions_stay_as_they_are(quat, scale):
    canonical = rotation.canonical_quaternion(tuple(scale * value for value in quat))
    assert rotation.canonical_quaternion(canonical) == canonical
    assert rotation.canonical_quaternion(np.array(canonical)).tolist() == list(canonical)


@pytest.mark.parametrize(('quat', 'canonical'), [
    ((0.0, 0.0, 0.0, -3.0), (0.0, 0.0, 0.0, 1.0)),
    ((-1.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)),
    ((0.0, -2.0, 0.0, -0.0), (0.0, 1.0, 0.0, 0.0)),
    ((-0.0, 0.0, -1e-300, 0.0), (0.0, 0.0, 1.0, 0.0)),
    ((0.0, -0.6, 0.8, 0.0), (0.0, 0.6, -0.8, 0.0)),
    ((0.6, -0.8, 0.0, -0.0), (0.6, -0.8, 0.0, 0.0)),
    ((5e-324, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)),
])
def test_the_sign_of_half_turns_is_chosen_by_the_first_component(quat, canonical):
    assert rotation.canonical_quaternion(quat) == canonical
    assert rotation.canonical_quaternion(np.array([quat])).tolist() == [list(canonical)]


@pytest.mark.parametrize('rpy', [(-0.0, -0.0, -0.0), (0.0, -0.0, 1.0), (math.pi, -0.0, -0.0)])
@pytest.mark.parametrize('through', [
    rotation.quaternion_from_rpy,
    rotation.matrix_from_rpy,
    lambda rpy: rotation.rpy_from_quaternion(rotation.quaternion_from_rpy(rpy)),
    lambda rpy: rotation.quaternion_inverse(rotation.quaternion_from_rpy(rpy)),
])
def test_no_negative_zeros_come_out(through, rpy):
    for answer in (through(rpy), through(np.array([rpy]))):
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
    quat = rotation.quaternion_from_rpy(rpy)
    # gz-math's own pitch is off by 1.6e-11 at 1.5708: it comes from an arc sine.
    assert rotation.rpy_from_quaternion(quat) == pytest.approx(expected, abs=2e-11)
    assert rotation.rpy_from_quaternion(np.array([quat]))[0] == pytest.approx(expected, abs=2e-11)
    assert rotation.near_gimbal_lock(quat) is lock
    assert rotation.near_gimbal_lock(np.array([quat])).tolist() == [lock]


@pytest.mark.parametrize('pitch', [math.pi / 2, -math.pi / 2])
def test_yaw_is_zero_at_lock_and_pitch_exactly_a_right_angle(pitch):
    rpy = random_rpy(20_000)
    rpy[:, 1] = pitch
    quats = rotation.quaternion_from_rpy(rpy)
    matrices = rotation.matrix_from_rpy(rpy)
    for answer in (rotation.rpy_from_quaternion(quats), rotation.rpy_from_matrix(matrices)):
        assert (answer[:, 2] == 0.0).all()
        assert (answer[:, 1] == pitch).all()
    ones = [rotation.rpy_from_quaternion(quat) for quat in quats[:200].tolist()]
    assert {one[1:] for one in ones} == {(pitch, 0.0)}


def test_near_lock_the_rotation_is_kept_where_gz_math_would_set_yaw_to_zero():
    rpy = (0.3, math.pi / 2 - 1e-9, 0.1)
    quat = rotation.quaternion_from_rpy(rpy)
    assert rotation.near_gimbal_lock(quat)
    answer = rotation.rpy_from_quaternion(quat)
    assert exact_turn(exact_quaternion(rpy), exact_quaternion(answer)) <= LARGEST_TURN


# One and many.

@pytest.mark.parametrize('function', [*FROM_RPY, *FROM_QUATERNION, *FROM_MATRIX])
@pytest.mark.parametrize('leading', [(), (0,), (1,), (7,), (2, 3), (4097,)])
def test_arrays_keep_their_leading_shape(function, leading):
    row = (3,) if function in FROM_RPY else (3, 3) if function in FROM_MATRIX else (4,)
    values = np.empty(leading + row)
    values[...] = EYE if row == (3, 3) else np.arange(1.0, 1.0 + row[0])
    answer = function(values)
    single = function(values[(0,) * len(leading)].tolist() if values.size else (
        EYE if row == (3, 3) else tuple(np.arange(1.0, 1.0 + row[0]))
    ))
    assert answer.shape == leading + np.shape(single)
    assert np.allclose(answer, single, rtol=0.0, atol=1e-15)


@pytest.mark.parametrize('function', [*FROM_RPY, *FROM_QUATERNION, *FROM_MATRIX])
def test_one_and_many_agree(function):
    rpy = np.concatenate((random_rpy(300), lock_rpy(300)))
    values = rpy if function in FROM_RPY else rotation.quaternion_from_rpy(rpy)
    if function in FROM_MATRIX:
        values = rotation.matrix_from_quaternion(values)
    many = function(values)
    ones = np.array([function(row) for row in values.tolist()])
    if function in (rotation.rpy_from_quaternion, rotation.rpy_from_matrix):
        many, ones = rotation.quaternion_from_rpy(many), rotation.quaternion_from_rpy(ones)
        assert largest_turn(many, ones) <= 2 * LARGEST_TURN
    elif function is not rotation.near_gimbal_lock:
        assert np.allclose(many, ones, rtol=0.0, atol=6e-16)
    else:
        assert (many == ones).mean() > 0.95


@pytest.mark.parametrize('prepare', [
    np.asfortranarray,
    lambda rows: np.repeat(rows, 2, axis=0)[::2],
    lambda rows: rows[::-1][::-1],
    lambda rows: rows.astype(np.float64).astype('>f8'),
    lambda rows: rows.tolist(),
], ids=['fortran', 'strided', 'reversed', 'big endian', 'nested lists'])
def test_memory_layout_does_not_matter(prepare):
    rpy = random_rpy(5000)
    assert np.array_equal(
        rotation.quaternion_from_rpy(prepare(rpy)), rotation.quaternion_from_rpy(rpy)
    )


def test_what_is_given_stays_as_it_was():
    quats = -3.0 * random_quaternions(100)
    before = quats.copy()
    for function in FROM_QUATERNION:
        function(quats)
    assert np.array_equal(quats, before)


def test_mixed_sizes_in_one_array_do_not_disturb_each_other():
    quats = random_quaternions(100)
    scales = 10.0 ** np.linspace(-300, 300, 100)
    scaled = quats * scales[:, None]
    for function in (rotation.rpy_from_quaternion, rotation.canonical_quaternion):
        assert np.allclose(function(scaled), function(quats), rtol=0.0, atol=2e-15)


def test_products_and_vectors_broadcast():
    quats = random_quaternions(6).reshape(2, 3, 4)
    other = rotation.quaternion_from_rpy((0.1, 0.2, 0.3))
    product = rotation.quaternion_product(quats, other)
    turned = rotation.rotated_vectors(quats, (1.0, 2.0, 3.0))
    assert product.shape == (2, 3, 4)
    assert turned.shape == (2, 3, 3)
    one = quats[1, 2].tolist()
    assert product[1, 2] == pytest.approx(rotation.quaternion_product(one, other), abs=1e-15)
    assert turned[1, 2] == pytest.approx(rotation.rotated_vectors(one, (1, 2, 3)), abs=1e-14)
    vectors = np.random.default_rng(1).normal(size=(5, 3))
    assert rotation.rotated_vectors(one, vectors)[4] == pytest.approx(
        rotation.rotated_vectors(one, vectors[4].tolist()), abs=1e-14
    )


# The nearest rotation to a matrix that is almost one.

def test_the_rotation_nearest_to_a_disturbed_matrix_is_found():
    rng = np.random.default_rng(4)
    quats = np.concatenate((random_quaternions(500), half_turns()))
    disturbed = rotation.matrix_from_quaternion(quats)
    disturbed += rng.uniform(-2.5e-6, 2.5e-6, disturbed.shape)
    left, _, right = np.linalg.svd(disturbed)
    nearest = left @ right
    answer = rotation.quaternion_from_matrix(disturbed)
    assert np.allclose(rotation.matrix_from_quaternion(answer), nearest, rtol=0.0, atol=1e-14)
    for matrix, expected in zip(disturbed[::9].tolist(), answer[::9], strict=False):
        assert rotation.quaternion_from_matrix(matrix) == pytest.approx(expected, abs=1e-15)
