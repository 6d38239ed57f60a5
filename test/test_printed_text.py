# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Text for a line of a message: shortened, listed, without control characters."""

import pytest

from sdf_pose_bridge.printed_text import printable, quoted_names, shortened


@pytest.mark.parametrize(('most', 'text'), [
    (3, '"a", "b", "c"'), (4, '"a", "b", "c"'), (1, '"a" and 2 more')])
def test_names_in_a_message(most, text):
    assert quoted_names(['a', 'b', 'c'], most) == text


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
