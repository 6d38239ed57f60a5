# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""From a file to a Scene, against the parse and a walk of its XML, and against libsdformat."""

from __future__ import annotations

from collections.abc import Iterator
import contextlib
from pathlib import Path
import shutil
import subprocess
import sys
import tempfile

from lxml import etree

from benchmarks import worlds
from benchmarks.harness import (
    AtMostTimes,
    benchmark,
    Function,
    Held,
    TimesAsFast,
    Took,
    Unavailable,
)
from sdf_pose_bridge.scene.loading import load

UNITS = 10_000
"""About 22,000 poses."""

MANY_UNITS = 450_000
"""About a million poses."""

POSES_OF_UNIT = 2.2
"""About as many are in each."""

INCLUDED_FILES = 100
ROOT = Path(__file__).resolve().parents[1]
LIBSDFORMAT = Path(__file__).with_name('load_with_libsdformat.cpp')

TIMES = """
import sys, time
from lxml import etree
from sdf_pose_bridge.scene.loading import load

def parse_and_walk(paths):
    for path in paths:
        for element in etree.parse(path).iter():
            element.tag, element.get('name'), element.text

what, small, *paths = sys.argv[1:]
load(small)
parse_and_walk([small])
times = []
while sum(times) < 3.0:
    begin = time.process_time()
    if what == 'load':
        load(paths[0])
    else:
        parse_and_walk(paths)
    times.append(time.process_time() - begin)
print(min(times))
"""
"""
Prints the seconds of processor time of a load or of its yardstick, with that to free the result.

It is the least of as many as 3 s allow, so imports, new memory and other processes do not count.
"""

PEAK = """
import sys
from lxml import etree
from sdf_pose_bridge.scene.loading import load

def peak_kb():
    with open('/proc/self/status') as status:
        return next(int(line.split()[1]) for line in status if line.startswith('VmHWM:'))

what, small, path = sys.argv[1:]
load(small)
before = peak_kb()
result = load(path) if what == 'load' else etree.parse(path)
print((peak_kb() - before) * 1024)
"""
"""Prints by how many bytes a load or a parse raises the peak of the memory."""


@contextlib.contextmanager
def files_of(*texts: str) -> Iterator[list[str]]:
    """Write texts into files for a while."""
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder, f'file_{number}.sdf') for number in range(len(texts))]
        for path, text in zip(paths, texts, strict=True):
            path.write_text(text, encoding='utf-8')
        yield [str(path) for path in paths]


def printed_by(program: str, *arguments: str) -> float:
    """Run a program in a process of its own, whose memory is as that of a new process."""
    return float(subprocess.run(
        [sys.executable, '-c', program, *arguments], cwd=ROOT, check=True, capture_output=True,
        text=True).stdout)


def against_parse_and_walk(*texts: str) -> Iterator[tuple[Function, Function | None]]:
    """
    Compare the load of the first text with the least that reading all of them takes.

    The yardstick parses the files with lxml, and asks each element for its tag, name and text.
    """
    with files_of(worlds.wide_world(10), *texts) as (small, *paths):
        yield (
            lambda: Took(printed_by(TIMES, 'load', small, *paths)),
            lambda: Took(printed_by(TIMES, 'parse and walk', small, *paths)))


@benchmark('file to Scene, wide world of 22,000 poses', counterpart='parse and walk',
           goal=AtMostTimes(6.0))
def wide_and_parse():
    yield from against_parse_and_walk(worlds.wide_world(UNITS))


@benchmark('file to Scene, models nested 20 deep', counterpart='parse and walk',
           goal=AtMostTimes(6.0))
def nested_and_parse():
    yield from against_parse_and_walk(worlds.nested_world(UNITS))


@benchmark('file to Scene, chain of 10,000 links', counterpart='parse and walk',
           goal=AtMostTimes(6.0))
def chain_and_parse():
    yield from against_parse_and_walk(worlds.chain(UNITS))


@benchmark('file to Scene, wide world in version 1.4', counterpart='parse and walk',
           goal=AtMostTimes(7.0))
