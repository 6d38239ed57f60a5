# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Detect changes of files with ``os.stat``, as the standard library watches no files."""

from __future__ import annotations

from collections.abc import Iterable
import os
import time
from typing import TypeAlias

Signature: TypeAlias = tuple[int, ...] | None
"""
Device, inode, size, and both times of change of a file; None if there is no file.

Last, whether it may change again without another time: some file systems have times of whole
seconds, or of two. So each change there counts as a second one when this is over.
"""

_CHANGED: Signature = ()
"""Differs from every signature, so the file counts as changed."""

_TICK_NS = 20_000_000
"""Largest difference between the clock and the times of files."""

_SECOND_NS = 1_000_000_000


class FileWatcher:
    """
    Compares files with their earlier state.

    Editors replace a file, rename it, or write it in pieces; a file can vanish and come back. Each
    of these changes the result of ``os.stat`` for the path.
    """

    def __init__(self) -> None:
        self._signatures: dict[str, Signature] = {}
        self._recent: dict[str, Signature] = {}

    def watch(self, paths: Iterable[str], read_since_ns: int) -> None:
        """
        Watch these files and no others.

        A file that has changed since reading began counts as changed, once.

        :param read_since_ns: time at which reading began, in nanoseconds since 1970.
        """
        signatures = _signatures(paths)
        recent: dict[str, Signature] = {
            path: signature for path, signature in signatures.items()
            if signature is not None and signature[-2] >= read_since_ns - _TICK_NS}
        # Reported once, because a file with a time in the future is always recent.
        changed = [path for path in recent if recent[path] != self._recent.get(path)]
        self._signatures = {**signatures, **dict.fromkeys(changed, _CHANGED)}
        self._recent = recent

    def watch_also(self, paths: Iterable[str]) -> None:
        """Watch more files and directories (their entries), until the next :meth:`watch`."""
        self._signatures = _signatures(set(paths).difference(self._signatures)) | self._signatures

    def notices_change(self) -> bool:
        """Compare the files, remember their current state, and return whether any has changed."""
        before, self._signatures = self._signatures, _signatures(self._signatures)
        return before != self._signatures


def _signatures(paths: Iterable[str]) -> dict[str, Signature]:
    return {path: _signature(path) for path in paths}


def _signature(path: str) -> Signature:
    try:
        status = os.stat(path)  # noqa: PTH116 - faster than Path.stat
    except (OSError, ValueError):
        return None
    # ctime cannot be set, so it also shows changed files whose old time was restored.
    changed_ns = status.st_ctime_ns
    is_recent = changed_ns % _SECOND_NS == 0 and time.time_ns() < changed_ns + 2 * _SECOND_NS
    return (
        status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns, changed_ns, is_recent)
