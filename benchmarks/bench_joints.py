# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Joints that move, compared with a node that makes an object for each transform."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
import contextlib
import itertools
from pathlib import Path
import subprocess
import sys
import tempfile
import time
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.bench_publication import node
from benchmarks.harness import AtMostTimes, benchmark, Function, TimesAsFast, wait_until
from benchmarks.processes import own_node, repeated, RunningBridge, shares_of
import sdf_pose_bridge
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

if TYPE_CHECKING:
    from rclpy.node import Node
    from sensor_msgs.msg import JointState

RATE_HZ = 500.0
WINDOW_S = 4.0

COUNTERPART = """
import sys
import rclpy
from benchmarks.bench_joints import JointBroadcaster
rclpy.init(signal_handler_options=rclpy.signals.SignalHandlerOptions.NO)
node = rclpy.create_node('counterpart')
broadcaster = JointBroadcaster(node, int(sys.argv[1]), '/tf_of_counterpart')
rclpy.spin(node)
"""


RECEIVER = """
import rclpy
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import JointState
rclpy.init(signal_handler_options=rclpy.signals.SignalHandlerOptions.NO)
node = rclpy.create_node('counterpart')
node.create_subscription(
    JointState, 'joint_states', lambda message: None, qos_profile_sensor_data)
rclpy.spin(node)
"""
"""A minimal node that receives the messages and does nothing."""


def chain_text(joints: int) -> str:
    """Write a model of links that revolute joints connect, one after the other."""
    parts = ''.join(
        f'<link name="link_{number}"><pose relative_to="link_{number - 1}">0 0 0.1 0 0.1 0'
        f'</pose></link><joint name="joint_{number}" type="revolute">'
        f'<parent>link_{number - 1}</parent><child>link_{number}</child>'
        '<axis><xyz>0 0 1</xyz></axis></joint>' for number in range(1, joints + 1))
    return f'<sdf version="1.10"><model name="chain"><link name="link_0"/>{parts}</model></sdf>'


def joint_states(joints: int) -> Iterator[JointState]:
    """
    Make messages with other positions again and again.

    Their stamps are the time, as robot_state_publisher compares them with its period.
    """
    from sensor_msgs.msg import JointState
    names = [f'joint_{number}' for number in range(1, joints + 1)]
    for count in itertools.count(1):
        message = JointState(name=names, position=np.full(joints, count % 1000 * 1e-3))
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(time.time_ns(), 10**9)
        yield message


class JointBroadcaster:
    """
    Publishes the transforms of joints as programs with tf2_ros do: an object for each.

    All joints turn about z at the same place, which is the least that can be calculated.

    :param node: the node.
    :param joints: how many joints there are.
    :param topic: where the transforms are published.
    """

    def __init__(self, node: Node, joints: int, topic: str) -> None:
        from rclpy.qos import qos_profile_sensor_data
        from sensor_msgs.msg import JointState
        from tf2_msgs.msg import TFMessage
        self._frames = {
            f'joint_{number}': (f'link_{number - 1}', f'link_{number}')
            for number in range(1, joints + 1)}
        self._message_type = TFMessage
        self._publisher = node.create_publisher(TFMessage, topic, 100)
        node.create_subscription(JointState, 'joint_states', self.take, qos_profile_sensor_data)

    def take(self, message: JointState) -> None:
        """Publish the transforms of a message."""
        import math

        from geometry_msgs.msg import TransformStamped
        transforms = []
        for name, position in zip(message.name, message.position, strict=True):
            transform = TransformStamped()
            transform.header.stamp = message.header.stamp
            transform.header.frame_id, transform.child_frame_id = self._frames[name]
            transform.transform.translation.z = 0.1
            transform.transform.rotation.z = math.sin(0.5 * position)
            transform.transform.rotation.w = math.cos(0.5 * position)
            transforms.append(transform)
        self._publisher.publish(self._message_type(transforms=transforms))


@benchmark(
    'JointState of 100 joints to sent TFMessage', counterpart='an object for each, and sent',
    goal=TimesAsFast(5.0))
