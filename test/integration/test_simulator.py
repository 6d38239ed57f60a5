# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A bridge that asks a simulator for the poses of models, beside a process that answers."""

import re

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')
pytest.importorskip('simulation_interfaces', reason='needs simulation_interfaces')

from changes import pose_of, set_parameters
from simulation_interfaces.msg import EntityState, Result
from simulation_interfaces.srv import GetEntitiesStates
from tracker import Tracker, WORLD

# The bridge may stop asking between a call and its answer.
pytestmark = pytest.mark.filterwarnings('ignore:failed to send response:RuntimeWarning')

SIMULATOR = '/gzserver'


class Simulator:
    """Answers calls for the states of entities, in another process than the bridge."""

    def __init__(self, tf, result=Result.RESULT_OK, **x_of_entities):
        self.result, self.requests, self.sec = result, [], 5000
        self._x_of_entities = x_of_entities
        tf.listener.node.create_service(
            GetEntitiesStates, f'{SIMULATOR}/get_entities_states', self._answer)

    def _answer(self, request, response):
        self.requests.append(request)
        self.sec += 1
        response.result.result = self.result
        response.result.error_message = f'paused\n[FATAL] at {self.sec}'
        for name, x in self._x_of_entities.items():
            if re.search(request.filters.filter, name):
                state = EntityState()
                state.header.stamp.sec, state.header.frame_id = self.sec, 'world'
                state.pose.position.x = x
                response.entities.append(name)
                response.states.append(state)
        return response


@pytest.fixture(name='file')
def write_file(tmp_path):
    path = tmp_path / 'shop.sdf'
    path.write_text(WORLD.format(height=0.5), encoding='utf-8')
    return path


@pytest.mark.usefixtures('bridge')
def test_a_simulator_is_asked_for_the_models_that_can_move(tf):
    simulator = Simulator(tf, cart=3.0, arm=4.0, wall=5.0, cartoon=6.0)
    set_parameters(tf.listener, simulator=SIMULATOR, root_frame='map')
    tf.listener.wait(lambda: tf.last.keys() >= {'cart/deck', 'arm/base'}, lambda: tf.last)
    found = tf.last['cart/deck']
    assert (found.header.frame_id, found.header.stamp.sec > 5000) == ('map', True)
    assert (found.transform.translation.x, found.transform.translation.z) == (3.0, 0.5)
    assert simulator.requests[0].filters.filter == '^(cart|cart::crate|arm)$'
    set_parameters(tf.listener, simulator='')
    count = len(simulator.requests)
    pose_of(tf, 'wall')
    assert len(simulator.requests) <= count + 1


def test_a_simulator_may_start_later_and_be_stopped(bridge, tf):
    set_parameters(tf.listener, simulator=SIMULATOR, simulator_rate=100.0)
    bridge.wait_for_line(f'no poses of models from {SIMULATOR}/get_entities_states: there is no')
    simulator = Simulator(tf, Result.RESULT_INCORRECT_STATE, cart=3.0)
    tf.listener.wait(lambda: len(simulator.requests) > 2, lambda: 'calls')
    simulator.result = Result.RESULT_OK
    tf.listener.wait(lambda: 'cart/deck' in tf.last, lambda: tf.last)
    bridge.wait_for_line(
        r'the simulator answers with result 3, which is not OK: paused\n[FATAL] at 5001')
    assert sum('no poses of models' in line for line in bridge.lines) == 2


def test_the_newest_of_two_sources_counts(bridge, tf):
    tracker = Tracker(tf)
    simulator = Simulator(tf, cart=3.0)
    set_parameters(
        tf.listener, simulator=SIMULATOR, model_pose_topics=['/tracker/{model}/pose'])
    tf.listener.wait(lambda: 'cart/deck' in tf.last, lambda: tf.last)
    tracker.sec = simulator.sec + 1000
    words = f'"cart" come from several publishers at once on {SIMULATOR}/get_entities_states and'

    def is_told():
        tracker.move(4.0)
        return any(words in line for line in bridge.lines)

    tf.listener.wait(is_told, lambda: bridge.lines)
    count = len(simulator.requests)
    tf.listener.wait(lambda: len(simulator.requests) > count + 3, lambda: 'calls')
    assert pose_of(tf, 'cart').x == 4.0
    assert sum(words in line for line in bridge.lines) == 1
