# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""ROS domains that a test has to itself, also while other tests run beside it."""

import contextlib
import random
import socket

_CLAIMS = []


def port_of_claim(domain):
    """Return the sixth of the 250 UDP ports of a domain, which the middleware leaves alone."""
    return 7405 + 250 * domain


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

    Holding the port keeps other tests out, in this process and in others.
    """
    for domain in random.sample(range(1, 101), 100):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as claim:
            try:
                claim.bind(('127.0.0.1', port_of_claim(domain)))
            except OSError:
                continue
            _CLAIMS.append(claim)
            try:
                yield domain
            finally:
                _CLAIMS.remove(claim)
            return
    msg = 'all ROS domains from 1 to 100 are taken'
    raise RuntimeError(msg)
