# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Replace a range of bytes in a file, in a separate process that :func:`replace_range` starts.

The starting process may be killed at any time: the file has its old or its new content, and no
other file is left behind. The new content is written to a file without a name, and exchanged with
the old one, if the file system supports these. The old content is compared again after the
exchange, when nothing more can be written to it by its name.
"""

from __future__ import annotations

import ctypes
import errno
import fcntl
import os
from pathlib import Path
import stat
import subprocess
import sys
from typing import NamedTuple

_CHANGED = 'the file has changed since it was read, so it is not overwritten'
_WITHOUT_NAMELESS_FILES = frozenset({errno.EOPNOTSUPP, errno.EISDIR, errno.ENOENT})
_WITHOUT_EXCHANGE = frozenset({errno.EINVAL, errno.ENOSYS, errno.EOPNOTSUPP})
_EXCHANGE = 2  # RENAME_EXCHANGE of linux/fs.h
_AT_FDCWD = -100


class RefusedError(Exception):
    """The file is not changed; the text is the reason."""


class _State(NamedTuple):
    """The state of a file that must not change while it is replaced."""

    device: int
    inode: int
    mode: int
    links: int
    user: int
    group: int
    size: int
    changed_ns: int


def replace_range(path: str, old: bytes, begin: int, end: int, new: bytes) -> None:
    """
    Let another process replace a range of bytes in a file, and keep its attributes.

    The other process completes the replacement even if this one is killed.

    :param path: the file, or a link to it, which stays a link.
    :param old: the whole content of the file as the caller knows it.
    :param begin: the first byte of the range.
    :param end: the byte behind it.
    :param new: the new content of the range.
    :raises RefusedError: if it cannot be written, has another content than ``old``, or is being
        written by another process; it is unchanged then.
    """
    arguments = [os.fspath(path), str(begin), str(end), new.hex()]
    try:
        # Leaving the block waits for the process; subprocess.run would kill it.
        with subprocess.Popen(
                [sys.executable, '-I', '-S', __file__, *arguments], start_new_session=True,
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
            reason, failure = process.communicate(old)
    except OSError as error:
        msg = f'the file cannot be written: {_reason(error)}'
        raise RefusedError(msg) from error
    if process.returncode:
        lines = (reason or failure).decode().splitlines()
        raise RefusedError(
            lines[-1] if lines else f'the file cannot be written: exit code {process.returncode}')


def _reason(error: OSError) -> str:
    return (error.strerror or str(error)).lower()


def _replace(path: str, old: bytes, begin: int, end: int, new: bytes) -> None:
    """Replace a range of bytes as :func:`replace_range`, in this process."""
    real_path = Path(path).resolve(strict=True)
    with os.fdopen(os.open(real_path, os.O_RDWR | os.O_NONBLOCK | os.O_NOCTTY), 'rb') as file:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        state = _state(os.fstat(file.fileno()))
        if state.links > 1:
            msg = (f'the file has {state.links} names (hard links), and the others would keep the '
                   'old text; copy it first, or change it by an editor')
            raise RefusedError(msg)

        def check(current: Path) -> None:
            file.seek(0)
            if _state(current.lstat()) != state or file.read() != old:
                raise RefusedError(_CHANGED)

        check(real_path)
        folder = os.open(real_path.parent, os.O_RDONLY | os.O_DIRECTORY)
        temporary = real_path.with_name(f'.sdf_pose_{os.urandom(8).hex()}')
        target = _new_file(folder, temporary)
        try:
            with open(target, 'wb', closefd=False) as writer:
                writer.write(b''.join([old[:begin], new, old[end:]]))
            _copy_attributes(file.fileno(), target)
            os.fsync(target)
            if not temporary.exists():
                # With a descriptor of a directory os.link follows the link in /proc.
                os.link(f'/proc/self/fd/{target}', temporary, src_dir_fd=folder)
            if _exchanged(temporary, real_path):
                try:
                    check(temporary)
                except RefusedError:
                    _exchanged(temporary, real_path)
                    raise
                temporary.unlink()
            else:
                check(real_path)
                temporary.replace(real_path)
            os.fsync(folder)
        except BaseException:
            # A file that another process may have put there is not removed.
            if temporary.exists() and temporary.lstat().st_ino == os.fstat(target).st_ino:
                temporary.unlink()
            raise


def _state(status: os.stat_result) -> _State:
    return _State(
        status.st_dev, status.st_ino, status.st_mode, status.st_nlink, status.st_uid,
        status.st_gid, status.st_size, status.st_mtime_ns)


def _new_file(folder: int, temporary: Path) -> int:
    """Open a file for writing, without a name if the file system of the folder has such files."""
    try:
        return os.open(f'/proc/self/fd/{folder}', os.O_TMPFILE | os.O_WRONLY, 0o600)
    except OSError as error:
        if error.errno not in _WITHOUT_NAMELESS_FILES:
            raise
    return os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600)


def _copy_attributes(source: int, target: int) -> None:
    """Give a new file the owner, the access list and other attributes, and the mode of another."""
    status, new_status = os.fstat(source), os.fstat(target)
    try:
        if (status.st_uid, status.st_gid) != (new_status.st_uid, new_status.st_gid):
            os.fchown(target, status.st_uid, status.st_gid)
    except OSError as error:
        msg = f'its owner and group cannot be kept: {_reason(error)}'
        raise RefusedError(msg) from error
    wanted, existing = _extended_attributes(source), _extended_attributes(target)
    for name in {**wanted, **existing}:
        try:
            if name not in wanted:
                # For example the access list that a folder gives to its files.
                os.removexattr(target, name)
            elif wanted[name] != existing.get(name):
                os.setxattr(target, name, wanted[name])
        except OSError as error:
            msg = f'its attribute {name} cannot be kept: {_reason(error)}'
            raise RefusedError(msg) from error
    # The mode comes last, as other attributes change it. With an access list, it has the mask
    # instead of the rights of the group.
    if status.st_mode != os.fstat(target).st_mode:
        os.fchmod(target, stat.S_IMODE(status.st_mode))


def _extended_attributes(descriptor: int) -> dict[str, bytes]:
    """Return the extended attributes of a file, among them its access list."""
    try:
        return {name: os.getxattr(descriptor, name) for name in os.listxattr(descriptor)}
    except OSError as error:
        if error.errno != errno.EOPNOTSUPP:
            raise
    return {}


def _exchanged(temporary: Path, path: Path) -> bool:
    """Exchange two files at once; return False if the system or file system cannot do it."""
    renameat2 = getattr(ctypes.CDLL(None, use_errno=True), 'renameat2', None)
    if renameat2 is None:
        return False
    if renameat2(_AT_FDCWD, os.fsencode(temporary), _AT_FDCWD, os.fsencode(path), _EXCHANGE) == 0:
        return True
    number = ctypes.get_errno()
    if number in _WITHOUT_EXCHANGE:
        return False
    raise OSError(number, os.strerror(number))


def _main(path: str, begin: str, end: str, new: str) -> str:
    """
    Replace a range in a file whose old content comes from standard input.

    :return: why it was not done; empty if it was.
    """
    try:
        _replace(path, sys.stdin.buffer.read(), int(begin), int(end), bytes.fromhex(new))
    except RefusedError as error:
        return str(error)
    except BlockingIOError:
        return 'another process is writing the file'
    except OSError as error:
        return f'the file cannot be written: {_reason(error)}'
    return ''


if __name__ == '__main__':
    found = _main(*sys.argv[1:])
    print(found)
    sys.exit(bool(found))
