# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Take SIGINT and SIGTERM for the request that they are: to end, and to end well."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Iterator
from contextlib import contextmanager
import os
import signal
from types import FrameType

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class StopRequest:
    """
    Takes note of SIGINT and SIGTERM from the moment it is made; both mean a good end.

    Until there is something to clean up, the first of them ends the process.
    """

    def __init__(self) -> None:
        self._is_made = False
        self._reaction: Callable[[], None] = _exit_at_once
        for number in SIGNALS:
            signal.signal(number, self._take)

    def is_made(self) -> bool:
        """Tell whether a signal has come."""
        return self._is_made

    def defer(self) -> None:
        """Only take note from now on, since there is something to clean up."""
        self._reaction = _do_nothing

    @contextmanager
    def interrupting(self) -> Iterator[None]:
        """
        Let a signal interrupt what is done meanwhile, which must be able to bear it.

        :raises KeyboardInterrupt: if a signal comes, or came before.
        """
        self._reaction = _interrupt
        try:
            if self._is_made:
                _interrupt()
            yield
        finally:
            self._reaction = _do_nothing

    def ignore_further(self) -> None:
        """Take no more notice, so that an end that has begun goes on in peace."""
        for number in SIGNALS:
            signal.signal(number, signal.SIG_IGN)

    def _take(self, _number: int, _frame: FrameType | None) -> None:
        self._is_made = True
        self._reaction()


def _do_nothing() -> None:
    pass


def _interrupt() -> None:
    raise KeyboardInterrupt


def _exit_at_once() -> None:
    # An exception instead could be caught or reported by whatever import it comes out of.
    os._exit(0)
