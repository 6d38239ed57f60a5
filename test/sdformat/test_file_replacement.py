# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A file has its old content or its new one, keeps all that belongs to it, and nothing is lost."""

import errno
import fcntl
import os
from pathlib import Path
import random
import signal
import stat
import struct
import subprocess
import sys
import time

import pytest

from sdf_pose_bridge.sdformat import file_replacement
from sdf_pose_bridge.sdformat.file_replacement import RefusedError, replace_range

ROOT = Path(__file__).resolve().parents[2]
IMPORT = 'from sdf_pose_bridge.sdformat.file_replacement import replace_range\n'
ACCESS_LIST = 'system.posix_acl_access'
FOLDER_LIST = 'system.posix_acl_default'


def access_list(user, rights):
    """An access list that gives a user rights, and the owner all; nobody else has any."""
    nobody = 0xffffffff
    entries = [(1, 7, nobody), (2, rights, user), (4, 0, nobody), (16, 7, nobody), (32, 0, nobody)]
    return struct.pack('<I', 2) + b''.join(struct.pack('<HHI', *entry) for entry in entries)


def set_attribute(path, name, value):
    try:
        os.setxattr(path, name, value)
    except OSError as error:
        pytest.skip(f'the file system of {path} does not have {name}: {error.strerror}')


@pytest.fixture(name='path')
def make_file(tmp_path):
    path = tmp_path / 'cell.sdf'
    path.write_bytes(b'the old text')
    return path


@pytest.fixture(params=['as it is', 'no files without names', 'no exchange', 'neither'])
def here(request, monkeypatch):
    """``replace_range`` in this process, on file systems that lack something."""
    if request.param in ('no files without names', 'neither'):
        open_file = os.open

        def open_named(path, flags, *arguments):
            if flags & os.O_TMPFILE == os.O_TMPFILE:
                raise OSError(errno.EOPNOTSUPP, os.strerror(errno.EOPNOTSUPP))
            return open_file(path, flags, *arguments)

        monkeypatch.setattr(os, 'open', open_named)
    if request.param in ('no exchange', 'neither'):
        monkeypatch.setattr(file_replacement, '_exchanged', lambda *_: False)
    return file_replacement._replace


def start(program):
    return subprocess.Popen(
        [sys.executable, '-c', IMPORT + program], env={'PYTHONPATH': str(ROOT)},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def test_the_range_is_replaced_and_the_mode_stays(path):
    path.chmod(0o640)
    replace_range(str(path), b'the old text', 4, 7, b'new')
    assert path.read_bytes() == b'the new text'
    assert path.stat().st_mode & 0o777 == 0o640
    assert list(path.parent.iterdir()) == [path]


def test_on_every_file_system_nothing_else_is_left(here, path):
    other = path.with_name('.cell.sdf.sdf_pose')
    other.write_text('of the user')
    here(str(path), b'the old text', 4, 7, b'newer')
    assert path.read_bytes() == b'the newer text'
    assert sorted(path.parent.iterdir()) == [other, path]
    assert other.read_text() == 'of the user'


def test_on_every_file_system_a_failure_leaves_nothing(here, path, monkeypatch):
    def full(_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, 'fsync', full)
    with pytest.raises(OSError, match='No space'):
        here(str(path), b'the old text', 4, 7, b'newer')
    assert path.read_bytes() == b'the old text'
    assert list(path.parent.iterdir()) == [path]


@pytest.mark.parametrize('edit', ['in place', 'by another file'])
def test_an_edit_while_the_new_file_is_written_is_kept(here, path, monkeypatch, edit):
    synchronize = os.fsync

    def edit_meanwhile(descriptor):
        synchronize(descriptor)
        if edit == 'in place':
            before = path.stat()
            path.write_bytes(b'THE OLD TEXT')
            os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))
        else:
            other = path.with_name('other')
            other.write_bytes(b'THE OLD TEXT')
            other.replace(path)

    monkeypatch.setattr(os, 'fsync', edit_meanwhile)
    with pytest.raises(RefusedError, match='has changed since it was read'):
        here(str(path), b'the old text', 4, 7, b'newer')
    assert path.read_bytes() == b'THE OLD TEXT'
    assert list(path.parent.iterdir()) == [path]


def test_other_rights_that_it_got_meanwhile_are_kept(here, path, monkeypatch):
    path.chmod(0o644)
    synchronize = os.fsync

    def restrict(descriptor):
        synchronize(descriptor)
        path.chmod(0o600)

    monkeypatch.setattr(os, 'fsync', restrict)
    with pytest.raises(RefusedError, match='has changed'):
        here(str(path), b'the old text', 4, 7, b'newer')
    assert path.stat().st_mode & 0o777 == 0o600


