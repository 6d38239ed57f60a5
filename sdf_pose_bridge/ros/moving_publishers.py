# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Publish the frames that joints move: on ``/tf``, ``~/transforms`` and ``~/poses/...``."""

from __future__ import annotations

from itertools import compress
from typing import TYPE_CHECKING

from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy
from rclpy.qos import HistoryPolicy
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from tf2_msgs.msg import TFMessage

from sdf_pose_bridge.ros.cdr import pose_stamped_messages
from sdf_pose_bridge.ros.cdr import StampedMessages
from sdf_pose_bridge.ros.cdr import tf_message
from sdf_pose_bridge.ros.cdr import transform_stamped_messages
from sdf_pose_bridge.ros.publishers import FramePublishers
from sdf_pose_bridge.ros.publishers import latched_publisher
from sdf_pose_bridge.tf.moving_frames import MovingFrames
from sdf_pose_bridge.tf.tree import TfTree

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

TF_QUALITY = QoSProfile(
    history=HistoryPolicy.KEEP_LAST, depth=100, reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.VOLATILE)
"""The quality of service of ``/tf``, as in tf2_ros."""


class MovingPublishers:
    """
    Publishers of the moving frames of a tree; :meth:`use` must come first.

    :param node: the node that they belong to.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._tf = node.create_publisher(TFMessage, '/tf', TF_QUALITY)
        self._transforms: Publisher | None = None

    def use(self, tree: TfTree, moving: MovingFrames) -> None:
        """
        Publish a tree from now on.

        :param tree: the tree.
        :param moving: its moving frames.
        """
        self._tree = tree
        self._moving = moving
        self._posed: list[tuple[int, Publisher]] = []
        self._pose_messages = pose_stamped_messages([], tree.poses[:0])
        self._transform_messages = transform_stamped_messages(
            *tree.ids_of_transforms(moving.indices), tree.transforms[moving.indices])
        if self._transforms is not None:
            self._node.destroy_publisher(self._transforms)
        # It keeps one message of each transform for listeners that come later.
        self._transforms = latched_publisher(
            self._node, TransformStamped, '~/transforms', depth=max(1, len(moving.indices)))

    def destroy(self) -> None:
        """Destroy the publishers, but not those of pose topics."""
        for publisher in (self._tf, self._transforms):
            if publisher is not None:
                self._node.destroy_publisher(publisher)

    def tf_message(self, rows: NDArray[np.intp]) -> StampedMessages:
        """
        Prepare a message for ``/tf``.

        :param rows: which of the moving transforms it has.
        :return: the message, with transforms that are to be set.
        """
        indices = self._moving.indices[rows]
        return tf_message(*self._tree.ids_of_transforms(indices), self._tree.transforms[indices])

    def publish_tf(self, message: StampedMessages, stamp: tuple[int, int]) -> None:
        """
        Publish on ``/tf``.

        :param message: one message.
        :param stamp: seconds and nanoseconds.
        """
        (data,) = message.with_stamp(*stamp)
        self._tf.publish(data)

    def set_pose_publishers(self, publishers: FramePublishers | None) -> None:
        """
        Use the publishers of pose topics.

        :param publishers: those of all frames; None to use none while they are replaced.
        """
        tree = self._tree
        self._posed = []
        if publishers is not None:
            for row, index in enumerate(self._moving.posed_indices.tolist()):
                publisher = publishers.pose_publisher(tree.frame_ids[index])
                if publisher is not None:
                    self._posed.append((row, publisher))
        rows = [row for row, _ in self._posed]
        self._pose_messages = pose_stamped_messages(
            [tree.root_frame] * len(rows), tree.poses[self._moving.posed_indices[rows]])

    def publish_topics(
        self, positions: NDArray[np.float64], stamp: tuple[int, int], *, only_listeners: bool,
    ) -> None:
        """
        Publish on ``~/transforms`` and ``~/poses/...``.

        :param positions: the position of each degree of freedom, in radians or metres.
        :param stamp: seconds and nanoseconds.
        :param only_listeners: whether to leave out topics that nobody listens to.
        """
        def has_reader(publisher: Publisher) -> bool:
            return not only_listeners or publisher.get_subscription_count() > 0

        if self._transforms is not None and has_reader(self._transforms):
            self._transform_messages.set_poses(self._moving.transforms(positions))
            for message in self._transform_messages.with_stamp(*stamp):
                self._transforms.publish(message)
        are_read = [has_reader(publisher) for _, publisher in self._posed]
        if any(are_read):
            rows = [row for row, _ in self._posed]
            self._pose_messages.set_poses(self._moving.poses(positions)[rows])
            messages = zip(self._posed, self._pose_messages.with_stamp(*stamp), strict=True)
            for (_, publisher), message in compress(messages, are_read):
                publisher.publish(message)
