# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Run the benchmarks: ``python -m benchmarks [--only TEXT]``."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
import importlib
import os
import pkgutil
import platform
import sys

import numpy as np

import benchmarks
from benchmarks.harness import Benchmark
from benchmarks.harness import result_of
from benchmarks.harness import RUNS
from benchmarks.harness import table


def all_benchmarks() -> Iterator[Benchmark]:
    """Find the benchmarks of all modules ``bench_*`` of this package, in order."""
    for module in pkgutil.iter_modules(benchmarks.__path__):
        if module.name.startswith('bench_'):
            contents = vars(importlib.import_module(f'benchmarks.{module.name}'))
            yield from (value for value in contents.values() if isinstance(value, Benchmark))


def main() -> int:
    """Run what the arguments say; return 2 if that is nothing, else 0."""
    parser = argparse.ArgumentParser(prog='python -m benchmarks', description=__doc__)
    parser.add_argument(
        '--only', metavar='TEXT', default='',
        help='run only those that have this text in what they do or are compared with',
    )
    only = parser.parse_args().only.lower()
    chosen = [
        bench for bench in all_benchmarks()
        if only in bench.what.lower() or only in bench.counterpart.lower()
    ]
    if not chosen:
        print(f'no benchmark has {only!r} in its description', file=sys.stderr)
        return 2
    results = []
    for number, bench in enumerate(chosen, start=1):
        print(f'{number}/{len(chosen)} {bench.what} / {bench.counterpart}', file=sys.stderr)
        results.append(result_of(bench))
    print(
        f'Python {platform.python_version()}, numpy {np.__version__}, {os.cpu_count()} cores;'
        f' medians of {RUNS} runs of each, in turns'
    )
    print(table(results))
    return 0


if __name__ == '__main__':
    sys.exit(main())
