# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Search for inputs that end a load with anything but a scene or an SdfError.

A finding is an exception, a load that takes more than two seconds of processor time, or more than
1 GB of memory. It ends the run, and its input is kept in the folder of findings.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
import contextlib
from pathlib import Path
from random import Random
import sys
import tempfile
import time

import atheris

with atheris.instrument_imports(include=['sdf_pose_bridge']):
    from sdf_pose_bridge import load, load_text, SdfError
    import sdf_pose_bridge.sdformat.include.expansion  # noqa: F401  # else imported at first use
    from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

from differential.scene_builder import random_scene

ROOT = Path(__file__).resolve().parents[2]
LONGEST_S = 2.0
MEMORY = '/dev/shm' if Path('/dev/shm').is_dir() else None
LIMITS = ('-timeout=100', '-report_slow_units=100', '-rss_limit_mb=1024', '-max_len=20000')


@contextlib.contextmanager
def limited():
    """Refuse what takes too long, and let errors of files pass."""
    begin = time.process_time()
    with contextlib.suppress(SdfError):
        yield
    seconds = time.process_time() - begin
    assert seconds < LONGEST_S, f'the load has taken {seconds:.1f} s'


def load_bytes(data):
    """Load bytes as the content of a file."""
    with limited():
        load_text(data, str(ROOT / 'examples' / 'fuzzed.sdf'))


class Dice(Random):
    """Draws from bytes, so that similar bytes make similar scenes."""

    def __init__(self, data):
        super().__init__()
        self._provider = atheris.FuzzedDataProvider(data)

    def random(self):
        """Return a number from 0 to 1."""
        return self.getrandbits(32) / 2 ** 32

    def getrandbits(self, k):
        """Return a number of k bits."""
        return self._provider.ConsumeIntInRange(0, 2 ** k - 1)


def load_scene(data):
    """Load a scene of one or several files, some of which are wrong."""
    scene = random_scene(Dice(data))
    with tempfile.TemporaryDirectory(dir=MEMORY) as folder:
        path = scene.write(Path(folder), 'scene')
        with limited():
            tf_tree_from_scene(
                load(path, resource_paths=[folder]), TfOptions(use_joint_states=True))


TARGETS: dict[str, Callable[[bytes], object]] = {'bytes': load_bytes, 'scenes': load_scene}


def main():
    """Fuzz one target for some minutes."""
    parser = argparse.ArgumentParser(prog='fuzzing', description=__doc__)
    parser.add_argument('target', choices=TARGETS)
    parser.add_argument('--seconds', type=int, default=60)
    parser.add_argument('--findings', type=Path, default=ROOT / 'fuzz_findings')
    options = parser.parse_args()
    options.findings.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory() as corpus:
        for number, path in enumerate([*ROOT.glob('examples/*.sdf'), *ROOT.glob('test/**/*.sdf')]):
            Path(corpus, str(number)).write_bytes(path.read_bytes())
        atheris.Setup([
            sys.argv[0], *LIMITS, f'-max_total_time={options.seconds}',
            f'-artifact_prefix={options.findings}/', corpus], TARGETS[options.target])
        atheris.Fuzz()


if __name__ == '__main__':
    main()
