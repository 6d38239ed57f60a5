# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Compare the package with libsdformat on many random scenes.

``PYTHONPATH=test python -m differential`` from the root of the repository. The exit code is 0
where nothing differs, 1 where something does, 2 where libsdformat is missing.
"""

from __future__ import annotations

import argparse
import contextlib
from pathlib import Path
import shutil
import sys
import time

from differential.batches import compare_scenes, Tally
from differential.reference import built_reference, ReferenceMissingError

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / 'build' / 'differential'


def main():
    """Run the comparison that the command line asks for."""
    parser = argparse.ArgumentParser(
        prog='differential', description='Compare the package with libsdformat on random scenes.')
    parser.add_argument('--scenes', type=int, default=10_000, help='how many (default: 10000)')
    parser.add_argument('--seed', type=int, default=0, help='another seed gives other scenes')
    parser.add_argument('--folder', type=Path, default=FOLDER,
                        help='for the compiled program and for scenes that differ')
    arguments = parser.parse_args()
    try:
        reference = built_reference(arguments.folder)
    except ReferenceMissingError as error:
        print(f'differential: {error}', file=sys.stderr)
        return 2
    print(f'libsdformat {reference.version}, {arguments.scenes} scenes, seed {arguments.seed}')
    started, told = time.monotonic(), time.monotonic()
    tally = Tally()
    with contextlib.suppress(KeyboardInterrupt):  # Ctrl-C ends the drawing, not the report
        for tally in compare_scenes(reference, arguments.scenes, arguments.seed):
            if time.monotonic() - told > 10:
                told = time.monotonic()
                print(f'  {tally.scenes} scenes, {len(tally.differences)} differences', flush=True)
    report(tally, time.monotonic() - started)
    folder = arguments.folder / 'differences' / f'seed_{arguments.seed}'
    write_differences(tally, folder)
    return 1 if tally.differences else 0


def report(tally, seconds):
    """Print what was compared."""
    traits = ', '.join(f'{count} with {trait}' for trait, count in sorted(tally.traits.items()))
    print(f'{tally.scenes} scenes ({len(tally.distinct)} distinct'
          f'{", " + traits if traits else ""}), {tally.poses} poses, {tally.refused} refused, '
          f'{seconds:.0f} s')
    print(f'first error of libsdformat: also the first one here in {tally.same_first_code} '
          f'refused scenes, a later one in {tally.later_first_code}; not compared, as libsdformat '
          f'ends or refuses moments of inertia: {tally.not_comparable}')
    print(f'{len(tally.differences)} differences')


def write_differences(tally, folder):
    """Write all scenes that differ."""
    shutil.rmtree(folder, ignore_errors=True)
    for name, scene, difference in tally.differences:
        path = scene.write(folder, name)
        text = f'{difference.kind}\n{difference.text}\n'
        (path.parent / 'difference.txt').write_text(text, encoding='utf-8')
        print(f'{path}: {text}')


if __name__ == '__main__':
    sys.exit(main())
