# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Functions for floats return what numpy's functions of the same names return."""

import itertools
import math

import numpy as np
import pytest

from sdf_pose_bridge.geometry import floats

VALUES = (-0.0, 0.0, 1.0, -2.5, 1e-310, -1e300, 0.75)
ALL_VALUES = (*VALUES, math.nan, math.inf, -math.inf)


def assert_same(one, expected):
    """Compare two floats, and the sign of a zero."""
    assert math.copysign(1.0, one) == math.copysign(1.0, expected) or math.isnan(expected)
    assert one == pytest.approx(float(expected), rel=4e-16, abs=0.0, nan_ok=True)


def functions_of_numpy():
    """Return the names of all functions, by the number of their arguments."""
    names = [name for name, value in vars(floats).items()
             if callable(value) and not isinstance(value, type) and hasattr(np, name)]
    return {
        count: [name for name in names if getattr(getattr(np, name), 'nin', 0) == count]
        for count in (1, 2)}


@pytest.mark.parametrize('name', functions_of_numpy()[1])
def test_functions_of_one_float(name):
    for value in ALL_VALUES if name == 'isfinite' else VALUES:
        if name == 'sqrt' and value < 0.0:
            continue
        one, expected = getattr(floats, name)(value), getattr(np, name)(value)
        if name == 'frexp':
            assert one == (float(expected[0]), int(expected[1]))
        else:
            assert_same(one, expected)


@pytest.mark.parametrize('name', functions_of_numpy()[2])
def test_functions_of_two_floats(name):
    for first, second in itertools.product(VALUES, repeat=2):
        if name == 'fmod' and second == 0.0:
            continue
        if name == 'ldexp':
            second = int(max(-10.0, min(second, 10.0)))
        one, expected = getattr(floats, name)(first, second), getattr(np, name)(first, second)
        if first != second:  # of two equal zeros either may be the larger
            assert_same(one, expected)


@pytest.mark.parametrize('condition', [True, False])
def test_conditions(condition):
    assert floats.where(condition, 1.0, 2.0) == np.where(condition, 1.0, 2.0)
    assert floats.any(condition) == np.any(condition)
    assert floats.all(condition) == np.all(condition)
