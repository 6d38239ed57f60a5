# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The installed bridge and other nodes in processes of their own, their client, and their cost."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
import contextlib
import itertools
import os
from pathlib import Path
import random
import subprocess
import sys
import tempfile
import threading
import time
from typing import TYPE_CHECKING

from benchmarks.harness import DOMAINS, Function, Took, Unavailable

if TYPE_CHECKING:
    from rclpy.node import Node
    from rclpy.qos import QoSProfile

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


def program_of(package: str, name: str) -> Path:
    """Return the path of a program of a package of ROS."""
    from ament_index_python.packages import get_package_prefix
    try:
        return Path(get_package_prefix(package), 'lib', package, name)
    except LookupError:
        msg = f'{package} is not installed'
        raise Unavailable(msg) from None


def latched(depth: int) -> QoSProfile:
    """Return a reliable quality of service that keeps so many messages for those who come late."""
    from rclpy.qos import DurabilityPolicy, QoSProfile
    return QoSProfile(depth=depth, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@contextlib.contextmanager
def own_node(domain: int) -> Iterator[Node]:
    """Make a node of this process with an executor, in a ROS context of its own."""
    import rclpy
    from rclpy.context import Context
    from rclpy.executors import SingleThreadedExecutor
    context = Context()
    rclpy.init(args=[], context=context, domain_id=domain)
    node = rclpy.create_node(f'benchmark_{random.randint(0, 10 ** 9)}', context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    try:
        yield node
    finally:
        executor.shutdown()
        node.destroy_node()
        context.shutdown()
        context.destroy()


class Client:
    """
    Calls services and receives messages, by a node of its own.

    :param stack: ends it.
    """

    def __init__(self, stack: contextlib.ExitStack, domain: int) -> None:
        self._node = stack.enter_context(own_node(domain))

    def caller(self, service_type: type, name: str, request: object) -> Callable[[], object]:
        """Return a function that calls a service once and returns its response."""
        client = self._node.create_client(service_type, name)
        if not client.wait_for_service(timeout_sec=DEADLINE_S):
            msg = f'the service {name} did not come up'
            raise Unavailable(msg)

        def call() -> object:
            future = client.call_async(request)
            self._spin_until(future.done, f'the service {name} did not answer')
            return future.result()
        return call

    def listener(
        self, message_type: type, topic: str, quality: QoSProfile,
    ) -> Callable[[], bytes]:
        """Return a function that waits for one more message, and returns its bytes."""
        messages: list[bytes] = []
        self._node.create_subscription(message_type, topic, messages.append, quality, raw=True)

        def wait() -> bytes:
            self._spin_until(lambda: bool(messages), f'nothing came on {topic}')
            return messages.pop(0)
        return wait

    def _spin_until(self, has_happened: Callable[[], bool], what: str) -> None:
        deadline = time.monotonic() + DEADLINE_S
        while not has_happened():
            if time.monotonic() > deadline:
                raise Unavailable(what)
            self._node.executor.spin_once(timeout_sec=1.0)


class RunningBridge:
    """
    The installed bridge on a file, in a process and a domain of its own.

    :param stack: ends it.
    :param file: the file.
    :param parameters: more of them, as ``name:=value``.
    """

    def __init__(self, stack: contextlib.ExitStack, file: Path, *parameters: str) -> None:
        self.domain = random.choice(DOMAINS)
        self.environment = dict(os.environ, ROS_DOMAIN_ID=str(self.domain))
        self.file = file
        self.process = self.start(
            stack, program_of('sdf_pose_bridge', 'bridge'), '--ros-args', '-p',
            f'sdf_file:={file}',
            *itertools.chain.from_iterable(('-p', each) for each in parameters),
            stderr=subprocess.DEVNULL)
        self.client = Client(stack, self.domain)

    def start(
        self, stack: contextlib.ExitStack, *command: object, **options: object,
    ) -> subprocess.Popen[str]:
        """
        Start another process in its domain, which SIGTERM ends.

        A node in Python leaves that to the system: with rclpy's handlers it goes on waiting for
        ever where the signal comes just as it begins to spin.
        """
        process = stack.enter_context(subprocess.Popen(
            list(map(str, command)), env=self.environment, text=True, **options))
        stack.callback(process.terminate)
        return process

    def replace(self, text: str) -> None:
        """Replace the file, as editors do."""
        new = self.file.with_suffix('.new')
        new.write_text(text, encoding='utf-8')
        new.replace(self.file)


@contextlib.contextmanager
def bridge_and_minimal_node(text: str = MODEL) -> Iterator[Client]:
    """
    Run the bridge, and a node that does nothing.

    :param text: the file that the bridge publishes.
    """
    with contextlib.ExitStack() as stack:
        file = Path(stack.enter_context(tempfile.TemporaryDirectory()), 'model.sdf')
        file.write_text(text, encoding='utf-8')
        bridge = RunningBridge(stack, file)
        bridge.start(stack, sys.executable, '-c', MINIMAL_NODE, stderr=subprocess.DEVNULL)
        yield bridge.client


def calls(
    service_type: type, name: str, request: object, same_type: str = '', text: str = MODEL,
) -> Iterator[tuple[Function, Function]]:
    """
    Compare calls of a service of the bridge with those of an empty one.

    :param same_type: the service of the minimal node that has this type, instead of the empty one.
    """
    from std_srvs.srv import Empty
    with bridge_and_minimal_node(text) as client:
        yield client.caller(service_type, f'/sdf_pose_bridge/{name}', request), (
            client.caller(service_type, f'/minimal/{same_type}', request) if same_type
            else client.caller(Empty, '/minimal/empty', Empty.Request()))


def processor_time_ns(process: subprocess.Popen) -> int:
    """Return the nanoseconds that the threads of a process have run so far."""
    files = list(Path(f'/proc/{process.pid}/task').glob('*/schedstat'))
    if not files:
        msg = 'this system does not report how long threads have run'
        raise Unavailable(msg)
    return sum(int(file.read_text(encoding='ascii').split()[0]) for file in files)


def shares_of(
    processes: Sequence[subprocess.Popen], wait: Callable[[], object],
    now_s: Callable[[], float] = time.perf_counter,
) -> tuple[Function, Function]:
    """
    Return functions for the processor time in each second of one process, and of all others.

    All are measured in the same time, and then returned one after the other.

    :param wait: lets some time pass.
    :param now_s: the clock of these seconds.
    """
    last: list[float] = []

    def of_the_first() -> Took:
        before, begin_s = list(map(processor_time_ns, processes)), now_s()
        wait()
        passed_s = now_s() - begin_s
        last[:] = [
            1e-9 * (processor_time_ns(process) - first) / passed_s
            for process, first in zip(processes, before, strict=True)]
        return Took(last[0])
    return of_the_first, lambda: Took(sum(last[1:]))


@contextlib.contextmanager
def repeated(action: Callable[[], object], rate_hz: float) -> Iterator[None]:
    """Call a function so many times a second meanwhile."""
    has_ended = threading.Event()

    def repeat() -> None:
        due = time.perf_counter()
        while not has_ended.is_set():
            action()
            due += 1.0 / rate_hz
            time.sleep(max(0.0, due - time.perf_counter()))

    thread = threading.Thread(target=repeat, daemon=True)
    thread.start()
    try:
        yield
    finally:
        has_ended.set()
        thread.join()
