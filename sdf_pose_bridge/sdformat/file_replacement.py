# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Replace the content of a file in one step."""

from __future__ import annotations

import contextlib
import fcntl
import os
from pathlib import Path
import shutil
import tempfile

from sdf_pose_bridge.errors import FileWriteError, Place

_ACCESS_LIST = 'system.posix_acl_access'


def replace_file(path: str, old: bytes, new: bytes) -> None:
    """
    Replace the content of a file, and keep its mode, owner, access list and attributes.

    The file has its old or its new content at any time. If the process is killed meanwhile, a
    directory ``.sdf_pose_...`` may stay beside the file.

    :param path: the file, or a link to it, which stays a link.
    :param old: the content of the file as the caller knows it.
    :param new: the new content.
    :raises FileWriteError: if it cannot be written, has another content than ``old``, or is being
        written by another process; it is unchanged then.
    """
    try:
        reason = _refusal(Path(path), old, new)
    except BlockingIOError:
        reason = 'another process is writing the file'
    except OSError as error:
        reason = f'the file cannot be written: {(error.strerror or str(error)).lower()}'
    if reason:
        raise FileWriteError(reason, Place(path))


def _refusal(path: Path, old: bytes, new: bytes) -> str:
    """Replace the content of a file, or return why it must not be replaced."""
    # The rename below would replace a read-only file too, so it is opened for writing.
    with path.open('r+b') as file:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        path = path.resolve()
        status = os.fstat(file.fileno())
        if status.st_nlink > 1:
            return (f'the file has {status.st_nlink} names (hard links), and the others would '
                    'keep the old text; copy it first, or change it by an editor')
        # A directory of its own, as the standard library removes it after any exception.
        with tempfile.TemporaryDirectory(prefix='.sdf_pose_', dir=path.parent) as directory:
            new_path = Path(directory, path.name)
            with new_path.open('xb') as new_file:
                # The access list that the directory gives to its files may not be the file's.
                with contextlib.suppress(OSError):
                    os.removexattr(new_path, _ACCESS_LIST)
                try:
                    os.chown(new_path, status.st_uid, status.st_gid)
                except OSError as error:
                    return f'its owner and group cannot be kept: {(error.strerror or "").lower()}'
                shutil.copystat(path, new_path)
                # Written last, so that the file has the time of now.
                new_file.write(new)
                new_file.flush()
                os.fsync(new_file.fileno())
            if path.read_bytes() != old:
                return 'the file has changed since it was read, so it is not overwritten'
            new_path.replace(path)
    return ''
