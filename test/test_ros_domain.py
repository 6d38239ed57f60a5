# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Domains of tests are used by nobody else, and stay claimed while a process of the test runs."""

import socket
import subprocess
import sys

from processes import started
import pytest
import ros_domain
from ros_domain import claimed_domain, claims, port_of_claim


def test_a_process_that_is_left_behind_keeps_its_domain_claimed():
    with claimed_domain() as domain:
        process = started(
            [sys.executable, '-c', 'input()'], stdin=subprocess.PIPE, pass_fds=claims())
    assert claims() == []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        with process:
            with pytest.raises(OSError, match='in use'):
                other.bind(('127.0.0.1', port_of_claim(domain)))
            process.communicate(b'\n')
        other.bind(('127.0.0.1', port_of_claim(domain)))


def test_a_domain_that_another_program_uses_is_not_claimed(monkeypatch):
    with claimed_domain() as taken, claimed_domain() as free:
        pass
    monkeypatch.setattr(ros_domain.random, 'sample', lambda *_: [taken, free])
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as participant:
        # That of the first participant for discovery.
        participant.bind(('127.0.0.1', port_of_claim(taken) + 5))
        with claimed_domain() as domain:
            assert domain == free
