# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Print how loads grow with n, 2 n and 4 n, where a file of 4 n has 1 MB with all that it includes.

A row ends with what is wrong: more than 2 s of processor time, more than 300 MB, a thread that has
to wait for more than 0.2 s, time or memory that grows faster than in proportion, or a process that
ends. ``--pairs`` measures all contents in all others instead: each pair at 250 kB, and then the
worst of them as rows of the table.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from itertools import combinations, pairwise
import math
import os
from pathlib import Path
import resource
import subprocess
import sys
import tempfile
from typing import NamedTuple

from growth.families import (
    changed_contents,
    CONTENTS,
    FAMILIES,
    Files,
    included_contents,
    Link,
    merged_contents,
    model,
)

WIDTH = 56
"""Of the column of names."""

MOST_BYTES = 1_000_000
BYTES_OF_PAIR = 250_000
LONGEST_S = 2.0
MOST_MEMORY = 300_000_000
LONGEST_WAIT_S = 0.2
LONGEST_RUN_S = 20
LARGEST_GROWTH = 3.0
"""How many times as much 2 n may take as n; less than this is noise on a busy machine."""
SHORTEST_S = 0.3
"""Growth of shorter times than this is not judged."""
ROWS_OF_PAIRS = 40
"""How many pairs are measured again at 1 MB."""


class Load(NamedTuple):
    """One load, as it was measured."""

    seconds: float
    memory: int
    added_memory: int
    longest_wait_s: float
    outcome: str


def measured(files: Files) -> Load:
    """Load files in a process of its own."""
    with tempfile.TemporaryDirectory(prefix='growth_') as folder:
        for path, text in files.items():
            file = Path(folder, path)
            file.parent.mkdir(exist_ok=True, parents=True)
            if isinstance(text, Link):
                file.symlink_to(text.target)
            else:
                file.write_bytes(text.encode(errors='surrogateescape'))
        limit = (LONGEST_RUN_S, LONGEST_RUN_S)
        process = subprocess.run(
            [sys.executable, '-m', 'growth.measurement', str(Path(folder, 'scene.sdf'))],
            check=False, capture_output=True, text=True,
            env={**os.environ, 'GZ_FUEL_CACHE_PATH': str(Path(folder, 'fuel'))},
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, limit))
    if process.returncode:
        reason = process.stderr.strip().rpartition('\n')[2] or f'exit code {process.returncode}'
        return Load(LONGEST_RUN_S, 0, 0, 0.0, f'ENDED: {reason[:80]}')
    seconds, memory, added, wait, outcome = process.stdout.strip().split(' ', 4)
    return Load(float(seconds), int(memory), int(added), float(wait), outcome)


def size_of(files: Files) -> int:
    """Return how many bytes files have together."""
    return sum(
        len(text.target if isinstance(text, Link) else text.encode(errors='surrogateescape'))
        for text in files.values())


