# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Faults of disks, clocks and other processes; what was read before is served throughout."""

import os
from pathlib import Path
import re
import resource
import select
import signal
import subprocess
import sys

from builtin_interfaces.msg import Time
from changes import (
    asked_to_set,
    BRIDGE,
    listen_to_tf,
    Monitor,
    reason_for_refusal,
    reload,
    replace,
    set_parameters,
    wait_for_x,
    world,
)
from command_line import completed, executable_of_workspace
from deadline import DEADLINE_S
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import Point, Pose, PoseStamped
import needs
from processes import started
import pytest
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from sizes import size
from slow_file import SlowFile
from std_srvs.srv import Trigger

from sdf_pose_bridge_interfaces.srv import ConvertRotation, SetPose

LISTENING = """
import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

def show(message):
    print('x', message.transforms[-1].transform.translation.x, flush=True)

rclpy.init()
node = rclpy.create_node('stopped')
quality = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
node.create_subscription(TFMessage, '/tf_static', show, quality)
rclpy.spin(node)
"""


@pytest.fixture
def start(start_bridge):
    """Starts a bridge on a file; ``start(path)``."""
    return lambda path: start_bridge(sdf_file=path).wait_until_started()


@pytest.fixture
def listener(start_listener):
    listener = start_listener()
    listen_to_tf(listener)
    return listener


@pytest.fixture
def small_disk(tmp_path):
    """A folder on a disk with room for one page, in 4096 bytes."""
    folder = tmp_path / 'small'
    folder.mkdir()
    command = [needs.program('mount'), '-t', 'tmpfs', '-o', 'size=4k', 'none', folder]
    if completed(command).returncode:
        pytest.skip('this machine does not permit to mount a file system')
    yield folder
    subprocess.run([needs.program('umount'), '--lazy', folder], check=True)


def assert_reported_while_old_poses_are_served(bridge, listener, start_listener, path, text):
    monitor = Monitor(listener)
    monitor.wait_for(DiagnosticStatus.ERROR)
    assert text in monitor.status.message
    line = bridge.wait_for_line(f'{path} is rejected; the frames published before stay')
    assert line.startswith('[ERROR]')
    assert text in bridge.wait_for_line(text)
    late = start_listener()
    listen_to_tf(late)
    wait_for_x(late, 1.0)


def make_directory(path):
    path.unlink()
    path.mkdir()


def make_fifo(path):
    path.unlink()
    os.mkfifo(path)


@pytest.mark.parametrize('fault', [Path.unlink, make_directory, make_fifo])
def test_a_file_that_cannot_be_read_any_more_is_reported_and_its_repair_noticed(
        bridge, file, listener, start_listener, fault):
    wait_for_x(listener, 1.0)
    fault(file)
    assert_reported_while_old_poses_are_served(
        bridge, listener, start_listener, file, f'{file}: FILE_READ: ')
    if file.is_dir():
        file.rmdir()
    replace(file, world(2))
    wait_for_x(listener, 2.0)


def test_a_config_map_that_is_replaced_is_noticed(bridge, listener, tmp_path):
    # As Kubernetes does: cell.sdf -> ..data/cell.sdf, and ..data -> a folder for each version.
    for version, x in (('..1', 1.5), ('..2', 2)):
        (tmp_path / version).mkdir()
        (tmp_path / version / 'cell.sdf').write_text(world(x))
    (tmp_path / '..data').symlink_to('..1')
    (tmp_path / 'linked.sdf').symlink_to('..data/cell.sdf')
    set_parameters(listener, sdf_file=str(tmp_path / 'linked.sdf'))
    wait_for_x(listener, 1.5)
    (tmp_path / '..data_tmp').symlink_to('..2')
    (tmp_path / '..data_tmp').rename(tmp_path / '..data')
    (tmp_path / '..1/cell.sdf').unlink()
    (tmp_path / '..1').rmdir()
    wait_for_x(listener, 2.0)


def waiting_process(bridge):
    """Return the id of the process of a bridge that forks for each load."""
    (pid,) = bridge.children()
    return pid


def busy_process(bridge):
    """Return the id of the process of a bridge that reads a file."""
    waiting = waiting_process(bridge)
    (pid,) = Path(f'/proc/{waiting}/task/{waiting}/children').read_text(encoding='ascii').split()
    return int(pid)


def test_a_change_without_descriptors_is_read_once_there_are_some(start, file, listener):
    bridge = start(file)
    assert reload(listener).success
    soft, hard = resource.prlimit(bridge.pid, resource.RLIMIT_NOFILE)
    resource.prlimit(bridge.pid, resource.RLIMIT_NOFILE, (4, hard))
    replace(file, world(2))
    bridge.wait_for_line('Too many open files')
    resource.prlimit(bridge.pid, resource.RLIMIT_NOFILE, (soft, hard))
    wait_for_x(listener, 2.0)
    assert not bridge.count_of('internal error')


