# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Tell messages that cannot be processed from a node that cannot process any."""

from __future__ import annotations

from collections.abc import Callable, Collection
import math
import time
from typing import TypeVar

from sdf_pose_bridge.printed_text import printable
from sdf_pose_bridge.ros.following.state_messages import StateSource

LONGEST_S = 10.0
"""Time in s after which failures of all messages are those of the node; a failure is forgotten
after the same time."""

_Result = TypeVar('_Result')


class AllMessagesFailError(Exception):
    """The node cannot process messages of several publishers."""


class MessageFailures:
    """
    Internal errors in messages.

    They are reported, and other messages are processed, so that nobody can end the node by what
    they send. If those of several publishers fail, and no message is processed for a time, the
    node has a defect, and would publish nothing for ever. Then the error is raised.

    :param log: logs the exception that is being handled.
    :param raised: types of errors that are always raised.
    """

    def __init__(
        self, log: Callable[[], object], *raised: type[Exception],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._log, self._clock = log, clock
        self._raised: tuple[type[Exception], ...] = AllMessagesFailError, *raised
        # By source, the time of its last failure and a line.
        self._last: dict[StateSource, tuple[float, str]] = {}
        self._since = math.inf

    def attempt(
        self, sources: Collection[StateSource], default: _Result, function: Callable[..., _Result],
        *arguments: object,
    ) -> _Result:
        """
        Call a function that processes messages of sources.

        :return: its result, or the default after an error, which is noted.
        :raises AllMessagesFailError: if the node has a defect.
        """
        try:
            return function(*arguments)
        except self._raised:
            raise
        except Exception as error:  # noqa: BLE001 - includes defects
            self._note(error, sources)
            return default

    def note_success(self, sources: Collection[StateSource]) -> None:
        """Note that messages of sources were processed."""
        if sources:
            self._since = math.inf

    def problems(self) -> list[str]:
        """Return a line for each source with a failure not long ago."""
        return [line for _, line in self._recent().values()]

    def _recent(self) -> dict[StateSource, tuple[float, str]]:
        least = self._clock() - LONGEST_S
        return {each: last for each, last in self._last.copy().items() if last[0] >= least}

    def _note(self, error: Exception, sources: Collection[StateSource]) -> None:
        now, self._last = self._clock(), self._recent()
        self._since = min(self._since, now) if self._last else now
        self._log()
        for source in sources:
            self._last[source] = now, (
                f'internal error in messages of {source.name}: {printable(str(error))}')
        names = {name for each in self._last for name in each.publishers()}
        if sources and now - self._since >= LONGEST_S and len(names) > 1:
            msg = f'no message could be processed for {LONGEST_S:g} s'
            raise AllMessagesFailError(msg) from error
