# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Poses in a file are changed, and nothing else is; it has its old content or its new one."""

import fcntl
import math
import os
from pathlib import Path
import random
import signal
import subprocess
import sys
import time

from hypothesis import example
from hypothesis import given
from hypothesis import strategies as st
import pytest
from sdf_texts import model_file

from sdf_pose_bridge import Pose
from sdf_pose_bridge.errors import FileWriteError
from sdf_pose_bridge.errors import PoseNotSetError
from sdf_pose_bridge.geometry.poses import canonical_relative_pose
from sdf_pose_bridge.geometry.rotations import canonical_quaternion
from sdf_pose_bridge.sdformat.pose_writing import PoseText
from sdf_pose_bridge.sdformat.pose_writing import replace_file

HALF = 0.5 ** 0.5
NEW = Pose(1.5, -2.0, 0.25, 0.0, 0.0, HALF, HALF)


def changed(text):
    """Set the pose of the link, which comes third, behind sdf and model."""
    return PoseText(text.encode(), 'file.sdf').with_pose(3, NEW, 1e-9).decode()


@pytest.mark.parametrize(('old', 'new'), [
    ('<pose>0 0 0 0 0 0</pose>', '<pose>1.5 -2 0.25 0 0 1.570796327</pose>'),
    ('<pose>\n\t0  0\t0\r\n0 0 0 </pose>', '<pose>\n\t1.5  -2\t0.25\r\n0 0 1.570796327 </pose>'),
    ("<pose degrees='true' >0 0 0 0 0 0</pose >",
     "<pose degrees='true' >1.5 -2 0.25 0 0 90</pose >"),
    ('<pose rotation_format="quat_xyzw">0 0 0 0 0 0 1</pose>',
     '<pose rotation_format="quat_xyzw">1.5 -2 0.25 0 0 0.7071067812 0.7071067812</pose>'),
    ('<pose/>', '<pose>1.5 -2 0.25 0 0 1.570796327</pose>'),
    ('<pose relative_to="l" />', '<pose relative_to="l" >1.5 -2 0.25 0 0 1.570796327</pose>'),
    ('<pose></pose>', '<pose>1.5 -2 0.25 0 0 1.570796327</pose>'),
    ('<pose><!-- <pose> x y --> 0 0 0 0 0 0<!-- end --></pose>',
     '<pose><!-- <pose> x y --> 1.5 -2 0.25 0 0 1.570796327<!-- end --></pose>'),
    ('<pose>1.50 -2.0 2.5e-1 0.0 -0 0</pose>',
     '<pose>1.50 -2.0 2.5e-1 0.0 -0 1.570796327</pose>'),
    ('<pose>9 9 9 0 0 7.853981633974483</pose>', '<pose>1.5 -2 0.25 0 0 7.853981633974483</pose>'),
])
def test_only_the_numbers_change(old, new):
    text = model_file('<!-- <pose> é --><link name="l">{}</link ><frame name="f"/>\n')
    assert changed(text.replace('{}', old)) == text.replace('{}', new)


@pytest.mark.parametrize('encoding', [
    'utf-8', 'utf-8-sig', 'iso-8859-1', 'utf-16-le', 'utf-16-be'])
def test_encoding_stays(encoding):
    mark = '\ufeff' if encoding.startswith('utf-16') else ''
    declared = 'utf-8' if encoding == 'utf-8-sig' else encoding[:6] if mark else encoding
    text = f'{mark}<?xml version="1.0" encoding="{declared}"?>\r\n' + model_file(
        '<link name="é"><pose>0 0 0 0 0 0</pose></link>')
    pose_text = PoseText(text.encode(encoding), 'file.sdf')
    # The elements are sdf, model, link, pose.
    assert pose_text.with_pose(3, NEW, 1e-9) == text.replace(
        '0 0 0 0 0 0', '1.5 -2 0.25 0 0 1.570796327').encode(encoding)


@pytest.mark.parametrize(('old', 'new'), [
    ('<link name="l"/>', '<link name="l">{}</link>'),
    ('<link name="l"></link>', '<link name="l">{}</link>'),
    ('<link name="l">\n    <visual name="v"/>\n  </link>',
     '<link name="l">\n    {}\n    <visual name="v"/>\n  </link>'),
    ('<link name="l">\r\n\r\n\t<!-- c -->\r\n</link>',
     '<link name="l">\r\n\t{}\r\n\r\n\t<!-- c -->\r\n</link>'),
])
def test_a_new_pose_is_indented_like_what_follows(old, new):
    text = PoseText(model_file(old).encode(), 'file.sdf').with_new_pose(2, NEW, 1e-9).decode()
    assert text == model_file(new.format('<pose>1.5 -2 0.25 0 0 1.570796327</pose>'))


@pytest.mark.parametrize(('text', 'reason'), [
    (model_file('<link name="l"><pose><![CDATA[0 0 0 0 0 0]]></pose></link>'), 'plain text'),
    (model_file('<link name="l"><pose>&#48; 0 0 0 0 0</pose></link>'), 'plain text'),
    (model_file('<link name="l"><pose>0 0 0</pose></link>'), 'a pose has 6 values'),
    (model_file('<link name="l"><pose degrees="true" rotation_format="quat_xyzw"/></link>'),
     'cannot be combined'),
    (model_file('<link name="R&D"><pose>0 0 0 0 0 0</pose></link>'), 'not well-formed'),
    ('<robot name="r"><link name="l"><pose>0 0 0 0 0 0</pose></link></robot>', 'URDF'),
])
def test_other_texts_are_refused(text, reason):
    with pytest.raises(PoseNotSetError, match=reason):
        PoseText(text.encode(), 'file.sdf').with_pose(3, NEW, 1e-9)


