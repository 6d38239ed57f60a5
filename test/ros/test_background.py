# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Coroutines on a real executor: what they wait for, and who has a turn meanwhile."""

import threading

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from rclpy.executors import SingleThreadedExecutor

from sdf_pose_bridge.ros.background import at_once
from sdf_pose_bridge.ros.background import Background

SECONDS = 20.0


@pytest.fixture(name='node')
def spinnable_node(make_node):
    node = make_node('bridge')
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    yield node
    executor.shutdown()


def finished(node, *callbacks):
    """Run callbacks until all of them have ended, and return the last one's task."""
    tasks = [node.executor.create_task(callback) for callback in callbacks]
    # Fails if it waits in vain for somebody to wake it.
    deadline = threading.Timer(SECONDS, node.executor.shutdown)
    deadline.start()
    while not all(task.done() for task in tasks):
        node.executor.spin_once()
        assert deadline.is_alive(), 'waited in vain'
    deadline.cancel()
    return tasks[-1]


def counted_to(number, seen, name):
    for count in range(number):
        seen.append((name, count))
        yield
    return name


def test_what_is_done_beside_the_executor_is_done_in_another_thread(node):
    background = Background(node)

    async def callback():
        return await background.started(threading.current_thread)

    thread = finished(node, callback).result()
    assert thread is not threading.current_thread()
    assert thread.daemon


def test_others_have_their_turn_while_something_is_waited_for(node):
    background = Background(node)
    goes_on = threading.Event()

    async def callback():
        return await background.started(lambda: goes_on.wait(SECONDS))

    assert finished(node, goes_on.set, callback).result()


def test_what_it_raises_is_raised_where_it_is_waited_for(node):
    background = Background(node)

    async def callback():
        with pytest.raises(ZeroDivisionError):
            await background.started(lambda: 1 / 0)
        return 'caught'

    assert finished(node, callback).result() == 'caught'


def test_the_steps_of_two_alternate(node):
    background = Background(node)
    seen = []

    async def callback(name):
        return await background.all_of(counted_to(3, seen, name))

    async def first():
        return await callback('a')

    async def second():
        return await callback('b')

    assert finished(node, first, second).result() == 'b'
    assert [count for _, count in seen] == [0, 0, 1, 1, 2, 2]


def test_without_an_executor_all_steps_are_taken_at_once(make_node):
    background = Background(make_node('bridge'))
    seen = []
    assert at_once(background.all_of(counted_to(3, seen, 'a'))) == 'a'
    assert len(seen) == 3


def test_an_executor_that_was_shut_down_is_no_concern(node):
    background = Background(node)
    threads = set(threading.enumerate())
    goes_on = threading.Event()
    future = background.started(goes_on.wait)
    (thread,) = set(threading.enumerate()) - threads
    node.executor.shutdown()
    goes_on.set()
    thread.join(SECONDS)
    assert future.result()
