# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Run work beside the callbacks of a node, in threads or between the callbacks.

The node of each function and class has an executor.
"""

from __future__ import annotations

from collections.abc import Awaitable, Callable
import contextlib
import os
from queue import SimpleQueue
import threading
import time

from rclpy.callback_groups import CallbackGroup
from rclpy.exceptions import InvalidHandle
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.task import Future

PERIOD_S = 0.25
"""Seconds between two evaluations of the condition of a :class:`PollingThread`."""

LARGEST_SHARE = 0.001
"""Largest share of a core for evaluating it; if this takes long, the period gets longer."""


class Worker:
    """
    A thread that runs functions one after the other, and does not keep the process from ending.

    It is started while there is memory: a new thread may end without it before it runs anything.
    """

    def __init__(self, node: Node) -> None:
        self._executor = node.executor
        self._calls: SimpleQueue[tuple[Future, Callable[[], object]]] = SimpleQueue()
        threading.Thread(target=self._run, name='worker', daemon=True).start()

    def run(self, function: Callable[[], object]) -> Future:
        """
        Run a function in the thread.

        :param function: the function; it must not use the node.
        :return: a future for its result or exception, which a coroutine on the executor can await.
        """
        future = Future()
        self._calls.put((future, function))
        return future

    def _run(self) -> None:
        while True:
            self._run_next()

    def _run_next(self) -> None:
        result, error = None, None
        future, function = self._calls.get()
        try:
            result = function()
        except Exception as raised:  # noqa: BLE001 - raised where the future is awaited
            # Another MemoryError, as the traceback of this one keeps the objects of the function.
            error = MemoryError() if isinstance(raised, MemoryError) else raised
        try:
            if error is None:
                future.set_result(result)
            else:
                future.set_exception(error)
            # The executor resumes coroutines only when it wakes up.
            wake(self._executor)
        except MemoryError:
            # Without a result, callbacks that wait for it would be blocked forever.
            os._exit(1)


def wake(executor: Executor | None) -> None:
    """Wake up the executor of a node, unless it has been shut down."""
    if executor is not None:
        with contextlib.suppress(InvalidHandle):
            executor.wake()


async def run_other_callbacks(node: Node) -> None:
    """Let the executor run other callbacks before it resumes the coroutine that awaits this."""
    # The task wakes the executor: in some releases of rclpy it does not wake up by itself to
    # resume a coroutine when the awaited task has ended.
    await node.executor.create_task(node.executor.wake)


class CoroutineLock:
    """A lock for coroutines on the executor of a node; ``async with`` holds it."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._released: Future | None = None

    async def __aenter__(self) -> None:
        while self._released is not None:
            await self._released
        self._released = Future()

    async def __aexit__(self, *_exception: object) -> None:
        assert self._released is not None
        released, self._released = self._released, None
        released.set_result(None)
        # Some releases of rclpy do not wake up by themselves to resume waiting coroutines.
        wake(self._node.executor)


class PollingThread:
    """
    A thread that has the executor of a node run a callback whenever a condition is true.

    A timer of the node would wake its executor for each evaluation, which takes much more
    processor time.

    :param group: callback group of the callback.
    :param condition: is evaluated every ``PERIOD_S``, except while the callback runs.
    """

    def __init__(
        self, node: Node, group: CallbackGroup, condition: Callable[[], bool],
        callback: Callable[[], Awaitable[None]],
    ) -> None:
        self._condition = condition
        self._callback = callback
        self._has_ended = threading.Event()
        self._guard_condition = node.create_guard_condition(self._call, callback_group=group)
        threading.Thread(target=self._run, name='polling', daemon=True).start()

    async def _call(self) -> None:
        try:
            await self._callback()
        finally:
            self._has_ended.set()

    def _run(self) -> None:
        period = PERIOD_S
        while True:
            time.sleep(period)
            # Waiting for a disk or a core must not lengthen the period.
            begin = time.thread_time()
            is_due = self._condition()
            period = max(PERIOD_S, (time.thread_time() - begin) / LARGEST_SHARE)
            if is_due:
                self._has_ended.clear()
                try:
                    self._guard_condition.trigger()
                except InvalidHandle:  # the node was destroyed
                    return
                self._has_ended.wait()
