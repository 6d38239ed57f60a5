# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Domains of tests stay claimed while a process of the test runs."""

import socket
import subprocess
import sys

import pytest
from ros_domain import claimed_domain
from ros_domain import claims
from ros_domain import port_of_claim


def test_a_process_that_is_left_behind_keeps_its_domain_claimed():
    with claimed_domain() as domain:
        process = subprocess.Popen(
            [sys.executable, '-c', 'input()'], stdin=subprocess.PIPE, pass_fds=claims())
    assert claims() == []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        with process:
            with pytest.raises(OSError, match='in use'):
                other.bind(('127.0.0.1', port_of_claim(domain)))
            process.communicate(b'\n')
        other.bind(('127.0.0.1', port_of_claim(domain)))
