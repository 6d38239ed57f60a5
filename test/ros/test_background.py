# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Threads beside a real executor: what they do when, and what waits for what."""

import math
import threading

from deadline import DEADLINE_S, wait_until
import pytest

from sdf_pose_bridge.ros.background import Periodic, result_from_executor, Worker


@pytest.fixture
def worker(node):
    worker = Worker(node, 'worker')
    yield worker
    worker.end()


def finished(node, callback):
    """Run a callback until it has ended, and return its result."""
    task = node.executor.create_task(callback)
    # A test fails if it waits in vain for something to wake the executor.
    deadline = threading.Timer(DEADLINE_S, node.executor.shutdown)
    deadline.start()
    while not task.done():
        node.executor.spin_once()
        assert deadline.is_alive(), 'waited in vain'
    deadline.cancel()
    return task.result()


def test_functions_run_in_one_other_thread(node, worker):
    async def callback():
        return [await worker.run(threading.current_thread) for _ in range(2)]

    thread, same_thread = finished(node, callback)
    assert thread is same_thread
    assert thread is not threading.current_thread()
    assert thread.daemon


def test_other_callbacks_run_while_a_thread_is_awaited(node, worker):
    goes_on = threading.Event()

    async def callback():
        return await worker.run(lambda: goes_on.wait(DEADLINE_S))

    node.executor.create_task(goes_on.set)
    assert finished(node, callback)


def test_something_is_done_between_functions_and_again_after_a_time(worker):
    calls, before = [], []
    worker.between = lambda: calls.append(0) or 0.001
    worker.run(lambda: before.extend(calls))
    wait_until(lambda: len(calls) > 2)
    assert before == []


def test_a_thread_ends_after_the_function_that_it_runs(node, worker):
    goes_on = threading.Event()
    worker.run(goes_on.wait)
    worker.end()
    assert worker.is_alive
    node.executor.shutdown()
    goes_on.set()
    worker._thread.join(DEADLINE_S)
    assert not worker.is_alive


def test_the_executor_is_asked_by_another_thread(node, beside):
    def ask(function):
        return beside(node.executor, result_from_executor, node, function)

    assert ask(threading.current_thread) is threading.current_thread()
    with pytest.raises(ZeroDivisionError):
        ask(lambda: 1 / 0)


def test_what_is_due_is_called_once_in_a_period(monkeypatch):
    now, calls = 0.0, []
    monkeypatch.setattr('time.monotonic', lambda: now)
    periodic = Periodic(lambda: calls.append(now), 2.0)
    for now in (0.5, 2.0, 2.5, 4.5, 11.0, 11.5):  # noqa: B007 - the clock
        left_s = periodic.call_if_due()
    assert calls == [2.0, 4.5, 11.0, 11.5]
    assert left_s == 1.5
    assert Periodic(calls.clear, math.inf).call_if_due() == math.inf
