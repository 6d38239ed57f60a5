# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Texts with names that are nearly poses, and random texts, which are right or refused."""

import random

import pytest

from sdf_pose_bridge.geometry.formats import converted_poses, PoseFormatError
from sdf_pose_bridge.geometry.pose_texts import typed_poses_from_text

POSE = '{position: {x: 1, y: 2, z: 3}, orientation: {w: 1}}'
LISTS = 'xyz: [1, 2, 3]\nrpy: [0, 0, 1]\n'
MATRIX = '[1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7]'


@pytest.mark.parametrize(('text', 'message'), [
    ('rpy: [0, 0, 1]', 'rpy without a position'), ('xyz: [0, 0, 1]', 'without a rotation'),
    ('x: 1\ny: 2\nroll: 0\npitch: 0\nyaw: 0', 'z is missing beside x y'),
    (f'{LISTS}scale: 0.001', '"scale" is left over'), (f'{LISTS}unit: mm', '"unit" is left'),
    (f'm: {MATRIX}\na: 1\nb: 2\nscale: 2', '"scale" is left over'),
    ('<geom pos="1 2 3" quat="1 0 0 O"/>', '"quat" is \'1 0 0 O\', not 4 numbers'),
    (f'units: mm\na:\n  m: {MATRIX}', 'units'),
    (f'{LISTS}rpy: [1, 2, 3]', '"rpy" is given twice'), (f'{LISTS}degrees: true', 'left over'),
    ('x: 1\ny: nan\nz: 3\nroll: 0\npitch: 0\nyaw: 0', "\"y\" is 'nan', not a number"),
    ('x: 1\ny: 2 mm\nz: 3\nroll: 0\npitch: 0\nyaw: 0', '"y" is in mm'),
    ('R: [1, 0, 0, 0, 1, 0, 0, 0, 1]\nt: [1]', '"t" is left over beside R'),
    ('m: [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0]', '"m" has 11 numbers; a matrix has 9, 12 or 16'),
    ('<origin xyz="0 0 0" rpy="0 0 ${pi/2}"/>', 'as xacro does'),
    ('w:=[FALSE,"",[[1,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];', 'has 2 frames; .* --from abb'),
    ('position: [1, 2, 3]\norientation: [0, 0, 0, 1]', 'the order of four numbers is not said'),
    ('position: {x: 1}\norientation: {z: 1}', 'orientation.w is missing'),
    ('a.position.x=1 a.orientation.z=1', 'orientation.w is missing'),
    ('{pose: {pos: {x: 1, y: 2, z: 3}}}', 'without a rotation'),
    (f'a: {POSE}\nb:\n  c: {POSE}', 'several poses'),
    (f'a: {POSE}\nb: {{xyz: [1, 2, 3], rpy: [0, 0, 0]}}', 'several poses'),
    ('<body pos="0 0 1" axisangle="0 0 1 90"/>', '"axisangle" is left over'),
    ('static_transform_publisher 1 2 3 a b', 'has 3 numbers; it takes x y z yaw pitch roll'),
    ('<pose degrees="maybe">1 2 3 0 0 0</pose>', 'degrees="maybe" is not a boolean'),
    ('<pose rotation_format="quat">1 2 3 0 0 0</pose>', 'must be euler_rpy or quat_xyzw'),
    ('<pose>1 2 3</pose>', '<pose> has 6 numbers'), ('header: {stamp: 5}', 'no names of a pose'),
    (f'{POSE} # and 3 more', 'may hide numbers')])
def test_a_text_that_is_nearly_a_pose_says_what_is_wrong(text, message):
    with pytest.raises(PoseFormatError, match=message):
        typed_poses_from_text(text)


def test_unknown_attributes_of_a_pose_are_told():
    assert typed_poses_from_text('<pose units="mm">1 2 3 0 0 0</pose>')[0].notes[1] == (
        'units="mm" of <pose> is not defined in SDFormat')


# Random texts

