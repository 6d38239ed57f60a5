# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What the node costs while nothing happens but looking for changes of its files."""

from __future__ import annotations

from collections.abc import Iterator
import contextlib
from pathlib import Path
import subprocess
import sys
import time

from benchmarks.bench_reload import work_cell
from benchmarks.bench_services import MINIMAL_NODE
from benchmarks.harness import benchmark, Function, TimesAsFast, Took, Unavailable

WINDOW_S = 5.0
LARGEST_SHARE = 0.002
"""Of a core."""


def processor_time_ns(process: subprocess.Popen) -> int:
    """Return the nanoseconds that the threads of a process have run so far."""
    files = list(Path(f'/proc/{process.pid}/task').glob('*/schedstat'))
    if not files:
        msg = 'this system does not report how long threads have run'
        raise Unavailable(msg)
    return sum(int(file.read_text(encoding='ascii').split()[0]) for file in files)


@benchmark(
    'idle with watch on, processor time in each second',
    counterpart='a minimal node with nothing to do', goal=TimesAsFast(longest_s=LARGEST_SHARE))
def idle_and_minimal_node() -> Iterator[tuple[Function, Function | None]]:
    from std_srvs.srv import Empty
    with work_cell() as (bridge, _), contextlib.ExitStack() as stack:
        minimal = bridge.start(
            stack, sys.executable, '-c', MINIMAL_NODE, stderr=subprocess.DEVNULL)
        bridge.client.caller(Empty, '/minimal/empty', Empty.Request())()
        processes = (bridge.process, minimal)

        def shares() -> list[float]:
            before = [processor_time_ns(process) for process in processes]
            begin = time.perf_counter_ns()
            time.sleep(WINDOW_S)
            window = time.perf_counter_ns() - begin
            return [
                (processor_time_ns(process) - first) / window
                for process, first in zip(processes, before, strict=True)]
        # Both are measured in the same time, and then returned one after the other.
        last: list[float] = []

        def ours() -> Took:
            last[:] = shares()
            return Took(last[0])
        yield ours, lambda: Took(last[1])
