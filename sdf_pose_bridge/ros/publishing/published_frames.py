# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The frames of a TF tree on their topics.

These are ``/tf_static``, ``/tf``, ``~/transforms`` and ``~/poses/...``. Fixed frames are published
once, moving frames repeatedly, by the thread that follows joint states.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import compress

from geometry_msgs.msg import PoseStamped, TransformStamped
import numpy as np
from numpy.typing import NDArray
from rclpy.logging import LoggingSeverity
from rclpy.node import Node
from rclpy.publisher import Publisher
from tf2_msgs.msg import TFMessage

from sdf_pose_bridge.export.published_scene import LoadedScene
from sdf_pose_bridge.geometry.chains import Indices
from sdf_pose_bridge.ros.background import result_from_executor
from sdf_pose_bridge.ros.cdr import Rows, StampedRecords
from sdf_pose_bridge.ros.log_lines import line_from_text
from sdf_pose_bridge.ros.parameters.declarations import Settings
from sdf_pose_bridge.ros.publishing.publishers import Publishers, Topic
from sdf_pose_bridge.ros.publishing.topic_names import pose_topics_from_patterns
from sdf_pose_bridge.tf.joint_motion import MovingFrames, NO_DOF
from sdf_pose_bridge.tf.joint_positions import JointPositions, NEVER
from sdf_pose_bridge.tf.tree import TfTree

TF_STATIC = Topic('/tf_static', TFMessage, is_overridable=True)
TF = Topic('/tf', TFMessage, depth=100, is_latched=False, is_overridable=True)
"""With the quality of service that it has in tf2_ros."""


def frames_from_scene(
    node: Node, loaded: LoadedScene, settings: Settings, before: PublishedFrames,
) -> PublishedFrames:
    """
    Make the messages and the publishers of the frames of a scene; nothing is published.

    :param node: the node, the executor of which runs in another thread.
    :param before: the frames that these ones replace.
    """
    name, logger, publishers = (
        node.get_fully_qualified_name(), node.get_logger(), before.publishers)
    # The first search for a name makes the index of all names.
    loaded.scene.has('')
    topics = pose_topics_from_patterns(loaded.tree.frame_ids, settings.pose_topics, name)
    if topics.warning:
        logger.warning(topics.warning)
    if logger.is_enabled_for(LoggingSeverity.DEBUG):
        for frame_id, name in topics.names.items():
            logger.debug(line_from_text(f'frame "{frame_id}" has the topic ~/poses/{name}'))
    try:
        if loaded.tree.moving is not None:
            # It declares parameters.
            result_from_executor(node, lambda: publishers.opened(TF))
        frames = PublishedFrames(
            publishers, loaded.tree, loaded.joint_positions, topics.names, before,
            has_transforms=settings.publish_transforms)
        frames.open_topics()
    except Exception:
        before.destroy_other_publishers()
        raise
    return frames