def old_version_and_parse():
    yield from against_parse_and_walk(worlds.old_world(UNITS))


@benchmark('file to Scene, 100 included files', counterpart='parse and walk of each',
           goal=AtMostTimes(7.0))
def includes_and_parse():
    included = [
        worlds.model_file(f'model_{number}', UNITS // INCLUDED_FILES)
        for number in range(INCLUDED_FILES)]
    with files_of(*included) as paths, files_of(
            worlds.wide_world(10), worlds.including_world(paths)) as (small, world):
        yield (
            lambda: Took(printed_by(TIMES, 'load', small, world)),
            lambda: Took(printed_by(TIMES, 'parse and walk', small, world, *paths)))


@benchmark('file to Scene per pose, 1,000,000 poses', counterpart='per pose, 22,000 poses',
           goal=AtMostTimes(1.3))
def many_and_few():
    with files_of(worlds.wide_world(10), worlds.wide_world(MANY_UNITS),
                  worlds.wide_world(UNITS)) as (small, many, few):
        yield (
            lambda: Took(printed_by(TIMES, 'load', small, many) / (POSES_OF_UNIT * MANY_UNITS)),
            lambda: Took(printed_by(TIMES, 'load', small, few) / (POSES_OF_UNIT * UNITS)))


@benchmark('file to Scene, peak memory, wide world', counterpart='the tree of lxml',
           goal=AtMostTimes(4.0, 'memory'))
def memory_and_tree():
    with files_of(worlds.wide_world(10), worlds.wide_world(UNITS)) as (small, path):
        yield (
            lambda: Held(int(printed_by(PEAK, 'load', small, path))),
            lambda: Held(int(printed_by(PEAK, 'parse', small, path))))


@benchmark('file to Scene, robot of 50 poses', counterpart='lxml.etree.parse',
           goal=TimesAsFast(longest_s=3e-3))
def robot_and_parse():
    path = str(ROOT / 'examples' / 'mobile_robot.sdf')
    yield lambda: load(path), lambda: etree.parse(path)


# libsdformat 12 takes half a minute for the larger world: its time grows faster than the file.
@benchmark('file to Scene, wide world of 5,500 poses', counterpart='libsdformat 12',
           goal=TimesAsFast(20.0))
def wide_and_libsdformat_12():
    yield from against_libsdformat('sdformat12', worlds.wide_world(UNITS // 4))


@benchmark('file to Scene, wide world of 22,000 poses', counterpart='libsdformat 14',
           goal=TimesAsFast(3.0))
def wide_and_libsdformat_14():
    yield from against_libsdformat('sdformat14', worlds.wide_world(UNITS))


def against_libsdformat(
    release: str, text: str,
) -> Iterator[tuple[Function, Function | None]]:
    """Compare the load of a text with that by a release of libsdformat."""
    with files_of(worlds.wide_world(10), text) as (small, path), (
            libsdformat_loader(release)) as program:
        def seconds_of_libsdformat() -> Took:
            printed = subprocess.run(
                [program, path], check=True, capture_output=True, text=True).stdout
            return Took(float(printed.split()[0]))
        yield lambda: Took(printed_by(TIMES, 'load', small, path)), seconds_of_libsdformat


@contextlib.contextmanager
def libsdformat_loader(release: str) -> Iterator[str]:
    """Compile the program that times libsdformat."""
    compiler, pkg_config = shutil.which('g++'), shutil.which('pkg-config')
    if compiler is None or pkg_config is None:
        msg = 'g++ or pkg-config is not installed'
        raise Unavailable(msg)
    flags = subprocess.run(
        [pkg_config, '--cflags', '--libs', release], capture_output=True, text=True, check=False)
    if flags.returncode:
        msg = f'pkg-config does not know {release}'
        raise Unavailable(msg)
    with tempfile.TemporaryDirectory() as folder:
        program = str(Path(folder, 'load'))
        subprocess.run(
            [compiler, '-std=c++17', '-O2', '-o', program, str(LIBSDFORMAT),
             *flags.stdout.split()], check=True)
        yield program
