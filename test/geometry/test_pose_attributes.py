# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The attributes of a pose are those of its elements in the specification."""

import pytest

from sdf_pose_bridge.geometry.pose_attributes import (
    FORMAT_ATTRIBUTES,
    pose_format_from_attributes,
    PoseFormat,
    PoseTextError,
)
from sdf_pose_bridge.sdformat.grammar import definition_of


@pytest.mark.parametrize('name', ['pose', 'include/pose', 'inertial/pose', 'audio_source/pose'])
def test_each_pose_has_these_attributes(name):
    assert {*FORMAT_ATTRIBUTES} <= definition_of(name).attributes.keys() <= {
        'relative_to', *FORMAT_ATTRIBUTES}


@pytest.mark.parametrize(('rotation_format', 'degrees', 'expected'), [
    ('', '', PoseFormat()), ('', 'True', PoseFormat(is_degrees=True)),
    ('quat_xyzw', '', PoseFormat(is_quaternion=True))])
def test_attributes_are_a_format(rotation_format, degrees, expected):
    assert pose_format_from_attributes(rotation_format, degrees) == expected


@pytest.mark.parametrize(('rotation_format', 'degrees'), [('quat', ''), ('quat_xyzw', '1')])
def test_wrong_attributes_are_refused(rotation_format, degrees):
    with pytest.raises(PoseTextError):
        pose_format_from_attributes(rotation_format, degrees)
