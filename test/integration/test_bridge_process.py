# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""How the process starts, fails and ends, seen from outside."""

import os
import signal
import sys

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from bridge_process import LoggedProcess
from builtin_interfaces.msg import Time
from changes import Monitor, reload
from rosgraph_msgs.msg import Clock
from slow_file import SlowFile

from sdf_pose_bridge.ros.middleware import PROFILES, VARIABLES

PROFILE = PROFILES[os.environ['ROS_DISTRO']]
(OTHER_VARIABLE,) = set(VARIABLES) - {PROFILE.variable}
"""Setting it keeps the node from using its profile; Fast DDS does not read it."""

GOOD = '<sdf version="1.10"><model name="m"><link name="l"/></model></sdf>'
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

from sdf_pose_bridge.ros.process import _spin_until_signal

rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
node = Node('idle')
executor = SingleThreadedExecutor()
executor.add_node(node)
_spin_until_signal(executor, node, executor.create_task(print, 'spins', flush=True))
"""
"""A node that spins as the bridge does, and has no timers."""

STOP_SIGNALS = pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])


@pytest.fixture
def write_file(tmp_path):
    def write(text):
        path = tmp_path / 'scene.sdf'
        path.write_text(text, encoding='utf-8')
        return path
    return write


def fatal_lines(bridge):
    return [line for line in bridge.lines if line.startswith('[FATAL]')]


def assert_ended_well(bridge):
    assert bridge.wait_for_end() == 0, '\n'.join(bridge.lines)
    assert not [line for line in bridge.lines if 'Traceback' in line or 'Error' in line]


def test_a_bad_file_has_a_line_for_each_error(start_bridge, write_file):
    path = write_file(BAD)
    bridge = start_bridge('--ros-args', '-p', f'sdf_file:={path}')
    assert bridge.wait_for_end() == 1
    lines = fatal_lines(bridge)
    assert len(lines) == len(bridge.lines) == 2
    assert any(f'{path}:3: POSE_RELATIVE_TO_INVALID: ' in line for line in lines)
    assert any(f'{path}:5: DUPLICATE_NAME: ' in line for line in lines)


@pytest.mark.parametrize(('arguments', 'text'), [
    (['-p', 'sdf_file:=missing.sdf'], 'missing.sdf: FILE_READ: '),
    ([], 'parameter sdf_file is not set'),
])
def test_what_prevents_the_start_is_one_line(start_bridge, arguments, text):
    bridge = start_bridge('--ros-args', *arguments)
    assert bridge.wait_for_end() == 1
    (line,) = bridge.lines
    assert line.startswith('[FATAL]')
    assert text in line


def test_a_misspelt_file_parameter_is_named_before_the_missing_one(start_bridge):
    bridge = start_bridge('--ros-args', '-p', 'sdf_fil:=a.sdf')
    assert bridge.wait_for_end() == 1
    first, second = bridge.lines
    assert 'did you mean "sdf_file"?' in first
    assert 'parameter sdf_file is not set' in second


def test_a_wrong_value_of_a_parameter_of_rclpy_is_one_line(start_bridge, write_file):
    bridge = start_bridge(
        '--ros-args', '-p', f'sdf_file:={write_file(GOOD)}', '-p', 'use_sim_time:=5')
    assert bridge.wait_for_end() == 1
    (line,) = bridge.lines
    assert line == ("sdf_pose_bridge: Trying to set parameter 'use_sim_time' to '5' of type "
                    "'INTEGER', expecting type 'BOOL'")


@pytest.mark.parametrize(('arguments', 'text'), [
    (['cell.sdf'], 'the argument "cell.sdf" is not understood'),
    (['--ros-args', '--no-such-flag'], 'unknown arguments after --ros-args: '),
    (['--ros-args', '--params-file', 'missing.yaml'], 'missing.yaml'),
])
def test_a_wrong_command_line_is_explained(start_bridge, arguments, text):
    bridge = start_bridge(*arguments)
    assert bridge.wait_for_end() == 1
    assert any(text in line for line in bridge.lines)
    assert not any('Traceback' in line for line in bridge.lines)


def test_help_shows_how_to_start_it(start_bridge):
    bridge = start_bridge('--help')
    assert bridge.wait_for_end() == 0
    bridge.wait_for_line('--ros-args -p sdf_file:=cell.sdf')


def test_the_first_line_tells_what_is_published(start_bridge, write_file):
    path = write_file(GOOD)
    line = start_bridge('--ros-args', '-p', f'sdf_file:={path}').wait_for_line('publishing')
    assert '[INFO]' in line
    assert f'2 frames of {path} with 1 transform, root frame "world"' in line


@pytest.mark.parametrize(('value', 'text'), [
    (None, f'{PROFILE.file} is used'),
    ('', f'is not used: {OTHER_VARIABLE} is set'),
])
def test_the_profile_of_the_middleware_is_logged_for_debugging(
        start_bridge, write_file, monkeypatch, tmp_path, value, text):
    monkeypatch.chdir(tmp_path)
    if value is not None:
        monkeypatch.setenv(OTHER_VARIABLE, value)
    bridge = start_bridge(
        '--ros-args', '-p', f'sdf_file:={write_file(GOOD)}',
        '--log-level', 'sdf_pose_bridge:=debug')
    assert text in bridge.wait_for_line('Fast DDS profile')
    bridge.wait_until_started()
    assert not [line for line in bridge.lines if 'XMLPARSER' in line]


@STOP_SIGNALS
@pytest.mark.parametrize('times', [1, 3])
def test_a_signal_ends_it_well(start_bridge, write_file, number, times):
    bridge = start_bridge('--ros-args', '-p', f'sdf_file:={write_file(GOOD)}')
    bridge.wait_until_started()
    for _ in range(times):
        bridge.send(number)
    assert_ended_well(bridge)


def test_a_signal_ends_it_before_anything_else_happens(start_bridge, start_listener, write_file):
    bridge = start_bridge('--ros-args', '-p', f'sdf_file:={write_file(GOOD)}')
    listener = start_listener()
    monitor = Monitor(listener)
    monitor.wait_for_more()
    # The next diagnostics come in two seconds.
    bridge.send(signal.SIGTERM)
    count = monitor.count
    assert_ended_well(bridge)
    listener.spin_once()
    assert monitor.count == count


def test_a_signal_ends_it_although_nothing_else_wakes_it(ros_domain):
    process = LoggedProcess([sys.executable, '-c', IDLE])
    try:
        process.wait_for_line('spins')
        process.wait_until_sleeping()
        process.send(signal.SIGINT)
        assert process.wait_for_end() == 0, '\n'.join(process.lines)
    finally:
        process.end()


def test_a_negative_time_on_the_clock_does_not_end_it(start_bridge, start_listener, write_file):
    bridge = start_bridge(
        '--ros-args', '-p', f'sdf_file:={write_file(GOOD)}', '-p', 'use_sim_time:=true')
    bridge.wait_until_started()
    listener = start_listener()
    clock = listener.node.create_publisher(Clock, '/clock', 1)
    listener.wait(clock.get_subscription_count, lambda: 'the subscription to /clock')
    clock.publish(Clock(clock=Time(sec=-1)))
    bridge.wait_for_line('internal error in a callback: ')
    assert reload(listener).success


@STOP_SIGNALS
def test_a_signal_ends_it_well_before_anything_is_imported(start_bridge, write_file, number):
    bridge = start_bridge('--ros-args', '-p', f'sdf_file:={write_file(GOOD)}')
    # The first line of the executable does that; Python itself starts before.
    bridge.wait_until_blocking(number)
    bridge.send(number)
    assert_ended_well(bridge)


@STOP_SIGNALS
def test_a_signal_ends_it_well_before_anything_is_loaded(start_bridge, write_file, number):
    bridge = start_bridge('--ros-args', '-p', f'sdf_file:={write_file(GOOD)}')
    # Python itself handles SIGINT; with SIGTERM the bridge has taken over both.
    bridge.wait_until_handling(signal.SIGTERM)
    bridge.send(number)
    assert_ended_well(bridge)


@STOP_SIGNALS
def test_a_signal_ends_it_well_while_it_reads(start_bridge, tmp_path, number):
    slow = SlowFile(tmp_path / 'slow.sdf')
    bridge = start_bridge('--ros-args', '-p', f'sdf_file:={slow.path}')
    with slow.opened():
        bridge.wait_until_sleeping()
        bridge.send(number)
        assert_ended_well(bridge)
