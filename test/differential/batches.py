# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Draw scenes in batches, have both sides resolve them, and collect what differs."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
import tempfile

from differential.comparison import Difference, difference_between, is_comparable, own_answer
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


def compare_scenes(reference, count, first_seed):
    """
    Compare the package with libsdformat on random scenes.

    :param reference: libsdformat.
    :param count: how many scenes.
    :param first_seed: seed of the run.
    :return: the same tally after each batch, updated.
    """
    tally = Tally()
    for start in range(0, count, BATCH):
        number = first_seed * 1_000_003 + start // BATCH
        dice = Random(number)
        scenes = {
            f'seed_{number}_scene_{position}': drawn_scene(dice)
            for position in range(min(BATCH, count - start))}
        with tempfile.TemporaryDirectory(prefix='differential-') as folder:
            add_batch(tally, scenes, Path(folder), reference)
        yield tally


def drawn_scene(dice):
    """Draw a scene; in one of ten, a pose is set."""
    scene = random_scene(dice)
    return with_pose_set(scene, dice) if dice.randrange(10) == 0 else scene


def add_batch(tally, scenes, folder, reference):
    """Have both sides resolve scenes at the same time, compare, and add to the tally."""
    paths = [scene.write(folder, name) for name, scene in scenes.items()]
    process = reference.start(paths, folder)
    owns = [own_answer(path, folder) for path in paths]
    answers = reference.finish(process, paths, folder)
    for (name, scene), own, answer in zip(scenes.items(), owns, answers, strict=True):
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
