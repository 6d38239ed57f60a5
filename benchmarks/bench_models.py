# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Models that move, compared with a node that receives the same messages and does nothing."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import time
from typing import TYPE_CHECKING

from benchmarks.bench_joints import shares_while_publishing
from benchmarks.harness import AtMostTimes, benchmark, Function, wait_until

if TYPE_CHECKING:
    from rclpy.node import Node

RATE_HZ = 100.0

RECEIVER = """
import sys
import rclpy
from geometry_msgs.msg import PoseStamped
from rclpy.qos import qos_profile_sensor_data
rclpy.init(signal_handler_options=rclpy.signals.SignalHandlerOptions.NO)
node = rclpy.create_node('counterpart')
for number in range(int(sys.argv[1])):
    node.create_subscription(
        PoseStamped, f'/model/m{number}/pose', lambda message: None, qos_profile_sensor_data)
rclpy.spin(node)
"""


def world_text(models: int) -> str:
    """Write a world of models with one link each."""
    parts = ''.join(
        f'<model name="m{number}"><link name="l"/></model>' for number in range(models))
    return f'<sdf version="1.10"><world name="w">{parts}</world></sdf>'


def sender(models: int) -> Callable[[Node], Callable[[], None]]:
    """Return a function that makes publishers, and returns one that publishes all poses."""
    def publishing(node: Node) -> Callable[[], None]:
        from geometry_msgs.msg import PoseStamped
        message = PoseStamped()
        publishers = [
            node.create_publisher(PoseStamped, f'/model/m{number}/pose', 10)
            for number in range(models)]
        wait_until(
            lambda: all(each.get_subscription_count() >= 2 for each in publishers),
            'the nodes did not subscribe to the poses')

        def publish() -> None:
            stamp = message.header.stamp
            stamp.sec, stamp.nanosec = divmod(time.time_ns(), 10**9)
            message.pose.position.x = stamp.nanosec * 1e-9
            for publisher in publishers:
                publisher.publish(message)
        return publish
    return publishing


@benchmark(
    '30 models at 100 Hz, each message published, processor time in each second',
    counterpart='a minimal node that receives and does nothing', goal=AtMostTimes(0.95))
def share_of_30_models() -> Iterator[tuple[Function, Function | None]]:
    with shares_while_publishing(
            world_text(30), ["model_pose_topics:=['/model/{model}/pose']"], (RECEIVER, '30'),
            sender(30), RATE_HZ) as pair:
        yield pair
