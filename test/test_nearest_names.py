# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Hints with the nearest name."""

import string
import time

import pytest

from sdf_pose_bridge.nearest_names import hint_from_names, NameIndex


@pytest.mark.parametrize(('wanted', 'names', 'hint'), [
    ('table', [], ''),
    ('table', ['x'], ''),
    ('', ['x'], ''), ('table', ['table', 'chair'], ''),
    ('tabel', ['chair', 'table'], '; did you mean "table"?'),
    # An ending that many files have says nothing.
    ('nothing.sdf', ['g.sdf'], ''), ('cel.sdf', ['cell.sdf'], '; did you mean "cell.sdf"?'),
    ('cell.sdf', ['cell.world', 'g.sdf'], '; did you mean "cell.world"?'),
])
def test_hint_at_the_nearest_name(wanted, names, hint):
    assert hint_from_names(wanted, names) == hint


@pytest.mark.parametrize(('wanted', 'hint'), [
    ('robot_17/link_44', 'robot_17/link_4'), ('rbot_30/link_7', 'robot_30/link_7'),
    ('robot_5_link_6', 'robot_5/link_6'), ('nothing', ''), ('', ''), ('x' * 100_000, ''),
])
def test_hint_among_many_similar_names(wanted, hint):
    names = [f'robot_{robot}/link_{link}' for robot in range(1000) for link in range(10)]
    assert hint_from_names(wanted, names) == (hint and f'; did you mean "{hint}"?')


def test_very_long_name_has_no_hint():
    assert hint_from_names('x' * 10**6, ['x' * (10**6 - 1)]) == ''


@pytest.mark.parametrize('wanted', ['ba' * 100, 'abc' * 60, 'b' * 200])
def test_names_of_few_repeated_letters_take_no_longer_than_others(wanted):
    letters = string.ascii_letters + string.digits
    times_s = []
    for part, name in (('ab' * 95, wanted), (3 * letters, 3 * letters)):
        index = NameIndex(f'{part}{number}' for number in range(400))
        begin = time.thread_time()
        for _ in range(10):
            index.nearest(name)
        times_s.append(time.thread_time() - begin)
    assert times_s[0] < 5.0 * times_s[1], times_s


def test_index_finds_names_with_other_separators_and_cases():
    index = NameIndex(f'robot_{robot}::link_{link}' for robot in range(100) for link in range(9))
    assert index.nearest('Robot_5/Link-6') == 'robot_5::link_6'
    assert index.nearest('roboter_5::link_6') == 'robot_5::link_6'
    assert index.nearest('nothing') == ''
