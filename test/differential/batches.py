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

from differential.comparison import Difference, difference_between, is_comparable, own_answer
from differential.reference import Answer, Reference
from differential.scene_builder import random_scene, SceneFiles
from differential.scene_setting import with_pose_set

BATCH = 200


@dataclass
class Tally:
    """What a run found."""

    scenes: int = 0
    distinct: set[int] = field(default_factory=set)
    poses: int = 0
    refused: int = 0
    not_comparable: int = 0
    """Scenes that end libsdformat, or have moments of inertia that the package does not check."""
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
    own: list[Answer]


def compare_scenes(reference: Reference, count: int, first_seed: int) -> Iterator[Tally]:
    """
    Compare the package with libsdformat on random scenes.

    :param reference: libsdformat.
    :param count: how many scenes.
    :param first_seed: seed of the run.
    :return: the same tally after each batch, updated.
    """
    tally = Tally()
    pending: Batch | None = None
    try:
        for start in range(0, count, BATCH):
            number = first_seed * 1_000_003 + start // BATCH
            dice = Random(number)
            drawn = [drawn_scene(dice) for _ in range(min(BATCH, count - start))]
            # libsdformat was busy with the batch before while this one was drawn.
            if pending:
                add_batch(tally, pending, reference)
                yield tally
            pending = start_batch(reference, drawn, number)
        if pending:
            add_batch(tally, pending, reference)
            pending = None
            yield tally
    finally:
        if pending:
            pending.process.kill()
            pending.process.wait()
            shutil.rmtree(pending.folder)


def drawn_scene(dice: Random) -> SceneFiles:
    """Draw a scene; in one of ten, a pose is set."""
    scene = random_scene(dice)
    return with_pose_set(scene, dice) if dice.randrange(10) == 0 else scene


def start_batch(reference: Reference, drawn: list[SceneFiles], number: int) -> Batch:
    """Write a batch, start libsdformat on it and resolve it with the package meanwhile."""
    folder = Path(tempfile.mkdtemp(prefix='differential-'))
    names = [f'seed_{number}_scene_{position}' for position in range(len(drawn))]
    paths = [scene.write(folder, name) for scene, name in zip(drawn, names, strict=True)]
    process = reference.start(paths, folder)
    own = [own_answer(path, folder) for path in paths]
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
        difference = difference_between(own, answer, scene.traits)
        if not is_comparable(answer):
            tally.not_comparable += 1
        elif not own.accepted and not answer.accepted:
            is_first = own.codes[0] == answer.codes[0]
            tally.same_first_code += is_first
            tally.later_first_code += not is_first and answer.codes[0] in own.codes
        if difference:
            tally.differences.append((name, scene, difference))
