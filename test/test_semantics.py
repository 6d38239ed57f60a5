# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The rules of poses and frames, one file each: ``semantics/*.sdf``.

The ``.json`` beside a file has the code of its first error, or the pose of every element as the
steps that lead to it from the root: ``x y z roll pitch yaw`` in metres and degrees (zeros at the
end left out), each in the frame that the one before it reached, or ``inverse`` and such a step.
"""

import json
from pathlib import Path

from matrices import assert_same_pose, matrix_from_degrees
import numpy as np
import pytest
from sdf_texts import warning_codes

from sdf_pose_bridge import Kind, load, SdfError

FOLDER = Path(__file__).parent / 'semantics'
CASES = {
    path.stem: json.loads(path.with_suffix('.json').read_text())
    for path in sorted(FOLDER.glob('*.sdf'))}
VALID = [name for name, expected in CASES.items() if expected['error'] is None]
INVALID = [name for name, expected in CASES.items() if expected['error'] is not None]


def scene_of(name):
    return load(FOLDER / f'{name}.sdf', resource_paths=[FOLDER / 'models'])


def matrix_from_steps(steps):
    matrix = np.eye(4)
    for step in steps:
        numbers = step.removeprefix('inverse').split()
        move = matrix_from_degrees(*map(float, numbers))
        matrix = matrix @ (np.linalg.inv(move) if step.startswith('inverse') else move)
    return matrix


@pytest.mark.parametrize('name', VALID)
def test_poses(name):
    scene = scene_of(name)
    for element, steps in CASES[name]['poses'].items():
        assert_same_pose(scene.pose(element), matrix_from_steps(steps), name=element)


@pytest.mark.parametrize('name', VALID)
def test_nothing_is_missing_or_made_up(name):
    scene = scene_of(name)
    names = [
        element for element, kind in zip(scene.names, scene.kinds, strict=True)
        if kind not in {Kind.ROOT, Kind.WORLD, Kind.INERTIAL}]
    assert sorted(names) == sorted(CASES[name]['poses'])


@pytest.mark.parametrize('name', INVALID)
def test_the_first_error(name):
    with pytest.raises(SdfError) as caught:
        scene_of(name)
    assert caught.value.code == CASES[name]['error']
    assert caught.value.file.endswith(f'{name}.sdf')


@pytest.mark.parametrize(('name', 'codes'), [
    ('14_merged_visual', ['WARNING']), ('16_renamed_siblings', ['WARNING', 'WARNING']),
    ('23_visual_that_cannot_be_placed', ['POSE_RELATIVE_TO_INVALID']),
    ('08_names_in_nested_models', []),
    ('12_merged_into_a_model', []), ('17_flat_names', []), ('15_frame_attribute', []),
])
def test_warnings(name, codes):
    assert warning_codes(scene_of(name)) == codes
