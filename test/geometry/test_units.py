# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Texts of poses in units; test_convert.py and test_set.py have those that are typed."""

import math

import pytest

from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.units import DEGREES, METRES, MILLIMETRES, RADIANS, Units


def test_pose_is_written_in_units():
    pose = Pose(1.25, -0.00001, 3.0, 0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))
    assert Units().texts(pose) == [
        '1.2500', '-1e-05', '3.0000', '0.0000', '0.0000', '1.5708']
    assert Units(MILLIMETRES, DEGREES).texts(pose) == [
        '1250.0', '-0.01', '3000.0', '0.00', '0.00', '90.00']


@pytest.mark.parametrize('unit', [METRES, MILLIMETRES, RADIANS, DEGREES])
@pytest.mark.parametrize('digits', [None, 0, 1, 3, 15])
@pytest.mark.parametrize('value', [
    0.0, -0.0, 9e-10, 1e-9, -1.1e-9, 4e-8, 3.5e-5, -4.4e-4, 4.6e-4, 0.0123, 0.049, -0.51, 1e9])
def test_no_number_but_zero_is_written_as_zero(unit, digits, value):
    if digits is not None:
        unit = unit._replace(digits=digits)
    text = unit.rounded(value)
    assert (float(text) == 0.0) == (abs(value) < 1e-9)
    assert float(text) == pytest.approx(
        value * unit.factor, abs=max(0.5 * 10.0 ** -unit.digits, 1e-9 * unit.factor))
