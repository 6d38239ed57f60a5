# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""ROS domains that a test has to itself, also while other tests run beside it."""

import contextlib
import os
from pathlib import Path
import random
import socket

import pytest
from shared_memory import FIRST_PORT, PORTS, remove_incomplete_ports, remove_ports

_CLAIMS = []

needs_fast_dds = pytest.mark.skipif(
    'fastrtps' not in os.environ.get('RMW_IMPLEMENTATION', 'rmw_fastrtps_cpp'),
    reason='is about Fast DDS')


def port_of_claim(domain):
    """Return the sixth of the 250 UDP ports of a domain, which the middleware leaves alone."""
    return FIRST_PORT + PORTS * domain + 5


def has_participants(domain):
    """Tell whether a process on this machine has a port of a domain beside that of a claim."""
    ports = {FIRST_PORT + PORTS * domain + number for number in range(PORTS)}
    ports.remove(port_of_claim(domain))
    # The second column is the local address and port, in hexadecimal digits.
    lines = [line for table in ('udp', 'udp6') if (path := Path('/proc/net', table)).exists()
             for line in path.read_text(encoding='ascii').splitlines()[1:]]
    return any(int(line.split()[1].rpartition(':')[2], 16) in ports for line in lines)


def claims():
    """
    Return the file descriptors of all claims.

    Processes that inherit them keep their domain claimed where a killed run of tests leaves them.
    """
    return [claim.fileno() for claim in _CLAIMS]


@contextlib.contextmanager
def claimed_domain():
    """
    Claim a ROS domain until the context ends, and until no process has :func:`claims` any more.

    Holding the port keeps other tests out, in this process and in others. A domain that other
    programs use is left to them.
    """
    for domain in random.sample(range(1, 101), 100):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as claim:
            try:
                claim.bind(('127.0.0.1', port_of_claim(domain)))
            except OSError:
                continue
            if has_participants(domain):
                continue
            _CLAIMS.append(claim)
            remove_incomplete_ports(domain)
            try:
                yield domain
            finally:
                _CLAIMS.remove(claim)
                if not has_participants(domain):
                    remove_ports(domain)
            return
    msg = 'all ROS domains from 1 to 100 are taken'
    raise RuntimeError(msg)


@contextlib.contextmanager
def environment_with_domain(log_folder):
    """Claim a ROS domain, which processes that are started in the context use."""
    with claimed_domain() as domain, pytest.MonkeyPatch.context() as monkeypatch:
        monkeypatch.setenv('ROS_DOMAIN_ID', str(domain))
        monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
        monkeypatch.setenv('ROS_LOG_DIR', str(log_folder))
        yield domain