def transforms_of_100_joints() -> Iterator[tuple[Function, Function | None]]:
    from rclpy.serialization import serialize_message

    from sdf_pose_bridge.ros.cdr import JOINT_STATE
    from sdf_pose_bridge.ros.following.state_messages import KnownStreams
    from sdf_pose_bridge.ros.following.state_topic import StateTopic, TopicKey
    from sdf_pose_bridge.ros.publishing.published_frames import PublishedFrames
    from sdf_pose_bridge.ros.publishing.publishers import Publishers
    from sdf_pose_bridge.tf.lookup import PoseLookup
    with node() as ros:
        scene = sdf_pose_bridge.load_text(chain_text(100))
        tree = tf_tree_from_scene(scene, TfOptions(use_joint_states=True))
        assert tree.moving is not None
        positions = JointPositions(scene, tree.moving.motion)
        frames = PublishedFrames(Publishers(ros), tree, positions, {}).moving
        assert frames is not None
        topic = StateTopic(ros, TopicKey('joint_states', '', JOINT_STATE))
        streams = KnownStreams(frames, PoseLookup(scene, tree, positions))
        broadcaster = JointBroadcaster(ros, 100, '/tf_of_counterpart')
        messages = joint_states(100)
        # The counterpart gets objects, which rclpy would have to make first.
        serialized = itertools.cycle(
            [serialize_message(each) for each in itertools.islice(messages, 1000)])

        def publish() -> None:
            message, = topic.read(next(serialized), streams)
            positions.update(
                message.stream.selection, message.values, message.stamp_ns, ignore_stamps=True)
            frames.publish_tf(frames.stamp(streams.rows(message.stream), message.stamp_ns))

        yield publish, lambda: broadcaster.take(next(messages))


@contextlib.contextmanager
def shares_of_processors(
    joints: int, counterpart: str = COUNTERPART, publish_frequency: float = 0.0,
) -> Iterator[tuple[Function, Function]]:
    """Measure what the bridge and the counterpart take while they follow joint states."""
    from sensor_msgs.msg import JointState

    def publishing(node: Node) -> Callable[[], None]:
        publisher = node.create_publisher(JointState, 'joint_states', 10)
        wait_until(
            lambda: publisher.get_subscription_count() >= 2,
            'the nodes did not subscribe to joint_states')
        messages = joint_states(joints)
        return lambda: publisher.publish(next(messages))

    with shares_while_publishing(
            chain_text(joints), (
                'use_joint_states:=true', f'publish_frequency:={publish_frequency}'),
            (counterpart, str(joints)), publishing, RATE_HZ) as pair:
        yield pair


@contextlib.contextmanager
def shares_while_publishing(
    text: str, parameters: Sequence[str], counterpart: Sequence[str],
    publishing: Callable[[Node], Callable[[], None]], rate_hz: float,
) -> Iterator[tuple[Function, Function]]:
    """
    Measure what the bridge and a counterpart take while they follow the same messages.

    :param text: the file of the bridge.
    :param counterpart: the program of the counterpart, and its arguments.
    :param publishing: makes publishers on a node, and returns a function that publishes once.
    """
    with contextlib.ExitStack() as stack:
        file = Path(stack.enter_context(tempfile.TemporaryDirectory()), 'file.sdf')
        file.write_text(text, encoding='utf-8')
        bridge = RunningBridge(stack, file, 'watch:=false', 'pose_topics:=[]', *parameters)
        other = bridge.start(
            stack, sys.executable, '-c', *counterpart, stderr=subprocess.DEVNULL)
        publish = publishing(stack.enter_context(own_node(bridge.domain)))
        stack.enter_context(repeated(publish, rate_hz))
        yield shares_of((bridge.process, other), lambda: time.sleep(WINDOW_S))


@benchmark(
    '30 joints at 500 Hz, processor time in each second',
    counterpart='a node that makes an object for each', goal=TimesAsFast())
def share_of_30_joints() -> Iterator[tuple[Function, Function | None]]:
    with shares_of_processors(30) as pair:
        yield pair


@benchmark(
    '100 joints at 500 Hz, processor time in each second',
    counterpart='a node that makes an object for each', goal=TimesAsFast())
def share_of_100_joints() -> Iterator[tuple[Function, Function | None]]:
    with shares_of_processors(100) as pair:
        yield pair


@benchmark(
    '30 joints at 500 Hz, each message published, processor time in each second',
    counterpart='a minimal node that receives and does nothing', goal=AtMostTimes(0.95))
def share_and_receiver() -> Iterator[tuple[Function, Function | None]]:
    with shares_of_processors(30, RECEIVER) as pair:
        yield pair


@benchmark(
    '30 joints at 500 Hz, publish_frequency 20, processor time in each second',
    counterpart='a minimal node that receives and does nothing', goal=AtMostTimes(1.0))
def share_at_20_hz_and_receiver() -> Iterator[tuple[Function, Function | None]]:
    with shares_of_processors(30, RECEIVER, publish_frequency=20.0) as pair:
        yield pair
