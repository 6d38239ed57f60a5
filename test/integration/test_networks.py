# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A bridge and a listener on two hosts: network namespaces that a cable (veth) connects."""

import os
from pathlib import Path
import subprocess
import sys

from ament_index_python.packages import get_package_share_directory
from bridge_process import STARTED
from changes import replace, world
from command_line import completed, executable_of_workspace
from deadline import wait_until
import needs
import pytest
from ros_domain import needs_fast_dds
from sizes import size

from sdf_pose_bridge.ros.node.middleware import PROFILES

ADDRESSES = {'a': '10.211.7.1', 'b': '10.211.7.2'}
LEASE = '<leaseDuration><sec>3</sec></leaseDuration>'
"""How long Fast DDS waits for a silent participant; 20 s by default."""

FRAMES = size(500, 10_000)
LOSE_5_PERCENT = '4,32 0 0 4294963256,53 1 0 214748365,6 0 0 2,6 0 0 0'
"""Classic BPF: a random number; if it is below 5 % of 2**32, drop the packet."""

LISTENING = """
import sys
import rclpy
from geometry_msgs.msg import TransformStamped
from rclpy.qos import DurabilityPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

frames = set()
publishers = 0

def show(message):
    x = max(each.transform.translation.x for each in message.transforms)
    print('tree', len(message.transforms), x, flush=True)

def collect(message):
    frames.add(message.child_frame_id)
    if len(frames) == int(sys.argv[1]):
        print('all transforms', flush=True)

def count():
    global publishers
    if publishers != (publishers := node.count_publishers('/tf_static')):
        print('publishers', publishers, flush=True)

rclpy.init()
node = rclpy.create_node('remote')
latched = QoSProfile(depth=20000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
node.create_subscription(TFMessage, '/tf_static', show, latched)
node.create_subscription(TransformStamped, '/sdf_pose_bridge/transforms', collect, latched)
node.create_timer(0.1, count)
rclpy.spin(node)
"""


def ip(*arguments):
    return completed([needs.program('ip'), *arguments], check=True).stdout


def counted_by_kernel(host):
    """Return what the kernel has counted of a host's IP packets, by the names of RFC 1213."""
    names, values = ip('netns', 'exec', host, 'grep', 'Ip:', '/proc/net/snmp').splitlines()
    return dict(zip(names.split()[1:], map(int, values.split()[1:]), strict=True))


def world_with_many_frames():
    return world(1, extra=''.join(f'<frame name="f{number}"/>' for number in range(FRAMES - 2)))


def wait_for_link(hosts):
    """Wait for the kernel to report the cable as running; Fast DDS looks once, at its start."""
    for name in hosts.values():
        wait_until(
            lambda name=name: 'state UP' in ip('-n', name, 'link', 'show', 'cable'),
            what=lambda name=name: f'the cable of {name}')


@pytest.fixture
def hosts(ros_domain):
    """Names of the network namespaces of two hosts, "a" and "b"."""
    # Other tests have another domain, so also other names.
    hosts = {host: f'sdf_pose_bridge_{ros_domain}{host}' for host in ADDRESSES}
    made = []
    try:
        for name in hosts.values():
            ip('netns', 'add', name)
            made.append(name)
        ip('-n', hosts['a'], 'link', 'add', 'cable', 'type', 'veth',
           'peer', 'name', 'cable', 'netns', hosts['b'])
        for host, address in ADDRESSES.items():
            ip('-n', hosts[host], 'address', 'add', f'{address}/24', 'dev', 'cable')
            for device in ('lo', 'cable'):
                ip('-n', hosts[host], 'link', 'set', device, 'up')
        wait_for_link(hosts)
    except (OSError, subprocess.CalledProcessError) as error:
        pytest.skip(f'this machine does not permit network namespaces: {error}')
    else:
        yield hosts
    finally:
        for name in made:
            ip('netns', 'del', name)


@pytest.fixture
def start_on(hosts, start_program, monkeypatch):
    """Starts a process on one of the hosts; ``start_on(host, *command)``."""
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'SUBNET')

    def start(host, *command):
        # Each host has its own shared memory.
        return start_program([
            needs.program('ip'), 'netns', 'exec', hosts[host], 'sh', '-c',
            'mount -t tmpfs none /dev/shm && exec "$@"', 'sh', *command])
    return start


