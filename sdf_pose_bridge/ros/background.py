# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Run long work beside the other callbacks of a node."""

from __future__ import annotations

from collections.abc import Callable
import contextlib
import os
import threading

from rclpy.exceptions import InvalidHandle
from rclpy.node import Node
from rclpy.task import Future


def run_in_thread(node: Node, function: Callable[[], object]) -> Future:
    """
    Run a function in a thread of its own, which does not keep the process from ending.

    :param node: a node with an executor.
    :param function: what to run; it must not use the node.
    :return: a future for its result or exception, which a coroutine on the executor can await.
    :raises MemoryError: if no thread can be started.
    """
    executor = node.executor
    future = Future()

    def run() -> None:
        try:
            try:
                future.set_result(function())
            except MemoryError:
                pass  # here its traceback still keeps all that the function has made
            except Exception as error:  # noqa: BLE001 - raised where the future is awaited
                future.set_exception(error)
            if not future.done():
                future.set_exception(MemoryError('out of memory'))
        except MemoryError:
            # Without a result, the callbacks that wait for it would be blocked for ever.
            os._exit(1)
        # The executor resumes coroutines only when it wakes up. It may have been shut down.
        with contextlib.suppress(InvalidHandle):
            executor.wake()

    try:
        threading.Thread(target=run, name='background', daemon=True).start()
    except RuntimeError as error:
        msg = 'there is no room for another thread'
        raise MemoryError(msg) from error
    return future


async def run_other_callbacks(node: Node) -> None:
    """
    Let the executor run other callbacks before it goes on with the coroutine that awaits this.

    :param node: a node with an executor.
    """
    # To wake the executor is what the task is for: releases of rclpy differ in whether it wakes up
    # by itself to go on with a coroutine when the task that the coroutine awaits has ended.
    await node.executor.create_task(node.executor.wake)
