# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Frames of a running bridge, looked up with the listener and the buffer that ROS programs use.

tf2 composes the transforms; what it finds is compared with the poses that the core resolves.
"""

import itertools

from folders import EXAMPLES
from matrices import assert_same_pose, matrix_from_pose
import pytest

pytest.importorskip('tf2_ros', reason='needs tf2_ros, which is not installed')

from rclpy.time import Time
from tf2_ros import Buffer, TransformListener

import sdf_pose_bridge
from sdf_pose_bridge.tf.anchors import AnchorModels
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions


@pytest.fixture
def start_buffer(start_listener):
    """Starts to listen with tf2; ``start_buffer()`` gives a buffer and what to wait with."""
    listeners = []

    def start():
        listener = start_listener()
        buffer = Buffer()
        listeners.append(TransformListener(buffer, listener.node))
        return buffer, listener

    yield start
    for each in listeners:
        each.unregister()


def found_pose(buffer, frame_id, relative_to):
    """Return x y z and a quaternion x y z w with w >= 0, which tf2 does not care for."""
    transform = buffer.lookup_transform(relative_to, frame_id, Time()).transform
    xyz, quat = transform.translation, transform.rotation
    sign = -1.0 if quat.w < 0.0 else 1.0
    return (
        xyz.x, xyz.y, xyz.z, sign * quat.x, sign * quat.y, sign * quat.z, sign * quat.w)


def wait_for_frames(buffer, listener, frame_ids, root_frame):
    def missing():
        return [each for each in frame_ids if not buffer.can_transform(root_frame, each, Time())]
    listener.wait(lambda: not missing(), missing)


@pytest.mark.parametrize('comes_late', [False, True], ids=['early', 'late'])
@pytest.mark.parametrize('name', ['work_cell.sdf', 'mobile_robot.sdf'])
def test_every_frame_can_be_looked_up_from_every_other(
        start_bridge, start_buffer, name, comes_late):
    path = EXAMPLES / name
    scene = sdf_pose_bridge.load(path)
    tree = tf_tree_from_scene(scene, TfOptions(anchor_models=AnchorModels.ALL))
    expected = PoseLookup(scene, tree)
    frame_ids = [tree.root_frame, *tree.frame_ids]
    if not comes_late:
        buffer, listener = start_buffer()
    bridge = start_bridge(sdf_file=path, anchor_models='all')
    if comes_late:
        bridge.wait_until_started()
        buffer, listener = start_buffer()
    wait_for_frames(buffer, listener, frame_ids, tree.root_frame)
    for frame_id, reference in itertools.product(frame_ids, repeat=2):
        assert_same_pose(
            found_pose(buffer, frame_id, reference),
            matrix_from_pose(expected.pose(frame_id, reference).pose),
            name=f'{frame_id} in {reference}')
