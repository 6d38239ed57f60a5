# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The command line as a process: what it prints, where, and with which exit code."""

import json
from pathlib import Path
import subprocess
import sys

import pytest

ROOT = Path(__file__).resolve().parents[2]
GOOD = """<sdf version="1.10">
  <world name="w">
    <frame name="f"><pose>1 2 3 0 0 0</pose></frame>
    <model name="m"><pose relative_to="f">1 0 0 0 0 0</pose><link name="l"/></model>
  </world>
</sdf>
"""
BAD = GOOD.replace('relative_to="f"', 'relative_to="ff"').replace('1 2 3', '1 2')
WARNED = GOOD.replace('<link name="l"/>', """<link name="l">
      <light name="lamp" type="point"><pose relative_to="nowhere"/></light>
    </link>""")


@pytest.fixture(name='files')
def write_files(tmp_path):
    for name, text in (('good', GOOD), ('bad', BAD), ('warned', WARNED)):
        (tmp_path / f'{name}.sdf').write_text(text)
    return tmp_path


def run(folder, *words):
    return subprocess.run(
        [sys.executable, '-m', 'sdf_pose_bridge', *words], cwd=folder,
        env={'PYTHONPATH': str(ROOT)}, capture_output=True, text=True, timeout=60, check=False)


def test_check_prints_errors_in_the_order_of_the_file(files):
    done = run(files, 'check', 'bad.sdf')
    assert done.returncode == 1
    first, second = done.stdout.splitlines()
    assert first.startswith('bad.sdf:3: ELEMENT_INVALID: ')
    assert second.startswith('bad.sdf:4: POSE_RELATIVE_TO_INVALID: relative_to="ff" names no ')


def test_check_says_nothing_of_a_good_file(files):
    done = run(files, 'check', 'good.sdf')
    assert (done.returncode, done.stdout, done.stderr) == (0, '', '')


def test_check_prints_warnings_and_exits_with_0(files):
    done = run(files, 'check', 'warned.sdf')
    assert done.returncode == 0
    assert done.stdout.startswith('warned.sdf:5: WARNING: POSE_RELATIVE_TO_INVALID: ')


def test_check_goes_on_after_a_bad_file(files):
    done = run(files, 'check', 'missing.sdf', 'bad.sdf')
    assert done.returncode == 1
    assert [line.split(':')[0] for line in done.stdout.splitlines()] == [
        'missing.sdf', 'bad.sdf', 'bad.sdf']


def test_check_prints_no_colours_into_a_pipe(files):
    assert '\x1b' not in run(files, 'check', 'bad.sdf').stdout


def test_poses_prints_a_table(files):
    lines = run(files, 'poses', 'good.sdf').stdout.splitlines()
    assert lines[0].split() == ['kind', 'name', 'x', 'y', 'z', 'qx', 'qy', 'qz', 'qw']
    assert lines[3].split() == [
        'link', 'm::l', '2.000000', '2.000000', '3.000000', *['0.000000'] * 3, '1.000000']


def test_poses_prints_an_object_for_each_file(files):
    done = run(files, 'poses', '--json', 'bad.sdf', 'good.sdf')
    assert done.returncode == 1
    bad, good = map(json.loads, done.stdout.splitlines())
    assert (bad['file'], bad['ok'], bad['elements']) == ('bad.sdf', False, [])
    assert bad['errors'][1].items() >= {
        'code': 'POSE_RELATIVE_TO_INVALID', 'file': 'bad.sdf', 'line': 4,
        'element': '/sdf/world[@name="w"]/model[@name="m"]/pose'}.items()
    assert (good['ok'], good['errors'], good['warnings']) == (True, [], [])
    assert good['elements'][2] == {
        'kind': 'link', 'name': 'm::l', 'world': 'w', 'pose': [2.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0]}


def test_poses_are_printed_relative_to_a_frame(files):
    done = run(files, 'poses', '--json', '--relative-to', 'f', '--kinds', 'link,model', 'good.sdf')
    elements = json.loads(done.stdout)['elements']
    assert [element['kind'] for element in elements] == ['model', 'link']
    assert elements[1]['pose'] == [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]


def test_an_unknown_frame_is_an_error_of_the_file(files):
    done = run(files, 'poses', '--relative-to', 'ff', 'good.sdf')
    assert done.returncode == 1
    assert '"ff" names nothing in world "w"; did you mean "f"?' in done.stderr


def test_an_unknown_kind_is_named_with_those_there_are(files):
    done = run(files, 'poses', '--kinds', 'link,lnik', 'good.sdf')
    assert done.returncode == 2
    assert '"lnik" is no kind of element; known are model, link' in done.stderr


def test_includes_are_looked_for_in_given_directories(files):
    (files / 'models').mkdir()
    (files / 'models' / 'm.sdf').write_text('<sdf version="1.9"><model name="m"><link name="l"/>'
                                            '</model></sdf>')
    (files / 'world.sdf').write_text('<sdf version="1.9"><world name="w"><include><uri>model://m.sdf'
                                     '</uri></include></world></sdf>')
    assert run(files, 'check', 'world.sdf').returncode == 1
    assert run(files, 'check', '-I', 'models', 'world.sdf').returncode == 0
    skipped = run(files, 'check', '--skip-missing', 'world.sdf')
    assert skipped.returncode == 0
    assert 'WARNING: "model://m.sdf" cannot be included' in skipped.stdout


def test_a_reader_that_goes_away_is_no_error_to_tell(files):
    command = f'{sys.executable} -m sdf_pose_bridge poses {"good.sdf " * 2000}| head -1'
    done = subprocess.run(
        ['bash', '-c', command], cwd=files, env={'PYTHONPATH': str(ROOT), 'PATH': '/usr/bin:/bin'},
        capture_output=True, text=True, timeout=60, check=False)
    assert done.stderr == ''
