#!/usr/bin/env python3
# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Subscribe to the pose of a frame, and call services of the bridge.

When the pose arrives or changes, the node asks the bridge for the pose relative to another frame,
and converts its rotation. ``cpp_client`` does the same in C++. Start the bridge in one shell, and
this in another::

    ros2 run sdf_pose_bridge bridge --ros-args -p sdf_file:=examples/work_cell.sdf
    python3 examples/python_client.py --ros-args -p frame:=fixture
"""

from geometry_msgs.msg import PoseStamped
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.task import Future

from sdf_pose_bridge.tf.frame_ids import topic_name_from_frame_id
from sdf_pose_bridge_interfaces.srv import ConvertRotation, LookupPose


class Client(Node):
    """Logs where a frame is."""

    def __init__(self) -> None:
        super().__init__('python_client')
        self.frame = self.declare_parameter('frame', 'robot/tool0').value
        self.relative_to = self.declare_parameter('relative_to', 'table').value
        bridge = self.declare_parameter('bridge', '/sdf_pose_bridge').value

        self.lookup_pose = self.create_client(LookupPose, f'{bridge}/lookup_pose')
        self.convert_rotation = self.create_client(ConvertRotation, f'{bridge}/convert_rotation')
        # A request that is sent before the service is found gets no response.
        for service in (self.lookup_pose, self.convert_rotation):
            while not service.wait_for_service(timeout_sec=1.0):
                self.get_logger().info(f'waiting for {service.service_name}')

        # A pose is published once, and again when it changes or the file is read again. A
        # transient local subscription gets the last message even if it starts later; a volatile
        # one, the default, would miss it. Characters that a topic cannot have are escaped.
        latched = QoSProfile(
            depth=1, reliability=ReliabilityPolicy.RELIABLE,
            durability=DurabilityPolicy.TRANSIENT_LOCAL)
        topic = f'{bridge}/poses/{topic_name_from_frame_id(self.frame)}'
        self.create_subscription(PoseStamped, topic, self.take_pose, latched)

    def take_pose(self, pose: PoseStamped) -> None:
        """Log a pose, and ask for the pose relative to the other frame."""
        self.log_position(pose)
        request = LookupPose.Request(frame=self.frame, relative_to=self.relative_to)
        # The response comes to a callback. Waiting for it in this one would block the executor,
        # which has to receive it.
        self.lookup_pose.call_async(request).add_done_callback(self.take_looked_up_pose)

    def take_looked_up_pose(self, future: Future) -> None:
        """Log the pose relative to the other frame, and convert its rotation."""
        response = future.result()
        if not response.success:  # a name that the file does not have; the message says which
            self.get_logger().error(response.message)
            return
        self.log_position(response.pose)
        request = ConvertRotation.Request(
            given=ConvertRotation.Request.QUATERNION,
            quaternion=response.pose.pose.orientation, degrees=True)
        self.convert_rotation.call_async(request).add_done_callback(self.take_rotation)

    def take_rotation(self, future: Future) -> None:
        """Log a rotation."""
        rpy = future.result().rpy
        self.get_logger().info(
            f'roll pitch yaw: {rpy.x:.2f} {rpy.y:.2f} {rpy.z:.2f} degrees')

    def log_position(self, pose: PoseStamped) -> None:
        """Log the position of the frame."""
        xyz = pose.pose.position
        self.get_logger().info(
            f'{self.frame} in {pose.header.frame_id}: xyz {xyz.x:.4f} {xyz.y:.4f} {xyz.z:.4f} m')


def main() -> None:
    rclpy.init()
    try:
        rclpy.spin(Client())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass  # rclpy has shut ROS down
    except RuntimeError:
        if rclpy.ok():  # else it was shut down in the middle of a call
            raise


if __name__ == '__main__':
    main()
