# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Processes that end with the tests that start them."""

import ctypes
from functools import partial
import signal
import subprocess

_PR_SET_PDEATHSIG = 1
_LIBC = ctypes.CDLL(None)


def end_with_parent():
    """Have this process, which is to run a program, get SIGTERM when its parent ends."""
    _LIBC.prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)


started = partial(subprocess.Popen, preexec_fn=end_with_parent)
"""Starts a process that ends with this one, even where this one is killed."""