FAILING = """
import _testcapi, sys
from pathlib import Path
from sdf_pose_bridge.geometry import formats
from sdf_pose_bridge.limited_process import Call
from sdf_pose_bridge.ros.node.bridge import main

def then_allocations_fail(function):
    def call(*arguments, **others):
        result = function(*arguments, **others)
        if result is not False and control.exists():
            first, last = map(int, control.read_text().split())
            control.unlink()
            _testcapi.set_nomemory(first, last)
        return result
    return call

control = Path(sys.argv.pop(1))
Call.has_ended = then_allocations_fail(Call.has_ended)
formats.converted_rotations = then_allocations_fail(formats.converted_rotations)
sys.exit(main())
"""
"""The node, in which some allocations fail after a file was read, or a rotation converted."""


@pytest.mark.parametrize('service', ['reload', 'convert_rotation'])
@pytest.mark.parametrize('first', size(range(3, 300, 90), range(0, 3000, 40)))
def test_after_failing_allocations_the_bridge_answers_or_is_gone(
        start_bridge, file, tmp_path, listener, service, first):
    pytest.importorskip('_testcapi', reason='needs a module for tests of Python itself')
    control = tmp_path / 'control'
    bridge = start_bridge(control, program=FAILING, sdf_file=file)
    wait_for_x(listener, 1.0)
    for name in ('reload', 'convert_rotation'):
        assert_answers_or_is_gone(bridge, listener, name)
    control.write_text(f'{first} {first + 30}')
    for name in (service, 'reload', 'convert_rotation'):
        assert_answers_or_is_gone(bridge, listener, name)


@pytest.mark.parametrize('megabytes', size((), range(1, 40, 3)))
def test_beyond_a_limit_of_the_kernel_the_bridge_answers_or_is_gone(
        start, file, listener, megabytes):
    bridge = start(file)
    replace(file, world(2, extra=''.join(
        f'<model name="m{i}"><link name="l"/></model>' for i in range(20_000))))
    used = int(re.search(r'VmData:\s*(\d+) kB', Path(f'/proc/{bridge.pid}/status').read_text())[1])
    limit = used * 1024 + megabytes * 10**6
    resource.prlimit(bridge.pid, resource.RLIMIT_DATA, (limit, limit))
    for name in ('reload', 'convert_rotation', 'reload'):
        assert_answers_or_is_gone(bridge, listener, name)


def assert_answers_or_is_gone(bridge, listener, service):
    if bridge.is_running:
        types = {'reload': Trigger, 'convert_rotation': ConvertRotation}
        answer = listener.ask(types[service], f'{BRIDGE}/{service}', types[service].Request())
        listener.wait(
            lambda: answer.done() or not bridge.is_running, lambda: '\n'.join(bridge.lines))
    if not bridge.is_running:
        code = bridge.wait_for_end()
        assert code
        # Libraries may crash.
        assert code < 0 or bridge.lines[-1].endswith('not enough memory, so the node ends')


CHANGED = """
import sys
from sdf_pose_bridge.ros.file_process import FileProcess
reader = FileProcess()
from sdf_pose_bridge.ros.node.process import run
{}
sys.exit(run(sys.argv, 'bridge', reader))
"""
"""The node, with a change after the process that reads files has begun."""

UNABLE_TO_PUBLISH = CHANGED.format("""
from sdf_pose_bridge.ros.publishing.published_frames import PublishedFrames

def publish_topics(frames):
    if frames.tree.transforms[-1, 0] == 2.0:
        frames.publishers.opened(frames._topics[-1]).destroy()
    publish(frames)

publish, PublishedFrames.publish_topics = PublishedFrames.publish_topics, publish_topics
""")
"""The node, of which one publisher does not work when the crate is at x = 2."""


def change_the_file(listener, file):
    replace(file, world(2))


def set_another_file(listener, file):
    other = file.with_name('other.sdf')
    other.write_text(world(2))
    asked_to_set(listener, sdf_file=str(other))


def set_the_pose(listener, file):
    pose = PoseStamped(pose=Pose(position=Point(x=2.0)))
    listener.ask(SetPose, f'{BRIDGE}/set_pose', SetPose.Request(frame='crate', pose=pose))


