# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Publish the text of a robot, as robot_state_publisher does."""

from __future__ import annotations

from rclpy.node import Node
from rclpy.publisher import Publisher
from std_msgs.msg import String

from sdf_pose_bridge.ros.publishers import new_publisher
from sdf_pose_bridge.ros.publishers import Topic

TOPIC = Topic('robot_description', String)
"""With the quality of service that it has in robot_state_publisher."""


class RobotDescription:
    """
    The topic ``robot_description``, which exists while there is a text for it.

    :param node: the node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._publisher: Publisher | None = None

    def update(self, text: str) -> None:
        """
        Publish a text.

        :param text: the text; if it is empty, there is no topic, so that nobody gets a text of the
            past.
        """
        if text:
            self._publisher = self._publisher or new_publisher(self._node, TOPIC)
            self._publisher.publish(String(data=text))
        elif self._publisher is not None:
            self._node.destroy_publisher(self._publisher)
            self._publisher = None
