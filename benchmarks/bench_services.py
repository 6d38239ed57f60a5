# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Services of the node, called from another process as its clients do."""

from __future__ import annotations

import array
from collections.abc import Callable, Iterator
import contextlib
import os
from pathlib import Path
import random
import subprocess
import sys
import tempfile
import time

from benchmarks.harness import AtMostTimes, benchmark, DOMAINS, Function, PerSecond, Unavailable

POSES = 100_000
DEADLINE_S = 20.0

MODEL = '<sdf version="1.10"><model name="m"><link name="l"/></model></sdf>'

MINIMAL_NODE = """
import rclpy
from sdf_pose_bridge_interfaces.srv import ConvertRotation
from sdf_pose_bridge_interfaces.srv import LookupPose
from std_srvs.srv import Empty
rclpy.init(signal_handler_options=rclpy.signals.SignalHandlerOptions.NO)
node = rclpy.create_node('minimal')
node.create_service(Empty, '~/empty', lambda request, response: response)
node.create_service(ConvertRotation, '~/same_type', lambda request, response: response)
node.create_service(LookupPose, '~/type_of_lookup', lambda request, response: response)
rclpy.spin(node)
"""


class Client:
    """Calls services and waits for the answers, in a ROS context of its own."""

    def __init__(self, domain: int) -> None:
        import rclpy
        from rclpy.context import Context
        from rclpy.executors import SingleThreadedExecutor
        self._context = Context()
        rclpy.init(args=[], context=self._context, domain_id=domain)
        self._node = rclpy.create_node('benchmark', context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)

    def caller(self, service_type: type, name: str, request: object) -> Callable[[], object]:
        """Return a function that calls a service once and returns its response."""
        client = self._node.create_client(service_type, name)
        if not client.wait_for_service(timeout_sec=DEADLINE_S):
            msg = f'the service {name} did not come up'
            raise Unavailable(msg)

        def call() -> object:
            future = client.call_async(request)
            deadline = time.monotonic() + DEADLINE_S
            while not future.done():
                if time.monotonic() > deadline:
                    msg = f'the service {name} did not answer'
                    raise Unavailable(msg)
                self._executor.spin_once(timeout_sec=1.0)
            return future.result()
        return call

    def listener(
        self, message_type: type, topic: str, quality: object,
    ) -> Callable[[], bytes]:
        """Return a function that waits for one more message, and returns its bytes."""
        messages: list[bytes] = []
        self._node.create_subscription(message_type, topic, messages.append, quality, raw=True)

        def wait() -> bytes:
            deadline = time.monotonic() + DEADLINE_S
            while not messages:
                if time.monotonic() > deadline:
                    msg = f'nothing came on {topic}'
                    raise Unavailable(msg)
                self._executor.spin_once(timeout_sec=1.0)
            return messages.pop(0)
        return wait

    def close(self) -> None:
        """Leave ROS."""
        self._executor.shutdown()
        self._node.destroy_node()
        self._context.shutdown()
        self._context.destroy()


@contextlib.contextmanager
def bridge_and_minimal_node(text: str = MODEL) -> Iterator[Client]:
    """
    Run the installed bridge and a node that does nothing, each in its own process.

    :param text: the file that the bridge publishes.
    """
    from ament_index_python.packages import get_package_prefix
    domain = random.choice(DOMAINS)
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    environment = dict(os.environ, ROS_DOMAIN_ID=str(domain))
    try:
        prefix = Path(get_package_prefix('sdf_pose_bridge'))
    except LookupError:
        msg = 'sdf_pose_bridge is not installed'
        raise Unavailable(msg) from None
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        file = folder / 'model.sdf'
        file.write_text(text, encoding='utf-8')
        for command in (
            [prefix / 'lib/sdf_pose_bridge/bridge', '--ros-args', '-p', f'sdf_file:={file}'],
            [sys.executable, '-c', MINIMAL_NODE],
        ):
            process = stack.enter_context(subprocess.Popen(
                list(map(str, command)), env=environment, stderr=subprocess.DEVNULL))
            stack.callback(process.terminate)
        client = Client(domain)
        stack.callback(client.close)
        yield client


def rotation_request() -> object:
    from sdf_pose_bridge_interfaces.srv import ConvertRotation
    request = ConvertRotation.Request(given=ConvertRotation.Request.RPY)
    request.rpy.x, request.rpy.y, request.rpy.z = 0.1, -0.2, 2.3
    return request


@benchmark('~/convert_rotation', counterpart='an empty service', goal=AtMostTimes(1.15))
def rotation_and_empty_service() -> Iterator[tuple[Function, Function | None]]:
    from std_srvs.srv import Empty

    from sdf_pose_bridge_interfaces.srv import ConvertRotation
    with bridge_and_minimal_node() as client:
        yield (
            client.caller(
                ConvertRotation, '/sdf_pose_bridge/convert_rotation', rotation_request()),
            client.caller(Empty, '/minimal/empty', Empty.Request()),
        )


# What remains when rclpy's cost of converting messages with these fields is taken out.
@benchmark(
    '~/convert_rotation', counterpart='an empty service of its type', goal=AtMostTimes(1.15))
def rotation_and_service_of_same_type() -> Iterator[tuple[Function, Function | None]]:
    from sdf_pose_bridge_interfaces.srv import ConvertRotation
    with bridge_and_minimal_node() as client:
        yield (
            client.caller(
                ConvertRotation, '/sdf_pose_bridge/convert_rotation', rotation_request()),
            client.caller(ConvertRotation, '/minimal/same_type', rotation_request()),
        )


@benchmark(
    f'~/convert_poses, {POSES:,} poses', counterpart='-', goal=PerSecond(3e5, POSES, 'poses'))
def batch_of_poses() -> Iterator[tuple[Function, Function | None]]:
    from sdf_pose_bridge_interfaces.srv import ConvertPoses
    rng = random.Random(1)
    values = array.array('d', (rng.uniform(-3.0, 3.0) for _ in range(6 * POSES)))
    request = ConvertPoses.Request(
        from_format='sdf_rpy', to_format='sdf_quat_xyzw', values=values)
    with bridge_and_minimal_node() as client:
        yield client.caller(ConvertPoses, '/sdf_pose_bridge/convert_poses', request), None