@pytest.mark.parametrize('change', [change_the_file, set_another_file, set_the_pose])
def test_a_publish_that_fails_after_the_swap_of_scenes_ends_the_bridge(
        start_bridge, file, listener, change):
    bridge = start_bridge(program=UNABLE_TO_PUBLISH, sdf_file=file, allow_set_pose=True)
    wait_for_x(listener, 1.0)
    change(listener, file)
    assert bridge.wait_for_end() == 1
    assert 'sdf_pose_bridge: thread "loader" has failed, so the node ends' in bridge.lines
    assert not bridge.count_of('is rejected')


TELLING = CHANGED.format("""
from sdf_pose_bridge.ros.following.joint_states import JointStates
from sdf_pose_bridge.ros.publishing.published_frames import PublishedFrames

def told(function):
    def call(*arguments):
        function(*arguments)
        print('has done', function.__name__, flush=True)
    return call

JointStates.follow = told(JointStates.follow)
PublishedFrames.publish_tf_static = told(PublishedFrames.publish_tf_static)
""")
"""The node, which tells when it follows the joints of a scene, and when it publishes a scene."""


def test_the_joints_of_a_new_scene_are_followed_before_it_is_published(start_bridge, file):
    file.write_text(ARM)
    bridge = start_bridge(program=TELLING, sdf_file=file, use_joint_states=True)
    bridge.wait_for_line('has done follow')
    replace(file, ARM.replace('upper', 'lower'))
    bridge.wait_for_line('has done follow', 2)
    bridge.wait_for_line('has done publish_tf_static', 2)
    done = [line for line in bridge.lines if line.startswith('has done')]
    assert done[-2:] == ['has done follow', 'has done publish_tf_static']


WITH_DEFECT = CHANGED.format("""
from sdf_pose_bridge.ros.following import state_topic

def joint_state_from_bytes(*_):
    raise TypeError('a defect')

state_topic.joint_state_from_bytes = joint_state_from_bytes
""")
"""The node, which cannot read any JointState."""

DEFECT = 'internal error in messages of /joint_states: a defect'
ARM = """<sdf version="1.11"><model name="arm"><link name="base"/><link name="upper"/>
<joint name="turn" type="revolute"><parent>base</parent><child>upper</child>
  <axis><xyz>0 0 1</xyz></axis></joint></model></sdf>"""


def test_a_bridge_that_can_process_no_message_says_so_and_ends(
        start_bridge, make_node, file, listener):
    file.write_text(ARM)
    senders = [
        make_node(name).create_publisher(JointState, 'joint_states', 10)
        for name in ('arm', 'gripper')]
    listener.node.create_timer(0.1, lambda: [each.publish(JointState()) for each in senders])
    monitor = Monitor(listener)
    bridge = start_bridge(program=WITH_DEFECT, sdf_file=file, use_joint_states=True)
    monitor.wait_for(DiagnosticStatus.ERROR)
    assert monitor.status.message == DEFECT
    listener.wait(lambda: not bridge.is_running, 'the end of the bridge')
    assert bridge.wait_for_end() == 1
    assert 'sdf_pose_bridge: thread "joint states" has failed, so the node ends' in bridge.lines
    assert bridge.count_of('internal error in') == 1


# The process that reads files


def test_a_reading_process_that_is_killed_is_an_error_and_replaced(start, tmp_path, listener):
    slow = SlowFile(tmp_path / 'slow.sdf', world(1))
    bridge = start(slow.path)
    slow.hold()
    os.utime(slow.path)
    with slow.opened():
        os.kill(busy_process(bridge), signal.SIGKILL)
        bridge.wait_for_line('the process that reads files has ended by signal 9')
        slow.write(world(2))
    wait_for_x(listener, 2.0)


def test_without_the_waiting_process_the_frames_stay_and_one_line_says_what_to_do(
        start, file, listener, start_listener):
    bridge = start(file)
    os.kill(waiting_process(bridge), signal.SIGKILL)
    os.utime(file)
    assert_reported_while_old_poses_are_served(
        bridge, listener, start_listener, file, 'start this program again')
    assert 'start this program again' in reload(listener).message
    bridge.send(signal.SIGTERM)
    assert bridge.wait_for_end() == 0
    assert len([line for line in bridge.lines if 'start this program again' in line]) == 1


LIMITED = """
import sys
from sdf_pose_bridge.process_limits import Allowance
from sdf_pose_bridge.ros import file_process
from sdf_pose_bridge.ros.node.bridge import main

file_process.FOR_FILES = Allowance({})
sys.exit(main())
"""
"""The node with smaller limits than those for which the smallest file would be very large."""