def _written(rng, value, style, indent=''):
    """Write nested names in one of the styles."""
    def inner(each):
        return _written(rng, each, style, f'{indent}  ')
    if isinstance(value, list):
        form = rng.choice(['np.array([{}])', '[{}]']) if style == 'python' else '[{}]'
        return form.format(rng.choice([', ', ',']).join(map(inner, value)))
    if not isinstance(value, dict):
        return rng.choice(['{:.9f}', '{!r}', '{:+.9e}']).format(value)
    items = rng.sample([*value.items()], len(value))
    if style == 'yaml':
        return ''.join(f'\n{indent}{name}: {inner(each)}' for name, each in items)
    if style == 'protobuf':
        return ''.join(
            f'\n{indent}{name} {{{inner(each)}\n{indent}}}' if isinstance(each, dict)
            else f'\n{indent}{name}: {inner(each)}' for name, each in items)
    form = {'json': '"{}": {}', 'flow': '{}: {}', 'python': '{}={}'}[style]
    text = ', '.join(form.format(name, inner(each)) for name, each in items)
    call = rng.choice(['dict({})', 'Pose({})', 'a.b.Foo({})'])
    return call.format(text) if style == 'python' else f'{{{text}}}'


def _random_pose(rng):
    """Return names with the numbers of a pose, and the pose."""
    pose = [rng.uniform(-2, 2) for _ in range(3)] + [rng.uniform(-1.5, 1.5) for _ in range(3)]
    quat = converted_poses(pose, 'sdf_rpy', 'sdf_quat_xyzw')[3:].tolist()
    matrix = converted_poses(pose, 'sdf_rpy', 'matrix_row_major').reshape(4, 4).tolist()
    rpy = dict(zip(('roll', 'pitch', 'yaw'), pose[3:], strict=True))
    position = dict(zip('xyz', pose[:3], strict=True))
    if rng.random() < 0.6:
        name = rng.choice(['position', 'translation', 'xyz', 'pos'])
        position = {name: rng.choice([position, pose[:3]])}
    turned = rng.choice(['orientation', 'rotation', 'quaternion', 'quat', 'rot'])
    rotation = rng.choice([
        rpy, {rng.choice(['rpy', turned]): rpy}, {'rpy': pose[3:]}, {'quat_xyzw': quat},
        dict(zip(('qx', 'qy', 'qz', 'qw'), quat, strict=True)),
        {turned: dict(zip('xyzw', quat, strict=True))}, {'quat_wxyz': [quat[3], *quat[:3]]},
        {turned: [row[:3] for row in matrix[:3]]}])
    names = rng.choice(3 * [{**position, **rotation}] + [{'T_a_b': matrix}, {'m': matrix[:3]}])
    return names, pose


@pytest.mark.parametrize('style', ['yaml', 'json', 'flow', 'python', 'protobuf'])
def test_random_texts_are_right_or_refused(style):
    rng, right = random.Random(style), 0
    for _ in range(400):
        names, pose = _random_pose(rng)
        fault = rng.choice(['', '', 'scale', 'gap', 'second'])
        if fault == 'scale':
            names = {**names, 'scale': rng.choice([0.001, [1, 1, 2], {'x': 1, 'y': 1, 'z': 2}])}
        elif fault == 'gap':
            del names[rng.choice([*names])]
        beside = rng.choice(
            [{}, {'intrinsics': [5.0, 5.0, 3.0, 2.0]}, {'header': {'stamp': {'sec': 5}}}])
        second = {'b': {'c': _random_pose(rng)[0]}} if fault == 'second' else {}
        text = _written(rng, {**beside, 'a': names, **second}, style)
        try:
            found = typed_poses_from_text(text)
        except PoseFormatError:
            assert fault, text
            continue
        if fault != 'gap' or found[0].format.position:  # or a rotation alone
            assert not fault, text
            right += 1
            assert converted_poses(found[0].numbers, found[0].format, 'sdf_rpy') == (
                pytest.approx(pose, abs=1e-7)), text
    assert right > 100