def test_a_link_stays_a_link(path, tmp_path):
    link = tmp_path / 'link.sdf'
    link.symlink_to('cell.sdf')
    replace_range(str(link), b'the old text', 4, 7, b'new')
    assert link.is_symlink()
    assert path.read_bytes() == b'the new text'


def test_a_file_with_a_second_name_is_refused(path):
    os.link(path, path.with_name('second.sdf'))
    with pytest.raises(RefusedError, match=r'2 names \(hard links\), and the others would keep'):
        replace_range(str(path), b'the old text', 4, 7, b'new')
    assert path.read_bytes() == b'the old text'


def test_a_file_that_has_changed_is_not_overwritten(path):
    path.write_bytes(b'the new text of another')
    with pytest.raises(RefusedError, match='has changed since it was read'):
        replace_range(str(path), b'the old text', 4, 7, b'new')
    assert path.read_bytes() == b'the new text of another'


def test_a_file_that_another_process_writes_is_left_alone(path):
    with path.open('rb') as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        with pytest.raises(RefusedError, match='another process is writing the file'):
            replace_range(str(path), b'the old text', 4, 7, b'new')
    assert path.read_bytes() == b'the old text'


def test_a_missing_file_is_one_sentence(tmp_path):
    with pytest.raises(RefusedError, match='no such file'):
        replace_range(str(tmp_path / 'missing.sdf'), b'', 0, 0, b'new')


def test_a_process_that_cannot_be_started_is_one_sentence(path, monkeypatch):
    monkeypatch.setattr(sys, 'executable', '/nowhere/python')
    with pytest.raises(RefusedError, match='no such file'):
        replace_range(str(path), b'the old text', 4, 7, b'new')


@pytest.mark.skipif(os.geteuid() == 0, reason='root may write everywhere')
def test_a_directory_that_cannot_be_written_is_one_sentence(path):
    path.parent.chmod(0o500)
    with pytest.raises(RefusedError, match='permission denied'):
        replace_range(str(path), b'the old text', 4, 7, b'new')
    path.parent.chmod(0o700)
    assert path.read_bytes() == b'the old text'


def test_access_list_and_attributes_stay(here, path):
    set_attribute(path, ACCESS_LIST, access_list(4321, 4))
    set_attribute(path, 'user.note', b'measured in March')
    before = path.stat()
    here(str(path), b'the old text', 4, 7, b'new')
    assert os.getxattr(path, ACCESS_LIST) == access_list(4321, 4)
    assert os.getxattr(path, 'user.note') == b'measured in March'
    assert path.stat().st_mode == before.st_mode


def test_the_list_that_a_folder_gives_to_new_files_is_not_taken(here, path):
    path.chmod(0o600)
    set_attribute(path.parent, FOLDER_LIST, access_list(4321, 7))
    here(str(path), b'the old text', 4, 7, b'new')
    assert ACCESS_LIST not in os.listxattr(path)
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_attributes_that_cannot_be_kept_are_a_reason_to_refuse(path, monkeypatch):
    set_attribute(path, 'user.note', b'measured in March')

    def refuse(*_):
        raise OSError(errno.EPERM, os.strerror(errno.EPERM))

    monkeypatch.setattr(os, 'setxattr', refuse)
    with pytest.raises(RefusedError, match=r'attribute user\.note cannot be kept: operation not'):
        file_replacement._replace(str(path), b'the old text', 4, 7, b'new')
    assert path.read_bytes() == b'the old text'
    assert list(path.parent.iterdir()) == [path]


def test_without_space_the_old_file_is_whole(path):
    process = start(
        'import resource\n'
        'resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))\n'
        f'replace_range({str(path)!r}, b"the old text", 4, 7, bytes(2000))')
    assert 'the file cannot be written: file too large' in process.communicate(timeout=60)[1]
    assert path.read_bytes() == b'the old text'
    assert list(path.parent.iterdir()) == [path]


def test_a_killed_process_leaves_the_old_file_or_the_new_one(path):
    random_numbers = random.Random(1)
    rest = b'x' * 300_000
    contents = [b'old' + rest, b'new' + rest]
    for _ in range(5):
        path.write_bytes(contents[0])
        process = start(
            'texts = [b"old", b"new"]\n'
            'print(flush=True)\n'
            'while True:\n'
            '    old, new = texts\n'
            f'    replace_range({str(path)!r}, old + b"x" * 300_000, 0, 3, new)\n'
            '    texts.reverse()')
        process.stdout.readline()
        with pytest.raises(subprocess.TimeoutExpired):
            process.wait(random_numbers.uniform(0.001, 0.1))
        process.send_signal(signal.SIGKILL)
        process.communicate()
        assert path.read_bytes() in contents
        # Another process may still be replacing the file.
        deadline = time.monotonic() + 20.0
        while list(path.parent.iterdir()) != [path]:
            assert time.monotonic() < deadline
        assert path.read_bytes() in contents
