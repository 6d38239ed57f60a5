# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What a new user runs first."""

from pathlib import Path
import subprocess
import sys

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

DEMO = Path(__file__).resolve().parents[2] / 'examples/demo.py'


def test_the_demonstration_receives_every_frame_in_every_way():
    done = subprocess.run(
        [sys.executable, DEMO], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    assert (
        '49 transforms on /tf_static, 49 on /sdf_pose_bridge/transforms, '
        '49 poses on /sdf_pose_bridge/poses/...') in done.stdout
