#!/usr/bin/env python3
# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Publish poses of the part in the work cell, as a tracker or an object detector does.

The part circles above a frame: the table, or the gripper, which moves with the robot. Start the
bridge in one shell, and this in another::

    ros2 run sdf_pose_bridge bridge --ros-args -p sdf_file:=examples/work_cell.sdf \
        -p "model_pose_topics:=['/tracker/{model}/pose']"
    python3 examples/track_part.py --ros-args -p frame:=table
"""

import contextlib
import math
import time

from geometry_msgs.msg import PoseStamped
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Tracker(Node):
    """Publishes the pose of the part twenty times a second."""

    def __init__(self) -> None:
        super().__init__('tracker')
        self.pose = PoseStamped()
        self.pose.header.frame_id = self.declare_parameter('frame', 'table').value
        self.publisher = self.create_publisher(PoseStamped, '/tracker/gear_housing/pose', 10)
        self.create_timer(0.05, self.publish)

    def publish(self) -> None:
        """Publish the current pose."""
        angle = time.monotonic()
        self.pose.header.stamp = self.get_clock().now().to_msg()
        position, quaternion = self.pose.pose.position, self.pose.pose.orientation
        position.x, position.y, position.z = 0.1 * math.cos(angle), 0.1 * math.sin(angle), 0.2
        quaternion.z, quaternion.w = math.sin(0.5 * angle), math.cos(0.5 * angle)
        self.publisher.publish(self.pose)


def main() -> None:
    rclpy.init()
    # rclpy has shut ROS down then.
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(Tracker())


if __name__ == '__main__':
    main()
