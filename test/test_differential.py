# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The package against libsdformat: a fixed share of the random scenes, and the examples.

``make differential`` compares many more.
"""

from pathlib import Path
from random import Random

from differential.batches import compare_scenes
from differential.comparison import difference_between, own_answer
from differential.reference import Answer, built_reference, CRASH, ReferenceMissingError
from differential.scene_builder import random_scene
import pytest

ROOT = Path(__file__).resolve().parents[1]
EXAMPLES = sorted((ROOT / 'examples').rglob('*.sdf'))
SCENES = 80


@pytest.fixture(scope='module')
def reference():
    try:
        return built_reference(ROOT / 'build' / 'differential')
    except ReferenceMissingError as error:
        pytest.skip(str(error))


@pytest.mark.parametrize('example', EXAMPLES, ids=lambda path: path.stem)
def test_example_is_resolved_as_by_libsdformat(reference, example, tmp_path):
    expected = reference.answers([example], tmp_path)[0]
    assert expected.accepted
    assert difference_between(own_answer(example, tmp_path), expected) is None


def test_random_scenes_are_resolved_as_by_libsdformat(reference):
    *_, tally = compare_scenes(reference, SCENES, 20260101)
    assert tally.scenes == SCENES
    assert [(name, difference.text) for name, _, difference in tally.differences] == []


def test_random_scenes_are_resolved_or_refused(tmp_path):
    dice = Random(1)
    answers = [
        own_answer(random_scene(dice).write(tmp_path, f'scene_{number}'), tmp_path)
        for number in range(SCENES)]
    assert [answer.message for answer in answers if CRASH in answer.codes] == []
    assert {answer.accepted for answer in answers} == {True, False}


ONE_LINK = {('', 'link', 'm::l'): (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0)}
ACCEPTED = Answer(True, (), '', ONE_LINK)
REFUSED = Answer(False, ('DUPLICATE_NAME',), 'twice', {})


@pytest.mark.parametrize(('own', 'expected', 'kind'), [
    (ACCEPTED, REFUSED, 'accepted'),
    (REFUSED, ACCEPTED, 'refused'),
    (REFUSED, Answer(False, ('RESERVED_NAME',), 'world', {}), 'code'),
    (Answer(True, (), '', {}), ACCEPTED, 'missing'),
    (ACCEPTED, Answer(True, (), '', {}), 'extra'),
    (Answer(False, (CRASH,), 'KeyError: 1', {}), REFUSED, 'crash'),
])
def test_disagreement_is_found(own, expected, kind):
    assert difference_between(own, expected).kind == kind


@pytest.mark.parametrize(('own', 'expected'), [
    (Answer(False, ('RESERVED_NAME', 'DUPLICATE_NAME'), 'world', {}), REFUSED),
    (ACCEPTED, Answer(False, (CRASH,), 'exit code -6', {})),
    (ACCEPTED, Answer(False, ('LINK_INERTIA_INVALID',), 'A link named l has invalid inertia', {})),
])
def test_what_may_differ(own, expected):
    assert difference_between(own, expected) is None


@pytest.mark.parametrize('pose', [
    (1.0, 2.0, 3.0 + 1e-8, 0.0, 0.0, 0.0, 1.0),
    (1.0, 2.0, 3.0, 1e-8, 0.0, 0.0, 1.0),
    (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0),
])
def test_small_change_of_a_pose_is_found(pose):
    changed = Answer(True, (), '', {('', 'link', 'm::l'): pose})
    assert difference_between(ACCEPTED, changed).kind == 'pose'


def test_sign_and_length_of_a_quaternion_do_not_matter():
    turned = Answer(True, (), '', {('', 'link', 'm::l'): (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, -2.0)})
    assert difference_between(ACCEPTED, turned) is None
