# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Reloads of the running node: how soon a listener has the new frames, and how long calls take."""

from __future__ import annotations

from collections.abc import Callable, Iterator
import contextlib
import itertools
from pathlib import Path
import shutil
import struct
import subprocess
import sys
import tempfile
import time

from benchmarks.harness import AtMostTimes, benchmark, Function, TimesAsFast, Took
from benchmarks.processes import latched, MINIMAL_NODE, RunningBridge

EXAMPLES = Path(__file__).resolve().parents[1] / 'examples'
WORK_CELL = 'work_cell.sdf'
MODELS = 1000
POSES_OF_MODEL = 22
LONGEST_ANSWER_S = 0.02
LONGEST_RELOAD_S = 0.03
LONGEST_NOTICE_S = 0.05

CALLER = """
import contextlib
import sys
import threading
import time

from benchmarks.bench_services import rotation_request
from benchmarks.processes import Client
from sdf_pose_bridge_interfaces.srv import ConvertRotation

asked = threading.Event()

def listen():
    for line in sys.stdin:
        asked.set()

stack = contextlib.ExitStack()
client = Client(stack, int(sys.argv[1]))
call = client.caller(ConvertRotation, '/sdf_pose_bridge/convert_rotation', rotation_request())
call()
threading.Thread(target=listen, daemon=True).start()
print('ready', flush=True)
longest = 0.0
while True:
    begin = time.perf_counter()
    call()
    longest = max(longest, time.perf_counter() - begin)
    if asked.is_set():
        asked.clear()
        print(longest, flush=True)
        longest = 0.0
    time.sleep(0.001)
"""
"""Calls the bridge again and again; writes the longest call whenever it is asked for it."""


@contextlib.contextmanager
def work_cell() -> Iterator[tuple[RunningBridge, Callable[[], bytes]]]:
    """Run the bridge on a copy of the example; also give a function that waits for /tf_static."""
    from tf2_msgs.msg import TFMessage
    with contextlib.ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()), 'examples')
        shutil.copytree(EXAMPLES, folder)
        bridge = RunningBridge(stack, folder / WORK_CELL)
        next_message = bridge.client.listener(TFMessage, '/tf_static', latched(10))
        next_message()
        yield bridge, next_message


def work_cell_with_frame_at(x: float) -> str:
    """Return the example with one more frame."""
    text = (EXAMPLES / WORK_CELL).read_text(encoding='utf-8')
    assert '</world>' in text
    return text.replace(
        '</world>', f'<frame name="moving"><pose>{x} 0 0 0 0 0</pose></frame></world>')


@benchmark(
    'work cell: ~/reload to its transforms at a listener', counterpart='an empty service',
    goal=TimesAsFast(longest_s=LONGEST_RELOAD_S))
def asked_reload() -> Iterator[tuple[Function, Function | None]]:
    from std_srvs.srv import Empty, Trigger
    with work_cell() as (bridge, next_message), contextlib.ExitStack() as stack:
        bridge.start(stack, sys.executable, '-c', MINIMAL_NODE, stderr=subprocess.DEVNULL)
        reload = bridge.client.caller(Trigger, '/sdf_pose_bridge/reload', Trigger.Request())

        def ours() -> None:
            reload()
            next_message()
        yield ours, bridge.client.caller(Empty, '/minimal/empty', Empty.Request())


@benchmark(
    'work cell: change of the file, right after the watch looked, to its transforms at a listener',
    counterpart='the period of the watch', goal=AtMostTimes(1.2))
def noticed_change() -> Iterator[tuple[Function, Function | None]]:
    from sdf_pose_bridge.ros.node.node import LOOKING_PERIOD_S
    assert LOOKING_PERIOD_S * 0.2 <= LONGEST_NOTICE_S
    with work_cell() as (bridge, next_message):
        numbers = itertools.count(1)

        def change() -> None:
            x = next(numbers) + 0.125
            bridge.replace(work_cell_with_frame_at(x))
            while struct.pack('<d', x) not in next_message():
                pass

        def ours() -> Took:
            change()
            begin = time.perf_counter()
            change()
            return Took(time.perf_counter() - begin)
        yield ours, lambda: time.sleep(LOOKING_PERIOD_S)