@pytest.fixture
def start_bridge_on(start_on, file):
    def start(host):
        bridge = start_on(
            host, executable_of_workspace('bridge'), '--ros-args', '-p', f'sdf_file:={file}')
        bridge.wait_for_line(STARTED)
        return bridge
    return start


@pytest.fixture
def start_listener_on(start_on):
    def start(host, count=2):
        return start_on(host, sys.executable, '-c', LISTENING, str(count))
    return start


@needs_fast_dds
def test_a_link_that_is_cut_for_longer_than_the_lease_and_restored(
        hosts, start_bridge_on, start_listener_on, file, tmp_path, monkeypatch):
    share = get_package_share_directory('sdf_pose_bridge')
    (profile,) = [each for each in PROFILES if os.environ['ROS_DISTRO'] in each.distros]
    text = Path(share, profile.file).read_text()
    short = tmp_path / 'profile.xml'
    short.write_text(text.replace('<leaseAnnouncement>', f'{LEASE}<leaseAnnouncement>'))
    monkeypatch.setenv(profile.variable, str(short))
    bridge = start_bridge_on('a')
    listener = start_listener_on('b')
    listener.wait_for_line('all transforms')
    ip('-n', hosts['a'], 'link', 'set', 'cable', 'down')
    listener.wait_for_line('publishers 0')
    replace(file, world(2))
    bridge.wait_for_line(STARTED, 2)
    ip('-n', hosts['a'], 'link', 'set', 'cable', 'up')
    listener.wait_for_line('tree 2 2.0')
    listener.wait_for_line('all transforms', 3)


def test_a_late_joiner_on_another_host_gets_everything_in_whole_packets(
        hosts, start_bridge_on, start_listener_on, file):
    file.write_text(world_with_many_frames())
    start_bridge_on('a')
    listener = start_listener_on('b', FRAMES)
    listener.wait_for_line(f'tree {FRAMES} 1.0')
    listener.wait_for_line('all transforms')
    assert counted_by_kernel(hosts['a'])['FragCreates'] == 0


def test_many_frames_arrive_whole_where_packets_are_lost(
        hosts, start_bridge_on, start_listener_on, file):
    for host in hosts.values():
        # The module of the kernel for netem is often not installed.
        for arguments in (['qdisc', 'add', 'dev', 'cable', 'clsact'],
                          ['filter', 'add', 'dev', 'cable', 'ingress', 'bpf', 'direct-action',
                           'bytecode', LOSE_5_PERCENT]):
            command = [needs.program('tc'), '-n', host, *arguments]
            if subprocess.run(command, check=False).returncode:
                pytest.skip('this machine has no BPF for tc')
    file.write_text(world_with_many_frames())
    start_bridge_on('a')
    listener = start_listener_on('b', FRAMES)
    listener.wait_for_line(f'tree {FRAMES} 1.0')
    listener.wait_for_line('all transforms')


@needs_fast_dds
def test_a_discovery_server_leads_to_everything(
        start_on, start_bridge_on, start_listener_on, monkeypatch):
    # What "fastdds discovery" of Fast DDS 3 calls for a server.
    command = [] if os.environ['ROS_DISTRO'] in PROFILES[0].distros else ['42']
    start_on(
        'a', needs.program('fast-discovery-server'), *command, '-i', '0', '-l', ADDRESSES['a'],
        '-p', '11811')
    monkeypatch.setenv('ROS_DISCOVERY_SERVER', f'{ADDRESSES["a"]}:11811')
    start_bridge_on('a')
    listener = start_listener_on('b')
    listener.wait_for_line('tree 2 1.0')
    listener.wait_for_line('all transforms')


def test_static_peers_lead_to_everything_without_multicast(
        start_bridge_on, start_listener_on, monkeypatch):
    monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
    monkeypatch.setenv('ROS_STATIC_PEERS', ';'.join(ADDRESSES.values()))
    start_bridge_on('a')
    listener = start_listener_on('b')
    listener.wait_for_line('tree 2 1.0')
    listener.wait_for_line('all transforms')
