# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The node beside a real Gazebo, whose messages the world of the tests hands on."""

from __future__ import annotations

from collections.abc import Iterator
import contextlib
import os
from pathlib import Path
import random
import subprocess
import tempfile

from benchmarks.harness import AtMostTimes, benchmark, DOMAINS, Function, Unavailable
from benchmarks.processes import program_of, shares_of

ROBOTS = 30
WINDOW_S = 3.0


@benchmark(
    f'{ROBOTS} robots with two wheels and true odometry, processor time in each second of '
    'simulated time', counterpart='Gazebo', goal=AtMostTimes(1.0))
def share_of_robots_in_gazebo() -> Iterator[tuple[Function, Function | None]]:
    from gazebo import environment_of_gazebo, FOLDER, Gazebo, gazebo_world
    from listener import Listener
    from test_gazebo import PLACES
    if not (FOLDER / 'bin/gazebo_server').exists():
        msg = f'there is no Gazebo in {FOLDER}'
        raise Unavailable(msg)
    domain = random.choice(DOMAINS)
    os.environ['ROS_DOMAIN_ID'] = str(domain)
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        os.environ.update(environment_of_gazebo(folder))
        world = folder / 'shop.sdf'
        world.write_text(gazebo_world(''.join(
            f'<model name="robot{number}"><pose>{number} 0 0.1 0 0 1.5</pose>'
            f'{PLACES["two"].content.replace("/o<", f"/o{number}<")}</model>'
            for number in range(ROBOTS))), encoding='utf-8')
        listener = Listener(domain)
        stack.callback(listener.end)
        gazebo = Gazebo(world, listener)
        stack.callback(gazebo.end)
        bridge = stack.enter_context(subprocess.Popen([
            program_of('sdf_pose_bridge', 'bridge'),
            '--ros-args', '--params-file', gazebo.node_file]))
        stack.callback(bridge.terminate)
        gazebo.wait(lambda: len(gazebo.stamps) == 3 * ROBOTS, 'all robots in TF')
        ours, counterpart = shares_of(
            (bridge, gazebo.server), lambda: gazebo.drive(WINDOW_S), lambda: gazebo.now)

        def share() -> object:
            took = ours()
            gazebo.forget()
            return took
        yield share, counterpart
