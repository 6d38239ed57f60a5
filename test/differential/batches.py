# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Draw scenes in batches, have both sides resolve them, and collect what differs."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
import shutil
import subprocess
import tempfile

from differential.comparison import (
    Difference,
    difference_between,
    has_wrong_moments,
    own_answer,
)
from differential.reference import Answer, Reference
from differential.scene_builder import random_scene
from differential.scene_parts import Feature, SCENE, SceneFiles
from differential.scene_values import ODD_VALUES

BATCH = 200


@dataclass
class Tally:
    """What a run found."""

    scenes: int = 0
    distinct: set[int] = field(default_factory=set)
    poses: int = 0
    refused: int = 0
    wrong_moments: int = 0
    """Refused scenes with moments of inertia that the package does not check."""
    same_first_code: int = 0
    later_first_code: int = 0
    """Refused scenes in which the first error of libsdformat is a later one here."""
    traits: Counter[str] = field(default_factory=Counter)
    differences: list[tuple[str, SceneFiles, Difference]] = field(default_factory=list)
    """Name of the scene, the scene and what differs."""


@dataclass
class Batch:
    """Scenes that are being resolved."""

    names: list[str]
    scenes: list[SceneFiles]
    paths: list[Path]
    folder: Path
    process: subprocess.Popen[str]
    own: list[Answer | None]


def write_scene(files: dict[str, str], folder: Path, name: str) -> Path:
    """
    Write a scene's files.

    :param files: texts by path.
    :param folder: folder of the batch.
    :param name: name of the scene's own folder in it.
    :return: path of the scene itself.
    """
    for path, text in files.items():
        target = folder / name / path
        target.parent.mkdir(parents=True, exist_ok=True)
        # Line ends stay as they were drawn.
        target.write_bytes(text.replace(SCENE, name).encode(errors='surrogateescape'))
    return folder / name / 'scene.sdf'


def compare_scenes(reference: Reference, count: int, first_seed: int,
                   features: frozenset[Feature], *,
                   reference_only: bool = False) -> Iterator[Tally]:
    """
    Compare the package with libsdformat on random scenes.

    :param reference: libsdformat.
    :param count: how many scenes.
    :param first_seed: seed of the run.
    :param features: what the scenes may hold.
    :param reference_only: only check that libsdformat accepts what is meant to be valid, and
        refuses the rest.
    :return: the same tally after each batch, updated.
    """
    tally = Tally()
    pending: Batch | None = None
    try:
        for start in range(0, count, BATCH):
            number = first_seed * 1_000_003 + start // BATCH
            dice = Random(number)
            drawn = [random_scene(dice, features) for _ in range(min(BATCH, count - start))]
            # libsdformat was busy with the batch before while this one was drawn.
            if pending:
                add_batch(tally, pending, reference)
                yield tally
            pending = start_batch(reference, drawn, number, reference_only=reference_only)
        if pending:
            add_batch(tally, pending, reference)
            pending = None
            yield tally
    finally:
        if pending:
            pending.process.kill()
            pending.process.wait()
            shutil.rmtree(pending.folder)


def start_batch(reference: Reference, drawn: list[SceneFiles], number: int, *,
                reference_only: bool) -> Batch:
    """Write a batch, start libsdformat on it and resolve it with the package meanwhile."""
    folder = Path(tempfile.mkdtemp(prefix='differential-'))
    names = [f'seed_{number}_scene_{position}' for position in range(len(drawn))]
    paths = [write_scene(scene.files, folder, name)
             for scene, name in zip(drawn, names, strict=True)]
    process = reference.start(paths, folder)
    own = [None if reference_only else own_answer(path, folder) for path in paths]
    return Batch(names, drawn, paths, folder, process, own)


def add_batch(tally: Tally, batch: Batch, reference: Reference) -> None:
    """Wait for libsdformat's answers on a batch, compare, and add to the tally."""
    answers = reference.finish(batch.process, batch.paths, batch.folder)
    shutil.rmtree(batch.folder)
    for name, scene, own, answer in zip(batch.names, batch.scenes, batch.own, answers,
                                        strict=True):
        tally.scenes += 1
        tally.distinct.add(hash(tuple(scene.files.values())))
        tally.poses += len(answer.poses)
        tally.refused += not answer.accepted
        tally.traits.update(scene.traits)
        difference = difference_from_intent(scene, answer)
        if own is not None:
            difference = difference_between(own, answer, scene.traits) or difference
            if has_wrong_moments(answer):
                tally.wrong_moments += 1
            elif not own.accepted and not answer.accepted:
                is_first = own.codes[0] == answer.codes[0]
                tally.same_first_code += is_first
                tally.later_first_code += not is_first and answer.codes[0] in own.codes
        if difference:
            tally.differences.append((name, scene, difference))


def difference_from_intent(scene: SceneFiles, answer: Answer) -> Difference | None:
    """Check libsdformat's verdict against what the scene was meant to be."""
    if ODD_VALUES in scene.traits:
        return None
    if scene.defect and answer.accepted:
        return Difference('intent', f'meant to be invalid by {scene.defect}, but accepted')
    if not scene.defect and not answer.accepted:
        said = f'{answer.codes[0]}: {answer.message}'
        return Difference('intent', f'meant to be valid, but libsdformat says {said}')
    return None
