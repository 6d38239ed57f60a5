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
import time

from benchmarks.bench_joints import chain_text, joint_states
from benchmarks.harness import (
    AtMostTimes,
    benchmark,
    Function,
    Held,
    wait_until,
)
from benchmarks.processes import own_node, program_of, repeated, RunningBridge, shares_of
import sdf_pose_bridge

ROBOTS = 30
JOINTS = 12
RATE_HZ = 50.0
WINDOW_S = 4.0


@contextlib.contextmanager
def running_fleet() -> Iterator[tuple[subprocess.Popen[str], list[subprocess.Popen[str]]]]:
    """Start the bridge, and a robot_state_publisher for each robot, with the same messages."""
    from sensor_msgs.msg import JointState
    publisher_of_robot = program_of('robot_state_publisher', 'robot_state_publisher')
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
                stack, publisher_of_robot, urdf, '--ros-args', '-r', f'__ns:=/{name}', '-r',
                'tf:=/tf', '-p', f'frame_prefix:={name}/', stderr=subprocess.DEVNULL)
            for name in names]
        node = stack.enter_context(own_node(bridge.domain))
        publishers = [
            node.create_publisher(JointState, f'{name}/joint_states', 10) for name in names]
        wait_until(
            lambda: all(each.get_subscription_count() >= 2 for each in publishers),
            'the nodes did not subscribe to all joint states')
        pairs = zip(itertools.cycle(publishers), joint_states(JOINTS), strict=False)

        def publish() -> None:
            publisher, message = next(pairs)
            publisher.publish(message)

        stack.enter_context(repeated(publish, RATE_HZ * ROBOTS))
        yield bridge.process, others


@benchmark(
    f'{ROBOTS} robots of {JOINTS} joints at 50 Hz, publish_frequency 20, processor time in each '
    'second', counterpart='a robot_state_publisher for each', goal=AtMostTimes(1.0))
def share_of_fleet() -> Iterator[tuple[Function, Function | None]]:
    with running_fleet() as (bridge, others):
        yield shares_of((bridge, *others), lambda: time.sleep(WINDOW_S))


@benchmark(
    f'{ROBOTS} robots of {JOINTS} joints, memory of the node',
    counterpart='a robot_state_publisher for each', goal=AtMostTimes(0.2, 'memory'))
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
