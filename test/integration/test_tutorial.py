# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The steps of the tutorial, one after another, with its files and its output."""

from pathlib import Path
import re
import shlex

from folders import ROOT
import pytest

from sdf_pose_bridge.cli import view
from sdf_pose_bridge.cli.main import main

TUTORIAL = ROOT / 'docs/tutorial.md'
PICTURED = TUTORIAL.parent / 'pictures/tutorial'
BLOCK = re.compile(r'^```(?P<kind>.*)\n(?::caption: (?P<caption>.*)\n\n)?(?P<text>(?:.*\n)*?)```$',
                   re.M)


@pytest.fixture(scope='module')
def steps():
    return [match.groupdict() for match in BLOCK.finditer(TUTORIAL.read_text())]


def write(step):
    """Write the file of a step, or a part of it."""
    name, _, where = step['caption'].partition(', before ')
    file = Path(name)
    if not where:
        file.write_text(step['text'])
        return
    begin, line, end = file.read_text().rpartition(f'  {where}\n')
    # The mistake of the tutorial is mended before the next step.
    begin = begin.replace('cornor', 'corner')
    file.write_text(begin + step['text'] + line + end)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_steps_without_ros(steps, folder, capsys, monkeypatch):
    shown = []
    monkeypatch.setattr(view, 'run', lambda options: shown.append(options.files) or 0)
    for step in steps:
        if step['kind'] == '{code-block} xml':
            write(step)
        elif step['kind'] == 'console' and 'ros2' not in step['text']:
            command, _, output = step['text'].partition('\n')
            arguments = shlex.split(command.removeprefix('$ sdf_pose '))
            main(arguments)
            captured = capsys.readouterr()
            assert captured.out == output, captured.err
            assert captured.err == ''
    assert shown == [['cell.sdf']]
    for drawn in PICTURED.glob('*.sdf'):
        assert Path(drawn.name).read_text() == drawn.read_text()


def test_pose_on_its_topic(steps, folder, start_bridge, start_listener):
    for step in steps:
        if step['kind'] == '{code-block} xml':
            write(step)
    run, echo = (step['text'] for step in steps if step['text'].startswith('$ ros2'))
    start_bridge(*shlex.split(run)[5:]).wait_until_started()
    topic = shlex.split(echo)[5]
    listener = start_listener()
    listener.listen_to_poses([topic])
    listener.wait_for_keys(listener.poses, [topic])
    position = listener.poses[topic].pose.position
    shown = dict(re.findall(r'^([xyz]): (.*)$', echo, re.M))
    assert {name: float(value) for name, value in shown.items()} == pytest.approx(
        {name: getattr(position, name) for name in 'xyz'}, abs=1e-9)
