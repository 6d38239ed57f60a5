# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Time two things in turns and set the results beside each other, with the goal.

A benchmark is a context manager with a decorator. It prepares what it needs, yields two functions,
and cleans up::

    @benchmark('sorting', counterpart='copying', goal=AtMostTimes(10.0))
    def sorting():
        numbers = [random.random() for _ in range(10_000)]
        yield lambda: sorted(numbers), numbers.copy

A benchmark whose preparation raises ImportError or :class:`Unavailable` is skipped, and the
reason is printed in its place.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
import dataclasses
import gc
import statistics
import time
from typing import NamedTuple, Protocol, TypeAlias

RUNS = 9
"""Runs of each of the two, in turns; the median counts."""

SHORTEST_RUN_S = 0.02
"""Short functions are called in a loop until a run takes this long, so that the clock is exact."""

DEADLINE_S = 60.0
"""Longest time for which a benchmark waits for something that has to happen."""

DOMAINS = range(215, 233)
"""ROS domains of benchmarks; tests, which may run meanwhile, have others."""

Function: TypeAlias = Callable[[], object]
Preparation: TypeAlias = Callable[[], Iterator[tuple[Function, Function | None]]]


class Unavailable(Exception):  # noqa: N818 - nothing went wrong
    """Something that a benchmark needs is not on this machine."""


def wait_until(has_happened: Callable[[], bool], what: str) -> None:
    """
    Wait for something that has to happen.

    :param what: what did not happen if it takes too long.
    """
    deadline = time.monotonic() + DEADLINE_S
    while not has_happened():
        if time.monotonic() > deadline:
            msg = f'{what} within {DEADLINE_S:g} s'
            raise Unavailable(msg)
        time.sleep(0.1)


class Took(NamedTuple):
    """Returned by a function that has measured itself, because its own time is not what counts."""

    seconds: float
    """What counts."""


class Held(NamedTuple):
    """Returned by a function that has measured how much memory something takes."""

    bytes_: int


class Medians(NamedTuple):
    """What was measured."""

    ours_s: float
    """Seconds that one call takes; bytes where memory is measured."""
    counterpart_s: float | None
    """Seconds that one call of the counterpart takes, if there is one."""


class Goal(Protocol):
    """What the medians of a benchmark shall be."""

    def ratio(self, medians: Medians) -> str:
        """Say how the two compare."""
        ...

    def is_reached(self, medians: Medians) -> bool | None:
        """Tell whether it is good enough; None if nothing was asked for."""
        ...


class AtMostTimes(NamedTuple):
    """Ours may take so many times what the counterpart takes."""

    limit: float
    what: str = 'time'
    """What is measured: "time" or "memory"."""

    def __str__(self) -> str:
        return f'at most {self.limit:g} times the {self.what}'

    def ratio(self, medians: Medians) -> str:
        """Say how many times what the counterpart takes ours takes."""
        return f'{_quotient(medians):.2f} times the {self.what}'

    def is_reached(self, medians: Medians) -> bool | None:
        """Tell whether ours keeps within the limit."""
        return _quotient(medians) <= self.limit


class TimesAsFast(NamedTuple):
    """Ours has to be so many times as fast as the counterpart, and may be limited besides."""

    factor: float | None = None
    """None shows the ratio without a goal."""
    longest_s: float | None = None
    """Longest time that one call may take."""

    def __str__(self) -> str:
        parts = []
        if self.factor is not None:
            parts.append(f'at least {self.factor:g} times as fast')
        if self.longest_s is not None:
            parts.append(f'under {time_text(self.longest_s)}')
        return ', '.join(parts) or '-'

    def ratio(self, medians: Medians) -> str:
        """Say how many times as fast as the counterpart ours is, or how many times as slow."""
        quotient = _quotient(medians)
        if self.factor is None and quotient > 1.0:
            return f'{quotient:.2f} times the time'
        return f'{1.0 / quotient:.1f} times as fast'

    def is_reached(self, medians: Medians) -> bool | None:
        """Tell whether ours is as fast as asked."""
        if self.factor is None and self.longest_s is None:
            return None
        return (self.factor is None or 1.0 / _quotient(medians) >= self.factor) and (
            self.longest_s is None or medians.ours_s < self.longest_s
        )


class PerSecond(NamedTuple):
    """Ours has to get so much done in a second."""

    rate: float
    items: int
    """How many are done by one call."""
    item: str
    """What they are called, in the plural."""

    def __str__(self) -> str:
        return f'at least {self.rate:,.0f} {self.item} per second'

    def ratio(self, medians: Medians) -> str:
        """Say how many are done in a second."""
        return f'{self.items / medians.ours_s:,.0f} {self.item} per second'

    def is_reached(self, medians: Medians) -> bool | None:
        """Tell whether enough is done in a second."""
        return self.items / medians.ours_s >= self.rate


