# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What the node costs while nothing happens but looking for changes of its files."""

from __future__ import annotations

from collections.abc import Iterator
import contextlib
import subprocess
import sys
import time

from benchmarks.bench_reload import work_cell
from benchmarks.harness import benchmark, Function, TimesAsFast
from benchmarks.processes import MINIMAL_NODE, shares_of

WINDOW_S = 5.0
LARGEST_SHARE = 0.002
"""Of a core."""


@benchmark(
    'idle with watch on, processor time in each second',
    counterpart='a minimal node with nothing to do', goal=TimesAsFast(longest_s=LARGEST_SHARE))
def idle_and_minimal_node() -> Iterator[tuple[Function, Function | None]]:
    from std_srvs.srv import Empty
    with work_cell() as (bridge, _), contextlib.ExitStack() as stack:
        minimal = bridge.start(
            stack, sys.executable, '-c', MINIMAL_NODE, stderr=subprocess.DEVNULL)
        bridge.client.caller(Empty, '/minimal/empty', Empty.Request())()
        yield shares_of((bridge.process, minimal), lambda: time.sleep(WINDOW_S))
