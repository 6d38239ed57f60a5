# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Other bytes in a range of a file, and how they are shown."""

import difflib

import pytest

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st

from sdf_pose_bridge.sdformat.file_change import FileChange


def change_of(text, old, new, encoding='utf-8', path='cell.sdf'):
    begin = len(text[:text.index(old)].encode(encoding))
    return FileChange(path, text.encode(encoding), encoding, begin,
                      begin + len(old.encode(encoding)), new.encode(encoding))


LINES = ''.join(f'line {number}\n' for number in range(1, 10))


@pytest.mark.parametrize('text', [LINES, LINES[:-1]])
@pytest.mark.parametrize(('old', 'new'), [
    ('5', 'x'), ('1', 'x'), ('9', 'x'), ('5\nline 6', 'x'), ('2', 'x\ny'), ('7', ''), ('8', 'x'),
    ('line 6\nline 7', 'a\nb'),
    ('5', '5\nx'), ('5', 'x\nline 5'), ('1', '1\nx'), ('9', '9\nx'), ('9', 'x\nline 9')])
def test_the_change_is_shown_as_difflib_would(text, old, new):
    texts = (text, text.replace(old, new))
    expected = difflib.unified_diff(
        *(each.splitlines(keepends=True) for each in texts), 'cell.sdf', 'cell.sdf')
    assert change_of(text, old, new).diff == ''.join(
        line if line.endswith('\n') else f'{line}\n\\ No newline at end of file\n'
        for line in expected)


def test_a_change_that_is_undone():
    change = change_of(LINES, '5', 'other')
    assert change.undone.old_text == change.new_text
    assert change.undone.new_text == LINES.encode()


@given(st.text('ab\n', min_size=1), st.data())
def test_the_new_text_is_the_old_one_with_the_range_replaced(text, data):
    begin = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(begin, len(text)))
    change = FileChange('f', text.encode(), 'utf-8', begin, end, b'new')
    assert change.new_text.decode() == f'{text[:begin]}new{text[end:]}'
    removed = [line for line in change.diff.splitlines()[3:] if line[0] in '- ']
    assert set(''.join(line[1:] for line in removed)) <= set(text)


def test_nothing_different_is_no_change(tmp_path):
    change = change_of(LINES, '5', '5', path=str(tmp_path / 'missing.sdf'))
    change.write()
    assert change.diff == ''


def test_other_encodings_are_shown_as_text():
    assert '\n-é 1\n+é 2\n' in change_of('\ufeffa\né 1\n', '1', '2', 'utf-16-le').diff


def test_what_does_not_print_is_escaped_but_for_tabs_and_ends_of_lines():
    shown = change_of('\t\x1b[2J\u202e 1\r\n\ra\n', '1', '2', path='\x1b.sdf').diff
    assert shown == (
        '--- \\x1b.sdf\n+++ \\x1b.sdf\n@@ -1,2 +1,2 @@\n'
        '-\t\\x1b[2J\\u202e 1\r\n+\t\\x1b[2J\\u202e 2\r\n \\ra\n')


def test_of_long_lines_and_long_changes_a_part_is_shown():
    diff = change_of(f'{100_000 * "x"} 1 {100_000 * "y"}', '1', '2').diff
    assert f'-...{999 * "x"} 1 {999 * "y"}...\n' in diff
    assert f'+...{999 * "x"} 2 {999 * "y"}...\n' in diff
    many = change_of(f'a{10_000 * chr(10)}b', f'a{10_000 * chr(10)}b', '').diff
    assert len(many) < 2000
