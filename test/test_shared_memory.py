# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Shared memory of processes that were killed is removed, and no other."""

from pathlib import Path
import subprocess
import sys
import time

from processes import started
import pytest
from ros_domain import environment_with_domain, needs_fast_dds
from shared_memory import remove_dead_segments, remove_incomplete_ports

# The ports from 7000 are those of all domains.
RUNNING = """
import re, signal, rclpy
rclpy.init()
node = rclpy.create_node('killed')
print(*set(re.findall('/dev/shm/fast(?!.*_port70).*', open('/proc/self/maps').read())))
signal.pause()
"""


@pytest.mark.parametrize('state', [b'', bytes(4), b'\1\0\0\0'])
def test_shared_memory_that_nobody_completed_is_removed(tmp_path, state):
    segment = tmp_path / 'fastrtps_port22913'
    segment.write_bytes(state)
    remove_incomplete_ports(62, tmp_path)
    assert not segment.exists()


def test_other_shared_memory_is_kept(tmp_path):
    complete = tmp_path / 'fastrtps_port22913'
    complete.write_bytes(b'\2\0\0\0' + bytes(100))
    lock = tmp_path / 'fastrtps_port22913_el'
    lock.touch()
    of_other_domain = tmp_path / 'fastrtps_port23150'
    of_other_domain.touch()
    remove_incomplete_ports(62, tmp_path)
    assert sorted(tmp_path.iterdir()) == [complete, lock, of_other_domain]


@needs_fast_dds
def test_shared_memory_of_a_process_is_removed_after_it_was_killed(tmp_path):
    pytest.importorskip('rclpy', reason='needs ROS 2')
    since_s = time.time() - 1.0
    with environment_with_domain(tmp_path), started(
            [sys.executable, '-uc', RUNNING], stdout=subprocess.PIPE, text=True) as process:
        files = [Path(name) for name in process.stdout.readline().split()]
        remove_dead_segments(since_s)
        there = [path.exists() for path in files]
        process.kill()
    assert there
    assert all(there)
    remove_dead_segments(since_s)
    assert [path for path in files if path.exists()] == []
