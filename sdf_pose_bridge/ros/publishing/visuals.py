# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Publish the shapes of the links for RViz while there is a subscriber."""

from __future__ import annotations

from collections.abc import Generator
import math

from rclpy.node import Node
from visualization_msgs.msg import MarkerArray

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.export.published_scene import fingerprint_of_scene, LoadedScene
from sdf_pose_bridge.ros.file_process import FileProcess
from sdf_pose_bridge.ros.log_lines import line_from_text, lines_from_error, lines_from_warnings
from sdf_pose_bridge.ros.publishing.publishers import SwitchedPublisher, Topic
from sdf_pose_bridge.ros.publishing.visual_messages import serialized_markers_from_text

WAITING_S = 0.02
"""Time in s between two looks whether another process has made the markers."""


class VisualPublisher:
    """
    Publishes ``~/visuals``.

    The topic exists once it is switched on. Shapes are read and markers made for the first
    subscriber, and again for each new scene while there are subscribers.

    :param reader: reads shapes.
    """

    def __init__(self, node: Node, reader: FileProcess, loaded: LoadedScene) -> None:
        self._logger = node.get_logger()
        self._reader = reader
        self._loaded = loaded
        self._shown: LoadedScene | None = None
        self._publisher = SwitchedPublisher(node, Topic('~/visuals', MarkerArray))
        self._work = self._publishing(loaded)

    def switch(self, *, on: bool) -> None:
        """Start or stop publishing."""
        self._publisher.switch(on=on)
        self._shown = self._shown if on else None

    def replace(self, loaded: LoadedScene) -> None:
        """Show another scene from now on; markers of the one before are no longer made."""
        self._loaded = loaded
        self._work.close()

    def go_on(self) -> float:
        """Begin or go on if there is something to do; return the time in s until there may be."""
        if self._shown is not self._loaded and self._publisher.has_listeners():
            self._shown = self._loaded
            self._work = self._publishing(self._loaded)
        elif self._shown is None:
            return math.inf
        return next(self._work, math.inf)

    def _publishing(self, loaded: LoadedScene) -> Generator[float, None, None]:
        """Publish the visuals of a scene; yield while another process makes them."""
        reasons = [
            f'a file that {line_from_text(loaded.path)} includes has changed since it was read']
        try:
            with self._reader.calling(
                    loaded.request, serialized_markers_from_text, loaded.text, loaded.path,
                    loaded.request, fingerprint_of_scene(loaded.scene),
                    loaded.tree.root_frame) as call:
                while not call.has_ended(0.0):
                    yield WAITING_S
                found = call.result()
        except SdfError as error:
            found, reasons = None, lines_from_error(error)
        if found is None:
            for reason in reasons:
                self._logger.warning(f'~/visuals is not updated: {reason}')
            return
        message, warnings = found
        for line in lines_from_warnings(warnings):
            self._logger.warning(line)
        self._publisher.publish(message)
