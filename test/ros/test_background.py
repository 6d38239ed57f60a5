# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Coroutines on a real executor, and threads: what they wait for, and what runs meanwhile."""

import threading
import weakref

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.task import Future

from sdf_pose_bridge.ros import background
from sdf_pose_bridge.ros.background import (
    CoroutineLock,
    PollingThread,
    run_other_callbacks,
    Worker,
)

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


def test_functions_run_in_one_other_thread(node):
    worker = Worker(node)

    async def callback():
        return [await worker.run(threading.current_thread) for _ in range(2)]

    thread, same_thread = finished(node, callback)
    assert thread is same_thread
    assert thread is not threading.current_thread()
    assert thread.daemon


def test_other_callbacks_run_while_a_thread_is_awaited(node):
    goes_on = threading.Event()

    async def callback():
        return await Worker(node).run(lambda: goes_on.wait(SECONDS))

    assert finished(node, goes_on.set, callback)


def test_an_exception_in_a_thread_is_raised_where_it_is_awaited(node):
    async def callback():
        with pytest.raises(ZeroDivisionError):
            await Worker(node).run(lambda: 1 / 0)
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
            await Worker(node).run(use_all_memory)
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


def test_one_coroutine_holds_a_lock_at_a_time(node):
    lock = CoroutineLock(node)
    seen = []

    async def count():
        async with lock:
            for number in range(3):
                seen.append(number)
                await run_other_callbacks(node)

    finished(node, count, count, count)
    assert seen == [0, 1, 2] * 3
    assert lock._released is None


def test_a_lock_is_released_when_python_ends_after_the_executor(node):
    lock = CoroutineLock(node)

    async def hold():
        async with lock:
            await Future()

    coroutine = hold()
    coroutine.send(None)
    node.executor.shutdown()
    node.executor = None
    # As Python does when it ends. Another exception would be taken for that of a load.
    coroutine.close()
    assert lock._released is None


def test_a_thread_may_end_after_the_executor_was_shut_down(node):
    goes_on, has_ended = threading.Event(), threading.Event()
    future = Worker(node).run(goes_on.wait)
    future.add_done_callback(lambda _: has_ended.set())
    node.executor.shutdown()
    goes_on.set()
    assert has_ended.wait(SECONDS)


@pytest.fixture
def poll(node, monkeypatch):
    """Starts a thread that evaluates a condition with a short period."""
    monkeypatch.setattr(background, 'PERIOD_S', 0.001)

    def start(condition, callback=None):
        PollingThread(node, ReentrantCallbackGroup(), condition, callback)
    return start


def test_a_thread_calls_a_callback_again_when_it_has_ended(node, poll):
    calls = []
    has_ended = Future(executor=node.executor)

    async def callback():
        calls.append(1)
        await has_ended

    poll(lambda: True, callback)
    while not calls:
        node.executor.spin_once(SECONDS)
    for _ in range(20):
        node.executor.spin_once(0.005)
    assert len(calls) == 1
    has_ended.set_result(None)
    while len(calls) < 3:
        node.executor.spin_once(SECONDS)


def test_a_look_that_takes_too_much_of_the_processor_is_not_soon_followed_by_another(
        poll, monkeypatch):
    monkeypatch.setattr(background, 'LARGEST_SHARE', 1e-12)
    looks = threading.Semaphore(0)
    poll(lambda: bool(looks.release()))
    assert looks.acquire(timeout=20)
    assert not looks.acquire(timeout=0.1)


def test_a_look_that_has_to_wait_is_soon_followed_by_another(poll):
    looks = threading.Semaphore(0)

    def is_due():
        # As a disk on the network may let it.
        looks.release()
        return threading.Event().wait(0.1)

    poll(is_due)
    for _ in range(3):
        assert looks.acquire(timeout=20)


def test_a_thread_ends_when_the_node_is_destroyed(node, poll):
    threads = set(threading.enumerate())
    is_due = threading.Event()
    poll(is_due.is_set)
    (thread,) = set(threading.enumerate()) - threads
    node.destroy_node()
    is_due.set()
    thread.join(SECONDS)
    assert not thread.is_alive()
