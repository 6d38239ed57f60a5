# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Names in SDFormat: reserved ones, names in scopes, hints at the nearest name."""

from itertools import product
import string
import time

import pytest

from sdf_pose_bridge.names import (
    hint_from_names,
    is_reserved,
    NameIndex,
    printable,
    quoted_names,
    scoped_name,
    shortened,
    unused_name,
)


@pytest.mark.parametrize(('names', 'reserved'), [
    (['world', '__model__', '__root__', '____', '__a__', '_____'], True),
    (['', '_', '__', '___', '__x_', '_x__', '__x', 'x__', 'World', 'worlds', 'a__b'], False)])
def test_reserved_names(names, reserved):
    assert [name for name in names if is_reserved(name) is not reserved] == []


@pytest.mark.parametrize(('most', 'text'), [
    (3, '"a", "b", "c"'), (4, '"a", "b", "c"'), (1, '"a" and 2 more')])
def test_names_in_a_message(most, text):
    assert quoted_names(['a', 'b', 'c'], most) == text


@pytest.mark.parametrize(('scope', 'name', 'scoped'), [
    ('robot::arm', 'hand', 'robot::arm::hand'), ('', 'robot', 'robot')])
def test_name_in_a_scope_or_in_a_world(scope, name, scoped):
    assert scoped_name(scope, name) == scoped


@pytest.mark.parametrize(('wanted', 'names', 'hint'), [
    ('table', [], ''),
    ('table', ['x'], ''),
    ('', ['x'], ''),
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


@pytest.mark.parametrize('length', [0, 1, 79, 80])
def test_short_value_stays(length):
    assert shortened('x' * length) == 'x' * length


def test_long_value_keeps_its_ends():
    text = shortened('a' * 50 + 'b' * 50)
    assert len(text) <= 80
    assert text.startswith('aaa')
    assert text.endswith('bbb')


@pytest.mark.parametrize(('text', 'shown'), [
    ('a\nb', r'a\nb'), ('\x9b', r'\x9b'), ('\u202e', r'\u202e'), ('\ud800', r'\ud800'),
    ('ö 1', 'ö 1'), ('a\u3164', r'a\u3164'), ('a\ufe0fb', r'a\ufe0fb'),
    ('\U000e0100', r'\U000e0100'), ('x ###[stop]', r'x #\x23#[stop]'),
    ('::stop::', r'\x3a:stop::'), (' ::a', r' \x3a:a'), ('a::b ##x', 'a::b ##x'),
])
def test_printable_text_is_one_line_without_control_characters(text, shown):
    assert printable(text) == shown


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


@pytest.mark.parametrize('taken', [[], ['a_1']])
def test_a_used_name_gets_the_first_number_that_is_free(taken):
    for names in product(['a', 'a_1', 'a_2', 'a_1_1'], repeat=5):
        used, all_names = dict.fromkeys(taken, 0), [*taken]
        for name in names:
            candidates = [name, *(f'{name}_{number}' for number in range(1, 9))]
            all_names.append(next(each for each in candidates if each not in all_names))
            assert unused_name(name, used) == all_names[-1]
