# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The names of rclpy that wait for messages without an executor, in the release that is here."""

import math
import threading

import pytest
from rclpy.exceptions import InvalidHandle
from std_msgs.msg import String

from sdf_pose_bridge.ros.following.wait_set import NoExecutor, WaitSet


@pytest.fixture
def node(make_node):
    return make_node('waiting')


@pytest.fixture
def wait_set(node):
    found = WaitSet(node.context)
    yield found
    found.close()


@pytest.fixture
def subscription(node):
    return node.create_subscription(
        String, 'text', lambda _: None, 10, callback_group=NoExecutor(), raw=True)


def test_another_thread_ends_the_wait(wait_set, subscription):
    threading.Timer(0.1, wait_set.wake).start()
    assert wait_set.wait([subscription], math.inf) == []


def test_a_subscription_that_is_destroyed_during_the_wait_is_kept_for_it(
        node, wait_set, subscription):
    wait_set.wait([subscription], 0.0)
    node.destroy_subscription(subscription)
    assert wait_set.wait([subscription], 0.01) == []
    wait_set.wait([], 0.0)
    with pytest.raises(InvalidHandle):
        wait_set.wait([subscription], 0.0)
