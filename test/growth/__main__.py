# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Print how the time and the memory of a load grow with n, 2 n and 4 n, for each family of files.

A file of 4 n has the given size, with all that it includes. A row has the exponent of the growth
from n to 4 n: 1 is growth in proportion to n, 2 is growth with its square. Families in which each
of n includes copies n elements have 2 until the limit of copied elements ends the load.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial
import math
import os
from pathlib import Path
import resource
import subprocess
import sys
import tempfile
from typing import NamedTuple

from growth.families import AROUND, FILES, Files, files_of, PARTS, write

WIDTH = 40
"""Of the column of names."""

LONGEST_S = 30
"""A process that needs more processor time is ended."""

SHORTEST_S, SMALLEST_BYTES = 0.2, 20_000_000
"""The growth to less than this is noise."""


class Load(NamedTuple):
    """One load, as it was measured."""

    seconds: float
    memory: float
    outcome: str


def measured(files):
    """Load files in a process of its own."""
    with tempfile.TemporaryDirectory(prefix='growth_') as folder:
        process = subprocess.run(
            [sys.executable, '-m', 'growth.measurement', str(write(files, Path(folder)))],
            check=False, capture_output=True, text=True,
            env={**os.environ, 'GZ_FUEL_CACHE_PATH': str(Path(folder, 'fuel'))},
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (LONGEST_S, LONGEST_S)))
    if process.returncode:
        reason = process.stderr.strip().rpartition('\n')[2] or f'exit code {process.returncode}'
        return Load(LONGEST_S, math.nan, f'ENDED: {reason[:80]}')
    seconds, memory, outcome = process.stdout.strip().split(' ', 2)
    return Load(float(seconds), float(memory), outcome)


def size_of(files):
    """Return how many bytes files have together."""
    return sum(len(text.encode(errors='surrogateescape')) for text in files.values())


def largest_n(family, most_bytes):
    """Return for which n, to an eighth, the files of a family have about so many bytes."""
    n = 4
    while n < 50_000 and size_of(family(2 * n)) <= most_bytes:
        n *= 2
    return max((n + i * n // 8 for i in range(8) if size_of(family(n + i * n // 8)) <= most_bytes),
               default=n)


def exponent(first, last, smallest):
    """Return the exponent of the growth from n to 4 n."""
    is_noise = last < smallest or first <= 0.0
    return '' if is_noise else f'{math.log(last / first, 4.0):.1f}'


def row(name, family, most_bytes):
    """Measure a family; return a row of the table."""
    n = max(largest_n(family, most_bytes) // 4, 1)
    loads = [measured(family(count)) for count in (n, 2 * n, 4 * n)]
    first, _, last = loads
    seconds = ' '.join(f'{load.seconds:6.2f}' for load in loads)
    memory = ' '.join(f'{load.memory / 1e6:5.0f}' for load in loads)
    return (f'{name:{WIDTH}} {4 * n:7} {size_of(family(4 * n)) / 1e3:6.0f} {seconds} '
            f'{exponent(first.seconds, last.seconds, SHORTEST_S):>4}  {memory} '
            f'{exponent(first.memory, last.memory, SMALLEST_BYTES):>4}  {last.outcome[:60]}')


def main():
    """Print the table; return 1 if a process was ended."""
    parser = argparse.ArgumentParser(prog='growth', description=__doc__)
    parser.add_argument(
        '--only', default='', metavar='TEXT', help='families with this in the name')
    parser.add_argument(
        '--around', choices=AROUND, help='only contents of models, and what is around them')
    parser.add_argument('--kilobytes', type=int, default=1000, help='size of the files of 4 n')
    options = parser.parse_args()
    families: dict[str, Callable[[int], Files]] = {
        name: partial(files_of, name, around=options.around or 'model')
        for name in (*PARTS, *(FILES if options.around is None else ()))}
    print(f'{"family":{WIDTH}} {"4 n":>7} {"kB":>6} {"s of n, 2 n, 4 n":>20} {"exp.":>4}  '
          f'{"MB more":>17} {"exp.":>4}  outcome of 4 n')
    has_ended = False
    for name, family in families.items():
        if options.only in name:
            text = row(name, family, 1000 * options.kilobytes)
            has_ended |= 'ENDED' in text
            print(text, flush=True)
    return int(has_ended)


if __name__ == '__main__':
    sys.exit(main())