def test_each_tag_has_a_line():
    text = PoseText(model_file('<link name="a"/><link name="b"\n/>').encode(), 'file.sdf')
    assert [text.element_at_line(line) for line in (1, 2, 3, 4)] == [0, 1, 2, 3]
    with pytest.raises(PoseNotSetError):
        text.element_at_line(5)
    assert text.line(3) == 1


NUMBERS = st.floats(-1e6, 1e6)


@example(
    (899462.4420425005, 1.4364914845209569, 0.0),
    (-0.30711506386201737, -1.0, -0.30711506386201737, -0.5), '')
@given(st.tuples(NUMBERS, NUMBERS, NUMBERS), st.tuples(*[st.floats(-1, 1)] * 4).filter(
    lambda quat_xyzw: max(map(abs, quat_xyzw)) > 1e-3), st.sampled_from([
        '', 'degrees="true"', 'rotation_format="quat_xyzw"']))
def test_what_is_written_is_right_to_the_tolerance(xyz, quat_xyzw, attributes):
    pose = Pose(*xyz, *canonical_quaternion(quat_xyzw))
    text = model_file(f'<link name="l"><pose {attributes}/></link>').encode()
    written = PoseText(PoseText(text, '').with_pose(3, pose, 1e-9), '').pose(3)
    # Far from the origin, a relative pose is rounded more than what is written.
    assert math.dist(pose[:3], written[:3]) <= 1e-9
    between = canonical_relative_pose(pose, written)
    assert 2.0 * sum(part ** 2 for part in between[3:6]) ** 0.5 <= 1e-9


ROOT = Path(__file__).resolve().parents[2]
IMPORT = 'from sdf_pose_bridge.sdformat.pose_writing import replace_file\n'


@pytest.fixture(name='path')
def make_file(tmp_path):
    path = tmp_path / 'cell.sdf'
    path.write_bytes(b'old')
    return path


def start(program):
    return subprocess.Popen(
        [sys.executable, '-c', IMPORT + program], env={'PYTHONPATH': str(ROOT)},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def test_content_is_replaced_and_mode_stays(path):
    path.chmod(0o640)
    replace_file(str(path), b'old', b'new')
    assert path.read_bytes() == b'new'
    assert path.stat().st_mode & 0o777 == 0o640
    assert list(path.parent.iterdir()) == [path]


def test_a_link_stays_a_link(path, tmp_path):
    link = tmp_path / 'link.sdf'
    link.symlink_to('cell.sdf')
    replace_file(str(link), b'old', b'new')
    assert link.is_symlink()
    assert path.read_bytes() == b'new'


def test_a_file_that_has_changed_is_not_overwritten(path):
    path.write_bytes(b'of another')
    with pytest.raises(FileWriteError, match='has changed since it was read'):
        replace_file(str(path), b'old', b'new')
    assert path.read_bytes() == b'of another'


def test_a_file_that_another_process_writes_is_left_alone(path):
    with path.open('rb') as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        with pytest.raises(FileWriteError, match='another process is writing the file'):
            replace_file(str(path), b'old', b'new')
    assert path.read_bytes() == b'old'


def test_a_missing_file_is_one_error(tmp_path):
    with pytest.raises(FileWriteError, match='no such file'):
        replace_file(str(tmp_path / 'missing.sdf'), b'', b'new')


@pytest.mark.skipif(os.geteuid() == 0, reason='root may write everywhere')
def test_a_directory_that_cannot_be_written_is_one_error(path):
    path.parent.chmod(0o500)
    with pytest.raises(FileWriteError, match='permission denied'):
        replace_file(str(path), b'old', b'new')
    path.parent.chmod(0o700)
    assert path.read_bytes() == b'old'


def test_without_space_the_old_file_is_whole(path):
    process = start(
        'import resource\n'
        'resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))\n'
        f'replace_file({str(path)!r}, b"old", bytes(2000))')
    assert 'FileWriteError' in process.communicate(timeout=60)[1]
    assert path.read_bytes() == b'old'
    assert list(path.parent.iterdir()) == [path]


def test_the_rest_of_a_killed_process_is_removed(path):
    (path.parent / '.cell.sdf.sdf_pose').write_bytes(b'rest')
    replace_file(str(path), b'old', b'new')
    assert list(path.parent.iterdir()) == [path]


def test_a_killed_process_leaves_the_old_file_or_the_new_one(path):
    random_numbers = random.Random(1)
    contents = [b'old', b'new' * 100_000]
    for _ in range(5):
        path.write_bytes(contents[0])
        process = start(
            f'contents = [b"old", b"new" * 100_000]\n'
            'print(flush=True)\n'
            'while True:\n'
            f'    replace_file({str(path)!r}, *contents)\n'
            '    contents.reverse()')
        process.stdout.readline()
        with pytest.raises(subprocess.TimeoutExpired):
            process.wait(random_numbers.uniform(0.001, 0.1))
        process.send_signal(signal.SIGKILL)
        process.communicate()
        assert path.read_bytes() in contents
        # Another process may still be at the last step.
        deadline = time.monotonic() + 20.0
        while list(path.parent.iterdir()) != [path]:
            assert time.monotonic() < deadline
        assert path.read_bytes() in contents
