# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The attributes of a pose are those of its elements in the specification."""

import math

import pytest
from sdf_texts import model_file

from sdf_pose_bridge import load_text, Pose
from sdf_pose_bridge.geometry.formats import converted_poses
from sdf_pose_bridge.geometry.pose_attributes import (
    FORMAT_ATTRIBUTES,
    pose_format_from_attributes,
    PoseFormat,
    PoseTextError,
)
from sdf_pose_bridge.geometry.pose_texts import typed_poses_from_text
from sdf_pose_bridge.sdformat.grammar import definition_of
from sdf_pose_bridge.sdformat.pose_writing import PoseText

VALUES = {
    'rotation_format': (
        'quat_xyzw', '1 2 3 0 0 0.6 0.8', f'1 2 3 0 0 {2 * math.atan2(0.6, 0.8)}'),
    'degrees': ('true', '1 2 3 0 0 90', f'1 2 3 0 0 {math.pi / 2}')}
"""A value of each attribute, numbers with it, and without it the same pose."""


@pytest.mark.parametrize('name', ['pose', 'include/pose', 'inertial/pose', 'audio_source/pose'])
def test_each_pose_has_these_attributes(name):
    assert {*FORMAT_ATTRIBUTES} <= definition_of(name).attributes.keys() <= {
        'relative_to', *FORMAT_ATTRIBUTES}


@pytest.mark.parametrize(('rotation_format', 'degrees', 'expected'), [
    ('', '', PoseFormat()), ('', 'True', PoseFormat(is_degrees=True)),
    ('euler_rpy', '', PoseFormat()),
    ('quat_xyzw', '', PoseFormat(is_quaternion=True))])
def test_attributes_are_a_format(rotation_format, degrees, expected):
    assert pose_format_from_attributes(rotation_format, degrees) == expected


@pytest.mark.parametrize(('rotation_format', 'degrees', 'message'), [
    ('quat', '', '^rotation_format="quat" must be euler_rpy or quat_xyzw$'),
    ('quat_xyzw', '1',
     '^degrees="true" cannot be combined with rotation_format="quat_xyzw"$')])
def test_wrong_attributes_are_refused(rotation_format, degrees, message):
    with pytest.raises(PoseTextError, match=message):
        pose_format_from_attributes(rotation_format, degrees)


@pytest.mark.parametrize('name', FORMAT_ATTRIBUTES)
def test_each_attribute_is_read_written_and_pasted(name):
    value, numbers, plain = VALUES[name]
    pose = Pose(*converted_poses([*map(float, plain.split())], 'sdf_rpy', 'sdf_quat_xyzw'))
    element = f'<pose {name}="{value}">{{}}</pose>'
    text = model_file(f'<link name="l">{element}</link>')
    assert load_text(text.format(numbers)).pose('l') == pytest.approx(pose)
    blank = PoseText(text.format('').encode(), 'f')
    assert blank.with_pose(3, pose, 1e-9).new_text.decode() == text.format(numbers)
    pasted, = typed_poses_from_text(element.format(numbers))
    assert converted_poses(pasted.numbers, pasted.format, 'sdf_quat_xyzw') == pytest.approx(pose)


@pytest.mark.parametrize('name', definition_of('pose').attributes)
def test_no_attribute_of_a_pasted_pose_is_called_undefined(name):
    value, numbers, _ = VALUES.get(name, ('a', '1 2 3 0 0 0', ''))
    pasted, = typed_poses_from_text(f'<pose {name}="{value}">{numbers}</pose>')
    assert 'not defined' not in ''.join(pasted.notes)
