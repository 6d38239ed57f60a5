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
from differential.minimal import minimal_scene
from differential.reference import built_reference, Reference, ReferenceMissingError
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
    parser.add_argument('--show', type=int, default=5,
                        help='how many differences to cut down and write (default: 5)')
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
    write_differences(tally, reference, folder, arguments.show)
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


def write_differences(tally: Tally, reference: Reference, folder: Path, most: int) -> None:
    """Write all scenes that differ, and cut some of them down, one of each sort first."""
    shutil.rmtree(folder, ignore_errors=True)
    seen: dict[str, int] = {}
    ranked = []
    for entry in tally.differences:
        sort = f'{entry[2].kind} {entry[1].defect}'
        seen[sort] = seen.get(sort, 0) + 1
        ranked.append((seen[sort], entry))
        path = write_scene(entry[1].files, folder / 'whole', entry[0])
        text = f'{sort}\n{entry[2].text}\n'
        (path.parent / 'difference.txt').write_text(text, encoding='utf-8')
        print(f'{entry[0]}: {sort}: {entry[2].text}')
    for _, (name, scene, difference) in sorted(ranked, key=lambda pair: pair[0])[:most]:
        print(f'\n{name} ({difference.kind}{", " if scene.defect else ""}{scene.defect})')
        files, text = scene.files, difference.text
        if difference.kind != 'intent':
            # What a scene is meant to be does not survive cutting.
            files, text = minimal_scene(scene, reference)
        path = write_scene(files, folder / 'cut', name)
        (path.parent / 'difference.txt').write_text(text + '\n', encoding='utf-8')
        print(f'  {text}\n  {path}')
        for part in sorted(files):
            print('\n'.join(f'  | {line}' for line in [f'{part}:', *files[part].split('\n')]))


if __name__ == '__main__':
    sys.exit(main())