class PublishedFrames:
    """
    The frames of a tree on their topics.

    :param publishers: the publishers of the node. Publishers of the frames before are kept if
        these frames have the same topics.
    :param positions: the positions of its joints; None if joints move nothing.
    :param pose_topics: the names of the topics of poses, by frame id.
    :param has_transforms: whether to publish on ``~/transforms``.
    :param before: the frames that these ones replace; the stamp stays if the tree does.
    """

    def __init__(
        self, publishers: Publishers, tree: TfTree, positions: JointPositions | None,
        pose_topics: Mapping[str, str], before: PublishedFrames | None = None,
        *, has_transforms: bool = True,
    ) -> None:
        self.publishers = publishers
        self.tree = tree
        self.stamp_ns: int = publishers.now_ns() if (
            before is None or before.tree is not tree) else before.stamp_ns
        self._tf_static = publishers.opened(TF_STATIC)
        self._transforms = _records_of_transforms(tree, tree.fixed_indices)
        moved = set() if tree.moving is None else set(tree.moving.posed_indices.tolist())
        # A frame that begins to move has another publisher, which does not keep its last pose.
        topics = {
            index: Topic(
                f'~/poses/{pose_topics[frame_id]}', PoseStamped,
                part='moving' if index in moved else '')
            for index, frame_id in enumerate(tree.frame_ids) if frame_id in pose_topics}
        # Serialized messages, and the topic of each.
        self._fixed = [_poses_with_topics(tree, topics, topics.keys() - moved)]
        self.moving: MovingTopics | None = None
        """The moving frames; None if joints move nothing."""
        self._topics = [TF_STATIC, *topics.values()]
        if has_transforms:
            topic = _transforms_topic(len(tree.fixed_indices), 'fixed')
            self._topics.append(topic)
            self._fixed.insert(0, (self._transforms, [topic] * len(tree.fixed_indices)))
        if tree.moving is not None and positions is not None:
            self.moving = MovingTopics(publishers, tree, tree.moving, positions, topics)
            self._topics += [TF, self.moving.transforms_topic] if has_transforms else [TF]

    def publish_tf_static(self) -> None:
        """Publish all fixed frames on ``/tf_static``."""
        self._transforms.set_stamps(self.stamp_ns)
        self.publishers.static_stamps_ns.append(self.stamp_ns)
        self._tf_static.publish(self._transforms.tf_message())

    def open_topics(self) -> None:
        """Make the publishers that are missing."""
        for topic in self._topics:
            self.publishers.opened(topic)

    def destroy_other_publishers(self) -> None:
        """Destroy the publishers of all other topics, so that no listener gets old messages."""
        self.publishers.destroy_others(dict.fromkeys(self._topics))

    def publish_topics(self) -> None:
        """Publish all fixed frames on all other topics."""
        for records, topics in self._fixed:
            records.set_stamps(self.stamp_ns)
            for topic, message in zip(topics, records.messages(), strict=True):
                self.publishers.opened(topic).publish(message)

    def publish_fixed_again(self) -> None:
        """Publish all fixed frames on all topics with a new stamp."""
        self.stamp_ns = self.publishers.now_ns()
        self.publish_tf_static()
        self.publish_topics()


