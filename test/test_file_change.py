# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Other bytes in a range of a file, how they are shown, and how the file is replaced."""

import difflib
import fcntl
import os
import random
import re
import resource
import signal
import stat
import struct
import subprocess
import sys

from command_line import completed
from processes import started
import pytest

from sdf_pose_bridge.errors import FileWriteError
from sdf_pose_bridge.file_change import FileChange, replace_file


def change_of(text, old, new, encoding='utf-8', path='cell.sdf'):
    before, _, behind = text.partition(old)
    return FileChange(path, encoding, *(
        part.encode(encoding) for part in (before, old, new, behind)))


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
    assert change.undone.new_text == LINES.encode()
    assert change.undone.undone == change


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


# Replacement

ACCESS_LIST = 'system.posix_acl_access'
FOLDER_LIST = 'system.posix_acl_default'
OLD, NEW = b'the old text', b'the new text'


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


@pytest.fixture
def path(tmp_path):
    path = tmp_path / 'cell.sdf'
    path.write_bytes(b'the old text')
    return path


def left_beside(path):
    return [each for each in path.parent.iterdir() if each != path]


def assert_refused(path, reason, content=OLD):
    """Check that a file is not replaced for a reason, and stays as it is."""
    with pytest.raises(FileWriteError, match=reason):
        replace_file(str(path), OLD, NEW)
    assert path.read_bytes() == content
    assert not left_beside(path)


def edited_meanwhile(monkeypatch, edit):
    """Run an edit after the new file is written, before the old one is replaced."""
    synchronize = os.fsync

    def synchronize_and_edit(descriptor):
        synchronize(descriptor)
        edit()

    monkeypatch.setattr(os, 'fsync', synchronize_and_edit)


def test_a_missing_file_is_one_sentence(tmp_path):
    with pytest.raises(FileWriteError, match='cannot be written: no such file') as caught:
        replace_file(str(tmp_path / 'missing.sdf'), b'', NEW)
    assert caught.value.place.file == str(tmp_path / 'missing.sdf')


def test_a_file_that_has_changed_is_not_overwritten(path):
    path.write_bytes(b'the new text of another')
    assert_refused(path, 'has changed since it was read', b'the new text of another')


def test_a_pipe_in_the_place_of_the_file_is_refused(path):
    path.unlink()
    os.mkfifo(path)
    with pytest.raises(FileWriteError, match='it is no regular file any more'):
        replace_file(str(path), OLD, NEW)
    assert not left_beside(path)


@pytest.mark.parametrize('make', [os.mkfifo, lambda other: other.open('wb').truncate(10**12)])
def test_what_takes_the_place_of_the_file_meanwhile_is_neither_waited_for_nor_read(
        path, monkeypatch, make):
    def swap():
        other = path.with_name('other')
        make(other)
        other.replace(path)

    edited_meanwhile(monkeypatch, swap)
    with pytest.raises(FileWriteError, match='has changed since it was read'):
        replace_file(str(path), OLD, NEW)
    assert not left_beside(path)


@pytest.mark.parametrize('edit', ['in place', 'by another file'])
def test_an_edit_while_the_new_file_is_written_is_kept(path, monkeypatch, edit):
    def change():
        other = path if edit == 'in place' else path.with_name('other')
        other.write_bytes(b'THE OLD TEXT')
        other.replace(path)

    edited_meanwhile(monkeypatch, change)
    assert_refused(path, 'has changed since it was read', b'THE OLD TEXT')


def test_a_file_with_a_second_name_is_refused(path, tmp_path_factory):
    os.link(path, tmp_path_factory.mktemp('other') / 'second.sdf')
    assert_refused(path, r'2 names \(hard links\), and the others would keep')


def test_a_file_that_another_process_writes_is_left_alone(path):
    with path.open('rb') as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        assert_refused(path, 'another process is writing the file')


@pytest.mark.skipif(os.geteuid() == 0, reason='root may write everywhere')
@pytest.mark.parametrize('part', ['file', 'directory'])
def test_without_the_right_to_write_it_is_one_sentence(path, part):
    refusing = path if part == 'file' else path.parent
    mode = refusing.stat().st_mode
    refusing.chmod(mode & 0o555)
    assert_refused(path, 'permission denied')
    refusing.chmod(mode)


