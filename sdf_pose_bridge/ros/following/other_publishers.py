# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Notice other nodes that publish frames of this one, each of which must have one publisher."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Mapping, Sequence
import contextlib
from functools import partial
import time

from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.subscription import Subscription
from rclpy.topic_endpoint_info import TopicEndpointInfo

from sdf_pose_bridge.ros.background import result_from_executor
from sdf_pose_bridge.ros.cdr import MOST_BYTES, POSE_TYPES, poses_from_bytes, TF_MESSAGE
from sdf_pose_bridge.ros.following.wait_set import NoExecutor, take_message
from sdf_pose_bridge.ros.log_lines import names_in_line
from sdf_pose_bridge.ros.publishing.published_frames import PublishedFrames, TF, TF_STATIC
from sdf_pose_bridge.ros.publishing.publishers import Topic
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.tf.tree import TfTree

OTHERS_PERIOD_S = 1.0
"""Period in s of :meth:`OtherPublishers.look`."""

TF_PERIOD_S = 30.0
"""Time in s until it listens to ``/tf`` again, where a publisher may be silent at first."""

_MOST_WAITING = 100
"""Largest number of messages that wait in a subscription, those of this node included; then new
ones replace the oldest."""

_MOST_BYTES_READ = 2 * MOST_BYTES
"""Number of bytes after which a look reads no more messages, as the loader waits meanwhile; a
megabyte takes about 0.04 s."""

_UNKNOWN_NODE = '_NODE_NAME_UNKNOWN_'
"""The name of a node in the middleware (rmw_dds_common) until it is discovered."""


