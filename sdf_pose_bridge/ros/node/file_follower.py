# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Decide when the files of the published scene are read again, and which failures are reported."""

from __future__ import annotations

from collections.abc import Iterable
import math
import time

from sdf_pose_bridge.errors import SdfError, TemporaryReadError
from sdf_pose_bridge.export.published_scene import LoadedScene
from sdf_pose_bridge.file_watcher import FileWatcher

RETRY_PERIOD_S = 1.0
"""Seconds until the files are read again after a temporary failure."""


class FileFollower:
    """
    Follows the files of a scene.

    Another program may still be writing a file. So a failure to read it is reported only if the
    files do not change during the next period, or if the next attempt fails in the same way.
    """

    def __init__(self, loaded: LoadedScene) -> None:
        self._watcher = FileWatcher()
        self._failure: list[str] = []
        self._reported: list[str] = []
        self._retry_time = math.inf
        self.follow(loaded)

    def follow(self, loaded: LoadedScene) -> None:
        """Follow the files of a scene that was read, and forget earlier failures."""
        self._watcher.watch(loaded.files, loaded.read_since_ns)
        self._failure = self._reported = []
        self._retry_time = math.inf

    def follow_error(self, error: Exception, files: Iterable[str]) -> None:
        """Also follow the files behind an error, and read again soon if it is a temporary one."""
        self._watcher.watch_also(files)
        is_temporary = isinstance(error, SdfError) and any(
            isinstance(each, TemporaryReadError) for each in error.errors)
        self._retry_time = time.monotonic() + RETRY_PERIOD_S if is_temporary else math.inf

    def has_to_read(self) -> bool:
        """Return whether the files have to be read again, and remember their state."""
        return self._watcher.notices_change() or time.monotonic() >= self._retry_time

    def failure_of_period(self, failure: list[str] | None) -> list[str]:
        """
        Return the errors to report at the end of a period, if any.

        :param failure: the errors of reading the files; None if they were not read.
        """
        is_settled = failure is None or failure == self._failure
        if failure is not None:
            self._failure = failure
        return self.unreported(self._failure) if is_settled else []

    def unreported(self, failure: list[str]) -> list[str]:
        """Return errors that are reported now; empty if they were reported before."""
        self._failure = failure
        if failure == self._reported:
            return []
        self._reported = failure
        return failure
