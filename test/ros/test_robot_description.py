# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The topic of a robot's text: latched, and there only while there is a text."""

import time

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile
from std_msgs.msg import String

from sdf_pose_bridge.ros.robot_description import RobotDescription


def test_each_text_is_published_and_nothing_without_one(node):
    quality = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    received, sent = [], []
    node.create_subscription(
        String, 'robot_description', lambda message: received.append(message.data), quality)
    description = RobotDescription(node)
    for text in ('<robot/>', '<robot/>', '', '<robot name="r"/>'):
        description.update(text)
        assert node.count_publishers('robot_description') == bool(text)
        if text:
            sent.append(text)
            deadline = time.monotonic() + 20
            while len(received) < len(sent):
                assert time.monotonic() < deadline
                node.executor.spin_once(timeout_sec=0.1)
    assert received == sent
