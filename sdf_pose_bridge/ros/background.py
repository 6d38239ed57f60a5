# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Run functions in a thread beside the executor of a node, and there at certain times."""

from __future__ import annotations

from collections.abc import Callable
import concurrent.futures
import contextlib
import math
import queue
import threading
import time
from typing import TypeVar

from rclpy.exceptions import InvalidHandle
from rclpy.executors import Executor
from rclpy.node import Node
from rclpy.task import Future

_Result = TypeVar('_Result')


class Worker:
    """
    A thread that runs functions one after the other, and does not keep the process from ending.

    An exception of a function ends the thread; ``threading.excepthook`` decides what follows.

    :param node: the node, with an executor that awaits the results.
    """

    def __init__(self, node: Node, name: str) -> None:
        self.between: Callable[[], float] = lambda: math.inf
        """Is called after each function and each wait; returns the longest time in s to wait for
        the next function."""
        self.has_to_end = False
        """Whether the thread has to end; a function that takes long looks at it."""
        self._executor = node.executor
        self._calls: queue.SimpleQueue[tuple[Future, Callable[[], object]]] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def run(self, function: Callable[[], object]) -> Future:
        """
        Run a function in the thread.

        :return: a future for its result, which a coroutine on the executor can await.
        """
        future = Future()
        self._calls.put((future, function))
        return future

    def end(self) -> None:
        """End the thread after the function that it runs."""
        self.has_to_end = True
        self.run(lambda: None)

    @property
    def is_alive(self) -> bool:
        """Whether the thread has not ended."""
        return self._thread.is_alive()

    def _run(self) -> None:
        longest_s = math.inf
        while not self.has_to_end:
            with contextlib.suppress(queue.Empty):
                future, function = self._calls.get(
                    timeout=None if math.isinf(longest_s) else longest_s)
                future.set_result(function())
                # The executor resumes coroutines only when it wakes up.
                wake(self._executor)
            longest_s = self.between()


class Periodic:
    """
    A function to be called in each period; missed periods are left out.

    :param period_s: the period in s; infinity for never.
    """

    def __init__(self, function: Callable[[], None], period_s: float) -> None:
        self._function = function
        self.period_s = period_s
        self._due = time.monotonic() + period_s

    def call_if_due(self) -> float:
        """Call the function if a period has ended; return the time in s until the next does."""
        if time.monotonic() >= self._due:
            self._function()
            self._due = max(self._due + self.period_s, time.monotonic())
        return max(0.0, self._due - time.monotonic())


def result_from_executor(node: Node, function: Callable[[], _Result]) -> _Result:
    """
    Have the executor of a node call a function, and wait for its result in another thread.

    Subscriptions, services, timers and parameters are changed in this way, because the executor
    uses them at any time. It does not use publishers.

    :raises Exception: any exception of the function.
    """
    return result_from_thread(node.executor.create_task, function)


def result_from_thread(
    hand_over: Callable[[Callable[[], None]], object], function: Callable[[], _Result],
    longest_s: float | None = None,
) -> _Result:
    """
    Have another thread call a function, and wait for its result.

    :param hand_over: hands a function to the thread.
    :param longest_s: longest time in s to wait; None for any.
    :raises concurrent.futures.TimeoutError: after this time.
    :raises Exception: any exception of the function.
    """
    future: concurrent.futures.Future[_Result] = concurrent.futures.Future()

    def call() -> None:
        try:
            future.set_result(function())
        except MemoryError:
            raise
        except Exception as error:  # noqa: BLE001 - raised by the one who waits
            future.set_exception(error)

    hand_over(call)
    return future.result(longest_s)


def wake(executor: Executor | None) -> None:
    """Wake up the executor of a node, unless it has been shut down."""
    if executor is not None:
        with contextlib.suppress(InvalidHandle):
            executor.wake()
