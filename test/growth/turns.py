# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Compare the processor time of something hostile with half of it, and with something plain."""

import gc
import math
import time

MOST_TURNS = 40


def fault_of_growth(*calls):
    """
    Return how a time grows too fast; empty if it grows with the size.

    :param calls: functions that process something hostile, half of it, and as much that is plain.
    """
    shortest_s = [math.inf] * 3
    for turn in range(MOST_TURNS):
        # Other processes share the caches of the machine: the shortest of three or more counts.
        shortest_s = list(map(min, shortest_s, map(_processor_s, calls)))
        hostile_s, half_s, plain_s = shortest_s
        # Of what takes a twentieth of something plain, caches of the processor decide.
        if turn >= 2 and hostile_s < 2.6 * half_s + 0.05 * plain_s and hostile_s < 10.0 * plain_s:
            return ''
    return f'{hostile_s / half_s:.1f} times its half, {hostile_s / plain_s:.1f} times plain'


def _processor_s(call):
    """Return the processor time of a call, in which other work of the machine does not count."""
    # Nor does the search for garbage, which other tests may have left.
    gc.disable()
    try:
        begin = time.thread_time()
        call()
        return time.thread_time() - begin
    finally:
        gc.enable()
