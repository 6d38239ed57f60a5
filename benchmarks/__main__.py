# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Run the benchmarks: ``python -m benchmarks [--only TEXT]``."""

from __future__ import annotations

import argparse
from concurrent.futures import ProcessPoolExecutor
import multiprocessing
import os
import platform
import sys

import numpy as np

from benchmarks.catalogue import all_benchmarks, result_of_number
from benchmarks.harness import RUNS, table


def main() -> int:
    """Run what the arguments say; return 2 if that is nothing, else 0."""
    parser = argparse.ArgumentParser(prog='python -m benchmarks', description=__doc__)
    parser.add_argument(
        '--only', metavar='TEXT', default='',
        help='run only those that have this text in what they do or are compared with',
    )
    only = parser.parse_args().only.lower()
    chosen = [
        (number, bench) for number, bench in enumerate(all_benchmarks())
        if only in bench.what.lower() or only in bench.counterpart.lower()
    ]
    if not chosen:
        print(f'no benchmark has {only!r} in its description', file=sys.stderr)
        return 2
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    results = []
    # None shall find the memory as another has left it.
    spawning = multiprocessing.get_context('spawn')
    for turn, (number, bench) in enumerate(chosen, start=1):
        print(f'{turn}/{len(chosen)} {bench.what} / {bench.counterpart}', file=sys.stderr)
        with ProcessPoolExecutor(1, mp_context=spawning) as process:
            result = process.submit(result_of_number, number).result()
        # All of them take more than half an hour, and a run that is ended early keeps these.
        print(f'    {result.ours}, {result.ratio}: {result.reached}', file=sys.stderr)
        results.append(result)
    print(
        f'Python {platform.python_version()}, numpy {np.__version__}, {os.cpu_count()} cores, '
        f'{os.environ.get("RMW_IMPLEMENTATION", "no ROS")};'
        f' medians of {RUNS} runs of each, in turns'
    )
    print(table(results))
    return 0


if __name__ == '__main__':
    sys.exit(main())
