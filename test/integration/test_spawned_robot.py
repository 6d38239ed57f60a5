# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The example of a node that publishes the frames of a robot by itself."""

import sys

from folders import EXAMPLES
import pytest

pytest.importorskip('tf2_ros', reason='needs tf2_ros, which is not installed')

from sdf_pose_bridge.ros.transforms import transforms_from_parameters


def test_the_example_publishes_all_frames_of_the_robot(start_program, start_listener):
    listener = start_listener()
    listener.listen_to_frames()
    file = EXAMPLES / 'mobile_robot.sdf'
    spawner = start_program([sys.executable, EXAMPLES / 'spawned_robot.py', file, 'robot_1'])
    listener.wait(lambda: listener.tf_messages, lambda: spawner.lines)
    assert listener.tf_messages[-1].transforms == transforms_from_parameters(
        sdf_file=str(file), model_name='robot_1')
