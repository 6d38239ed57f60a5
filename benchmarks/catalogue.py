# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Find all benchmarks, in an order that every process agrees on."""

from __future__ import annotations

from collections.abc import Iterator
import importlib
import pkgutil

import benchmarks
from benchmarks.harness import Benchmark, Result, result_of


def all_benchmarks() -> Iterator[Benchmark]:
    """Find the benchmarks of all modules ``bench_*`` of this package, in order."""
    for module in pkgutil.iter_modules(benchmarks.__path__):
        if module.name.startswith('bench_'):
            contents = vars(importlib.import_module(f'benchmarks.{module.name}'))
            yield from (value for value in contents.values() if isinstance(value, Benchmark))


def result_of_number(number: int) -> Result:
    """Run the benchmark that comes so many after the first one."""
    return result_of(list(all_benchmarks())[number])
