# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Fixtures of tests with ROS, and settings of property tests."""

from hypothesis import HealthCheck
from hypothesis import settings
import pytest
from ros_domain import claimed_domain

# A machine that has other work to do may take long for an example.
settings.register_profile(
    'untimed', settings(), deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile('untimed')


@pytest.fixture
def ros_domain(monkeypatch, tmp_path):
    """Number of a ROS domain that this test has to itself, on this machine alone."""
    with claimed_domain() as domain:
        monkeypatch.setenv('ROS_DOMAIN_ID', str(domain))
        monkeypatch.setenv('ROS_AUTOMATIC_DISCOVERY_RANGE', 'LOCALHOST')
        monkeypatch.setenv('ROS_LOG_DIR', str(tmp_path / 'ros_log'))
        yield domain


@pytest.fixture
def make_node(ros_domain):
    """Makes nodes in a context of their own; ``make_node(name, *ros_args)``."""
    rclpy = pytest.importorskip('rclpy', reason='needs ROS 2')
    from rclpy.context import Context
    context = Context()
    rclpy.init(args=[], context=context, domain_id=ros_domain)
    nodes = []

    def make(name, *ros_args):
        nodes.append(rclpy.create_node(
            name, context=context, cli_args=['--ros-args', *ros_args] if ros_args else None))
        return nodes[-1]

    yield make
    for node in nodes:
        node.destroy_node()
    context.shutdown()
    context.destroy()
