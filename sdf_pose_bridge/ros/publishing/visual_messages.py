# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Make the message of ``~/visuals``, in the process that reads the file again.

To make and serialize 100,000 markers would keep the other threads of the node waiting.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from geometry_msgs.msg import Point, Quaternion, Vector3
from geometry_msgs.msg import Pose as PoseMessage
from rclpy.serialization import serialize_message
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker, MarkerArray

from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.export.published_scene import LoadRequest
from sdf_pose_bridge.export.visual_markers import markers_from_text, VisualMarker


def serialized_markers_from_text(
    text: str | bytes, path: Path, request: LoadRequest, fingerprint: bytes, root_frame: str,
) -> tuple[bytes, tuple[SdfWarning, ...]] | None:
    """
    Make the message of all markers of a scene.

    :param root_frame: frame id of the root.
    :return: the serialized message, with warnings; otherwise as
        :func:`~sdf_pose_bridge.export.visual_markers.markers_from_text`.
    """
    found = markers_from_text(text, path, request, fingerprint)
    if found is None:
        return None
    markers, warnings = found
    return serialize_message(message_from_markers(markers, root_frame)), warnings


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
