# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The names of rclpy that wait for messages without an executor, in the release that is here."""

import math
import threading
import time

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from rclpy.exceptions import InvalidHandle
from rclpy.serialization import deserialize_message
from std_msgs.msg import String

from sdf_pose_bridge.ros.wait_set import NoExecutor, take_message, WaitSet


@pytest.fixture(name='node')
def waiting_node(make_node):
    return make_node('waiting')


@pytest.fixture(name='wait_set')
def make_wait_set(node):
    found = WaitSet(node.context)
    yield found
    found.close()


@pytest.fixture(name='subscription')
def make_subscription(node):
    return node.create_subscription(
        String, 'text', lambda _: None, 10, callback_group=NoExecutor(), raw=True)


def test_a_message_ends_the_wait_and_is_taken_here(node, wait_set, subscription, make_executor):
    publisher = node.create_publisher(String, 'text', 10)
    executor = make_executor(node)
    deadline = time.monotonic() + 20.0
    while not (ready := wait_set.wait([subscription], 0.1)):
        assert time.monotonic() < deadline
        publisher.publish(String(data='x'))
        executor.spin_once(timeout_sec=0.0)
    assert ready == [0]
    assert deserialize_message(take_message(subscription), String).data == 'x'
    while take_message(subscription) is not None:
        pass
    assert wait_set.wait([subscription], 0.0) == []


def test_another_thread_ends_the_wait(wait_set, subscription):
    threading.Timer(0.1, wait_set.wake).start()
    assert wait_set.wait([subscription], math.inf) == []


def test_a_call_before_the_wait_ends_it(wait_set):
    wait_set.wake()
    assert wait_set.wait([], math.inf) == []


def test_a_subscription_that_is_destroyed_during_the_wait_is_kept_for_it(
        node, wait_set, subscription):
    wait_set.wait([subscription], 0.0)
    node.destroy_subscription(subscription)
    assert wait_set.wait([subscription], 0.01) == []
    wait_set.wait([], 0.0)
    with pytest.raises(InvalidHandle):
        wait_set.wait([subscription], 0.0)
