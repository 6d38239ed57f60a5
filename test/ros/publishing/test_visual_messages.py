# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The message of all markers, as RViz needs it."""

import numpy as np
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from visualization_msgs.msg import Marker, MarkerArray

from sdf_pose_bridge.export.visual_markers import VisualMarker
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.ros.publishing.visual_messages import message_from_markers

POSE = Pose(1.0, 2.0, 3.0, 0.0, 0.0, 1.0, 0.0)
BLUE = (0.0, 0.0, 1.0, 0.5)
TRIANGLE = np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 2.0, 0.0)])


def sent(*markers):
    message = message_from_markers(markers, 'map')
    return deserialize_message(serialize_message(message), MarkerArray).markers


def marker(*values, rgba=BLUE, **others):
    return VisualMarker(*values, rgba=rgba, frame_id='a/b/link', namespace='a::b', **others)


def only_sent(*values, **others):
    _, message = sent(marker(*values, **others))
    return message


def test_earlier_markers_are_deleted_first():
    (first,) = sent()
    assert (first.action, first.header.frame_id) == (Marker.DELETEALL, 'map')


def test_marker_moves_with_its_frame():
    message = only_sent('CUBE', (1.0, 2.0, 3.0), POSE)
    assert (message.action, message.frame_locked) == (Marker.ADD, True)
    assert (message.header.frame_id, message.ns) == ('a/b/link', 'a::b')
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (0, 0)
    assert (message.lifetime.sec, message.lifetime.nanosec) == (0, 0)
    xyz, quat = message.pose.position, message.pose.orientation
    assert (xyz.x, xyz.y, xyz.z, quat.x, quat.y, quat.z, quat.w) == POSE


def test_each_marker_has_an_id_of_its_own():
    messages = sent(*(marker('CUBE') for _ in range(3)))
    assert len({each.id for each in messages}) == 4


@pytest.mark.parametrize(('name', 'number'), [
    ('CUBE', Marker.CUBE), ('SPHERE', Marker.SPHERE), ('CYLINDER', Marker.CYLINDER)])
def test_shape_has_its_type_scale_and_color(name, number):
    message = only_sent(name, (1.0, 2.0, 3.0))
    assert message.type == number
    assert (message.scale.x, message.scale.y, message.scale.z) == (1.0, 2.0, 3.0)
    color = message.color
    assert (color.r, color.g, color.b, color.a) == BLUE
    assert not message.mesh_use_embedded_materials


def test_triangles_are_their_corners():
    message = only_sent('TRIANGLE_LIST', points=TRIANGLE)
    assert message.type == Marker.TRIANGLE_LIST
    assert [[each.x, each.y, each.z] for each in message.points] == TRIANGLE.tolist()


def test_mesh_with_a_color():
    message = only_sent('MESH_RESOURCE', mesh_resource='file:///a.stl')
    assert (message.type, message.mesh_resource) == (Marker.MESH_RESOURCE, 'file:///a.stl')
    assert (message.color.b, message.mesh_use_embedded_materials) == (1.0, False)


def test_mesh_without_a_color_keeps_its_own():
    message = only_sent('MESH_RESOURCE', mesh_resource='file:///a.dae', rgba=None)
    color = message.color
    assert (color.r, color.g, color.b, color.a) == (0.0, 0.0, 0.0, 0.0)
    assert message.mesh_use_embedded_materials
