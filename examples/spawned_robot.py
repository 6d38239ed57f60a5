#!/usr/bin/env python3
# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Publish the frames of a robot from a node of your own, such as one that spawns it.

    python3 examples/spawned_robot.py examples/mobile_robot.sdf robot_1

Needs tf2_ros. The arguments of ``transforms_from_parameters`` are parameters of the node.
"""

import contextlib
import sys

import rclpy
from rclpy.executors import ExternalShutdownException
from tf2_ros import StaticTransformBroadcaster

from sdf_pose_bridge.ros.transforms import transforms_from_parameters


def main() -> None:
    """Publish the frames of the file, with the name of the robot, until Ctrl-C."""
    if len(sys.argv) != 3:
        sys.exit('usage: spawned_robot.py FILE NAME')
    sdf_file, name = sys.argv[1:]
    rclpy.init()
    node = rclpy.create_node('spawner')
    broadcaster = StaticTransformBroadcaster(node)
    broadcaster.sendTransform(transforms_from_parameters(sdf_file=sdf_file, model_name=name))
    with contextlib.suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)


if __name__ == '__main__':
    main()
