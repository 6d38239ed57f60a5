# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Notice that files have changed, by what the file system says of them."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Iterable
import os
import threading
import time
from typing import TypeAlias

Signature: TypeAlias = tuple[int, int, int, int, int] | None
"""Device, inode, size and both times of change of a file; None for one that is not there."""

_UNKNOWN: Signature = (-1, -1, -1, -1, -1)
"""Of a file that changed while it was read, so that nobody knows what was read of it."""

_TICK_NS = 20_000_000
"""A file's time of change is that of the kernel's last tick, at most so long ago."""


PERIOD_S = 0.25
"""Seconds between two looks at the files."""

LARGEST_SHARE = 0.001
"""
The part of a core that may go into looking.

Where there are thousands of files, or they are far away, the period is so much longer.
"""


class FileWatch:
    """
    Looks at files when asked, so that the asking sets the pace.

    Editors replace a file by another, rename it, or write it in pieces; a file can vanish and come
    back. All of these change what the file system says of the path.
    """

    def __init__(self) -> None:
        self._signatures: dict[str, Signature] = {}
        self._doubtful: dict[str, Signature] = {}

    def watch(self, paths: Iterable[str], read_since_ns: int) -> None:
        """
        Watch these files from now on, and no others.

        A file that has changed since the reading began counts as changed, once.

        :param paths: paths of files, which need not exist.
        :param read_since_ns: when the first of them began to be read, in nanoseconds since 1970.
        """
        signatures = _look(paths)
        doubtful: dict[str, Signature] = {
            path: signature for path, signature in signatures.items()
            if signature is not None and signature[-1] >= read_since_ns - _TICK_NS}
        # Once is enough, or a file with a time that lies ahead would be read for ever.
        unknown = {
            path: _UNKNOWN for path, signature in doubtful.items()
            if self._doubtful.get(path) != signature}
        self._signatures = {**signatures, **unknown}
        self._doubtful = doubtful

    def watch_also(self, paths: Iterable[str]) -> None:
        """
        Watch more files and directories, until the next :meth:`watch`.

        :param paths: their paths; a directory changes when something in it appears or vanishes.
        """
        self._signatures = _look(set(paths).difference(self._signatures)) | self._signatures

    def has_changed(self) -> bool:
        """
        Look at the files.

        :return: whether any differs from when this was asked before; if so, the next question is
            about changes from now on.
        """
        now = _look(self._signatures)
        has_changed = now != self._signatures
        self._signatures = now
        return has_changed

    def would_differ(self) -> bool:
        """
        Look at the files without taking note, which other threads may do too.

        :return: what :meth:`has_changed` would.
        """
        signatures = self._signatures
        return _look(signatures) != signatures


class Watchman:
    """
    A thread that looks at the pace of ``PERIOD_S`` whether there is something to do.

    An executor that woke up for each look would use ten times as much of the processor.

    :param is_due: tells whether there is something to do.
    :param call: is called if so; nothing more happens until :meth:`go_on`.
    """

    def __init__(self, is_due: Callable[[], bool], call: Callable[[], None]) -> None:
        self._is_due = is_due
        self._call = call
        self._may_go_on = threading.Event()
        threading.Thread(target=self._watch, name='watch', daemon=True).start()

    def go_on(self) -> None:
        """Look again, first a period from now."""
        self._may_go_on.set()

    def _watch(self) -> None:
        period = PERIOD_S
        while True:
            time.sleep(period)
            begin = time.perf_counter()
            is_due = self._is_due()
            period = max(PERIOD_S, (time.perf_counter() - begin) / LARGEST_SHARE)
            if is_due:
                self._may_go_on.clear()
                self._call()
                self._may_go_on.wait()


def _look(paths: Iterable[str]) -> dict[str, Signature]:
    return {path: _signature(path) for path in paths}


def _signature(path: str) -> Signature:
    try:
        status = os.stat(path)  # noqa: PTH116 - a third of the time
    except (OSError, ValueError):
        return None
    # The second time cannot be set, and so tells of files that were given their old time back, and
    # of changed permissions.
    return (
        status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns)
