# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Replace the content of a file: all of it or nothing, whatever happens meanwhile.

The new content is written to a file without a name, which vanishes with the process. It gets a
name beside the old file only when it is on the disk, and takes the place of the old one at once,
by a process of its own, so that a writer that is killed leaves nothing behind.
"""

from __future__ import annotations

import errno
import fcntl
import os
from pathlib import Path
import stat
import subprocess
import sys

from sdf_pose_bridge.errors import FileWriteError
from sdf_pose_bridge.errors import Place


def replace_file(path: str, old: bytes, new: bytes) -> None:
    """
    Replace the content of a file, which keeps its mode and owner; links to it stay links.

    :param path: path of the file.
    :param old: what it holds, as far as the caller knows.
    :param new: what it shall hold.
    :raises FileWriteError: if it cannot be written, or does not hold ``old``, or another process
        replaces it now; it is as before then.
    """
    try:
        real_path = Path(path).resolve(strict=True)
        with real_path.open('rb') as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if not os.access(real_path, os.W_OK):
                raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
            status = os.fstat(file.fileno())
            descriptor = os.open(real_path.parent, os.O_TMPFILE | os.O_WRONLY, 0o600)
            with os.fdopen(descriptor, 'wb') as target:
                target.write(new)
                os.fchown(target.fileno(), status.st_uid, status.st_gid)
                os.fchmod(target.fileno(), stat.S_IMODE(status.st_mode))
                target.flush()
                os.fsync(target.fileno())
                if file.read() != old:
                    raise FileWriteError(_CHANGED, Place(path))
                _put_in_place(target.fileno(), real_path, file.fileno())
    except BlockingIOError as error:
        msg = 'another process is writing the file'
        raise FileWriteError(msg, Place(path)) from error
    except OSError as error:
        msg = f'the file cannot be written: {(error.strerror or str(error)).lower()}'
        raise FileWriteError(msg, Place(path)) from error


def _put_in_place(descriptor: int, path: Path, locked: int) -> None:
    """
    Let another process do the last step, which is done even if this one is killed meanwhile.

    :param descriptor: the new file.
    :param locked: the old file, which stays locked until that process has ended.
    """
    status = os.fstat(locked)
    # Linux has no call that gives a file a name that is in use, so it gets another one first. If
    # all processes are killed just then, the next one that writes the file removes the rest.
    temporary = path.with_name(f'.{path.name}.sdf_pose')
    arguments = [descriptor, temporary, path, status.st_ino, status.st_mtime_ns]
    done = subprocess.run(
        [sys.executable, '-I', '-S', '-c', _LAST_STEP, *map(str, arguments)],
        pass_fds=[descriptor, locked], start_new_session=True, check=False)
    if done.returncode == _HAS_CHANGED:
        raise FileWriteError(_CHANGED, Place(str(path)))
    if done.returncode:
        raise OSError(done.returncode, os.strerror(done.returncode))


_CHANGED = 'the file has changed since it was read, so it is not overwritten'
_HAS_CHANGED = 255
_LAST_STEP = f"""
import contextlib, os, sys
descriptor, temporary, path, *expected = sys.argv[1:]
try:
    folder = os.open(os.path.dirname(path), os.O_RDONLY)
    with contextlib.suppress(FileNotFoundError):
        os.unlink(temporary)
    status = os.stat(path)
    if expected != [str(status.st_ino), str(status.st_mtime_ns)]:
        sys.exit({_HAS_CHANGED})
    # With a descriptor of a directory os.link follows the link in /proc.
    os.link(f'/proc/self/fd/{{descriptor}}', temporary, src_dir_fd=folder)
    os.replace(temporary, path)
    os.fsync(folder)
except OSError as error:
    sys.exit(error.errno)
"""
