# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Notice that files have changed, by what the file system says of them."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TypeAlias

Signature: TypeAlias = tuple[int, int, int, int] | None
"""Device, inode, size and time of change of a file; None for one that is not there."""


class FileWatch:
    """
    Looks at files when asked, so that the asking sets the pace.

    Editors replace a file by another, rename it, or write it in pieces; a file can vanish and come
    back. All of these change what the file system says of the path.
    """

    def __init__(self) -> None:
        self._signatures: dict[str, Signature] = {}

    def watch(self, paths: Iterable[str]) -> None:
        """
        Watch these files from now on, and no others.

        :param paths: paths of files, which need not exist.
        """
        self._signatures = {path: _signature(path) for path in paths}

    def has_changed(self) -> bool:
        """
        Look at the files.

        :return: whether any differs from when this was asked before; if so, the next question is
            about changes from now on.
        """
        now = {path: _signature(path) for path in self._signatures}
        has_changed = now != self._signatures
        self._signatures = now
        return has_changed


def _signature(path: str) -> Signature:
    try:
        status = Path(path).stat()
    except (OSError, ValueError):
        return None
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns
