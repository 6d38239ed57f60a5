# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Processes that end with the tests that start them."""

import ctypes
from functools import partial
import signal
import subprocess

_PR_SET_PDEATHSIG = 1
_LIBC = ctypes.CDLL(None)


def _end_with_parent():
    _LIBC.prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)


started = partial(subprocess.Popen, preexec_fn=_end_with_parent)
"""Starts a process, which gets SIGTERM when this one ends, even where this one is killed."""
