# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Formulas for one and many: functions for floats, invalid rotations, and blocks of rows."""

import itertools
import math

import numpy as np
import pytest

from sdf_pose_bridge.geometry.formulas import (
    BLOCK,
    degrees_from_radians,
    FLOATS,
    InvalidRotationError,
    orthonormality,
    radians_from_degrees,
    row_blocks,
)
from sdf_pose_bridge.geometry.rotations import canonical_quaternion

VALUES = (-0.0, 0.0, 1.0, -2.5, 1e-310, -1e300, 0.75)
ALL_VALUES = (*VALUES, math.nan, math.inf, -math.inf)


def assert_same(one, expected):
    """Compare two floats, and the sign of a zero."""
    assert math.copysign(1.0, one) == math.copysign(1.0, expected) or math.isnan(expected)
    assert one == pytest.approx(float(expected), rel=4e-16, abs=0.0, nan_ok=True)


def functions_of_numpy():
    """Return the names of all functions, by the number of their arguments."""
    names = [name for name, value in vars(FLOATS).items()
             if not isinstance(value, type)]
    return {
        count: [name for name in names if getattr(getattr(np, name), 'nin', 0) == count]
        for count in (1, 2)}


@pytest.mark.parametrize('name', functions_of_numpy()[1])
def test_functions_of_one_float(name):
    for value in ALL_VALUES if name == 'isfinite' else VALUES:
        if name == 'sqrt' and value < 0.0:
            continue
        one, expected = getattr(FLOATS, name)(value), getattr(np, name)(value)
        if name == 'frexp':
            assert one == (float(expected[0]), int(expected[1]))
        else:
            assert_same(one, expected)


@pytest.mark.parametrize('name', functions_of_numpy()[2])
def test_functions_of_two_floats(name):
    for first, second in itertools.product(VALUES, repeat=2):
        if name == 'ldexp':
            second = int(max(-10.0, min(second, 10.0)))
        one, expected = getattr(FLOATS, name)(first, second), getattr(np, name)(first, second)
        if first != second:  # of two equal zeros either may be the larger
            assert_same(one, expected)


@pytest.mark.parametrize('condition', [True, False])
def test_conditions(condition):
    assert FLOATS.where(condition, 1.0, 2.0) == np.where(condition, 1.0, 2.0)
    assert FLOATS.any(condition) == np.any(condition)
    assert FLOATS.all(condition) == np.all(condition)


def test_the_rotations_that_are_not_valid_are_told():
    with pytest.raises(InvalidRotationError) as caught:
        canonical_quaternion.formula(np, *np.array([[0.0, 0, 0, 1], [0, 0, 0, 0]]).T)
    assert caught.value.args[0].tolist() == [True, False]


@pytest.mark.parametrize('count', [0, 1, BLOCK, BLOCK + 1])
def test_blocks_hold_every_row_once(count):
    rows = list(range(count))
    assert [row for block in row_blocks(count) for row in rows[block]] == rows


def test_a_conversion_has_the_documentation_of_its_formula():
    assert canonical_quaternion.__name__ == 'canonical_quaternion'
    assert canonical_quaternion.__doc__ == canonical_quaternion.formula.__doc__


def test_rows_columns_and_products_are_named():
    matrix = ((1.0, 0.0, 5.0), (0.0, 2.0, 0.0), (0.0, 0.0, 3.0))
    found = {what: value for value, _, what in orthonormality(FLOATS, *matrix)}
    assert found == {
        'column 0 has norm': 1.0, 'column 1 has norm': 2.0,
        'column 2 has norm': math.sqrt(34.0), 'row 0 has norm': math.sqrt(26.0),
        'row 1 has norm': 2.0, 'row 2 has norm': 3.0,
        'columns 0 and 1 have scalar product': 0.0, 'columns 0 and 2 have scalar product': 5.0,
        'columns 1 and 2 have scalar product': 0.0}


@pytest.mark.parametrize(('degrees', 'radians'), [
    (90.0, 0.5 * math.pi), (-90.0, -0.5 * math.pi), (360.0, 0.0),
    (3.6e17 + 64.0, 64.0 / 180.0 * math.pi),
])
def test_radians_of_degrees_of_any_size(degrees, radians):
    assert radians_from_degrees(np.array(degrees)) == pytest.approx(radians, rel=3e-16)


def test_degrees_of_a_right_angle_are_exact():
    assert degrees_from_radians(0.5 * math.pi) == 90.0
