# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A node for all robots of a world, compared with a robot_state_publisher for each."""

from __future__ import annotations

from collections.abc import Iterator
import contextlib
import itertools
from pathlib import Path
import re
import subprocess
import tempfile
import threading
import time

from benchmarks.bench_idle import processor_time_ns
from benchmarks.bench_joints import chain_text, joint_states
from benchmarks.bench_reload import RunningBridge
from benchmarks.harness import (
    AtMostAsMuch,
    AtMostTimes,
    benchmark,
    Function,
    Held,
    Took,
    Unavailable,
    wait_until,
)
import sdf_pose_bridge

ROBOTS = 30
JOINTS = 12
RATE_HZ = 50.0
WINDOW_S = 4.0


@contextlib.contextmanager
def running_fleet() -> Iterator[tuple[subprocess.Popen[str], list[subprocess.Popen[str]]]]:
    """Start the bridge, and a robot_state_publisher for each robot, with the same messages."""
    from ament_index_python.packages import get_package_prefix
    import rclpy
    from rclpy.context import Context
    from sensor_msgs.msg import JointState
    try:
        prefix = Path(get_package_prefix('robot_state_publisher'))
    except LookupError:
        msg = 'robot_state_publisher is not installed'
        raise Unavailable(msg) from None
    names = [f'robot{number}' for number in range(1, ROBOTS + 1)]
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        robot, urdf, world = (folder / name for name in ('robot.sdf', 'robot.urdf', 'world.sdf'))
        text = chain_text(JOINTS)
        robot.write_text(text, encoding='utf-8')
        urdf.write_text(
            sdf_pose_bridge.urdf_from_scene(sdf_pose_bridge.load_text(text, shapes=True))[0],
            encoding='utf-8')
        world.write_text('<sdf version="1.10"><world name="w">{}</world></sdf>'.format(''.join(
            f'<include><uri>robot.sdf</uri><name>{name}</name></include>' for name in names)),
            encoding='utf-8')
        bridge = RunningBridge(
            stack, world, 'use_joint_states:=true', 'watch:=false', 'publish_frequency:=20.0')
        others = [
            bridge.start(
                stack, prefix / 'lib/robot_state_publisher/robot_state_publisher', urdf,
                '--ros-args', '-r', f'__ns:=/{name}', '-r', 'tf:=/tf', '-p',
                f'frame_prefix:={name}/', stderr=subprocess.DEVNULL)
            for name in names]
        context = Context()
        rclpy.init(args=[], context=context, domain_id=bridge.domain)
        stack.callback(context.shutdown)
        node = rclpy.create_node('joints', context=context)
        publishers = [
            node.create_publisher(JointState, f'{name}/joint_states', 10) for name in names]
        wait_until(
            lambda: all(each.get_subscription_count() >= 2 for each in publishers),
            'the nodes did not subscribe to all joint states')
        has_ended = threading.Event()
        stack.callback(has_ended.set)

        def publish() -> None:
            due = time.perf_counter()
            pairs = zip(itertools.cycle(publishers), joint_states(JOINTS), strict=False)
            for publisher, message in pairs:
                if has_ended.is_set():
                    return
                publisher.publish(message)
                due += 1.0 / (RATE_HZ * ROBOTS)
                time.sleep(max(0.0, due - time.perf_counter()))

        threading.Thread(target=publish, daemon=True).start()
        yield bridge.process, others


@benchmark(
    f'{ROBOTS} robots of {JOINTS} joints at 50 Hz, publish_frequency 20, processor time in each '
    'second', counterpart='a robot_state_publisher for each', goal=AtMostTimes(1.0))
def share_of_fleet() -> Iterator[tuple[Function, Function | None]]:
    with running_fleet() as (bridge, others):
        last: list[float] = []

        def shares() -> Took:
            before = [processor_time_ns(each) for each in (bridge, *others)]
            begin = time.perf_counter_ns()
            time.sleep(WINDOW_S)
            window = time.perf_counter_ns() - begin
            last[:] = [
                (processor_time_ns(each) - first) / window
                for each, first in zip((bridge, *others), before, strict=True)]
            return Took(last[0])
        yield shares, lambda: Took(sum(last[1:]))


@benchmark(
    f'{ROBOTS} robots of {JOINTS} joints, memory of the node',
    counterpart='a robot_state_publisher for each', goal=AtMostAsMuch(0.2))
def memory_of_fleet() -> Iterator[tuple[Function, Function | None]]:
    with running_fleet() as (bridge, others):
        yield (
            lambda: Held(_resident_bytes(bridge)),
            lambda: Held(sum(map(_resident_bytes, others))))


def _resident_bytes(process: subprocess.Popen[str]) -> int:
    status = Path(f'/proc/{process.pid}/status').read_text(encoding='ascii')
    found = re.search(r'VmRSS:\s+(\d+) kB', status)
    assert found is not None
    return 1024 * int(found[1])