def test_an_owner_that_cannot_be_kept_is_a_reason_to_refuse_but_for_an_output(path, monkeypatch):
    def refuse(*_):
        raise PermissionError(1, 'Operation not permitted')

    monkeypatch.setattr(os, 'chown', refuse)
    assert_refused(path, 'its owner and group cannot be kept: operation not')
    replace_file(str(path), None, NEW)
    assert path.read_bytes() == NEW


def test_without_space_the_old_file_is_whole(path):
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (len(NEW) - 1, limits[1]))
    try:
        assert_refused(path, 'the file cannot be written: file too large')
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)


def test_the_content_is_replaced_and_the_mode_stays(path):
    path.chmod(0o640)
    os.utime(path, ns=(0, 0))
    replace_file(str(path), OLD, NEW)
    assert path.read_bytes() == NEW
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    assert path.stat().st_mtime_ns > 0
    assert not left_beside(path)


def test_a_link_stays_a_link(path, tmp_path):
    link = tmp_path / 'link.sdf'
    link.symlink_to('cell.sdf')
    replace_file(str(link), OLD, NEW)
    assert link.is_symlink()
    assert path.read_bytes() == NEW


def test_access_list_and_attributes_stay(path):
    set_attribute(path, ACCESS_LIST, access_list(4321, 4))
    set_attribute(path, 'user.note', b'measured in March')
    before = path.stat()
    replace_file(str(path), OLD, NEW)
    assert os.getxattr(path, ACCESS_LIST) == access_list(4321, 4)
    assert os.getxattr(path, 'user.note') == b'measured in March'
    assert path.stat().st_mode == before.st_mode


def test_the_list_that_a_folder_gives_to_new_files_is_not_taken(path):
    path.chmod(0o600)
    set_attribute(path.parent, FOLDER_LIST, access_list(4321, 7))
    replace_file(str(path), OLD, NEW)
    assert ACCESS_LIST not in os.listxattr(path)
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_a_killed_process_leaves_the_old_file_or_the_new_one(path):
    random_numbers = random.Random(1)
    rest = b'x' * 300_000
    program = (
        'from sdf_pose_bridge.file_change import replace_file\n'
        'texts = [word + b"x" * 300_000 for word in (b"old", b"new")]\n'
        'print(flush=True)\n'
        'while True:\n'
        f'    replace_file({str(path)!r}, *texts)\n'
        '    texts.reverse()')
    for _ in range(5):
        path.write_bytes(b'old' + rest)
        process = started([sys.executable, '-c', program], stdout=subprocess.PIPE)
        process.stdout.readline()
        with pytest.raises(subprocess.TimeoutExpired):
            process.wait(random_numbers.uniform(0.001, 0.1))
        process.send_signal(signal.SIGKILL)
        process.communicate()
        assert path.read_bytes() in (b'old' + rest, b'new' + rest)


AT_EACH_LINE = """
from itertools import count, cycle
import os
from pathlib import Path
import signal
import sys

from sdf_pose_bridge.file_change import replace_file

path, old, new = Path(sys.argv[1]), b'the old text', b'the new text'
modules = 'file_change', 'contextlib', 'tempfile', 'shutil'
numbers = signal.SIGINT, signal.SIGTERM, signal.SIGHUP
for number in numbers:
    signal.signal(number, signal.SIG_DFL)
# Nothing here depends on the disk, which is slow.
os.fsync = lambda _: None


def end_at_line(last, number):
    lines = count()

    def trace(frame, event, _value):
        if Path(frame.f_code.co_filename).stem not in modules:
            return None
        if event == 'line' and next(lines) == last:
            os.kill(os.getpid(), number)
        return trace

    sys.settrace(trace)
    replace_file(str(path), old, new)
    sys.settrace(None)
    os._exit(1 if next(lines) > last else 0)


for last, number in zip(count(), cycle(numbers)):
    path.write_bytes(old)
    pid = os.fork() or end_at_line(last, number)
    code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
    if code == 0:
        break
    result = code, os.listdir(path.parent), path.read_bytes()
    if result not in [(-number, [path.name], text) for text in (old, new)]:
        sys.exit(f'{result} at line {last}')
print('ended at', last, 'lines')
"""
"""Has each process get a signal at another line of Python that replaces a file."""


def test_a_signal_at_any_line_leaves_a_whole_file_alone(path):
    done = completed([sys.executable, '-c', AT_EACH_LINE, str(path)])
    assert done.stderr == ''
    assert re.fullmatch(r'ended at \d{3,} lines\n', done.stdout)
