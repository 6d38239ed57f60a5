# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Messages that come at the same time; everything else is in the tests of joint states."""

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from sdf_pose_bridge.ros.joint_state_thread import _merged


def test_messages_that_come_together_share_a_message_unless_they_name_the_same_joint():
    one, other = (np.array([2, 3]), 5), (np.array([0, 1]), 7)
    (rows, stamps_ns), = _merged([one, other])
    assert (rows.tolist(), stamps_ns.tolist()) == ([0, 1, 2, 3], [7, 7, 5, 5])
    assert len(_merged([one, one])) == 2
