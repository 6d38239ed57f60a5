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

from differential.batches import compare_scenes, Tally, write_scene
from differential.reference import built_reference, ReferenceMissingError
from differential.scene_parts import Feature, features_of_release

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / 'build' / 'differential'


def main() -> int:
    """Run the comparison that the command line asks for."""
    parser = argparse.ArgumentParser(
        prog='differential', description='Compare the package with libsdformat on random scenes.')
    parser.add_argument('--scenes', type=int, default=10_000, help='how many (default: 10000)')
    parser.add_argument('--seed', type=int, default=0, help='another seed gives other scenes')
    parser.add_argument('--without', action='append', default=[], metavar='FEATURE',
                        choices=[feature.value for feature in Feature],
                        help='leave out: ' + ', '.join(feature.value for feature in Feature))
    parser.add_argument('--reference-only', action='store_true',
                        help='only check the scenes themselves: libsdformat has to accept the '
                        'valid ones and to refuse the broken ones')
    parser.add_argument('--folder', type=Path, default=FOLDER,
                        help='for the compiled program and for scenes that differ')
    arguments = parser.parse_args()
    features = frozenset(f for f in Feature if f.value not in arguments.without)
    try:
        reference = built_reference(arguments.folder)
    except ReferenceMissingError as error:
        print(f'differential: {error}', file=sys.stderr)
        return 2
    features &= features_of_release(reference.version)
    print(f'libsdformat {reference.version}, {arguments.scenes} scenes, seed {arguments.seed}, '
          f'with {", ".join(sorted(f.value for f in features)) or "nothing special"}')
    started, told = time.monotonic(), time.monotonic()
    tally = Tally()
    with contextlib.suppress(KeyboardInterrupt):  # Ctrl-C ends the drawing, not the report
        for tally in compare_scenes(reference, arguments.scenes, arguments.seed, features,
                                    reference_only=arguments.reference_only):
            if time.monotonic() - told > 10:
                told = time.monotonic()
                print(f'  {tally.scenes} scenes, {len(tally.differences)} differences', flush=True)
    report(tally, time.monotonic() - started)
    folder = arguments.folder / 'differences' / f'seed_{arguments.seed}'
    write_differences(tally, folder)
    return 1 if tally.differences else 0


def report(tally: Tally, seconds: float) -> None:
    """Print what was compared."""
    traits = ', '.join(f'{count} with {trait}' for trait, count in sorted(tally.traits.items()))
    print(f'{tally.scenes} scenes ({len(tally.distinct)} distinct'
          f'{", " + traits if traits else ""}), {tally.poses} poses, {tally.refused} refused, '
          f'{seconds:.0f} s')
    print(f'first error of libsdformat: also the first one here in {tally.same_first_code} '
          f'refused scenes, a later one in {tally.later_first_code}; moments of inertia, which '
          f'are not checked here, in {tally.wrong_moments}')
    print(f'{len(tally.differences)} differences')


def write_differences(tally: Tally, folder: Path) -> None:
    """Write all scenes that differ."""
    shutil.rmtree(folder, ignore_errors=True)
    for name, scene, difference in tally.differences:
        path = write_scene(scene.files, folder, name)
        text = f'{difference.kind} {scene.defect}\n{difference.text}\n'
        (path.parent / 'difference.txt').write_text(text, encoding='utf-8')
        print(f'{path}: {text}')


if __name__ == '__main__':
    sys.exit(main())
