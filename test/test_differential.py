# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The package against libsdformat: a fixed share of the random scenes, and the examples.

``make differential`` compares many more.
"""

from pathlib import Path
from random import Random

from differential.batches import compare_scenes, write_scene
from differential.comparison import difference_between, own_answer
from differential.reference import Answer, built_reference, CRASH, ReferenceMissingError
from differential.scene_chains import FAMILIES, text_of
from differential.scene_parts import Feature, features_of_release
import pytest

ROOT = Path(__file__).resolve().parents[1]
EXAMPLES = sorted((ROOT / 'examples').rglob('*.sdf'))
SCENES = 80
PLAIN = frozenset({Feature.DEFECTS, Feature.WORLDS})


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
    *_, tally = compare_scenes(reference, SCENES, 20260101, PLAIN)
    assert tally.scenes == SCENES
    assert [(name, difference.text) for name, _, difference in tally.differences] == []


@pytest.mark.parametrize('family', sorted(set(FAMILIES), key=lambda family: family.__name__))
def test_odd_scene_is_resolved_or_refused(family, tmp_path):
    for number in range(8):
        files = {path: text_of(root) for path, root in family(Random(number)).items()}
        path = write_scene(files, tmp_path, f'scene_{number}')
        answer = own_answer(path, tmp_path)
        assert CRASH not in answer.codes, (number, answer.message)
        assert answer.accepted == (not answer.codes)


def test_libsdformat_judges_random_scenes_as_they_are_meant(reference):
    features = features_of_release(reference.version)
    *_, tally = compare_scenes(reference, 25, 20260102, features, reference_only=True)
    assert tally.scenes == 25
    assert [(name, difference.text) for name, _, difference in tally.differences] == []


ONE_LINK = {('', 'link', 'm::l'): (1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0)}
ACCEPTED = Answer(True, (), '', ONE_LINK)
REFUSED = Answer(False, ('DUPLICATE_NAME',), 'twice', {})


@pytest.mark.parametrize(('own', 'expected', 'kind'), [
    (ACCEPTED, REFUSED, 'accepted'),
    (REFUSED, ACCEPTED, 'refused'),
    (REFUSED, Answer(False, ('RESERVED_NAME',), 'world', {}), 'code'),
    (Answer(True, (), '', {}), ACCEPTED, 'missing'),
    (ACCEPTED, Answer(True, (), '', {}), 'extra'),
    (ACCEPTED, Answer(False, (CRASH,), 'exit code -6', {}), 'crash'),
    (Answer(False, (CRASH,), 'KeyError: 1', {}), REFUSED, 'crash'),
])
def test_disagreement_is_found(own, expected, kind):
    assert difference_between(own, expected).kind == kind


@pytest.mark.parametrize(('own', 'expected'), [
    (Answer(False, ('RESERVED_NAME', 'DUPLICATE_NAME'), 'world', {}), REFUSED),
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
