# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Texts of names with numbers: their limits, and the growth of their time."""

import contextlib
import time

import pytest

from sdf_pose_bridge.geometry.formats import PoseFormatError
from sdf_pose_bridge.geometry.named_numbers import named_from_text
from sdf_pose_bridge.geometry.pose_texts import TextDivider, typed_poses_from_text

POSE = '{position: {x: 1, y: 2, z: 3}, orientation: {w: 1}}\n'


@pytest.mark.parametrize(('text', 'message'), [
    ('a: ' + '[' * 60, 'more than 50 names'), ('<a>' * 60, 'more than 50 names'),
    ('x: ' + ' ' * 1_000_000, 'more than 1000000 characters')])
def test_a_text_has_limits(text, message):
    with pytest.raises(PoseFormatError, match=message):
        named_from_text(text)


@pytest.mark.parametrize('text', [
    '- 0.1\n', 'x: [\n', '<pose a="1" ', '<b/>', 'k: ', 'x: 1\n', '"', "'a", '<!--', '# a\n',
    'a [[1,2,3],', '--x 1 ', POSE, 'pose {\n}\n', 'm: [1,0,0,0,1,0,0,0,1]\n', '    ', '\n', 'a.',
    '(a', '1,', '$', '0 0 0\n', '\nx: 1\n'])
def test_time_is_in_proportion_to_the_length(text):
    def seconds(count):
        lines, times = ('a: 1\n' + count * text).splitlines(True), []
        for _ in range(4):
            begin = time.process_time()
            for _, each in TextDivider(None).divided(lines, is_end=True):
                with contextlib.suppress(PoseFormatError):
                    typed_poses_from_text(each)
            times.append(time.process_time() - begin)
        return min(times)
    count = 12_000 // len(text)
    # Smaller times are those of the clock.
    assert seconds(2 * count) <= 2.6 * seconds(count) + 0.002
