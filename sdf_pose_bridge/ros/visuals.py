# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Publish the shapes of the links for RViz while there is a subscriber."""

from __future__ import annotations

from collections.abc import Iterable

from geometry_msgs.msg import Point, Quaternion, Vector3
from geometry_msgs.msg import Pose as PoseMessage
from rclpy.node import Node
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.ros.background import Worker
from sdf_pose_bridge.ros.log_lines import lines_from_error, lines_from_warnings
from sdf_pose_bridge.ros.publishers import SwitchedPublisher, Topic
from sdf_pose_bridge.ros.scene_reader import SceneReader
from sdf_pose_bridge.tf.loaded_scene import fingerprint_of_scene, LoadedScene
from sdf_pose_bridge.tf.visual_markers import markers_from_text, VisualMarker


class VisualPublisher:
    """
    Publishes ``~/visuals``.

    The topic exists once it is switched on. Shapes are read and markers made for the first
    subscriber, and again for each new scene while there are subscribers.

    :param reader: reads shapes.
    """

    def __init__(self, node: Node, reader: SceneReader, loaded: LoadedScene) -> None:
        self._node = node
        self._worker = Worker(node)
        self._reader = reader
        self._loaded = loaded
        self._shown: LoadedScene | None = None
        self._publisher = SwitchedPublisher(
            node, Topic('~/visuals', MarkerArray), lambda _: self._publish_to_listeners())

    def switch(self, *, on: bool) -> None:
        """Start or stop publishing."""
        self._publisher.switch(on=on)
        self._shown = self._shown if on else None

    def replace(self, loaded: LoadedScene) -> None:
        """Show another scene from now on."""
        self._loaded = loaded
        self._publish_to_listeners()

    def _publish_to_listeners(self) -> None:
        if self._shown is not self._loaded and self._publisher.has_listeners():
            self._shown = self._loaded
            self._node.executor.create_task(self._publish, self._loaded)

    async def _publish(self, loaded: LoadedScene) -> None:
        message, lines = await self._worker.run(
            lambda: _message_and_warnings(loaded, self._reader))
        if loaded is not self._loaded:
            return
        for line in lines:
            self._node.get_logger().warning(line)
        if message is not None:
            self._publisher.publish(message)


def _message_and_warnings(
    loaded: LoadedScene, reader: SceneReader,
) -> tuple[MarkerArray | None, list[str]]:
    try:
        found = reader.result(
            loaded.request, markers_from_text, loaded.text, loaded.path, loaded.request,
            fingerprint_of_scene(loaded.scene))
    except (SdfError, MemoryError) as error:
        return None, [f'~/visuals is not updated: {line}' for line in lines_from_error(error)]
    if found is None:
        return None, [
            (f'~/visuals is not updated: a file that {loaded.path} includes has changed since it '
             'was read')]
    markers, warnings = found
    return message_from_markers(markers, loaded.tree.root_frame), lines_from_warnings(warnings)


def message_from_markers(markers: Iterable[VisualMarker], root_frame: str) -> MarkerArray:
    """
    Make the message of all markers.

    :param root_frame: frame id of the root.
    :return: the message; it first deletes all markers of earlier messages. Stamps are zero, so
        that RViz uses the latest transforms.
    """
    delete_all = Marker(header=Header(frame_id=root_frame), action=Marker.DELETEALL)
    return MarkerArray(markers=[
        delete_all,
        *(_marker_message(marker, number) for number, marker in enumerate(markers, start=1))])


def _marker_message(marker: VisualMarker, number: int) -> Marker:
    x, y, z, qx, qy, qz, qw = marker.pose
    # No color means the materials of the mesh itself.
    red, green, blue, alpha = marker.rgba or (0.0, 0.0, 0.0, 0.0)
    return Marker(
        header=Header(frame_id=marker.frame_id), frame_locked=True,
        ns=marker.namespace, id=number, action=Marker.ADD, type=getattr(Marker, marker.type),
        pose=PoseMessage(
            position=Point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw)),
        scale=Vector3(**dict(zip('xyz', marker.scale, strict=True))),
        color=ColorRGBA(r=red, g=green, b=blue, a=alpha),
        points=[Point(x=x, y=y, z=z) for x, y, z in marker.points.tolist()],
        mesh_resource=marker.mesh_resource,
        mesh_use_embedded_materials=marker.rgba is None)