@dataclasses.dataclass(frozen=True, slots=True)
class Benchmark:
    """Two functions to be timed, and what the comparison shall show."""

    what: str
    counterpart: str
    goal: Goal
    prepare: Preparation


def benchmark(
    what: str, *, counterpart: str, goal: Goal,
) -> Callable[[Preparation], Benchmark]:
    """
    Make a benchmark of a generator function that yields the two functions once.

    :param what: what ours does, in a few words.
    :param counterpart: what it is compared with.
    :param goal: what the comparison shall show.
    :return: a decorator.
    """
    def decorate(prepare: Preparation) -> Benchmark:
        return Benchmark(what, counterpart, goal, prepare)
    return decorate


class Result(NamedTuple):
    """One line of the table."""

    what: str
    ours: str
    counterpart: str
    ratio: str
    goal: str
    reached: str


def result_of(bench: Benchmark) -> Result:
    """
    Run one benchmark.

    :param bench: the benchmark.
    :return: its line; of one that cannot run here, with the reason.
    """
    try:
        with contextmanager(bench.prepare)() as (ours, counterpart):
            medians = medians_of(ours, counterpart)
    except ImportError as error:
        return _skipped(bench, f'{error.name or error} is not installed')
    except Unavailable as reason:
        return _skipped(bench, str(reason))
    reached = bench.goal.is_reached(medians)
    is_memory = isinstance(bench.goal, AtMostTimes) and bench.goal.what == 'memory'
    text = memory_text if is_memory else time_text
    return Result(
        bench.what,
        text(medians.ours_s),
        bench.counterpart if medians.counterpart_s is None
        else f'{bench.counterpart}: {text(medians.counterpart_s)}',
        bench.goal.ratio(medians),
        str(bench.goal),
        {True: 'yes', False: 'NO', None: '-'}[reached],
    )


def medians_of(ours: Function, counterpart: Function | None) -> Medians:
    """
    Time two functions in turns, so that whatever else the machine does meets both.

    :param ours: the first function.
    :param counterpart: the second, if there is one.
    :return: the median of the seconds that one call takes, of each.
    """
    functions = [ours] if counterpart is None else [ours, counterpart]
    loops = [_loops(function) for function in functions]
    times: list[list[float]] = [[] for _ in functions]
    was_collecting = gc.isenabled()
    gc.disable()
    try:
        for _ in range(RUNS):
            for function, count, seconds in zip(functions, loops, times, strict=True):
                seconds.append(_time_of(function, count) / count)
    finally:
        if was_collecting:
            gc.enable()
    medians = [statistics.median(seconds) for seconds in times]
    return Medians(medians[0], medians[1] if counterpart is not None else None)


def table(results: list[Result]) -> str:
    """
    Lay out results in columns.

    :param results: any number of them.
    :return: lines of text, the first one being the names of the columns.
    """
    rows = [Result(*Result._fields), *results]
    widths = [max(len(row[column]) for row in rows) for column in range(len(Result._fields))]
    lines = [
        '  '.join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]
    lines.insert(1, '  '.join('-' * width for width in widths))
    return '\n'.join(lines)


def time_text(seconds: float) -> str:
    """Write a time with three digits and the unit that fits."""
    for unit, size in (('s', 1.0), ('ms', 1e-3), ('µs', 1e-6)):
        if seconds >= size:
            return f'{seconds / size:.3g} {unit}'
    return f'{seconds / 1e-9:.3g} ns'


def memory_text(size: float) -> str:
    """Write a number of bytes."""
    return f'{size / 1e6:.3g} MB'


def _quotient(medians: Medians) -> float:
    if medians.counterpart_s is None:
        msg = 'this goal needs a counterpart to compare with'
        raise ValueError(msg)
    return medians.ours_s / medians.counterpart_s


def _skipped(bench: Benchmark, reason: str) -> Result:
    return Result(
        bench.what, '-', bench.counterpart, f'skipped: {reason}', str(bench.goal), 'skipped'
    )


def _loops(function: Function) -> int:
    """Return how many calls make a run long enough; the calls warm up caches besides."""
    count = 1
    if isinstance(function(), Took | Held):
        return count
    while (seconds := _time_of(function, count)) < SHORTEST_RUN_S:
        count = max(2 * count, int(1.1 * count * SHORTEST_RUN_S / max(seconds, 1e-6)))
    return count


def _time_of(function: Function, count: int) -> float:
    turns = range(count)
    result = None
    start = time.perf_counter()
    for _ in turns:
        result = function()
    seconds = time.perf_counter() - start
    if isinstance(result, Held):
        return float(result.bytes_)
    return result.seconds * count if isinstance(result, Took) else seconds
