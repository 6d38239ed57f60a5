# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""From a file to a Scene, against the parse of its XML alone and against libsdformat."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Iterator
import contextlib
from pathlib import Path
import shutil
import subprocess
import sys
import tempfile
import time

from lxml import etree

from benchmarks import worlds
from benchmarks.harness import AtMostAsMuch
from benchmarks.harness import AtMostTimes
from benchmarks.harness import benchmark
from benchmarks.harness import Function
from benchmarks.harness import Held
from benchmarks.harness import TimesAsFast
from benchmarks.harness import Took
from benchmarks.harness import Unavailable
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
RELEASES = ('sdformat14', 'sdformat13', 'sdformat12')

PEAK = """
import sys
from lxml import etree
from sdf_pose_bridge.scene.loading import load

def peak_kb():
    with open('/proc/self/status') as status:
        return next(int(line.split()[1]) for line in status if line.startswith('VmHWM:'))

load(sys.argv[3])
before = peak_kb()
held = load(sys.argv[2]) if sys.argv[1] == 'scene' else etree.parse(sys.argv[2])
print((peak_kb() - before) * 1024)
"""


@contextlib.contextmanager
def files_of(*texts: str) -> Iterator[list[str]]:
    """Write texts into files for a while."""
    with tempfile.TemporaryDirectory() as folder:
        paths = [Path(folder, f'file_{number}.sdf') for number in range(len(texts))]
        for path, text in zip(paths, texts, strict=True):
            path.write_text(text, encoding='utf-8')
        yield [str(path) for path in paths]


def timed(function: Callable[[], object], count: float = 1) -> Took:
    """
    Time one call, and what it takes to free the result.

    Memory that others have freed in many small pieces is put in order before, which would
    otherwise be left to whoever asks for a large piece first.
    """
    bytearray(64_000_000)
    begin = time.perf_counter()
    function()
    return Took((time.perf_counter() - begin) / count)


def against_parse(text: str) -> Iterator[tuple[Function, Function | None]]:
    """Compare the load of a text with its parse."""
    with files_of(text) as (path,):
        yield lambda: timed(lambda: load(path)), lambda: timed(lambda: etree.parse(path))


@benchmark('file to Scene, wide world of 22,000 poses', counterpart='lxml.etree.parse',
           goal=AtMostTimes(3.0))
def wide_and_parse():
    yield from against_parse(worlds.wide_world(UNITS))


@benchmark('file to Scene, models nested 20 deep', counterpart='lxml.etree.parse',
           goal=AtMostTimes(3.0))
def nested_and_parse():
    yield from against_parse(worlds.nested_world(UNITS))


@benchmark('file to Scene, chain of 10,000 links', counterpart='lxml.etree.parse',
           goal=AtMostTimes(3.0))
def chain_and_parse():
    yield from against_parse(worlds.chain(UNITS))


@benchmark('file to Scene, wide world in version 1.4', counterpart='lxml.etree.parse',
           goal=AtMostTimes(4.0))
def old_version_and_parse():
    yield from against_parse(worlds.old_world(UNITS))


@benchmark('file to Scene, 100 included files', counterpart='lxml.etree.parse of each',
           goal=AtMostTimes(4.0))
def includes_and_parse():
    included = [
        worlds.model_file(f'model_{number}', UNITS // INCLUDED_FILES)
        for number in range(INCLUDED_FILES)]
    with files_of(*included) as paths, files_of(worlds.including_world(paths)) as (world,):
        yield (
            lambda: timed(lambda: load(world)),
            lambda: timed(lambda: [etree.parse(path) for path in (world, *paths)]))


@benchmark('file to Scene per pose, 1,000,000 poses', counterpart='per pose, 22,000 poses',
           goal=AtMostTimes(1.3))
def many_and_few():
    with files_of(worlds.wide_world(MANY_UNITS), worlds.wide_world(UNITS)) as (many, few):
        yield (
            lambda: timed(lambda: load(many), POSES_OF_UNIT * MANY_UNITS),
            lambda: timed(lambda: load(few), POSES_OF_UNIT * UNITS))


@benchmark('file to Scene, peak memory, wide world', counterpart='the tree of lxml',
           goal=AtMostAsMuch(4.0))
def memory_and_tree():
    with files_of(worlds.wide_world(UNITS), worlds.wide_world(10)) as (path, small):
        def peak(what: str) -> Held:
            printed = subprocess.run(
                [sys.executable, '-c', PEAK, what, path, small], cwd=ROOT, check=True,
                capture_output=True, text=True).stdout
            return Held(int(printed))
        yield lambda: peak('scene'), lambda: peak('tree')


@benchmark('file to Scene, robot of 50 poses', counterpart='lxml.etree.parse',
           goal=TimesAsFast(longest_s=3e-3))
def robot_and_parse():
    path = str(ROOT / 'examples' / 'mobile_robot.sdf')
    yield lambda: load(path), lambda: etree.parse(path)


# It takes half a minute for the larger world: its time grows faster than the file.
@benchmark('file to Scene, wide world of 5,500 poses', counterpart='libsdformat',
           goal=TimesAsFast(20.0))
def wide_and_libsdformat():
    with files_of(worlds.wide_world(UNITS // 4)) as (path,), libsdformat_loader() as program:
        def seconds_of_libsdformat() -> Took:
            printed = subprocess.run(
                [program, path], check=True, capture_output=True, text=True).stdout
            return Took(float(printed.split()[0]))
        yield lambda: timed(lambda: load(path)), seconds_of_libsdformat


@contextlib.contextmanager
def libsdformat_loader() -> Iterator[str]:
    """Compile the program that times libsdformat."""
    compiler, pkg_config = shutil.which('g++'), shutil.which('pkg-config')
    if compiler is None or pkg_config is None:
        msg = 'g++ or pkg-config is not installed'
        raise Unavailable(msg)
    for release in RELEASES:
        flags = subprocess.run(
            [pkg_config, '--cflags', '--libs', release], capture_output=True, text=True,
            check=False)
        if not flags.returncode:
            break
    else:
        msg = 'libsdformat is not installed (Debian: libsdformat-dev)'
        raise Unavailable(msg)
    with tempfile.TemporaryDirectory() as folder:
        program = str(Path(folder, 'load'))
        subprocess.run(
            [compiler, '-std=c++17', '-O2', '-o', program, str(LIBSDFORMAT),
             *flags.stdout.split()], check=True)
        yield program