def wide_world() -> str:
    """Return a world of many models side by side."""
    links = ''.join(
        f'<link name="l{number}"><pose degrees="true">{number} 1 2 10 20 30</pose>'
        '<visual name="v"><pose>0 0 1 0 0 0</pose><geometry/></visual>'
        '<collision name="c"><geometry/></collision><inertial/></link>'
        for number in range(5))
    models = ''.join(
        f'<model name="m{number}"><pose>{number} 0 0 0 0 0</pose>{links}<frame name="f"/></model>'
        for number in range(MODELS))
    assert POSES_OF_MODEL == 1 + 4 * 5 + 1
    return f'<sdf version="1.10"><world name="w">{models}</world></sdf>'


@contextlib.contextmanager
def wide_bridge() -> Iterator[tuple[RunningBridge, Callable[[], Took]]]:
    """Run the bridge on a wide world; also give a function for the longest call since its last."""
    with contextlib.ExitStack() as stack:
        file = Path(stack.enter_context(tempfile.TemporaryDirectory()), 'wide.sdf')
        file.write_text(wide_world(), encoding='utf-8')
        bridge = RunningBridge(stack, file)
        caller = bridge.start(
            stack, sys.executable, '-c', CALLER, bridge.domain, stdin=subprocess.PIPE,
            stdout=subprocess.PIPE)
        assert caller.stdin is not None
        assert caller.stdout is not None
        caller.stdout.readline()

        def longest() -> Took:
            print(file=caller.stdin, flush=True)
            return Took(float(caller.stdout.readline()))
        yield bridge, longest


def measured(
    longest: Callable[[], Took], reload: Callable[[], object],
) -> tuple[Function, Function]:
    """Return functions for the longest call during a reload, and in as much time without one."""
    took = 0.0

    def ours() -> Took:
        nonlocal took
        longest()
        begin = time.perf_counter()
        reload()
        took = time.perf_counter() - begin
        return longest()

    def counterpart() -> Took:
        longest()
        time.sleep(took)
        return longest()
    return ours, counterpart


WIDE = f'longest ~/convert_rotation while {MODELS * POSES_OF_MODEL:,} poses are reloaded'


@benchmark(
    f'{WIDE} by ~/reload', counterpart='without a reload',
    goal=TimesAsFast(longest_s=LONGEST_ANSWER_S))
def answers_during_reload() -> Iterator[tuple[Function, Function | None]]:
    from std_srvs.srv import Trigger
    with wide_bridge() as (bridge, longest):
        yield measured(longest, bridge.client.caller(
            Trigger, '/sdf_pose_bridge/reload', Trigger.Request()))


@benchmark(
    f'{WIDE} by sdf_file', counterpart='without a reload',
    goal=TimesAsFast(longest_s=LONGEST_ANSWER_S))
def answers_during_setting() -> Iterator[tuple[Function, Function | None]]:
    from rcl_interfaces.srv import SetParameters
    from rclpy.parameter import Parameter
    with wide_bridge() as (bridge, longest):
        parameter = Parameter('sdf_file', value=str(bridge.file)).to_parameter_msg()
        yield measured(longest, bridge.client.caller(
            SetParameters, '/sdf_pose_bridge/set_parameters',
            SetParameters.Request(parameters=[parameter])))


@benchmark(
    f'{WIDE} by the watch', counterpart='without a reload',
    goal=TimesAsFast(longest_s=LONGEST_ANSWER_S))
def answers_during_noticed_change() -> Iterator[tuple[Function, Function | None]]:
    from tf2_msgs.msg import TFMessage
    with wide_bridge() as (bridge, longest):
        next_message = bridge.client.listener(TFMessage, '/tf_static', latched(10))
        next_message()
        text = wide_world()

        def reload() -> None:
            bridge.replace(text)
            next_message()
            # What follows /tf_static belongs to the reload too.
            time.sleep(0.5)
        yield measured(longest, reload)
