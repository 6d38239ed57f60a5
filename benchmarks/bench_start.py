# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The start of the node, from the start of its process, compared with a minimal node."""

from __future__ import annotations

from collections.abc import Iterator
import contextlib
import itertools
import os
from pathlib import Path
import random
import statistics
import subprocess
import sys
import tempfile
import time
from typing import NamedTuple

from benchmarks.harness import (
    AtMostTimes,
    benchmark,
    DOMAINS,
    Function,
    Medians,
    RUNS,
    Took,
    Unavailable,
)
from benchmarks.processes import Client, latched, processor_time_ns, program_of

WORK_CELL = Path(__file__).resolve().parents[1] / 'examples/work_cell.sdf'
LISTENER_AGE_S = (0.8, 1.3)
IMPORTS_MS = 60
LATE_S = 1.0
"""Discovery mostly takes far less than this, but longer if an answer gets lost."""

STARTS_PER_RUN = 2

MINIMAL_NODE = """
import rclpy
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile
from tf2_msgs.msg import TFMessage
rclpy.init()
node = rclpy.create_node('minimal')
publisher = node.create_publisher(
    TFMessage, '/tf_static', QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
publisher.publish(TFMessage())
rclpy.spin(node)
"""

# Runs a program as it is, and writes to a pipe when it has published on /tf_static. Nothing is
# imported for that: the class of publishers is changed at the next import after its own.
RUNNER = """
import os, sys

class Changer:
    def find_spec(name, path=None, target=None):
        publisher = getattr(sys.modules.get('rclpy.publisher'), 'Publisher', None)
        if publisher is not None:
            sys.meta_path.remove(Changer)
            publish = publisher.publish
            def publish_and_report(self, message):
                publish(self, message)
                if self.topic_name == '/tf_static':
                    os.write(pipe, b'.')
            publisher.publish = publish_and_report

del sys.argv[0]
pipe = int(sys.argv.pop(0))
sys.path[0] = os.path.dirname(sys.argv[0])
sys.meta_path.insert(0, Changer)
with open(sys.argv[0]) as file:
    program = compile(file.read(), sys.argv[0], 'exec')
exec(program)
"""


class Start(NamedTuple):
    """How long a program took from its start until it published."""

    seconds: float
    processor_s: float


class Starter:
    """
    Starts programs, each in a domain of its own, and ends all of them.

    :param folder: for what Python compiles, so that both find their modules compiled.
    """

    def __init__(self, folder: str) -> None:
        self._environment = dict(os.environ, PYTHONPYCACHEPREFIX=f'{folder}/compiled')
        self._environment.pop('PYTHONDONTWRITEBYTECODE', None)
        self._folder = folder
        self._processes: list[subprocess.Popen] = []
        self._domains = itertools.cycle(random.sample(DOMAINS, len(DOMAINS)))

    def start(self, command: list[str], domain: int, **options: object) -> subprocess.Popen:
        """Start a program."""
        process = subprocess.Popen(
            command, cwd=self._folder, stderr=subprocess.DEVNULL,
            env=dict(self._environment, ROS_DOMAIN_ID=str(domain)), **options)
        self._processes.append(process)
        return process

    def until_published(self, command: list[str]) -> Start:
        """Start a program and wait until it has published."""
        reader, writer = os.pipe()
        begin = time.perf_counter()
        process = self.start(
            [sys.executable, '-c', RUNNER, str(writer), *command], next(self._domains),
            pass_fds=[writer])
        os.close(writer)
        published = os.read(reader, 1)
        start = Start(time.perf_counter() - begin, 1e-9 * processor_time_ns(process))
        os.close(reader)
        # The next start must not share the processors with its end.
        process.kill()
        process.wait()
        if not published:
            msg = f'{command[0]} ended before it published anything'
            raise Unavailable(msg)
        return start

    def until_received(self, command: list[str]) -> float:
        """Start a program for a listener that waits; return the seconds until it got something."""
        from tf2_msgs.msg import TFMessage
        with contextlib.ExitStack() as stack:
            domain = next(self._domains)
            wait = Client(stack, domain).listener(TFMessage, '/tf_static', latched(1))
            # It has announced itself by then; the pace of that would show in the times.
            time.sleep(random.uniform(*LISTENER_AGE_S))
            begin = time.perf_counter()
            process = self.start([sys.executable, *command], domain)
            wait()
            seconds = time.perf_counter() - begin
            process.kill()
            process.wait()
        return seconds

    def imports(self, program: str) -> dict[str, float]:
        """Return the seconds that each import of a program takes by itself."""
        done = subprocess.run(
            [sys.executable, '-X', 'importtime', '-c', program], cwd=self._folder,
            env=dict(self._environment, ROS_DOMAIN_ID='1'), capture_output=True, text=True,
            check=True)
        lines = (line.removeprefix('import time:').split('|') for line in
                 done.stderr.splitlines() if line.startswith('import time:'))
        next(lines)
        return {name.strip(): 1e-6 * float(seconds) for seconds, _, name in lines}

    def end(self) -> None:
        """End all of them."""
        for process in self._processes:
            process.kill()
            process.wait()


