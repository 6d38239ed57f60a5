# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Put poses into messages."""

from __future__ import annotations

from geometry_msgs.msg import PoseStamped

from sdf_pose_bridge.geometry.poses import Pose


def fill_pose_stamped(
    message: PoseStamped, pose: Pose, frame_id: str, stamp: tuple[int, int],
) -> None:
    """
    Put a pose into a message that is there already, as every response to a service is.

    :param message: what is to be filled; to make another would take longer than all the rest.
    :param pose: pose of something in a frame, in metres, quaternion x y z w.
    :param frame_id: that frame.
    :param stamp: the time that it gets: seconds and nanoseconds.
    """
    header, position, turn = message.header, message.pose.position, message.pose.orientation
    header.frame_id = frame_id
    header.stamp.sec, header.stamp.nanosec = stamp
    position.x, position.y, position.z, turn.x, turn.y, turn.z, turn.w = pose
