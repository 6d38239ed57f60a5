# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The node: reads its parameters, publishes the frames of a file and offers services."""

from __future__ import annotations

from rclpy.node import Node

from sdf_pose_bridge.content import Content
from sdf_pose_bridge.conversion_services import add_conversion_services
from sdf_pose_bridge.log_lines import lines_from_warnings
from sdf_pose_bridge.publications import Publications
from sdf_pose_bridge.settings import Settings

NODE_NAME = 'sdf_pose_bridge'


class SdfPoseBridge(Node):
    """The node; it serves nothing before :meth:`serve`."""

    def __init__(self) -> None:
        super().__init__(NODE_NAME)

    def serve(self, settings: Settings, content: Content) -> None:
        """
        Publish what a file holds, and offer services.

        :param settings: what the node is set to do.
        :param content: what it shall serve.
        """
        publications = Publications(self)
        transforms = publications.publish(content.tree, settings.pose_topics)
        add_conversion_services(self)
        for line in lines_from_warnings(content.warnings):
            self.get_logger().warning(line)
        self.get_logger().info(
            f'publishing {_count(len(content.tree.frame_ids), "frame")} of {content.path} with '
            f'{_count(transforms, "transform")}, root frame "{content.tree.root_frame}" '
            f'(read in {1e3 * content.seconds:.0f} ms)')


def _count(number: int, what: str) -> str:
    return f'{number} {what}' if number == 1 else f'{number} {what}s'
