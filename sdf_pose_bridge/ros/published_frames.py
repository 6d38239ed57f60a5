# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The frames of a TF tree on their topics.

These are ``/tf_static``, ``/tf``, ``~/transforms`` and ``~/poses/...``. Fixed frames are published
once, moving frames repeatedly.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property, lru_cache
from itertools import compress

from geometry_msgs.msg import PoseStamped, TransformStamped
import numpy as np
from numpy.typing import NDArray
from rclpy.logging import LoggingSeverity
from rclpy.node import Node
from rclpy.publisher import Publisher
from tf2_msgs.msg import TFMessage

from sdf_pose_bridge.geometry.chains import Indices
from sdf_pose_bridge.geometry.poses import PoseArray
from sdf_pose_bridge.ros.background import run_in_thread
from sdf_pose_bridge.ros.cdr import stamped_messages, StampedMessages, tf_message
from sdf_pose_bridge.ros.parameters import Settings
from sdf_pose_bridge.ros.publishers import NANOSECONDS, Publishers, Stamp, Topic
from sdf_pose_bridge.ros.topic_names import pose_topics_from_patterns, PoseTopics
from sdf_pose_bridge.tf.joint_motion import NO_DOF
from sdf_pose_bridge.tf.joint_positions import JointPositions, NEVER
from sdf_pose_bridge.tf.loaded_scene import LoadedScene
from sdf_pose_bridge.tf.moving_frames import MovingFrames
from sdf_pose_bridge.tf.tree import TfTree

TF_STATIC = Topic('/tf_static', TFMessage, is_overridable=True)
TF = Topic('/tf', TFMessage, depth=100, is_latched=False, is_overridable=True)
"""With the quality of service that it has in tf2_ros."""

_MOST_MESSAGES = 100
"""How many messages for ``/tf`` are kept, to be sent again with other poses."""


async def frames_from_scene(
    node: Node, loaded: LoadedScene, settings: Settings, before: PublishedFrames,
) -> PublishedFrames:
    """
    Make the messages and choose the topics of the frames of a scene; nothing is published.

    :param before: the frames that these ones replace.
    """
    name = node.get_fully_qualified_name()

    def prepared_topics() -> PoseTopics:
        # The first search for a name makes the index of all names.
        loaded.scene.has('')
        return pose_topics_from_patterns(loaded.tree.frame_ids, settings.pose_topics, name)

    topics: PoseTopics = await run_in_thread(node, prepared_topics)
    if topics.warning:
        node.get_logger().warning(topics.warning)
    if node.get_logger().is_enabled_for(LoggingSeverity.DEBUG):
        for frame_id, name in topics.names.items():
            node.get_logger().debug(f'frame "{frame_id}" has the topic ~/poses/{name}')
    frames = PublishedFrames(
        before.publishers, loaded.tree, loaded.joint_positions, topics.names, before,
        has_transforms=settings.publish_transforms)
    await run_in_thread(node, lambda: frames.lay_out(with_tf=before.tree is not loaded.tree))
    return frames


