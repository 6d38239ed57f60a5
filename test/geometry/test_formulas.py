# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Formulas of rotations: which numbers they refuse, units, and blocks of rows."""

import math

import numpy as np
import pytest

from sdf_pose_bridge.geometry import floats, formulas
from sdf_pose_bridge.geometry.formulas import InvalidRotationError


def columns_of_matrices(*matrices):
    """Return the elements of matrices as arrays with one element for each matrix."""
    return tuple(map(tuple, np.moveaxis(np.array(matrices), 0, -1)))


# Invalid numbers.


def test_the_rotations_that_are_not_valid_are_told():
    with pytest.raises(InvalidRotationError) as caught:
        formulas.canonical_quaternion(np, *np.array([[0.0, 0, 0, 1], [0, 0, 0, 0]]).T)
    assert caught.value.is_valid.tolist() == [True, False]


@pytest.mark.parametrize('place', range(9))
def test_every_element_of_a_matrix_is_checked(place):
    wrong = np.eye(3)
    wrong.flat[place] += 2.0 * formulas.MATRIX_TOLERANCE
    with pytest.raises(InvalidRotationError) as caught:
        formulas.quaternion_from_matrix(np, *columns_of_matrices(np.eye(3), wrong))
    assert caught.value.is_valid.tolist() == [True, False]


# What is determined by a matrix.


def test_determinant():
    assert formulas.determinant((1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (7.0, 8.0, 10.0)) == -3.0


def test_rows_columns_and_products_are_named():
    matrix = ((1.0, 0.0, 5.0), (0.0, 2.0, 0.0), (0.0, 0.0, 3.0))
    found = {what: value for value, _, what in formulas.orthonormality(floats, *matrix)}
    assert found == {
        'column 0 has norm': 1.0, 'column 1 has norm': 2.0,
        'column 2 has norm': math.sqrt(34.0), 'row 0 has norm': math.sqrt(26.0),
        'row 1 has norm': 2.0, 'row 2 has norm': 3.0,
        'columns 0 and 1 have scalar product': 0.0, 'columns 0 and 2 have scalar product': 5.0,
        'columns 1 and 2 have scalar product': 0.0}


# Angles.


@pytest.mark.parametrize(('degrees', 'radians'), [
    (90.0, 0.5 * math.pi), (-90.0, -0.5 * math.pi), (360.0, 0.0),
    (3.6e17 + 64.0, 64.0 / 180.0 * math.pi),
])
def test_radians_of_degrees_of_any_size(degrees, radians):
    assert formulas.radians_from_degrees(floats, degrees) == pytest.approx(radians, rel=3e-16)


def test_degrees_of_a_right_angle_are_exact():
    assert formulas.degrees_from_radians(0.5 * math.pi) == 90.0


# One and many.


@pytest.mark.parametrize('count', [0, 1, formulas.BLOCK, formulas.BLOCK + 1])
def test_blocks_hold_every_row_once(count):
    rows = list(range(count))
    assert [row for block in formulas.row_blocks(count) for row in rows[block]] == rows
