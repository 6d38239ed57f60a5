# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Texts of poses in units; test_convert.py and test_set.py have those that are typed."""

import math

from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.units import DEGREES, MILLIMETRES, Units


def test_pose_is_written_in_units():
    pose = Pose(1.25, -0.00001, 3.0, 0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))
    assert Units().texts(pose) == [
        '1.2500', '0.0000', '3.0000', '0.0000', '0.0000', '1.5708']
    assert Units(MILLIMETRES, DEGREES).texts(pose) == [
        '1250.0', '0.0', '3000.0', '0.00', '0.00', '90.00']
