# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Large scenes at a listener that comes late: everything arrives, and as fast as from any node."""

from __future__ import annotations

from collections.abc import Iterator
import contextlib
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
    TimesAsFast,
    Took,
    Unavailable,
)
from benchmarks.processes import latched, own_node, RunningBridge

FRAMES = 10_000
TOPICS = 1_000
DEADLINE_S = 60.0

MINIMAL_NODE = """
import sys
from geometry_msgs.msg import PoseStamped, TransformStamped
import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

def latched(depth):
    return QoSProfile(depth=depth, durability=DurabilityPolicy.TRANSIENT_LOCAL)

frames, topics = int(sys.argv[1]), int(sys.argv[2])
rclpy.init(signal_handler_options=rclpy.signals.SignalHandlerOptions.NO)
node = rclpy.create_node('sdf_pose_bridge')
message = TFMessage()
for number in range(frames):
    each = TransformStamped(child_frame_id=f'f{number}')
    each.header.frame_id = 'world'
    each.transform.translation.x = float(number)
    message.transforms.append(each)
node.create_publisher(TFMessage, '/tf_static', latched(1)).publish(message)
one_by_one = node.create_publisher(TransformStamped, '~/transforms', latched(frames))
for each in message.transforms:
    one_by_one.publish(each)
for number in range(topics):
    pose = PoseStamped()
    pose.header.frame_id = 'world'
    pose.pose.position.x = float(number)
    node.create_publisher(PoseStamped, f'~/poses/f{number}', latched(1)).publish(pose)
print('ready', flush=True)
rclpy.spin(node)
"""


@contextlib.contextmanager
def two_domains(frames: int, topics: int) -> Iterator[tuple[int, int]]:
    """Run the bridge, and a node that publishes the same from objects, in a domain each."""
    with contextlib.ExitStack() as stack:
        file = Path(stack.enter_context(tempfile.TemporaryDirectory()), 'world.sdf')
        elements = ''.join(
            f'<frame name="f{number}"><pose>{number} 0 0 0 0 0</pose></frame>'
            for number in range(frames))
        file.write_text(
            f'<sdf version="1.10"><world name="w">{elements}</world></sdf>', encoding='utf-8')
        bridge = RunningBridge(stack, file)
        other = random.choice([each for each in DOMAINS if each != bridge.domain])
        minimal = stack.enter_context(subprocess.Popen(
            [sys.executable, '-c', MINIMAL_NODE, str(frames), str(topics)],
            env=dict(bridge.environment, ROS_DOMAIN_ID=str(other)), stdout=subprocess.PIPE,
            text=True))
        stack.callback(minimal.terminate)
        assert minimal.stdout is not None
        minimal.stdout.readline()
        yield bridge.domain, other


class Arrival(NamedTuple):
    """Seconds from the start of a listener."""

    first: float
    """Until it had the first message, which is up to how the two processes discover each other."""
    last: float
    """Until it had everything."""


def late_listener(domain: int, wanted: dict[str, tuple[type, int]]) -> Arrival:
    """
    Start to listen, and stop when everything has come.

    :param domain: where to.
    :param wanted: the topics, with their type and how many messages each must have for a listener
        that comes late.
    :return: when it came.
    """
    begin = time.perf_counter()
    first = None
    with own_node(domain) as node:
        missing = {
            node.create_subscription(type_, topic, print, latched(count)): count
            for topic, (type_, count) in wanted.items()}
        deadline = time.monotonic() + DEADLINE_S
        # An executor would look at every subscription for each message.
        while missing:
            if time.monotonic() > deadline:
                msg = f'{sum(missing.values())} messages did not come'
                raise Unavailable(msg)
            for subscription, count in list(missing.items()):
                left = count
                with subscription.handle:
                    take = subscription.handle.take_message
                    while left and take(subscription.msg_type, False):
                        left -= 1
                if first is None and left < count:
                    first = time.perf_counter() - begin
                missing[subscription] = left
                if not left:
                    del missing[subscription]
            time.sleep(0.001)
        assert first is not None
        return Arrival(first, time.perf_counter() - begin)


def report(whose: str, arrivals: list[Arrival]) -> None:
    """Print when the first messages came: a median would hide that there are two kinds of them."""
    times = ' '.join(f'{1e3 * arrival.first:.0f}' for arrival in sorted(arrivals))
    whole = statistics.median(arrival.last for arrival in arrivals)
    print(
        f'    late listener of {whose}: everything there after a median of {1e3 * whole:.0f} ms, '
        f'the first message after: {times} ms', file=sys.stderr)


@benchmark(
    f'{FRAMES:,} frames: /tf_static and all of ~/transforms at a late listener, from the first '
    'message on', counterpart='a node that publishes objects', goal=AtMostTimes(1.15))
def frames_at_late_listener() -> Iterator[tuple[Function, Function | None]]:
    from geometry_msgs.msg import TransformStamped
    from tf2_msgs.msg import TFMessage
    wanted = {
        '/tf_static': (TFMessage, 1),
        '/sdf_pose_bridge/transforms': (TransformStamped, FRAMES)}
    arrivals: tuple[list[Arrival], list[Arrival]] = ([], [])
    with two_domains(FRAMES, 0) as domains:
        def seconds_of(node: int) -> Took:
            arrival = late_listener(domains[node], wanted)
            arrivals[node].append(arrival)
            return Took(arrival.last - arrival.first)
        yield lambda: seconds_of(0), lambda: seconds_of(1)
    report('the bridge', arrivals[0])
    report('the other node', arrivals[1])


# Without a goal: nearly all of it is the discovery of so many topics, which takes now one second
# and now four for either.
@benchmark(
    f'{TOPICS:,} topics of poses at a late listener',
    counterpart='a node that publishes objects', goal=TimesAsFast())
def topics_at_late_listener() -> Iterator[tuple[Function, Function | None]]:
    from geometry_msgs.msg import PoseStamped
    wanted = {
        f'/sdf_pose_bridge/poses/f{number}': (PoseStamped, 1) for number in range(TOPICS)}
    with two_domains(TOPICS, TOPICS) as (ours, other):
        yield lambda: late_listener(ours, wanted), lambda: late_listener(other, wanted)