class OtherPublishers:
    """
    Listens to other publishers of ``/tf_static``, and now and then to those of ``/tf``.

    There are subscriptions only while there are other publishers. The loader calls it.
    """

    def __init__(self, node: Node) -> None:
        self.problems: dict[str, str] = {}
        """A line for each topic on which another node publishes a frame of this one."""
        self._node = node
        self._subscriptions: dict[Topic, Subscription] = {}
        # The publishers and the frames of the last look, and the parents of the frames.
        self._last: tuple[set[bytes], TfTree] | None = None
        self._parents: dict[str, str] = {}
        # The parents that other nodes give frames of this one, in the order in which they came.
        self._found: dict[Topic, dict[str, str]] = {}
        self._reported: set[tuple[str, str]] = set()
        self._listens_to_tf_at = 0.0

    def look(self, frames: PublishedFrames, scene: Scene) -> None:
        """
        Read what has come since the last call, and look for other publishers.

        Of more messages than can be read in a short time, the others are not read. A message is
        read to its end, as a latched one does not come again.

        :param frames: the frames that this node publishes.
        :param scene: their scene.
        """
        others: dict[Topic, list[str]] = {}
        gids: set[bytes] = set()
        for topic in (TF_STATIC, TF):
            found = publishers_of_topic(self._node, topic.name)
            gids.update(bytes(each.endpoint_gid) for each in found)
            name = self._node.resolve_topic_name(topic.name)
            # The other node may have the same name.
            own = sum(each.topic_name == name for each in self._node.publishers)
            names = Counter(names_of_nodes(found))
            names[self._node.get_fully_qualified_name()] -= own
            others[topic] = sorted(+names)
        topics = [TF]
        if self._last == (gids, frames.tree):
            self._read(frames.publishers.static_stamps_ns)
            self._report(scene, others)
            self._close(topics)
            if time.monotonic() < self._listens_to_tf_at:
                return
        else:
            # Listen again, as latched messages may be about other frames of this node.
            topics.append(TF_STATIC)
            self._last = gids, frames.tree
            self.problems.clear()
            self._found = {each: {} for each in topics}
            self._close(topics)
            if any(others.values()):
                self._parents = dict(
                    zip(frames.tree.frame_ids, frames.tree.parent_ids, strict=True))
        self._listens_to_tf_at = time.monotonic() + TF_PERIOD_S
        for topic in [each for each in topics if others[each]]:
            with contextlib.suppress(RuntimeError):  # security may forbid it
                self._subscriptions[topic] = result_from_executor(
                    self._node, partial(_subscription, self._node, topic))

    def _close(self, topics: Sequence[Topic]) -> None:
        for topic in topics:
            if topic in self._subscriptions:
                result_from_executor(self._node, partial(
                    self._node.destroy_subscription, self._subscriptions.pop(topic)))

    def _read(self, own_stamps_ns: Collection[int]) -> None:
        bytes_left = _MOST_BYTES_READ
        for topic, subscription in self._subscriptions.items():
            for _ in range(_MOST_WAITING):
                taken = take_message(subscription)
                if taken is None:
                    break
                data, _ = taken
                if bytes_left > 0 and len(data) <= MOST_BYTES:
                    bytes_left -= len(data)
                    with contextlib.suppress(ValueError):  # it is not from a ROS node
                        self._compare(topic, data, own_stamps_ns)

    def _compare(self, topic: Topic, data: bytes, own_stamps_ns: Collection[int]) -> None:
        """Find the frames in a message of another node that this node publishes too."""
        for pose in poses_from_bytes(data, POSE_TYPES[TF_MESSAGE]):
            child, other = pose.child_frame_id.lstrip('/'), pose.frame_id.lstrip('/')
            parent = self._parents.get(child)
            # On /tf, another node may give the same stamps to the same frames.
            is_own = topic is TF or pose.stamp_ns in own_stamps_ns
            if parent and not (other == parent and is_own):
                self._found[topic].setdefault(child, other)

    def _report(self, scene: Scene, others: Mapping[Topic, Sequence[str]]) -> None:
        """Report what was found, with the names of the other nodes."""
        for topic, found in self._found.items():
            keys = {(topic.name, child) for child in found}
            if not found or (topic.name in self.problems and keys <= self._reported):
                continue
            (first, other), names = next(iter(found.items())), others[topic]
            in_file = [child for child in found if child in {
                frame_id for each in scene.sensors.values()
                for frame_id in (each.frame_id, each.older_frame_id, each.optical_frame_id)}]
            self.problems[topic.name] = line = (
                f'frame {names_in_line([first])} is also published on {topic.name} by '
                f'{"" if len(names) == 1 else "one of "}{names_in_line(names)}, with the parent '
                f'{names_in_line([other])}, here with {names_in_line([self._parents[first]])}'
                + (f', and so are {names_in_line([*found][1:])}' if found.keys() - {first} else '')
                + '; a frame must have one publisher, so stop one of them, or set frame_prefix'
                + (f'; for {names_in_line(in_file)}, set <gz_frame_id> of the sensor in the file '
                   'to another name for each robot, as Gazebo knows no prefix' if in_file else ''))
            if not keys <= self._reported:
                self._node.get_logger().warning(line)
                self._reported |= keys


def publishers_of_topic(node: Node, topic: str) -> list[TopicEndpointInfo]:
    """Return the publishers of a topic, without those whose nodes are not discovered yet."""
    return [each for each in node.get_publishers_info_by_topic(topic)
            if each.node_name != _UNKNOWN_NODE]


def names_of_nodes(publishers: Sequence[TopicEndpointInfo]) -> list[str]:
    """Return the full name of the node of each publisher, in alphabetical order."""
    return sorted(f'{each.node_namespace.rstrip("/")}/{each.node_name}' for each in publishers)


def _subscription(node: Node, topic: Topic) -> Subscription:
    quality = QoSProfile(depth=_MOST_WAITING, reliability=ReliabilityPolicy.BEST_EFFORT)
    if topic.is_latched:
        quality.reliability = ReliabilityPolicy.RELIABLE
        quality.durability = DurabilityPolicy.TRANSIENT_LOCAL
    return node.create_subscription(
        topic.message_type, topic.name, lambda _: None, quality, callback_group=NoExecutor(),
        raw=True, event_callbacks=SubscriptionEventCallbacks(use_default_callbacks=False))
