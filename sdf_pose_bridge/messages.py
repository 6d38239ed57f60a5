# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Turn the arrays of a TF tree into messages."""

from __future__ import annotations

from collections.abc import Iterable
from collections.abc import Sequence

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose
from geometry_msgs.msg import PoseStamped
from geometry_msgs.msg import Quaternion
from geometry_msgs.msg import Transform
from geometry_msgs.msg import TransformStamped
from geometry_msgs.msg import Vector3
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

from sdf_pose_bridge import poses
from sdf_pose_bridge.poses import PoseArray
from sdf_pose_bridge.tf_tree import TfTree


def transforms_from_tree(tree: TfTree, stamp: Time) -> list[TransformStamped]:
    """
    Return a message for each transform of a tree.

    :param tree: the tree.
    :param stamp: the time that all of them get.
    :return: TransformStamped messages in the tree's order: pose of the child in its parent, in
        metres, quaternion x y z w. Frames without a parent have none.
    """
    return [
        TransformStamped(
            header=Header(stamp=stamp, frame_id=parent_id),
            child_frame_id=frame_id,
            transform=Transform(
                translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=qx, y=qy, z=qz, w=qw)))
        for frame_id, parent_id, (x, y, z, qx, qy, qz, qw) in zip(
            tree.frame_ids, tree.parent_ids, _rows(tree.transforms), strict=True)
        if parent_id
    ]


def tf_message_from_transforms(transforms: Sequence[TransformStamped]) -> TFMessage:
    """
    Return the message for ``/tf_static``.

    :param transforms: all of them, since a new message replaces the one before for late joiners.
    :return: one message with all of them.
    """
    return TFMessage(transforms=transforms)


def pose_stamped(pose: poses.Pose, frame_id: str, stamp: Time) -> PoseStamped:
    """
    Return a message with one pose.

    :param pose: pose of something in a frame, in metres, quaternion x y z w.
    :param frame_id: that frame.
    :param stamp: the time that it gets.
    :return: the message.
    """
    x, y, z, qx, qy, qz, qw = pose
    return PoseStamped(
        header=Header(stamp=stamp, frame_id=frame_id),
        pose=Pose(position=Point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw)))


def poses_from_tree(tree: TfTree, indices: Iterable[int], stamp: Time) -> list[PoseStamped]:
    """
    Return messages with the poses of frames in the root frame.

    :param tree: the tree.
    :param indices: which of its frames.
    :param stamp: the time that all of them get.
    :return: a PoseStamped for each, in metres, quaternion x y z w.
    """
    header = Header(stamp=stamp, frame_id=tree.root_frame)
    return [
        PoseStamped(
            header=header,
            pose=Pose(
                position=Point(x=x, y=y, z=z), orientation=Quaternion(x=qx, y=qy, z=qz, w=qw)))
        for x, y, z, qx, qy, qz, qw in _rows(tree.poses[list(indices)])
    ]


def _rows(poses: PoseArray) -> list[list[float]]:
    # Python floats at once: a message takes no others, and one by one they cost more.
    rows: list[list[float]] = poses.tolist()
    return rows
