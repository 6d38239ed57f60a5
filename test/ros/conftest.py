# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Fixtures that run callbacks of real nodes in this process."""

from concurrent.futures import ThreadPoolExecutor

from deadline import DEADLINE_S
import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')
from rclpy.executors import SingleThreadedExecutor

from sdf_pose_bridge.ros.file_process import FileProcess


@pytest.fixture
def make_executor(make_node):
    """Makes executors with nodes; ``make_executor(node, ...)``."""
    executors = []

    def make(*nodes):
        executors.append(SingleThreadedExecutor(context=nodes[0].context))
        for node in nodes:
            executors[-1].add_node(node)
        return executors[-1]

    yield make
    for executor in executors:
        executor.shutdown()


@pytest.fixture
def node(make_node, make_executor):
    """Return a node that has an executor."""
    node = make_node('bridge')
    make_executor(node)
    return node


@pytest.fixture
def finish():
    """Runs a function or coroutine on an executor; ``finish(executor, function, *arguments)``."""
    def run(executor, function, *arguments):
        task = executor.create_task(function, *arguments)
        executor.spin_until_future_complete(task, timeout_sec=DEADLINE_S)
        assert task.done()
        return task.result()
    return run


@pytest.fixture
def beside():
    """Calls a function in a thread beside an executor; ``beside(executor, function, ...)``."""
    def call(executor, function, *arguments):
        with ThreadPoolExecutor(1) as threads:
            future = threads.submit(function, *arguments)
            while not future.done():
                executor.spin_once(timeout_sec=0.01)
            return future.result()
    return call


@pytest.fixture(scope='session')
def reader():
    """Return a reader of files."""
    found = FileProcess()
    yield found
    found.close()
