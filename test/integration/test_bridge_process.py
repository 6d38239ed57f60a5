# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""How the process starts, fails and ends, seen from outside."""

from functools import partial
import os
import re
import signal

from builtin_interfaces.msg import Time
from changes import Monitor, reason_for_refusal, reload
from command_line import CLOSED, executable_of_workspace, with_closed_streams
import pytest
from ros_domain import needs_fast_dds
from rosgraph_msgs.msg import Clock
from signal_places import with_signals_at
from slow_file import SlowFile

from sdf_pose_bridge.ros.node.middleware import PROFILES
from sdf_pose_bridge.ros.node.process import PROGRAMS

((PROFILE, OTHER_VARIABLE),) = [
    (each, other.variable) for each in PROFILES for other in PROFILES
    if os.environ['ROS_DISTRO'] in each.distros and other is not each]
"""Setting the variable keeps the node from using its profile; Fast DDS does not read it."""

BAD = """\
<sdf version="1.10">
  <model name="m">
    <link name="a"><pose relative_to="nowhere"/></link>
    <link name="b"/>
    <link name="b"/>
  </model>
</sdf>
"""
IDLE = """
import signal

# As the executable does, before anything that starts threads is imported.
signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from sdf_pose_bridge.ros.background import Worker
from sdf_pose_bridge.ros.node.process import _spin_until_signal

rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
node = Node('idle')
executor = SingleThreadedExecutor()
executor.add_node(node)
loader = Worker(node, 'loader')
loader.run(lambda: print('spins', flush=True))
_spin_until_signal(executor, node, loader)
"""
"""A node that spins as the bridge does, and has no timers."""

STOP_SIGNALS = pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])


@pytest.fixture
def start(start_bridge, file):
    """Starts a bridge on the file; ``start(*arguments, **parameters)``."""
    return partial(start_bridge, sdf_file=file)


def assert_ended_well(bridge):
    assert bridge.wait_for_end() == 0, '\n'.join(bridge.lines)
    assert not [line for line in bridge.lines if 'Traceback' in line or 'Error' in line]


@pytest.mark.parametrize(('parameters', 'patterns'), [
    ({'sdf_file': 'bad.sdf'}, [
        r'\[FATAL\].*/bad\.sdf:3: POSE_RELATIVE_TO_INVALID: ',
        r'\[FATAL\].*/bad\.sdf:5: DUPLICATE_NAME: ']),
    ({'sdf_file': 'missing.sdf'}, [r'\[FATAL\].*/missing\.sdf: FILE_READ: ']),
    ({'sdf_fil': 'a.sdf'}, [
        r'\[WARN\].*did you mean "sdf_file"\?$', r'\[FATAL\].* parameter sdf_file is not set']),
    ({'use_sim_time': 5}, [
        "sdf_pose_bridge: Trying to set parameter 'use_sim_time' to '5' of .* expecting .*'BOOL'$",
    ]),
])
def test_each_reason_not_to_start_has_a_line(
        start_bridge, tmp_path, monkeypatch, parameters, patterns):
    (tmp_path / 'bad.sdf').write_text(BAD)
    monkeypatch.chdir(tmp_path)
    bridge = start_bridge(**parameters)
    assert bridge.wait_for_end() == 1
    for line, pattern in zip(bridge.lines, patterns, strict=True):
        assert re.match(pattern, line), line


@pytest.mark.parametrize(('arguments', 'text'), [
    (['sdf_file:=a.sdf'], 'not understood; did you mean "--ros-args -p sdf_file:=a.sdf"?'),
    (['--ros-args', 'sdf_file:=a.sdf'], '; did you mean "--ros-args -p sdf_file:=a.sdf"?'),
    (['cell.sdf'], 'usage: ros2 run sdf_pose_bridge bridge --ros-args -p sdf_file:=cell.sdf'),
    (['--ros-args', '--no-such-flag'], 'unknown arguments after --ros-args: '),
    (['--ros-args', '--params-file', 'missing.yaml'], 'missing.yaml'),
])
def test_a_wrong_command_line_is_explained(start_bridge, arguments, text):
    bridge = start_bridge(*arguments)
    assert bridge.wait_for_end() == 1
    assert bridge.count_of(text)
    assert not bridge.count_of('Traceback')


