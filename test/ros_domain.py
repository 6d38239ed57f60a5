# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""ROS domains that a test has to itself, also while other tests run beside it."""

import contextlib
import random
import socket


@contextlib.contextmanager
def claimed_domain():
    """
    Claim a ROS domain until the context ends.

    Domain d has the 250 UDP ports from 7400 + 250 d; the middleware leaves the sixth of them
    alone, so that holding it keeps other tests out, in this process and in others.
    """
    for domain in random.sample(range(1, 101), 100):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as claim:
            try:
                claim.bind(('127.0.0.1', 7405 + 250 * domain))
            except OSError:
                continue
            yield domain
            return
    msg = 'all ROS domains from 1 to 100 are taken'
    raise RuntimeError(msg)