@pytest.mark.parametrize(('limits', 'message'), [
    ('processor_s=0.5, memory_bytes=10**9', 'more than 1 s of processor time'),
    ('processor_s=60.0, memory_bytes=5 * 10**7', 'more than 50 MB of memory'),
])
def test_a_file_that_needs_too_much_is_refused(
        start_bridge, file, tmp_path, listener, limits, message):
    large = tmp_path / 'large.sdf'
    large.write_text(world(2, extra=''.join(
        f'<model name="m{i}"><link name="l"/></model>' for i in range(100_000))))
    start_bridge(program=LIMITED.format(limits), sdf_file=file)
    wait_for_x(listener, 1.0)
    assert reload(listener).success
    assert reason_for_refusal(listener, sdf_file=str(large)) == (
        f'{large}: LIMIT: the file needs {message} to be read')
    assert reload(listener).success


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_to_all_processes_ends_them_well(start_bridge, tmp_path, number):
    slow = SlowFile(tmp_path / 'slow.sdf', world(1))
    bridge = start_bridge(sdf_file=slow.path, with_children=True).wait_until_started()
    slow.hold()
    os.utime(slow.path)
    with slow.opened():
        descriptor = os.pidfd_open(busy_process(bridge))
        bridge.send(number)
        assert bridge.wait_for_end() == 0
    assert select.select([descriptor], [], [], DEADLINE_S)[0]
    os.close(descriptor)
    assert len(bridge.lines) == 1, bridge.lines


def test_a_full_disk_for_the_log_and_a_full_terminal_end_nothing(
        start, file, small_disk, listener, monkeypatch):
    monkeypatch.setenv('ROS_LOG_DIR', str(small_disk))
    (small_disk / 'filling').write_bytes(bytes(4096))
    with Path('/dev/full').open('w') as full:
        process = started(
            [executable_of_workspace('bridge'), '--ros-args', '-p', f'sdf_file:={file}'],
            stdout=full, stderr=full)
    try:
        wait_for_x(listener, 1.0)
        replace(file, '<sdf')
        Monitor(listener).wait_for(DiagnosticStatus.ERROR)
        replace(file, world(2))
        wait_for_x(listener, 2.0)
    finally:
        process.send_signal(signal.SIGINT)
        assert process.wait(DEADLINE_S) == 0


def test_an_included_file_that_changes_during_the_load_is_read_again(
        bridge, listener, file, tmp_path):
    def model(name, x):
        return (f'<sdf version="1.10"><model name="{name}"><pose>{x} 0 0 0 0 0</pose>'
                '<link name="body"/></model></sdf>')

    first = tmp_path / 'crate.sdf'
    first.write_text(model('crate', 3))
    slow = SlowFile(tmp_path / 'slow.sdf', model('other', 0))
    replace(file, '<sdf version="1.10"><world name="w"><include><uri>crate.sdf</uri></include>'
            '<include><uri>slow.sdf</uri></include></world></sdf>')
    wait_for_x(listener, 3.0)
    slow.hold()
    os.utime(file)
    with slow.opened():
        replace(first, model('crate', 2))
    wait_for_x(listener, 2.0)


def test_listeners_follow_a_bridge_that_was_killed_and_started_again(start, file, listener):
    killed = start(file)
    wait_for_x(listener, 1.0)
    killed.send(signal.SIGKILL)
    assert killed.wait_for_end() == -signal.SIGKILL
    replace(file, world(2))
    start(file)
    wait_for_x(listener, 2.0)
    assert reload(listener).success


def test_a_clock_that_jumps_back_keeps_nothing_from_being_published(bridge, file, listener):
    set_parameters(listener, use_sim_time=True, publish_rate=20.0)
    wait_for_x(listener, 1.0)
    clock = listener.node.create_publisher(Clock, '/clock', 1)

    def stamp():
        return listener.tf_messages[-1].transforms[0].header.stamp.sec

    def has_jumped(seconds):
        clock.publish(Clock(clock=Time(sec=seconds)))
        return stamp() == seconds

    for x, seconds in enumerate((1000, 10, 2_000_000_000, 0), start=2):
        listener.wait(lambda seconds=seconds: has_jumped(seconds), stamp)
        replace(file, world(x))
        wait_for_x(listener, float(x))
        assert stamp() == seconds


def test_a_listener_that_is_stopped_keeps_nobody_waiting_and_gets_the_last(
        bridge, file, listener, start_program):
    set_parameters(listener, publish_rate=100.0)
    wait_for_x(listener, 1.0)
    stopped = start_program([sys.executable, '-c', LISTENING])
    stopped.wait_for_line('x 1.0')
    stopped.send(signal.SIGSTOP)
    last = size(5, 50)
    for x in range(2, last + 1):
        replace(file, world(x))
        assert reload(listener).success
        wait_for_x(listener, float(x))
    stopped.send(signal.SIGCONT)
    stopped.wait_for_line(f'x {last}.0')
