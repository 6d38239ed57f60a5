#!/usr/bin/env python3
# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Receive the frames of a running bridge on every topic, call its services, and print the results.

An example of a program that uses the node. Start the node in one shell and this in another, in any
order::

    ros2 run sdf_pose_bridge bridge --ros-args -p sdf_file:=cell.sdf
    python3 listen_to_frames.py
"""

import argparse
from collections.abc import Callable, Iterator
import itertools
import math
import sys
import textwrap
import time

from geometry_msgs.msg import PoseStamped, TransformStamped
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from tf2_msgs.msg import TFMessage

from sdf_pose_bridge.tf.frame_ids import topic_name_from_frame_id
from sdf_pose_bridge_interfaces.srv import ConvertRotation

WIDTH = 99


class MissingError(Exception):
    """Something did not arrive."""


def latched(depth: int) -> QoSProfile:
    """Return a quality of service with which messages also arrive that were sent earlier."""
    return QoSProfile(
        depth=depth, reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL)


class FrameListener(Node):
    """Collects the messages of the bridge, by frame id."""

    def __init__(self, bridge: str) -> None:
        super().__init__('frame_listener')
        self.bridge = bridge
        self.tf_static: dict[str, TransformStamped] = {}
        self.transforms: dict[str, TransformStamped] = {}
        self.poses: dict[str, PoseStamped] = {}
        self.create_subscription(TFMessage, '/tf_static', self.take_tf_static, latched(1))
        # They arrive one by one and almost at once, so the queue must have room for all.
        self.create_subscription(
            TransformStamped, f'{bridge}/transforms', self.take_transform, latched(10000))
        self.converter = self.create_client(ConvertRotation, f'{bridge}/convert_rotation')

    def take_tf_static(self, message: TFMessage) -> None:
        """Keep the last message, which contains all transforms."""
        self.tf_static = {each.child_frame_id: each for each in message.transforms}

    def take_transform(self, message: TransformStamped) -> None:
        """Keep one transform."""
        self.transforms[message.child_frame_id] = message

    def listen_to_pose(self, frame: str) -> None:
        """Subscribe to the pose of one frame."""
        def take(message: PoseStamped) -> None:
            self.poses[frame] = message

        topic = f'{self.bridge}/poses/{topic_name_from_frame_id(frame)}'
        self.create_subscription(PoseStamped, topic, take, latched(1))

    def wait(self, deadline: float, arrived: Callable[[], bool], what: Callable[[], str]) -> None:
        """Handle messages until something has arrived."""
        while not arrived():
            left = deadline - time.monotonic()
            if left <= 0.0:
                raise MissingError(what())
            rclpy.spin_once(self, timeout_sec=min(left, 0.1))

    def convert(
        self, request: ConvertRotation.Request, deadline: float,
    ) -> ConvertRotation.Response:
        """Call the conversion service."""
        future = self.converter.call_async(request)
        self.wait(deadline, future.done, lambda: 'no answer from the conversion service')
        response = future.result()
        if not response.success:
            msg = f'the conversion service refused: {response.message}'
            raise MissingError(msg)
        return response


def receive_frames(listener: FrameListener, deadline: float) -> None:
    """Wait until the same frames have arrived on all three kinds of topics."""
    listener.wait(
        deadline, lambda: bool(listener.tf_static), lambda: 'nothing arrived on /tf_static')
    frames = set(listener.tf_static)
    for frame in frames:
        listener.listen_to_pose(frame)
    listener.wait(
        deadline, lambda: frames <= set(listener.transforms),
        lambda: f'{len(listener.transforms)} of {len(frames)} transforms arrived on '
                f'{listener.bridge}/transforms')
    listener.wait(
        deadline, lambda: frames <= set(listener.poses),
        lambda: f'{len(listener.poses)} of {len(frames)} poses arrived on '
                f'{listener.bridge}/poses/...')
    for frame, transform in listener.transforms.items():
        if listener.tf_static.get(frame) != transform:
            msg = f'/tf_static and {listener.bridge}/transforms differ about "{frame}"'
            raise MissingError(msg)


def tree_lines(parents: dict[str, str], parent: str, indent: str = '  ') -> Iterator[str]:
    """Write a tree of frames, those without children in shared lines."""
    children = [child for child, its_parent in parents.items() if its_parent == parent]
    inner = set(parents.values())
    leaves = [child for child in children if child not in inner]
    if leaves:
        yield from textwrap.wrap(
            ', '.join(leaves), WIDTH, initial_indent=indent, subsequent_indent=indent,
            break_long_words=False, break_on_hyphens=False)
    for child in children:
        if child in inner:
            yield f'{indent}{child}'
            yield from tree_lines(parents, child, f'{indent}  ')


def text_from_pose(message: PoseStamped) -> str:
    """Write a pose in one line."""
    xyz, quat = message.pose.position, message.pose.orientation
    return (
        f'xyz {xyz.x:8.4f} {xyz.y:8.4f} {xyz.z:8.4f}   '
        f'quaternion xyzw {quat.x:7.4f} {quat.y:7.4f} {quat.z:7.4f} {quat.w:7.4f}')


def print_frames(listener: FrameListener) -> None:
    """Print how many frames arrived on which topics, and the tree of frames."""
    print(
        f'{len(listener.tf_static)} transforms on /tf_static, {len(listener.transforms)} on '
        f'{listener.bridge}/transforms, {len(listener.poses)} poses on '
        f'{listener.bridge}/poses/...')
    parents = {
        frame: transform.header.frame_id for frame, transform in listener.tf_static.items()}
    print('\nTree of frames:')
    for root in dict.fromkeys(parent for parent in parents.values() if parent not in parents):
        print(root)
        print('\n'.join(tree_lines(parents, root)))


def print_poses(listener: FrameListener, count: int) -> None:
    """Print the poses of a few frames of the tree."""
    frames = list(listener.tf_static)
    count = min(count, len(frames))
    chosen = [frames[(2 * index + 1) * len(frames) // (2 * count)] for index in range(count)]
    for root, group in itertools.groupby(chosen, lambda it: listener.poses[it].header.frame_id):
        print(f'\nPoses in {root}:')
        for frame in group:
            print(f'  {frame}\n    {text_from_pose(listener.poses[frame])}')


def print_conversions(listener: FrameListener, deadline: float) -> None:
    """Convert one rotation given as roll, pitch, yaw, and one as a quaternion."""
    listener.wait(
        deadline, listener.converter.service_is_ready,
        lambda: f'there is no service {listener.bridge}/convert_rotation')
    request = ConvertRotation.Request(given=ConvertRotation.Request.RPY, degrees=True)
    request.rpy.x, request.rpy.y, request.rpy.z = 10.0, 20.0, 90.0
    answer = listener.convert(request, deadline).quaternion
    print('\nThe service convert_rotation says:')
    print('  roll pitch yaw 10 20 90 degrees is quaternion xyzw '
          f'{answer.x:.6f} {answer.y:.6f} {answer.z:.6f} {answer.w:.6f}')
    request = ConvertRotation.Request(given=ConvertRotation.Request.QUATERNION, degrees=True)
    request.quaternion.z, request.quaternion.w = math.sqrt(0.5), math.sqrt(0.5)
    answer = listener.convert(request, deadline).rpy
    print('  quaternion xyzw 0 0 0.707107 0.707107 is roll pitch yaw '
          f'{answer.x:.6g} {answer.y:.6g} {answer.z:.6g} degrees')


def main() -> int:
    parser = argparse.ArgumentParser(description='Print the frames of a running bridge.')
    parser.add_argument(
        '--bridge', default='/sdf_pose_bridge', help='full name of its node (%(default)s)')
    parser.add_argument(
        '--timeout', type=float, default=20.0, help='seconds to wait for it (%(default)s)')
    parser.add_argument('--poses', type=int, default=3, help='how many to print (%(default)s)')
    arguments = parser.parse_args(rclpy.utilities.remove_ros_args(sys.argv)[1:])
    deadline = time.monotonic() + arguments.timeout
    rclpy.init()
    listener = FrameListener(arguments.bridge)
    try:
        receive_frames(listener, deadline)
        print_frames(listener)
        print_poses(listener, arguments.poses)
        print_conversions(listener, deadline)
    except MissingError as missing:
        print(f'After {arguments.timeout:g} s: {missing}.', file=sys.stderr)
        return 1
    except (KeyboardInterrupt, ExternalShutdownException):
        return 130
    finally:
        listener.destroy_node()
        rclpy.try_shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