def report_imports(starter: Starter) -> None:
    """Print what the node's imports take beyond those of the minimal node, which has rclpy's."""
    program = MINIMAL_NODE.replace('rclpy.spin(node)', '')
    seconds = []
    for _ in range(RUNS):
        common = starter.imports(program)
        ours = starter.imports('from sdf_pose_bridge.ros.node import node, process')
        seconds.append(sum(each for name, each in ours.items() if name not in common))
    print(
        f'    imports of the bridge beyond those of the minimal node: median '
        f'{1e3 * statistics.median(seconds):.0f} ms; goal: at most {IMPORTS_MS} ms',
        file=sys.stderr)


@contextlib.contextmanager
def prepared_starter() -> Iterator[tuple[Starter, list[str], list[str]]]:
    """Give a starter, and the commands of the bridge and of the minimal node."""
    with tempfile.TemporaryDirectory() as folder:
        minimal = Path(folder, 'minimal_node')
        minimal.write_text(MINIMAL_NODE, encoding='utf-8')
        starter = Starter(folder)
        ours = [
            str(program_of('sdf_pose_bridge', 'bridge')), '--ros-args', '-p',
            f'sdf_file:={WORK_CELL}']
        theirs = [str(minimal)]
        try:
            for command in (ours, theirs):
                starter.until_published(command)
            yield starter, ours, theirs
        finally:
            starter.end()


@benchmark(
    'start to /tf_static of the work cell published',
    counterpart='a minimal node that publishes an empty message', goal=AtMostTimes(1.08))
def start_and_minimal_node() -> Iterator[tuple[Function, Function | None]]:
    with prepared_starter() as (starter, ours, theirs):
        def fastest(command: list[str]) -> Took:
            # Whatever else the machine does only makes a start longer.
            return Took(min(
                starter.until_published(command).seconds for _ in range(STARTS_PER_RUN)))

        yield lambda: fastest(ours), lambda: fastest(theirs)
        report_imports(starter)


@benchmark(
    'start to /tf_static of the work cell published, processor time',
    counterpart='a minimal node that publishes an empty message', goal=AtMostTimes(1.08))
def processor_time_of_start() -> Iterator[tuple[Function, Function | None]]:
    with prepared_starter() as (starter, ours, theirs):
        yield (lambda: Took(starter.until_published(ours).processor_s),
               lambda: Took(starter.until_published(theirs).processor_s))


class LateStarts:
    """None of ours may be late: a second after the fastest, from process to first message."""

    def __init__(self) -> None:
        self.ours: list[float] = []
        self.minimal: list[float] = []

    def __str__(self) -> str:
        return 'none late'

    def ratio(self, _medians: Medians) -> str:
        """Count the late starts of both."""
        for what, seconds in (('the bridge', self.ours), ('the minimal node', self.minimal)):
            times = ' '.join(f'{1e3 * each:.0f}' for each in sorted(seconds))
            print(f'    {what}, from start to first message: {times} ms', file=sys.stderr)
        return (f'{count_late(self.ours)} of {len(self.ours)} late, '
                f'{count_late(self.minimal)} of {len(self.minimal)}')

    def is_reached(self, _medians: Medians) -> bool:
        """Return whether none of ours was late."""
        return count_late(self.ours) == 0


def count_late(seconds: list[float]) -> int:
    """Count the starts that took at least a second longer than the fastest one."""
    return sum(each > min(seconds) + LATE_S for each in seconds)


LATE_STARTS = LateStarts()


@benchmark(
    'start to /tf_static of the work cell at a listener that waits',
    counterpart='a minimal node that publishes an empty message', goal=LATE_STARTS)
def start_and_minimal_node_at_listener() -> Iterator[tuple[Function, Function | None]]:
    with prepared_starter() as (starter, ours, theirs):
        def first_messages(command: list[str], record: list[float]) -> Took:
            seconds = [starter.until_received(command) for _ in range(STARTS_PER_RUN)]
            record += seconds
            return Took(statistics.median(seconds))

        yield (lambda: first_messages(ours, LATE_STARTS.ours),
               lambda: first_messages(theirs, LATE_STARTS.minimal))
