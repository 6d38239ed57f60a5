# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Let a callback take its time while the executor goes on with the others."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Coroutine
from collections.abc import Generator
import contextlib
import threading
from typing import Any
from typing import TypeVar

from rclpy.exceptions import InvalidHandle
from rclpy.node import Node
from rclpy.task import Future

Result = TypeVar('Result')


class Background:
    """
    What coroutines wait with that are callbacks of a node.

    :param node: the node; it has an executor whenever something is waited for.
    """

    def __init__(self, node: Node) -> None:
        self._node = node

    def started(self, work: Callable[[], object]) -> Future:
        """
        Begin to do something in a thread of its own.

        The thread does not keep the process from ending. What it does must not touch the node.

        :param work: what to do.
        :return: has what it returns or raises in the end; to be awaited.
        """
        future = Future()
        executor = self._node.executor

        def do() -> None:
            try:
                future.set_result(work())
            except Exception as error:  # noqa: BLE001 - it is for whoever waits
                future.set_exception(error)
            # An executor that was shut down has nobody waiting.
            with contextlib.suppress(InvalidHandle):
                executor.wake()

        threading.Thread(target=do, name='background', daemon=True).start()
        return future

    async def all_of(self, steps: Generator[None, None, Result]) -> Result:
        """
        Take many steps and let the executor go on with other callbacks between them.

        :param steps: takes one step after another.
        :return: what it returns in the end.
        """
        while True:
            try:
                next(steps)
            except StopIteration as end:
                result: Result = end.value
                return result
            await self._turn()

    async def _turn(self) -> None:
        # The executor resumes what waits whenever it wakes, which has to be now.
        if self._node.executor is not None:
            self._node.executor.wake()
        await _Turn()


class _Turn:
    def __await__(self) -> Generator[None, None, None]:
        yield


def at_once(coroutine: Coroutine[Any, Any, Result]) -> Result:
    """
    Run a coroutine to its end where there is no executor yet.

    :param coroutine: waits for nothing but its turn.
    :return: what it returns.
    """
    while True:
        try:
            coroutine.send(None)
        except StopIteration as end:
            result: Result = end.value
            return result
