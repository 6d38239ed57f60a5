#!/usr/bin/env python3
# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Look at a running bridge and call its services, where there is no ros2 command line.

An example of clients for each service of the node. Start the node in one shell, and this in
another::

    python3 ask_bridge.py topics
    python3 ask_bridge.py pose robot/tool0
    python3 ask_bridge.py lookup robot/tool0 table
    python3 ask_bridge.py rotation --degrees 0 0 90
    python3 ask_bridge.py convert sdf_rpy_degrees sdf_quat_xyzw 1 2 3 0 0 90
    python3 ask_bridge.py reload
"""

import argparse
from collections.abc import Callable
import signal
import sys
import time
from typing import Any

from geometry_msgs.msg import PoseStamped
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_srvs.srv import Trigger

from sdf_pose_bridge.tf.frame_ids import topic_name_from_frame_id
from sdf_pose_bridge_interfaces.srv import ConvertPoses, ConvertRotation, LookupPose


class NoAnswerError(Exception):
    """The bridge is not there, or refuses."""


class Client(Node):
    """
    Asks one bridge.

    :param bridge: full name of its node.
    :param timeout: seconds to wait for it.
    """

    def __init__(self, bridge: str, timeout: float) -> None:
        super().__init__('ask_bridge')
        self.bridge = bridge
        self.timeout = timeout
        self._deadline = time.monotonic() + timeout

    def is_bridge_there(self) -> bool:
        """Return whether the node of the bridge is running."""
        namespace, _, name = self.bridge.rpartition('/')
        return (name, namespace or '/') in self.get_node_names_and_namespaces()

    def wait(
        self, arrived: Callable[[], bool], what: str, hint: str = 'is the node running?',
    ) -> None:
        """Handle messages until something has arrived."""
        while not arrived():
            left = self._deadline - time.monotonic()
            if left <= 0.0:
                msg = f'no {what} within {self.timeout:g} s; {hint}'
                raise NoAnswerError(msg)
            rclpy.spin_once(self, timeout_sec=min(left, 0.1))

    def call(self, service_type: type, name: str, request: Any) -> Any:
        """Call a service, and return its response if it was successful."""
        service = f'{self.bridge}/{name}'
        client = self.create_client(service_type, service)
        self.wait(client.service_is_ready, f'service {service}')
        futures = [client.call_async(request)]

        def ask_again() -> None:
            timer.cancel()
            futures.append(client.call_async(request))

        # The middleware may lose the answer to a client that it has not discovered completely.
        timer = self.create_timer(2.0, ask_again)
        self.wait(lambda: any(future.done() for future in futures), f'answer of {service}')
        response = next(future.result() for future in futures if future.done())
        if not response.success:
            raise NoAnswerError(response.message)
        return response

    def pose(self, frame: str) -> PoseStamped:
        """Return the message on the pose topic of a frame."""
        # The service answers at once where there is no such frame.
        self.call(LookupPose, 'lookup_pose', LookupPose.Request(frame=frame))
        topic = f'{self.bridge}/poses/{topic_name_from_frame_id(frame)}'
        poses: list[PoseStamped] = []
        self.create_subscription(
            PoseStamped, topic, poses.append,
            QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
        self.wait(
            lambda: bool(poses), f'message on {topic}',
            'the parameter pose_topics chooses the frames that have one')
        return poses[0]


def text_from_vector(vector: Any) -> str:
    return f'{vector.x} {vector.y} {vector.z}'


def text_from_quaternion(quaternion: Any) -> str:
    return f'{text_from_vector(quaternion)} {quaternion.w}'


def print_pose(frame: str, stamped: PoseStamped) -> None:
    print(f'{frame} in {stamped.header.frame_id}:')
    print(f'  position xyz      {text_from_vector(stamped.pose.position)}')
    print(f'  quaternion xyzw   {text_from_quaternion(stamped.pose.orientation)}')


def print_topics(client: Client, _: argparse.Namespace) -> None:
    namespace, _, name = client.bridge.rpartition('/')
    namespace = namespace or '/'
    client.wait(client.is_bridge_there, f'node {client.bridge}')
    service = f'{client.bridge}/reload'
    client.wait(
        lambda: service in dict(client.get_service_names_and_types_by_node(name, namespace)),
        f'service {service}')
    for title, names_and_types in (
        ('Topics', client.get_publisher_names_and_types_by_node(name, namespace)),
        ('Services', client.get_service_names_and_types_by_node(name, namespace)),
    ):
        print(f'{title}:')
        for each, types in names_and_types:
            print(f'  {each} [{", ".join(types)}]')


def print_pose_of_frame(client: Client, arguments: argparse.Namespace) -> None:
    print_pose(arguments.frame, client.pose(arguments.frame))


def print_lookup(client: Client, arguments: argparse.Namespace) -> None:
    request = LookupPose.Request(frame=arguments.frame, relative_to=arguments.relative_to)
    print_pose(arguments.frame, client.call(LookupPose, 'lookup_pose', request).pose)


def print_rotation(client: Client, arguments: argparse.Namespace) -> None:
    request = ConvertRotation.Request(degrees=arguments.degrees)
    if len(arguments.numbers) == 4:
        request.given = ConvertRotation.Request.QUATERNION
        each = request.quaternion
        each.x, each.y, each.z, each.w = arguments.numbers
    elif len(arguments.numbers) == 3:
        request.given = ConvertRotation.Request.RPY
        request.rpy.x, request.rpy.y, request.rpy.z = arguments.numbers
    else:
        msg = f'{len(arguments.numbers)} numbers are neither roll pitch yaw nor x y z w'
        raise NoAnswerError(msg)
    response = client.call(ConvertRotation, 'convert_rotation', request)
    print(f'roll pitch yaw    {text_from_vector(response.rpy)}')
    print(f'quaternion xyzw   {text_from_quaternion(response.quaternion)}')


def print_converted(client: Client, arguments: argparse.Namespace) -> None:
    request = ConvertPoses.Request(
        from_format=arguments.from_format, to_format=arguments.to_format,
        values=arguments.numbers)
    print(*client.call(ConvertPoses, 'convert_poses', request).values)


def print_reload(client: Client, _: argparse.Namespace) -> None:
    print(client.call(Trigger, 'reload', Trigger.Request()).message)


def parsed_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description='Look at a bridge and call its services.')
    parser.add_argument(
        '--bridge', default='/sdf_pose_bridge', help='full name of its node (%(default)s)')
    parser.add_argument(
        '--timeout', type=float, default=10.0, help='seconds to wait for it (%(default)s)')
    commands = parser.add_subparsers(required=True, metavar='COMMAND')

    def add(name: str, function: Callable, help_text: str) -> argparse.ArgumentParser:
        command = commands.add_parser(name, help=help_text, description=help_text)
        command.set_defaults(function=function)
        return command

    add('topics', print_topics, 'list its topics and services')
    command = add('pose', print_pose_of_frame, 'print the message on the topic of a frame')
    command.add_argument('frame', help='frame id, such as robot/tool0')
    command = add('lookup', print_lookup, 'call ~/lookup_pose')
    command.add_argument('frame', help='name as in SDF or in TF')
    command.add_argument('relative_to', nargs='?', default='', help='the same; the root if empty')
    command = add('rotation', print_rotation, 'call ~/convert_rotation')
    command.add_argument('numbers', type=float, nargs='+', help='roll pitch yaw, or x y z w')
    command.add_argument('--degrees', action='store_true')
    command = add('convert', print_converted, 'call ~/convert_poses')
    command.add_argument('from_format', help='such as sdf_rpy')
    command.add_argument('to_format', help='such as sdf_quat_xyzw')
    command.add_argument('numbers', type=float, nargs='+', help='the poses')
    add('reload', print_reload, 'call ~/reload')
    return parser.parse_args(rclpy.utilities.remove_ros_args(sys.argv)[1:])


def main() -> int:
    arguments = parsed_arguments()
    # Ends in silence where the reader of a pipe ends first, such as head.
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    rclpy.init()
    client = Client(arguments.bridge, arguments.timeout)
    try:
        arguments.function(client, arguments)
    except NoAnswerError as reason:
        print(reason, file=sys.stderr)
        return 1
    except (KeyboardInterrupt, ExternalShutdownException):
        return 130
    finally:
        client.destroy_node()
        rclpy.try_shutdown()
    return 0


if __name__ == '__main__':
    sys.exit(main())
