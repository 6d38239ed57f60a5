# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Messages have every number of the arrays, exactly and in its place."""

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from builtin_interfaces.msg import Time
from rclpy.serialization import deserialize_message
from rclpy.serialization import serialize_message
from tf2_msgs.msg import TFMessage

from sdf_pose_bridge.messages import poses_from_tree
from sdf_pose_bridge.messages import tf_message_from_transforms
from sdf_pose_bridge.messages import transforms_from_tree
from sdf_pose_bridge.tf_tree import TfTree

STAMP = Time(sec=12, nanosec=34)
POSES = np.array([
    [1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0],
    [0.1, -1e-300, 1e300, 0.5, -0.5, 0.5, 0.5],
    [4.0, 5.0, 6.0, 0.6, 0.0, 0.0, 0.8],
])
TRANSFORMS = POSES[::-1].copy()
TREE = TfTree(
    root_frame='map', frame_ids=('base', 'größe 1', 'adrift'), poses=POSES,
    parent_ids=('map', 'base', ''), transforms=TRANSFORMS,
    elements=np.arange(3, dtype=np.int32), world='', warnings=())


def numbers_of_transform(message):
    move, turn = message.transform.translation, message.transform.rotation
    return [move.x, move.y, move.z, turn.x, turn.y, turn.z, turn.w]


def numbers_of_pose(message):
    place, turn = message.pose.position, message.pose.orientation
    return [place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w]


def test_transforms_are_those_to_the_parents():
    messages = transforms_from_tree(TREE, STAMP)
    assert [message.header.frame_id for message in messages] == ['map', 'base']
    assert [message.child_frame_id for message in messages] == ['base', 'größe 1']
    for row, message in enumerate(messages):
        assert numbers_of_transform(message) == TRANSFORMS[row].tolist()
        assert message.header.stamp == STAMP


def test_a_frame_without_a_parent_has_no_transform():
    assert 'adrift' not in {each.child_frame_id for each in transforms_from_tree(TREE, STAMP)}


def test_poses_are_those_in_the_root_frame():
    first, second = poses_from_tree(TREE, [2, 1], STAMP)
    assert numbers_of_pose(first) == POSES[2].tolist()
    assert numbers_of_pose(second) == POSES[1].tolist()
    assert (first.header.frame_id, first.header.stamp) == ('map', STAMP)


def test_no_poses_are_no_messages():
    assert poses_from_tree(TREE, [], STAMP) == []


def test_the_message_for_tf_survives_the_wire():
    message = tf_message_from_transforms(transforms_from_tree(TREE, STAMP))
    assert deserialize_message(serialize_message(message), TFMessage) == message
