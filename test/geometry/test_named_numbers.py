# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Texts of names with numbers: their limits, and the growth of their time."""

import contextlib

from growth.turns import fault_of_growth
import pytest

from sdf_pose_bridge.geometry.formats import PoseFormatError
from sdf_pose_bridge.geometry.pose_texts import TextDivider, typed_poses_from_text

POSE = '{position: {x: 1, y: 2, z: 3}, orientation: {w: 1}}\n'


@pytest.mark.parametrize(('text', 'message'), [
    ('a: ' + '[' * 60, 'more than 50 names'), ('<a>' * 60, 'more than 50 names'),
    ('x: ' + ' ' * 1_000_000, 'more than 1000000 characters')])
def test_a_text_has_limits(text, message):
    with pytest.raises(PoseFormatError, match=message):
        typed_poses_from_text(text)


@pytest.mark.parametrize('text', [
    '- 0.1\n', 'x: [\n', '<pose a="1" ', '<b/>', 'k: ', 'x: 1\n', '"', "'a", '<!--', '# a\n',
    'a [[1,2,3],', '--x 1 ', POSE, 'pose {\n}\n', 'm: [1,0,0,0,1,0,0,0,1]\n', '    ', '\n', 'a.',
    '(a', '1,', '$', '0 0 0\n', '\nx: 1\n'])
def test_time_is_in_proportion_to_the_length(text):
    def reader(text, length):
        lines = ('a: 1\n' + length // len(text) * text).splitlines(True)

        def read():
            for _, each in TextDivider(None).divided(lines, is_end=True):
                with contextlib.suppress(PoseFormatError):
                    typed_poses_from_text(each)
        return read

    assert fault_of_growth(
        reader(text, 40_000), reader(text, 20_000), reader(POSE, 40_000)) == ''