def largest_n(family: Callable[[int], Files], most_bytes: int) -> int:
    """Return for which n the files of a family have about so many bytes."""
    n = 4
    while n < 50_000 and size_of(family(2 * n)) <= most_bytes:
        n *= 2
    step = n // 2
    while step >= max(n // 16, 1):
        if size_of(family(n + step)) <= most_bytes:
            n += step
        step //= 2
    return n


def faults(loads: list[Load]) -> Iterator[str]:
    """Say what is wrong with loads of n, 2 n and 4 n; or with one load."""
    last = loads[-1]
    if last.outcome.startswith('ENDED'):
        yield last.outcome
        return
    if last.seconds > LONGEST_S:
        yield f'{last.seconds:.1f} s'
    if last.memory > MOST_MEMORY:
        yield f'{last.memory / 1e6:.0f} MB'
    if last.longest_wait_s > LONGEST_WAIT_S:
        yield f'waits {last.longest_wait_s:.2f} s'
    for half, whole in pairwise(loads):
        if whole.seconds > SHORTEST_S and whole.seconds > LARGEST_GROWTH * half.seconds:
            yield f'time times {whole.seconds / half.seconds:.1f}'


def row(name: str, family: Callable[[int], Files]) -> tuple[str, bool]:
    """Measure a family; return a row of the table, and whether all is well."""
    n = max(largest_n(family, MOST_BYTES) // 4, 1)
    loads = [measured(family(count)) for count in (n, 2 * n, 4 * n)]
    found = ', '.join(faults(loads))
    seconds = ' '.join(f'{load.seconds:6.2f}' for load in loads)
    memory = ' '.join(f'{load.added_memory / 1e6:5.0f}' for load in loads)
    last = loads[-1]
    return (f'{name:{WIDTH}} {4 * n:7} {size_of(family(4 * n)) / 1e3:6.0f} {seconds}  {memory} '
            f'{last.longest_wait_s:5.2f}  {last.outcome[:46]:46} {found}'), not found


def pair(first: str, second: str, n: int) -> Files:
    """Return a model that holds two contents."""
    return {'scene.sdf': model(CONTENTS[first](n) + CONTENTS[second](n))}


def all_families() -> dict[str, Callable[[int], Files]]:
    """Return all families by name: contents alone and in includes, and whole files."""
    families: dict[str, Callable[[int], Files]] = {
        name: (lambda n, make=make: {'scene.sdf': model(make(n))})  # type: ignore[misc]
        for name, make in CONTENTS.items()}
    return families | FAMILIES


def all_pairs() -> dict[str, Callable[[int], Files]]:
    """Return contents beside each other, and in includes, in merges and under parameters."""
    pairs: dict[str, Callable[[int], Files]] = {
        f'{first} + {second}': partial(pair, first, second)
        for first, second in combinations(CONTENTS, 2)}
    for label, make in (('included', included_contents), ('merged', merged_contents),
                        ('changed', changed_contents)):
        pairs.update({f'{label} {name}': partial(make, name) for name in CONTENTS})
    return pairs


def share_of_promise(load: Load) -> float:
    """Return how much of what a load may take it has taken."""
    if load.outcome.startswith('ENDED'):
        return math.inf
    return max(load.seconds / LONGEST_S, load.memory / MOST_MEMORY,
               load.longest_wait_s / LONGEST_WAIT_S)


def worst_pairs(pairs: dict[str, Callable[[int], Files]], executor: ThreadPoolExecutor) -> (
        dict[str, Callable[[int], Files]]):
    """Measure pairs; return the worst, in this order."""
    loads = dict(zip(pairs, executor.map(
        lambda make: measured(make(largest_n(make, BYTES_OF_PAIR))), pairs.values()),
        strict=True))
    worst = sorted(loads, key=lambda name: -share_of_promise(loads[name]))[:ROWS_OF_PAIRS]
    return {name: pairs[name] for name in worst}


def main() -> int:
    """Print a table; return 1 if anything in it is wrong."""
    parser = argparse.ArgumentParser(prog='growth', description=__doc__)
    parser.add_argument(
        '--only', default='', metavar='TEXT', help='families with this in the name')
    parser.add_argument('--pairs', action='store_true', help='measure pairs')
    parser.add_argument('--workers', type=int, default=os.cpu_count() or 1)
    options = parser.parse_args()
    families = all_pairs() if options.pairs else all_families()
    chosen = {name: make for name, make in families.items() if options.only in name}
    is_well = True
    with ThreadPoolExecutor(options.workers) as executor:
        if options.pairs:
            chosen = worst_pairs(chosen, executor)
        print(f'{"family":{WIDTH}} {"4 n":>7} {"kB":>6} {"s of n, 2 n, 4 n":>20}  '
              f'{"MB more":>17} {"wait":>5}  outcome of 4 n')
        for text, is_row_well in executor.map(lambda item: row(*item), chosen.items()):
            print(text, flush=True)
            is_well &= is_row_well
    return 0 if is_well else 1


if __name__ == '__main__':
    sys.exit(main())
