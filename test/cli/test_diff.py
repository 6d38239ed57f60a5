# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""``sdf_pose diff``: the frames that changed, and the exit code."""

import json
import os
import sys

from command_line import completed
from folders import ROOT
import needs
import pytest
from sdf_texts import joint, model_file, TWO_LINKS


@pytest.fixture
def diff(run_main, files):
    text = (files / 'good.sdf').read_text()

    def diff(old, new, *arguments):
        (files / 'new.sdf').write_text(text.replace(old, new))
        return run_main('diff', 'good.sdf', 'new.sdf', *arguments)
    return diff


def test_the_same_file_is_not_different(diff):
    done = diff('', '')
    assert (done.returncode, done.stdout, done.stderr) == (0, '', '')


def test_moved_frames_have_distance_and_angle(diff):
    done = diff('1 2 3 0 0 0', '1 2 3.5 0 0 0.1')
    assert done.returncode == 1
    assert done.stdout.splitlines() == [
        'frame  kind   change distance m angle deg  was',
        'f      frame   moved        0.5   5.72958  1 2 3 0 0 0',
        '  with it: m, m::l']


def test_rounding_errors_are_printed_as_zero(diff):
    done = diff('1 2 3 0 0 0', '1 2 3.0000000000000004 0 0 0.1', '--kinds', 'frame', '--radians')
    assert done.stdout.splitlines()[1].split()[3:5] == ['0', '0.1']


@pytest.mark.parametrize(('old', 'new', 'arguments', 'code'), [
    ('1 2 3', '1 2 4', '--relative-to f', 0), ('1 2 3', '1 2 4', '--tolerance 2', 0),
    ('1 2 3', '1 2 4', '--kinds light', 0), ('1 2 3', '1 2 4', '--relative-to m/l', 0),
    ('1 2 3', '1 2 4', '--relative-to m/k', 2), ('', '', '--relative-to g', 2),
    ('relative_to="f"', 'relative_to="g"', '', 2)])
def test_code_is_that_of_the_frames_that_are_compared_or_of_an_error(
        diff, old, new, arguments, code):
    assert diff(old, new, *arguments.split()).returncode == code


def test_added_removed_and_renamed(diff):
    done = diff('<link name="l"/>', '<link name="k"/><frame name="g"/>')
    assert [line.split() for line in done.stdout.splitlines()[1:]] == [
        ['m::k', 'link', 'renamed', 'm::l'], ['m::g', 'frame', 'added']]


def test_a_joint_that_turns_the_other_way_is_a_line_with_what_it_was(run_main, files):
    for name, axis in (('new', '0 0 -1'), ('old', '0 0 1')):
        (files / f'{name}.sdf').write_text(model_file(TWO_LINKS + joint(
            f'<parent>a</parent><child>b</child><axis><xyz>{axis}</xyz></axis>', 'j', 'revolute')))
    done = run_main('diff', 'old.sdf', 'new.sdf')
    assert done.returncode == 1
    assert [line.split(maxsplit=3) for line in done.stdout.splitlines()[1:]] == [
        ['m::j', 'joint', 'axis', '0 0 1, now 0 0 -1']]
    records = json.loads(run_main('diff', 'old.sdf', 'new.sdf', '--format', 'json').stdout)
    assert [(each['change'], each['old'], each['new']) for each in records['differences']] == [
        ('axis', '0 0 1', '0 0 -1')]


def test_frames_that_move_with_one_of_a_kind_that_is_not_compared_have_lines(diff):
    done = diff('1 2 3 0 0 0', '1 2 3 0 0 1', '--kinds', 'link,model')
    assert [line.split()[:3] for line in done.stdout.splitlines()[1:]] == [
        ['m', 'model', 'moved'], ['m::l', 'link', 'moved']]


def test_records_have_all_that_moved_with_the_poses(diff):
    done = diff('1 2 3 0 0 0', '1 2 4 0 0 0', '--format', 'csv')
    assert [line.split(',')[2::4] for line in done.stdout.splitlines()[:3]] == [
        ['name', 'moved_with'], ['f', ''], ['m', 'f']]
    assert '1 2 3 0 0 0,1 2 4 0 0 0' in done.stdout


def test_git_shows_what_a_commit_moved(files):
    def git(*arguments):
        return completed(
            [needs.program('git'), '-c', 'user.name=a', '-c', 'user.email=b', *arguments],
            cwd=files, env={**os.environ, 'PYTHONPATH': str(ROOT)}, check=True).stdout

    git('init', '-q')
    for pose in ('1 2 3', '1 2 4'):
        path = files / 'good.sdf'
        path.write_text(path.read_text().replace('1 2 3', pose))
        git('add', 'good.sdf')
        git('commit', '-q', '-m', pose)
    command = f'{sys.executable} -m sdf_pose_bridge diff'
    shown = git('difftool', '--no-prompt', '--extcmd', command, 'HEAD~1', '--', 'good.sdf')
    assert shown.splitlines()[1].split()[:5] == ['f', 'frame', 'moved', '1', '0']


def test_a_missing_file_is_an_error(run_main):
    assert run_main('diff', 'good.sdf', 'missing.sdf').returncode == 2


@pytest.mark.parametrize('text', ['-1', 'inf', 'x'])
def test_a_tolerance_is_a_distance(diff, text):
    done = diff('', '', '--tolerance', text)
    assert (done.returncode, f'"{text}" is not a distance' in done.stderr) == (2, True)


def test_files_without_elements_have_no_difference(run_main, files):
    (files / 'new.sdf').write_text('<sdf version="1.9"/>')
    assert run_main('diff', 'new.sdf', 'new.sdf').returncode == 0
    assert run_main('diff', 'new.sdf', 'good.sdf').returncode == 1
