# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Calls of a simulator, and its answers."""

import sys
import time

from deadline import wait_until
import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')
pytest.importorskip('simulation_interfaces', reason='needs simulation_interfaces')

from rclpy.service import Service
from simulation_interfaces.srv import GetEntitiesStates

from sdf_pose_bridge.ros import simulator as module
from sdf_pose_bridge.ros.simulator import Simulator


@pytest.fixture(name='simulator')
def make_simulator(node):
    """Return a simulator that is asked a hundred times a second, and what wakes the thread."""
    found = Simulator(node, '/sim', lambda: None)
    found.follow(['a'], 100.0)
    yield found
    found.end()


def spin_until(node, condition):
    wait_until(condition, lambda: node.executor.spin_once(timeout_sec=0.01))


def test_without_the_package_a_line_says_what_to_install(node, monkeypatch, capfd):
    monkeypatch.setitem(sys.modules, 'simulation_interfaces.srv', None)
    simulator = Simulator(node, '/sim', lambda: None)
    simulator.follow(['a'], 100.0)
    simulator.end()
    assert not simulator.has_answers
    log = capfd.readouterr().err
    assert log.count('the package simulation_interfaces is not installed; install it') == 1


@pytest.mark.parametrize(('names', 'expression'), [
    (['a'], '^(a)$'), (['a', 'b::c'], '^(a|b::c)$'),
    (['a.b*', '[x]', 'y-1 ^$', '\\'], r'^(a\.b\*|\[x\]|y-1 \^\$|\\)$'),
])
def test_names_are_escaped_in_the_expression(simulator, names, expression):
    simulator.follow(names, 1.0)
    assert simulator._request.filters.filter == expression


def test_one_call_at_a_time_is_under_way(node, simulator, make_node, monkeypatch):
    requests, answers = [], []
    server = make_node('sim')
    node.executor.add_node(server)
    monkeypatch.setattr(Service, 'send_response', lambda *_: None)
    server.create_service(
        GetEntitiesStates, '/sim/get_entities_states',
        lambda request, response: requests.append(request) or response)
    spin_until(node, lambda: requests)
    ends_at = time.monotonic() + 0.3
    spin_until(node, lambda: time.monotonic() > ends_at)
    assert len(requests) == 1
    monkeypatch.setattr(module, 'LONGEST_CALL_S', 0.0)
    simulator._call_ends_at = 0.0
    spin_until(node, lambda: len(requests) > 1)
    assert not answers
    assert simulator._problem.startswith('no answer in')