class PublishedFrames:
    """
    The frames of a tree on their topics.

    Messages are made when they are first needed, so that nothing delays ``/tf_static``, or earlier
    by :meth:`lay_out` in another thread.

    :param publishers: the publishers of the node. Publishers of the frames before are kept if
        these frames have the same topics.
    :param positions: the positions of its joints; None if joints move nothing.
    :param pose_topics: the names of the topics of poses, by frame id.
    :param has_transforms: whether to publish on ``~/transforms``.
    :param before: the frames that these ones replace. Joints with the same names keep their
        positions; the stamp stays if the tree does.
    """

    def __init__(
        self, publishers: Publishers, tree: TfTree, positions: JointPositions | None,
        pose_topics: Mapping[str, str], before: PublishedFrames | None = None,
        *, has_transforms: bool = True,
    ) -> None:
        self.publishers = publishers
        self.tree = tree
        self.stamp: Stamp = publishers.now() if before is None or before.tree is not tree else (
            before.stamp)
        self._tf_static = publishers.opened(TF_STATIC)
        self._transforms_topics = [
            _transforms_topic(len(tree.fixed_indices), 'fixed')] if has_transforms else []
        self._pose_topics = {
            frame_id: Topic(f'~/poses/{name}', PoseStamped)
            for frame_id, name in pose_topics.items()}
        self.moving: PublishedMovingFrames | None = None
        """The moving frames; None if joints move nothing."""
        if tree.moving is not None and positions is not None:
            self.moving = PublishedMovingFrames(
                publishers, tree, tree.moving, positions, self._pose_topics,
                before.moving if before else None)

    def lay_out(self, *, with_tf: bool) -> None:
        """
        Make the messages of fixed frames, which takes long for many frames.

        :param with_tf: whether to make the message of ``/tf_static`` too.
        """
        if with_tf:
            self._tf_static_message  # noqa: B018 - to look at it makes it
        self._fixed_transforms  # noqa: B018
        self._fixed_poses  # noqa: B018

    def take_over(self, before: PublishedFrames) -> None:
        """Take the positions of joints from the frames that these ones replace."""
        if self.moving is not None and before.moving is not None:
            self.moving.take_over(before.moving)

    def publish_tf(self) -> None:
        """Publish all fixed frames on ``/tf_static``, and all moving ones on ``/tf``."""
        self._publish_tf_static()
        if self.moving is not None:
            self.moving.publish_all()

    async def publish_topics(self) -> None:
        """Publish all frames on all other topics; fixed ones with the stamp of ``/tf_static``."""
        topics = [TF_STATIC, *self._transforms_topics, *self._pose_topics.values()]
        if self.moving is not None:
            topics.append(TF)
            if self._transforms_topics:
                topics.append(self.moving.transforms_topic)
        # All publishers of poses may take a second.
        for topic in self._transforms_topics:
            self.publishers.opened(topic)
        await self._send(self._fixed_transforms)
        await self.publishers.replace(dict.fromkeys(topics))
        await self._send(self._fixed_poses)
        if self.moving is not None:
            self.moving.publish_topics(only_listeners=False)

    async def publish_fixed_again(self) -> None:
        """Publish all fixed frames on all topics with a new stamp."""
        self.stamp = self.publishers.now()
        self._publish_tf_static()
        await self._send(self._fixed_transforms)
        await self._send(self._fixed_poses)

    def _publish_tf_static(self) -> None:
        (message,) = self._tf_static_message.with_stamp(*self.stamp)
        self._tf_static.publish(message)

    async def _send(self, content: tuple[Sequence[Topic], StampedMessages]) -> None:
        topics, messages = content
        await self.publishers.send(topics, messages.with_stamp(*self.stamp))

    @cached_property
    def _tf_static_message(self) -> StampedMessages:
        return tf_message(*_transforms(self.tree, self.tree.fixed_indices))

    @cached_property
    def _fixed_transforms(self) -> tuple[Sequence[Topic], StampedMessages]:
        indices = self.tree.fixed_indices if self._transforms_topics else np.array([], np.intp)
        messages = stamped_messages(*_transforms(self.tree, indices))
        return self._transforms_topics * len(indices), messages

    @cached_property
    def _fixed_poses(self) -> tuple[Sequence[Topic], StampedMessages]:
        tree = self.tree
        moving = set() if tree.moving is None else set(tree.moving.posed_indices.tolist())
        posed = [
            (index, self._pose_topics[frame_id]) for index, frame_id in enumerate(tree.frame_ids)
            if frame_id in self._pose_topics and index not in moving]
        poses = tree.poses_in_pose_frame[[index for index, _ in posed]]
        return [topic for _, topic in posed], stamped_messages(
            [[tree.pose_frame] * len(posed)], poses)


