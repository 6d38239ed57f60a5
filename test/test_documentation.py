# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Every command and snippet of the documentation is run here, or named with the reason why not."""

import re
import shlex
import shutil
import sys

from command_line import completed
from folders import ROOT
import needs
import pytest

from sdf_pose_bridge import load_text
from sdf_pose_bridge.cli.main import main

PAGES = [ROOT / 'README.md', ROOT / 'CONTRIBUTING.md', *sorted((ROOT / 'docs').glob('*.md'))]

TESTED_ELSEWHERE = {
    'ros2 run sdf_pose_bridge bridge': 'test_documented_nodes.py starts the bridge in this way',
    'ros2 topic echo': 'test_readme.py compares the message',
    'ros2 service call': 'test_readme.py and test_callers.py make the calls',
    'ros2 param set': 'test_readme.py and test_bridge_changes.py set parameters',
    'sdf_pose diff': 'test_diff.py compares files, also for git',
    'git difftool': 'test_diff.py has git compare two commits',
    'sdf_pose check --format github': 'test_printing.py compares annotations',
    'sdf_pose tree cell.sdf': 'test_readme.py compares the output',
    'sdf_pose check broken.sdf': 'test_readme.py compares the output',
    'sdf_pose check cell.sdf': 'test_readme.py compares the output',
    'sdf_pose check --strict cell.sdf': 'test_readme.py compares the output',
    'make ': 'it is what runs the tests, or takes minutes',
}
"""Beginnings of commands."""

NOT_RUN = {
    'ros2 security': 'the ros2 command line is not on PyPI',
    'ros2 run ros_gz_bridge': 'needs Gazebo',
    'ros2 run tf2_ros': 'needs tf2_ros',
    'ros2 run joint_state_publisher_gui': 'needs joint_state_publisher_gui',
    'ros2 launch': 'launch is not on PyPI; test_launch_files.py runs the files where it is',
    'sdf_pose view examples/work_cell.sdf': 'opens a browser; test_view.py writes the page',
    'FASTDDS_': 'needs a network that loses packets, or a profile of the user',
    'ROS_SUPER_CLIENT': 'the ros2 command line is not on PyPI',
    'export ROS_': "sets variables of the reader's shell",
    'export ': "sets variables of the reader's shell",
    'pip install': 'needs the network',
    'rosdep install': 'needs the network',
    'colcon build': 'the setup of the tests has built the packages',
    'cd ws': "the workspace is the reader's",
    '. ': "sets up the reader's shell",
}
"""Beginnings of commands, and why no test runs them."""


def blocks():
    """Give each page with the lines of each of its indented blocks."""
    for page in PAGES:
        text = re.sub(r'^```.*?^```$', '', page.read_text(), flags=re.M | re.S)
        for block in re.findall(r'(?:(?:^|\n)(?: {4}.*)?(?=\n|$))+', text):
            lines = [line[4:] for line in block.strip('\n').splitlines()]
            if any(lines):
                yield page, lines


def commands():
    """Give each command of the pages, with the lines that continue it."""
    first_words = re.compile(
        r'\$ |(?:ros2|sdf_pose|make|gz|pip|sudo|rosdep|colcon|cd|export|\.|[A-Z_]+=\S+) ')
    found = set()
    for _, lines in blocks():
        text = '\n'.join(lines).replace('\\\n', ' ')
        for line in text.splitlines():
            if first_words.match(line):
                found.add(' '.join(line.removeprefix('$ ').split('  #')[0].split()))
    return sorted(found)


NOT_RUN_HERE = (*TESTED_ELSEWHERE, *NOT_RUN)


def test_the_lists_name_nothing_that_is_gone():
    for known in NOT_RUN_HERE:
        assert any(command.startswith(known) for command in commands()), known


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for name in ('examples', 'docs/pictures'):
        shutil.copytree(ROOT / name, tmp_path / name)
    # As the page about calibration says.
    shutil.copy(tmp_path / 'examples/work_cell.sdf', tmp_path / 'my_cell.sdf')
    # As these pages say.
    for page, name in ('README.md', 'cell.sdf'), ('moving_here.md', 'shop.sdf'):
        (tmp_path / name).write_text(next(
            '\n'.join(lines[:lines.index('</sdf>') + 1]) for each, lines in blocks()
            if each.name == page and lines[0].startswith('<sdf ')))
    (tmp_path / 'src').mkdir()
    (tmp_path / 'src/sdf_pose_bridge').symlink_to('..')
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize('command', [
    each for each in commands() if not each.startswith(NOT_RUN_HERE)])
def test_commands(command, folder, capsys):
    program, *arguments = shlex.split(command)
    assert program == 'sdf_pose', 'run it here, or name it above'
    if '-o' in arguments:
        if arguments[0] == 'graph':
            needs.program('dot')
        if arguments[0] == 'view':
            pytest.importorskip('viser', reason='needs viser')
    assert main(arguments) == 0
    if '-o' in arguments:
        assert (folder / arguments[arguments.index('-o') + 1]).stat().st_size
    else:
        assert capsys.readouterr().out


def shown_after(page, command):
    for each, lines in blocks():
        if each.name == page and f'$ {command}' in lines:
            return lines[lines.index(f'$ {command}') + 1:]
    raise AssertionError(command)


@pytest.mark.parametrize(('page', 'command'), [
    ('concepts.md', 'sdf_pose tree docs/pictures/arm.sdf'),
    ('pose_formats.md', 'sdf_pose convert --from rpy_degrees --to quaternion 0 0 90'),
    ('pose_formats.md', (
        'sdf_pose convert --mm --from matrix_row_major --to sdf_rpy'
        ' 0 -1 0 25 1 0 0 -719 0 0 1 1197 0 0 0 1')),
    ('README.md', 'sdf_pose convert --from franka_measured --to sdf_rpy 307 0 487 180 0 0'),
    ('calibration.md', (
        'sdf_pose convert --to sdf_rpy_degrees --digits 9 --from sdf_rpy_degrees 0 0 0 180 0 90'
        ' --times sdf_rpy_degrees 1 2 -3 0 0 30 --times sdf_rpy_degrees 0 0 0 180 0 0')),
])
def test_outputs(page, command, folder, capsys, monkeypatch):
    if 'convert' in command:
        # Into a pipe, numbers have more digits than on the terminal that is shown.
        monkeypatch.setattr(sys.stdout, 'isatty', lambda: True)
    main(shlex.split(command)[1:])
    printed = capsys.readouterr().out.splitlines()
    assert shown_after(page, command)[:len(printed)] == printed


def test_the_shown_lines_of_a_urdf_change(folder, capsys):
    (command,) = (each for each in commands() if each.startswith('sdf_pose set examples/arm.urdf'))
    main(shlex.split(command)[1:])
    assert [line for line in capsys.readouterr().out.splitlines() if line[1:3] == '  ' and (
        line[0] in '+-')] == shown_after('calibration.md', command)


@pytest.mark.parametrize('page', ['README.md', 'python_api.md', 'joints.md', 'urdf.md'])
def test_snippets_of_python(page, folder):
    snippets = [
        '\n'.join(lines) for each, lines in blocks()
        if each.name == page and re.match('import |from sdf_pose_bridge import', lines[0])]
    assert snippets
    for snippet in snippets:
        done = completed([sys.executable, '-c', snippet])
        assert done.returncode == 0, done.stderr


def test_files_of_sdf():
    files = ['\n'.join(lines) for _, lines in blocks() if lines[0].startswith('<?xml')]
    assert files
    for text in files:
        load_text(text)
