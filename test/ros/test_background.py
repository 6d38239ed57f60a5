# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Coroutines on a real executor: what they wait for, and what runs meanwhile."""

import threading
import weakref

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')


from sdf_pose_bridge.ros.background import run_in_thread
from sdf_pose_bridge.ros.background import run_other_callbacks

SECONDS = 20.0


class Large:
    """What a function makes before it runs out of memory."""


def finished(node, *callbacks):
    """Run callbacks until all of them have ended, and return the result of the last one."""
    tasks = [node.executor.create_task(callback) for callback in callbacks]
    # A test fails if it waits in vain for something to wake the executor.
    deadline = threading.Timer(SECONDS, node.executor.shutdown)
    deadline.start()
    while not all(task.done() for task in tasks):
        node.executor.spin_once()
        assert deadline.is_alive(), 'waited in vain'
    deadline.cancel()
    return tasks[-1].result()


def test_a_function_runs_in_another_thread(node):
    async def callback():
        return await run_in_thread(node, threading.current_thread)

    thread = finished(node, callback)
    assert thread is not threading.current_thread()
    assert thread.daemon


def test_other_callbacks_run_while_a_thread_is_awaited(node):
    goes_on = threading.Event()

    async def callback():
        return await run_in_thread(node, lambda: goes_on.wait(SECONDS))

    assert finished(node, goes_on.set, callback)


def test_an_exception_in_a_thread_is_raised_where_it_is_awaited(node):
    async def callback():
        with pytest.raises(ZeroDivisionError):
            await run_in_thread(node, lambda: 1 / 0)
        return 'caught'

    assert finished(node, callback) == 'caught'


def test_a_thread_without_memory_has_a_result_that_keeps_nothing(node):
    kept = []

    def use_all_memory():
        large = Large()
        kept.append(weakref.ref(large))
        raise MemoryError

    async def callback():
        with pytest.raises(MemoryError):
            await run_in_thread(node, use_all_memory)
        return kept[0]()

    assert finished(node, callback) is None


def test_two_coroutines_alternate(node):
    seen = []

    async def count():
        for number in range(3):
            seen.append(number)
            await run_other_callbacks(node)

    finished(node, count, count)
    assert seen == [0, 0, 1, 1, 2, 2]


def test_a_thread_may_end_after_the_executor_was_shut_down(node):
    threads = set(threading.enumerate())
    goes_on = threading.Event()
    future = run_in_thread(node, goes_on.wait)
    (thread,) = set(threading.enumerate()) - threads
    node.executor.shutdown()
    goes_on.set()
    thread.join(SECONDS)
    assert future.result()
