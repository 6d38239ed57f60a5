# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Publishing many frames with real publishers, compared with what most rclpy programs do."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
import contextlib
from pathlib import Path
import random
import tempfile
from typing import TYPE_CHECKING

from benchmarks.harness import AtMostTimes, benchmark, DOMAINS, Function, TimesAsFast
from benchmarks.processes import latched, own_node
import sdf_pose_bridge
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.tf.tree import DEFAULT_KINDS, tf_tree_from_scene, TfTree

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.publisher import Publisher

    from sdf_pose_bridge.ros.publishing.published_frames import PublishedFrames

MODELS = 1000
FRAMES = 10 * MODELS
TOPICS = 1000
LINKS = 5


def world_text(models: int) -> str:
    """Write a world of jointed models, each of ten frames (itself, five links, four frames)."""
    parts = ['<sdf version="1.10"><world name="hall">']
    for number in range(models):
        place = f'{number % 100} {number // 100} 0 0 0 0.{number % 9}'
        parts.append(f'<model name="robot_{number}"><pose>{place}</pose>')
        for link in range(LINKS):
            parts.append(
                f'<link name="link_{link}"><pose>{link} 1 2 0.1 0.2 0.3</pose><visual name="v">'
                '<geometry><box><size>1 1 1</size></box></geometry></visual></link>')
            if link:
                parts.append(
                    f'<joint name="joint_{link}" type="revolute"><parent>link_{link - 1}</parent>'
                    f'<child>link_{link}</child><axis><xyz>0 0 1</xyz></axis></joint>'
                    f'<frame name="frame_{link}" attached_to="link_{link}">'
                    '<pose>0 0 1 0 0 0</pose></frame>')
        parts.append('</model>')
    return ''.join([*parts, '</world></sdf>'])


def scene_of(models: int) -> Scene:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, 'hall.sdf')
        path.write_text(world_text(models), encoding='utf-8')
        return sdf_pose_bridge.load(path)


def node() -> contextlib.AbstractContextManager[Node]:
    return own_node(random.choice(DOMAINS))


def latched_publisher(node: Node, message_type: type, name: str, depth: int) -> Publisher:
    return node.create_publisher(message_type, name, latched(depth))


def transforms_of_tree(tree: TfTree) -> Iterator[tuple[str, str, Pose]]:
    """Give the parent frame, the child frame and the pose of each transform."""
    return zip(tree.parent_ids, tree.frame_ids, tree.transforms.tolist(), strict=True)


def transforms_of_scene(scene: Scene) -> Iterator[tuple[str, str, Pose]]:
    """
    Give the same of a scene, in a loop over its elements.

    The parent of each frame is its parent element, which is less work than the bridge's parents.
    """
    for index, name in enumerate(scene.names):
        if scene.kinds[index] in DEFAULT_KINDS:
            parent = int(scene.parents[index])
            yield (
                scene.names[parent].replace(SEPARATOR, '/'), name.replace(SEPARATOR, '/'),
                scene.relative_pose_of(index, parent))


def transform_messages(node: Node, transforms: Iterable[tuple[str, str, Pose]]) -> list:
    """Make an object of each."""
    from geometry_msgs.msg import TransformStamped
    stamp = node.get_clock().now().to_msg()
    messages = []
    for parent_id, child_id, numbers in transforms:
        message = TransformStamped()
        message.header.stamp = stamp
        message.header.frame_id = parent_id
        message.child_frame_id = child_id
        xyz, quat = message.transform.translation, message.transform.rotation
        xyz.x, xyz.y, xyz.z, quat.x, quat.y, quat.z, quat.w = numbers
        messages.append(message)
    return messages


def publishers_of_poses(node: Node, tree: TfTree) -> list[Publisher]:
    """Make a publisher for each frame, and publish an object by it."""
    from geometry_msgs.msg import PoseStamped
    stamp = node.get_clock().now().to_msg()
    publishers = []
    for frame_id, numbers in zip(tree.frame_ids, tree.poses.tolist(), strict=True):
        message = PoseStamped()
        message.header.stamp = stamp
        message.header.frame_id = tree.root_frame
        xyz, quat = message.pose.position, message.pose.orientation
        xyz.x, xyz.y, xyz.z, quat.x, quat.y, quat.z, quat.w = numbers
        publishers.append(latched_publisher(node, PoseStamped, f'/poses/{frame_id}', 1))
        publishers[-1].publish(message)
    return publishers


