# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A file has its old content or its new one, and nothing else is left."""

import fcntl
import os
from pathlib import Path
import random
import signal
import subprocess
import sys
import time

import pytest

from sdf_pose_bridge.errors import FileWriteError
from sdf_pose_bridge.sdformat.file_replacement import replace_file

ROOT = Path(__file__).resolve().parents[2]
IMPORT = 'from sdf_pose_bridge.sdformat.file_replacement import replace_file\n'


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
