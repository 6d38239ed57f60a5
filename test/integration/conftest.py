# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Fixtures that start real processes in a ROS domain of the test's own."""

from bridge_process import BridgeProcess
import pytest


@pytest.fixture
def start_bridge(ros_domain):
    """Starts the installed executable; ``start_bridge(*arguments)``."""
    processes = []

    def start(*arguments):
        processes.append(BridgeProcess(*arguments))
        return processes[-1]

    yield start
    for process in processes:
        process.end()


@pytest.fixture
def start_listener(ros_domain):
    """Starts to listen from this process; ``start_listener()``."""
    from listener import Listener
    listeners = []

    def start():
        listeners.append(Listener(ros_domain))
        return listeners[-1]

    yield start
    for listener in listeners:
        listener.end()
