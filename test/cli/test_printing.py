# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The help of commands, and problems as JSON and annotations."""

import json

import pytest
from sdf_texts import LINK, model_file, write_files

COMMANDS = ('check', 'poses', 'tree', 'graph', 'view', 'urdf', 'convert', 'diff', 'set')


@pytest.mark.parametrize('columns', ['80', '120'])
@pytest.mark.parametrize('command', COMMANDS)
def test_lines_of_help_are_as_long_as_those_of_the_terminal(
        run_main, monkeypatch, columns, command):
    monkeypatch.setenv('COLUMNS', columns)
    lines = run_main(command, '--help').stdout.splitlines()
    assert len(lines) > 2
    assert max(map(len, lines)) <= int(columns)


def test_check_prints_a_json_object_for_each_file(run_main):
    done = run_main('check', '--format', 'json', 'bad.sdf', 'warned.sdf')
    bad, warned = map(json.loads, done.stdout.splitlines())
    assert done.returncode == 1
    assert [error['line'] for error in bad['errors']] == [3, 4]
    assert (warned['ok'], warned['warnings'][0]['code']) == (True, 'POSE_RELATIVE_TO_INVALID')


def test_annotation_has_level_file_line_and_code(run_main):
    done = run_main('check', '--format', 'github', 'warned.sdf', 'bad.sdf')
    warning, error, _ = done.stdout.splitlines()
    assert warning.startswith(
        '::warning file=warned.sdf,line=5,title=POSE_RELATIVE_TO_INVALID::relative_to="nowhere" ')
    assert error.startswith('::error file=bad.sdf,line=3,title=ELEMENT_INVALID::')


def test_text_of_a_file_cannot_end_an_annotation(run_main, files):
    write_files(files, **{'a,b:c%\x1b': model_file(
        LINK + '<frame name="f" attached_to="50%&#10;::error::"/>')})
    (line,) = run_main('check', '--format', 'github', 'a,b:c%\x1b.sdf').stdout.splitlines()
    assert line.startswith(r'::error file=a%2Cb%3Ac%25\x1b.sdf,line=1,')
    assert r'attached_to="50%25\n\x3a:error::"' in line
