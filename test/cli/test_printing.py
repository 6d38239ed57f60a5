# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Poses in the units that a command prints."""

import math

from sdf_pose_bridge.cli.printing import DEGREES, MILLIMETRES, Units
from sdf_pose_bridge.geometry.poses import Pose


def test_pose_is_written_in_units():
    pose = Pose(1.25, -0.00001, 3.0, 0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))
    assert Units().texts(pose) == [
        '1.2500', '0.0000', '3.0000', '0.0000', '0.0000', '1.5708']
    assert Units(MILLIMETRES, DEGREES).texts(pose) == [
        '1250.0', '0.0', '3000.0', '0.00', '0.00', '90.00']