class MovingTopics:
    """
    The moving frames of a tree on their topics. One thread publishes them.

    A transform goes to ``/tf`` with a stamp that is newer than its last one, as TF rejects others.

    :param positions: the positions of the joints; the caller sets them.
    :param pose_topics: the topics of poses, by the indices of frames.
    """

    def __init__(
        self, publishers: Publishers, tree: TfTree, moving: MovingFrames,
        positions: JointPositions, pose_topics: Mapping[int, Topic],
    ) -> None:
        self._publishers = publishers
        self.tree = tree
        self.frames = moving
        self.positions = positions
        # The last stamp of each moving transform.
        self._stamps_ns = np.full(len(moving.indices), NEVER)
        self._tf = publishers.opened(TF)
        self.transforms_topic = _transforms_topic(len(moving.indices), 'moving')
        self._transforms = _records_of_transforms(tree, moving.indices)
        self._posed_rows = np.flatnonzero(np.isin(moving.posed_indices, list(pose_topics)))
        self._poses, self._posed_topics = _poses_with_topics(
            tree, pose_topics, moving.posed_indices[self._posed_rows].tolist())

    @property
    def has_transform(self) -> NDArray[np.bool_]:
        """Which of the moving transforms follow from known positions."""
        return ~self.frames.depends_on(~self.positions.is_known)

    def rows_from_dofs(self, dofs: Sequence[int]) -> Rows:
        """Return the moving transforms that some degrees of freedom, or joints at zero, move."""
        is_changed = self.positions.is_known & ~self.positions.is_reported
        is_changed[dofs] = True
        return np.flatnonzero(self.frames.depends_on(is_changed) & self.has_transform)

    def stamp(self, rows: Rows, stamp_ns: int, *, ignore_stamps: bool = False) -> Rows:
        """
        Give moving transforms a stamp, before they are published or wait for it.

        :param rows: their indices.
        :param stamp_ns: the stamp in nanoseconds.
        :param ignore_stamps: whether it need not be newer.
        :return: the indices of those that have got it.
        """
        if not ignore_stamps:
            rows = rows[self._stamps_ns[rows] < stamp_ns]
        self._stamps_ns[rows] = stamp_ns
        self._transforms.set_stamps(stamp_ns, rows)
        return rows

    def last_stamps_ns(self, rows: Rows) -> NDArray[np.int64]:
        """Return the last stamp of each of some moving transforms."""
        return self._stamps_ns[rows]

    def forget_stamps(self) -> None:
        """Accept any stamp next, after time has jumped back."""
        self._stamps_ns[:] = NEVER
        self.positions.forget_stamps()

    def publish_all(self) -> bool:
        """
        Publish all moving frames with known positions on ``/tf``.

        :return: whether all have the time of the node, because no message has given them a stamp.
        """
        rows = np.flatnonzero(self.has_transform)
        if not len(rows):
            return False
        last_ns = self.positions.stamps_ns[self.frames.last_dofs[rows]]
        is_stamped = last_ns != NEVER
        # TF would reject other transforms with the same stamps.
        self._stamps_ns[rows[is_stamped]] = last_ns[is_stamped] + 1
        self._transforms.set_stamps(
            np.where(is_stamped, last_ns + 1, self._publishers.now_ns()), rows)
        self.publish_tf(rows)
        return not is_stamped.any()

    def publish_tf(self, rows: Rows) -> None:
        """
        Publish moving transforms in one message on ``/tf``, with their stamps.

        :param rows: their indices, in ascending order; at least one.
        """
        self._transforms.set_poses(self.frames.transforms(self.positions.values))
        self._tf.publish(self._transforms.tf_message(rows))

    def publish_topics(self, *, only_listeners: bool) -> None:
        """
        Publish all moving frames with known positions on ``~/transforms`` and ``~/poses/...``.

        :param only_listeners: whether to leave out topics without subscribers.
        """
        publisher = self._wanted(self.transforms_topic, only_listeners=only_listeners)
        if publisher is not None:
            self._transforms.set_poses(self.frames.transforms(self.positions.values))
            self._transforms.set_stamps(self._stamps(self.frames.last_dofs))
            messages = self._transforms.messages()
            # They may wait to be published on /tf.
            self._transforms.set_stamps(self._stamps_ns)
            for message in compress(messages, self.has_transform):
                publisher.publish(message)
        publishers = [
            self._wanted(each, only_listeners=only_listeners) for each in self._posed_topics]
        if any(publishers):
            frames, rows = self.frames, self._posed_rows
            self._poses.set_poses(frames.poses(self.positions.values)[rows])
            self._poses.set_stamps(
                self._stamps(frames.posed_last_dofs[rows], frames.last_dof_of_pose_frame))
            for publisher, message in compress(
                    zip(publishers, self._poses.messages(), strict=True),
                    frames.has_pose(self.positions.is_known)[rows]):
                if publisher is not None:
                    publisher.publish(message)

    def _wanted(self, topic: Topic, *, only_listeners: bool) -> Publisher | None:
        """Return the publisher of a topic, or None if nothing is to be published there."""
        found = self._publishers.existing(topic)
        return found if found and (not only_listeners or found.get_subscription_count()) else None

    def _stamps(self, dofs: Indices, dof_of_reference: int = NO_DOF) -> NDArray[np.int64]:
        """
        Return the stamps of poses in nanoseconds.

        :param dofs: the last degree of freedom before each frame; -1 for none.
        :param dof_of_reference: the last degree of freedom before the frame in which the poses are
            given.
        :return: the newer stamp of both, or the time of the node where there is none.
        """
        known = np.append(self.positions.stamps_ns, NEVER)
        newest = np.maximum(known[dofs], known[dof_of_reference])
        return np.where(newest == NEVER, self._publishers.now_ns(), newest)


def _records_of_transforms(tree: TfTree, indices: Rows) -> StampedRecords:
    return StampedRecords(tree.ids_of_transforms(indices), tree.transforms[indices])


def _poses_with_topics(
    tree: TfTree, topics: Mapping[int, Topic], frames: Iterable[int],
) -> tuple[StampedRecords, list[Topic]]:
    indices = sorted(frames)
    return StampedRecords(
        [[tree.pose_frame] * len(indices)], tree.poses_in_pose_frame[indices],
    ), [topics[index] for index in indices]


def _transforms_topic(count: int, part: str) -> Topic:
    """
    Return ``~/transforms`` for a publisher that keeps as many messages as there are transforms.

    So new messages replace all old ones. Another number of transforms needs another publisher,
    which does not have the old messages.
    """
    return Topic('~/transforms', TransformStamped, depth=max(1, count), part=part)
