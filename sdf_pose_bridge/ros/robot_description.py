# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Publish the text of a robot, as robot_state_publisher does."""

from __future__ import annotations

from lxml import etree
from rclpy.node import Node
from rclpy.publisher import Publisher
from std_msgs.msg import String

from sdf_pose_bridge.ros.loaded_scene import LoadedScene
from sdf_pose_bridge.ros.publishers import new_publisher
from sdf_pose_bridge.ros.publishers import Topic
from sdf_pose_bridge.sdformat.xml_file import xml_from_bytes

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
        self._loaded: LoadedScene | None = None

    def update(self, loaded: LoadedScene | None) -> None:
        """
        Publish the text of a scene, unless it is published already.

        :param loaded: the scene; for a world, or None, there is no topic, so that nobody gets a
            text of the past.
        """
        if loaded is None or loaded.tree.world:
            if self._publisher is not None:
                self._node.destroy_publisher(self._publisher)
                self._publisher = None
        elif self._publisher is None or loaded is not self._loaded:
            self._publisher = self._publisher or new_publisher(self._node, TOPIC)
            self._publisher.publish(String(data=unicode_text(loaded.text)))
        self._loaded = loaded


def unicode_text(text: str | bytes) -> str:
    """
    Return XML as text.

    :param text: XML; bytes are in the encoding that they declare.
    :return: the text; of bytes that are not UTF-8 without the declaration, which is wrong for it.
    """
    if isinstance(text, str):
        return text
    try:
        return text.decode('utf-8-sig')
    except UnicodeDecodeError:
        return str(etree.tostring(xml_from_bytes(text, '').root, encoding='unicode'))