class PublishedMovingFrames:
    """
    The moving frames of a tree on their topics.

    :param pose_topics: the topics of poses, by frame id.
    :param before: the moving frames that these ones replace. Joints with the same names keep their
        positions.
    """

    def __init__(
        self, publishers: Publishers, tree: TfTree, moving: MovingFrames,
        positions: JointPositions, pose_topics: Mapping[str, Topic],
        before: PublishedMovingFrames | None,
    ) -> None:
        self._publishers = publishers
        self._tree = tree
        self.frames = moving
        self.positions = positions
        """The positions of the joints; the caller sets them."""
        if before is not None:
            self.take_over(before)
        self._tf = publishers.opened(TF)
        self._tf_message = lru_cache(_MOST_MESSAGES)(self._new_tf_message)
        self.transforms_topic = _transforms_topic(len(moving.indices), 'moving')
        self._transform_messages = stamped_messages(*_transforms(tree, moving.indices))
        topics = [pose_topics.get(tree.frame_ids[index]) for index in moving.posed_indices]
        self._posed_rows = [row for row, topic in enumerate(topics) if topic is not None]
        self._posed_topics = [topic for topic in topics if topic is not None]
        self._pose_messages = stamped_messages(
            [[tree.pose_frame] * len(self._posed_rows)],
            tree.poses_in_pose_frame[moving.posed_indices[self._posed_rows]])

    def take_over(self, before: PublishedMovingFrames) -> None:
        """Continue with the positions of joints with the same names."""
        if before.positions is not self.positions:
            self.positions.take_over(before.positions)

    @property
    def has_transform(self) -> NDArray[np.bool_]:
        """Which of the moving transforms follow from known positions."""
        return self.frames.has_transform(self.positions.is_known)

    def publish_tf(self, rows: NDArray[np.intp], stamps_ns: NDArray[np.int64] | int) -> None:
        """
        Publish one message on ``/tf``.

        :param rows: indices of the moving transforms in it.
        :param stamps_ns: the stamp of each of these, in nanoseconds; or one for all.
        """
        message = self._tf_message(rows.tobytes())
        message.set_poses(self.frames.transforms(self.positions.values)[rows])
        (data,) = (
            message.with_stamp(*divmod(stamps_ns, NANOSECONDS)) if isinstance(stamps_ns, int)
            else message.with_stamps(_stamps_from_ns(stamps_ns)))
        self._tf.publish(data)

    def _new_tf_message(self, rows: bytes) -> StampedMessages:
        indices = self.frames.indices[np.frombuffer(rows, np.intp)]
        return tf_message(*_transforms(self._tree, indices))

    def publish_all(self) -> None:
        """Publish all moving frames with known positions on ``/tf``, with the time of the node."""
        rows = np.flatnonzero(self.has_transform)
        if len(rows):
            self.publish_tf(rows, self._publishers.now_ns())

    def _stamps(self, dofs: Indices, dof_of_reference: int = NO_DOF) -> NDArray[np.int64]:
        """
        Return the stamps of poses, as messages take them.

        :param dofs: the last degree of freedom before each frame; -1 for none.
        :param dof_of_reference: that before the frame in which all of them are given.
        :return: the newer stamp of both, or the time of the node where there is none.
        """
        known = np.append(self.positions.stamps_ns, NEVER)
        newest = np.maximum(known[dofs], known[dof_of_reference])
        return _stamps_from_ns(np.where(newest == NEVER, self._publishers.now_ns(), newest))

    def publish_topics(self, *, only_listeners: bool) -> None:
        """
        Publish all moving frames with known positions on ``~/transforms`` and ``~/poses/...``.

        :param only_listeners: whether to leave out topics without subscribers.
        """
        def wanted_publisher(topic: Topic) -> Publisher | None:
            publisher = self._publishers.existing(topic)
            if publisher is None or (only_listeners and not publisher.get_subscription_count()):
                return None
            return publisher

        publisher = wanted_publisher(self.transforms_topic)
        if publisher is not None:
            self._transform_messages.set_poses(self.frames.transforms(self.positions.values))
            stamps = self._stamps(self.frames.last_dofs)
            for message in compress(
                    self._transform_messages.with_stamps(stamps), self.has_transform):
                publisher.publish(message)
        publishers = list(map(wanted_publisher, self._posed_topics))
        if any(publishers):
            self._pose_messages.set_poses(
                self.frames.poses(self.positions.values)[self._posed_rows])
            has_pose = self.frames.has_pose(self.positions.is_known)[self._posed_rows]
            stamps = self._stamps(
                self.frames.posed_last_dofs[self._posed_rows], self.frames.last_dof_of_pose_frame)
            for publisher, message, is_known in zip(
                    publishers, self._pose_messages.with_stamps(stamps), has_pose, strict=True):
                if publisher is not None and is_known:
                    publisher.publish(message)


def _stamps_from_ns(stamps_ns: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return seconds and nanoseconds, in a last dimension of two."""
    return np.stack(np.divmod(stamps_ns, NANOSECONDS), axis=-1)


def _transforms(
    tree: TfTree, indices: NDArray[np.intp],
) -> tuple[Sequence[Sequence[str]], PoseArray]:
    """Return the parents and children of transforms, and the transforms."""
    return tree.ids_of_transforms(indices), tree.transforms[indices]


def _transforms_topic(count: int, part: str) -> Topic:
    """
    Return ``~/transforms`` for a publisher that keeps as many messages as there are transforms.

    So new messages replace all old ones. Another number of transforms needs another publisher,
    which does not have the old messages.
    """
    return Topic('~/transforms', TransformStamped, depth=max(1, count), part=part)
