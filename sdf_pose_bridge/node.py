# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The node: reads its parameters, publishes the frames of a file and offers services."""

from __future__ import annotations

from pathlib import Path
import time
from typing import NamedTuple

from ament_index_python.packages import get_package_share_directory
from rclpy.node import Node

from sdf_pose_bridge.conversion_services import add_conversion_services
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.file_address import path_from_address
from sdf_pose_bridge.loading import load
from sdf_pose_bridge.log_lines import lines_from_warnings
from sdf_pose_bridge.publications import Publications
from sdf_pose_bridge.settings import Settings
from sdf_pose_bridge.tf_tree import tf_tree_from_scene
from sdf_pose_bridge.tf_tree import TfTree

NODE_NAME = 'sdf_pose_bridge'


class Content(NamedTuple):
    """What a file holds, as far as it is to be published."""

    path: Path
    tree: TfTree
    warnings: tuple[SdfWarning, ...]
    seconds: float
    """How long it took to get here from the file."""


def content_from_settings(settings: Settings) -> Content:
    """
    Read the file and lay out its frames.

    :param settings: what the node is set to do.
    :return: what to serve.
    :raises AddressError: if ``sdf_file`` is a URI that leads nowhere.
    :raises SdfError: if the file is not valid, or cannot be published as the settings say.
    """
    begin = time.perf_counter()
    path = path_from_address(settings.sdf_file, get_package_share_directory)
    scene = load(path, resource_paths=settings.resource_paths)
    tree = tf_tree_from_scene(scene, settings.tf_options)
    warnings = (*scene.warnings, *tree.warnings)
    return Content(path, tree, warnings, time.perf_counter() - begin)


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