class Bench:
    """
    The bridge's publishers, and a publisher as any program has it.

    :param ros: the node of both.
    """

    def __init__(self, ros: Node) -> None:
        from tf2_msgs.msg import TFMessage

        from sdf_pose_bridge.ros.publishing.publishers import Publishers
        self.ros = ros
        self.scene = scene_of(MODELS)
        self.tree = tf_tree_from_scene(self.scene)
        assert len(self.tree.frame_ids) == FRAMES
        self.publishers = Publishers(ros)
        self._message_type = TFMessage
        self._publisher = latched_publisher(ros, TFMessage, '/objects', 1)

    def frames(self, tree: TfTree) -> PublishedFrames:
        """Return the bridge's frames without topics of poses."""
        from sdf_pose_bridge.ros.publishing.published_frames import PublishedFrames
        return PublishedFrames(self.publishers, tree, None, {})

    def send_objects(self, transforms: Iterable[tuple[str, str, Pose]]) -> None:
        """Send a TFMessage made of one object each."""
        self._publisher.publish(
            self._message_type(transforms=transform_messages(self.ros, transforms)))

    def send_objects_of_tree(self) -> None:
        """Send those of the tree."""
        self.send_objects(transforms_of_tree(self.tree))


@benchmark(
    f'{FRAMES:,} transforms from Scene to sent TFMessage',
    counterpart='name, pose and an object for each element, and sent', goal=TimesAsFast(25.0))
def first_tf_static() -> Iterator[tuple[Function, Function | None]]:
    with node() as ros:
        bench = Bench(ros)
        yield (
            lambda: bench.frames(tf_tree_from_scene(bench.scene)).publish_tf_static(),
            lambda: bench.send_objects(transforms_of_scene(bench.scene)))


@benchmark(
    f'{FRAMES:,} transforms from Scene to sent TFMessage',
    counterpart='only the objects, of known transforms, and sent', goal=TimesAsFast())
def first_tf_static_and_objects_alone() -> Iterator[tuple[Function, Function | None]]:
    with node() as ros:
        bench = Bench(ros)
        yield (
            lambda: bench.frames(tf_tree_from_scene(bench.scene)).publish_tf_static(),
            bench.send_objects_of_tree)


@benchmark(
    f'{FRAMES:,} transforms from TfTree to sent TFMessage',
    counterpart='an object for each, and sent', goal=TimesAsFast(25.0))
def tf_static_from_tree() -> Iterator[tuple[Function, Function | None]]:
    with node() as ros:
        bench = Bench(ros)
        yield (
            lambda: bench.frames(bench.tree).publish_tf_static(), bench.send_objects_of_tree)


@benchmark(
    f'{FRAMES:,} transforms sent again with new stamps',
    counterpart='an object for each, and sent', goal=TimesAsFast(100.0))
def tf_static_again() -> Iterator[tuple[Function, Function | None]]:
    with node() as ros:
        bench = Bench(ros)
        frames = bench.frames(bench.tree)

        def publish_again() -> None:
            frames.stamp_ns = bench.publishers.now_ns()
            frames.publish_tf_static()
        yield publish_again, bench.send_objects_of_tree


@benchmark(
    f'{FRAMES:,} messages on ~/transforms sent again with new stamps, and /tf_static',
    counterpart='an object for each, and sent', goal=TimesAsFast())
def transforms_one_by_one() -> Iterator[tuple[Function, Function | None]]:
    from geometry_msgs.msg import TransformStamped
    with node() as ros:
        bench = Bench(ros)
        frames = bench.frames(bench.tree)
        frames.open_topics()
        frames.publish_topics()
        publisher = latched_publisher(ros, TransformStamped, '/one_by_one', FRAMES)

        def send_one_by_one() -> None:
            for message in transform_messages(ros, transforms_of_tree(bench.tree)):
                publisher.publish(message)
        yield frames.publish_fixed_again, send_one_by_one


@benchmark(
    f'{TOPICS:,} topics of poses, made, sent and taken down',
    counterpart="rclpy's publishers, of the same quality", goal=AtMostTimes(1.0))
def topics_of_poses() -> Iterator[tuple[Function, Function | None]]:
    from sdf_pose_bridge.ros.publishing.published_frames import PublishedFrames
    from sdf_pose_bridge.ros.publishing.publishers import Publishers
    from sdf_pose_bridge.ros.publishing.topic_names import pose_topics_from_patterns
    tree = tf_tree_from_scene(scene_of(TOPICS // 10))
    assert len(tree.frame_ids) == TOPICS
    with node() as ros:
        publishers = Publishers(ros)

        def ours() -> None:
            topics = pose_topics_from_patterns(tree.frame_ids, ['*'], '/benchmark').names
            for names in (topics, {}):
                frames = PublishedFrames(publishers, tree, None, names)
                frames.open_topics()
                frames.destroy_other_publishers()
                frames.publish_topics()

        def counterpart() -> None:
            for publisher in publishers_of_poses(ros, tree):
                ros.destroy_publisher(publisher)
        yield ours, counterpart
