# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Messages have every number exactly and in its place."""

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from geometry_msgs.msg import PoseStamped

from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.ros.messages import fill_pose_stamped


def test_a_pose_has_its_numbers_in_their_places():
    message = PoseStamped()
    fill_pose_stamped(message, Pose(0.1, -1e-300, 1e300, 0.1, 0.3, 0.5, 0.8), 'map', (0, 0))
    place, turn = message.pose.position, message.pose.orientation
    assert (place.x, place.y, place.z) == (0.1, -1e-300, 1e300)
    assert (turn.x, turn.y, turn.z, turn.w) == (0.1, 0.3, 0.5, 0.8)


def test_a_pose_has_its_frame_and_time():
    message = PoseStamped()
    fill_pose_stamped(message, Pose(), 'map', (12, 34))
    assert message.header.frame_id == 'map'
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (12, 34)
