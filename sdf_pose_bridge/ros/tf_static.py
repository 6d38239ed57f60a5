# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The topic that most listeners wait for at a start, apart from those that can come later."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy
from rclpy.qos import HistoryPolicy
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from tf2_msgs.msg import TFMessage

from sdf_pose_bridge.geometry.poses import PoseArray
from sdf_pose_bridge.ros.cdr import tf_message_bytes
from sdf_pose_bridge.tf.texts import Texts
from sdf_pose_bridge.tf.tree import NO_PARENT
from sdf_pose_bridge.tf.tree import TfTree


class Transforms(NamedTuple):
    """The transforms of a tree, which not every frame has."""

    parent_ids: Texts
    child_ids: Texts
    poses: PoseArray

    @classmethod
    def from_tree(cls, tree: TfTree) -> Transforms:
        """
        Choose the frames that have a transform.

        :param tree: a tree.
        :return: those that have a parent.
        """
        rows = np.flatnonzero(tree.parents != NO_PARENT)
        if len(rows) < len(tree.parents):
            return cls(
                tree.texts.taken(tree.parents[rows]), tree.texts.taken(rows),
                tree.transforms[rows])
        return cls(tree.texts.taken(tree.parents), tree.texts.taken(slice(-1)), tree.transforms)


class TfStatic:
    """
    The publisher of ``/tf_static``, for all transforms of a tree in one message.

    :param node: the node that it belongs to.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._publisher = latched_publisher(node, TFMessage, '/tf_static', depth=1)
        self.tree: TfTree | None = None
        """What was published last."""

    def publish(self, tree: TfTree) -> None:
        """
        Publish a tree, in the place of the one before.

        :param tree: the tree.
        """
        self.tree = tree
        self.transforms = Transforms.from_tree(tree)
        """The transforms of the tree."""
        self._messages = tf_message_bytes(*self.transforms)
        self.publish_again()

    def publish_again(self) -> None:
        """Publish what was published last once more, with a new stamp."""
        self.stamp: tuple[int, int] = self._node.get_clock().now().seconds_nanoseconds()
        """The time that was published last, in seconds and nanoseconds."""
        (data,) = self._messages.at(*self.stamp)
        self._publisher.publish(data)


def latched_publisher(node: Node, message_type: type, name: str, *, depth: int) -> Publisher:
    """
    Make a publisher whose last messages also reach listeners that come later.

    :param node: the node that it belongs to.
    :param message_type: class of the messages.
    :param name: name of the topic.
    :param depth: how many messages it keeps.
    :return: the publisher.
    """
    quality = QoSProfile(
        history=HistoryPolicy.KEEP_LAST, depth=depth,
        reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL)
    # The default callbacks only report listeners that ask for more than is offered, and there is
    # no more to offer; but each would be waited on, a thousand of them for a large scene.
    return node.create_publisher(
        message_type, name, quality,
        event_callbacks=PublisherEventCallbacks(use_default_callbacks=False))