@needs_fast_dds
@pytest.mark.parametrize(('value', 'text'), [
    (None, f'{PROFILE.file} is used'),
    ('', f'is used: {OTHER_VARIABLE} is set'),
])
def test_the_profile_of_the_middleware_is_logged_for_debugging(
        start, monkeypatch, tmp_path, value, text):
    monkeypatch.chdir(tmp_path)
    if value is not None:
        monkeypatch.setenv(OTHER_VARIABLE, value)
    bridge = start('--ros-args', '--log-level', 'sdf_pose_bridge:=debug')
    assert text in bridge.wait_for_line('middleware profile')
    bridge.wait_until_started()
    assert not bridge.count_of('XMLPARSER')


@STOP_SIGNALS
@pytest.mark.parametrize('times', [1, 3])
def test_a_signal_ends_it_well(start, number, times):
    bridge = start().wait_until_started()
    for _ in range(times):
        bridge.send(number)
    assert_ended_well(bridge)


def test_a_signal_ends_it_before_anything_else_happens(start, start_listener):
    bridge = start()
    listener = start_listener()
    monitor = Monitor(listener)
    monitor.wait_for_more()
    # The next diagnostics come in two seconds.
    bridge.send(signal.SIGTERM)
    count = monitor.count
    assert_ended_well(bridge)
    listener.spin_once()
    assert monitor.count == count


def test_a_signal_ends_it_although_nothing_else_wakes_it(start_bridge):
    process = start_bridge(program=IDLE)
    process.wait_for_line('spins')
    process.wait_until_sleeping()
    process.send(signal.SIGINT)
    assert process.wait_for_end() == 0, '\n'.join(process.lines)


def test_a_negative_time_on_the_clock_does_not_end_it(start, start_listener):
    bridge = start(use_sim_time=True).wait_until_started()
    listener = start_listener()
    clock = listener.node.create_publisher(Clock, '/clock', 1)

    def is_reported():
        # The first messages are lost, until the bridge has discovered the publisher.
        clock.publish(Clock(clock=Time(sec=-1)))
        return bridge.count_of('internal error in a callback: ')

    listener.wait(is_reported, bridge.lines)
    assert reload(listener).success


@pytest.mark.parametrize('program', PROGRAMS)
@pytest.mark.parametrize('place', [
    'import sdf_pose_bridge', 'import numpy', 'import sdf_pose_bridge.ros.node.process',
    'import rclpy', 'open {file}', 'import sdf_pose_bridge.ros.node.node'])
def test_signals_end_it_well_at_each_place(
        start, file, tmp_path, monkeypatch, program, place):
    for name, value in with_signals_at(
            place.format(file=file), [signal.SIGINT, signal.SIGTERM], tmp_path).items():
        monkeypatch.setenv(name, value)
    assert_ended_well(start(program=program))


@STOP_SIGNALS
def test_a_signal_ends_it_well_while_it_reads(start_bridge, tmp_path, number):
    slow = SlowFile(tmp_path / 'slow.sdf')
    bridge = start_bridge(sdf_file=slow.path)
    with slow.opened():
        bridge.wait_until_sleeping()
        bridge.send(number)
        assert_ended_well(bridge)


@pytest.mark.parametrize('closed', CLOSED, ids=' '.join)
def test_closed_streams_and_an_ignored_sigchld_are_no_obstacle(
        start_program, start_listener, file, closed):
    bridge = start_program(with_closed_streams(
        closed, executable_of_workspace('bridge'), '--ros-args', '-p', f'sdf_file:={file}'))
    listener = start_listener()
    for _ in range(2):
        answer = reload(listener)
        assert answer.success, answer.message
    assert 'did you mean "cell.sdf"?' in reason_for_refusal(listener, sdf_file=f'{file}x')
    bridge.send(signal.SIGINT)
    assert bridge.wait_for_end() == 0
