# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Documentation of conversions, the names of errors of matrices, and degrees."""

import math

import numpy as np
import pytest

from sdf_pose_bridge.geometry.formulas import (
    degrees_from_radians,
    FLOATS,
    orthonormality,
    radians_from_degrees,
)
from sdf_pose_bridge.geometry.rotations import canonical_quaternion


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
