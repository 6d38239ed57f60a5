# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A bridge that asks a simulator for the poses of models, beside a process that answers."""

import pytest

pytest.importorskip('simulation_interfaces', reason='needs simulation_interfaces')

from changes import pose_of, reload, set_parameters
from simulation_interfaces.msg import Result
from simulator import SIMULATOR, Simulator
from tracker import Tracker, WORLD

FILE_TEXT = WORLD.format(height=0.5)

# The bridge may stop asking between a call and its answer.
pytestmark = pytest.mark.filterwarnings('ignore:failed to send response:RuntimeWarning')

def test_a_simulator_is_asked_for_the_models_that_can_move(bridge, tf):
    simulator = Simulator(tf, cart=3.0, arm=4.0, wall=5.0, cartoon=6.0)
    set_parameters(tf.listener, simulator=SIMULATOR, root_frame='map')
    tf.wait_for_frames('cart/deck', 'arm/base')
    found = tf.last['cart/deck']
    assert (found.header.frame_id, found.header.stamp.sec > 5000) == ('map', True)
    assert (found.transform.translation.x, found.transform.translation.z) == (3.0, 0.5)
    assert simulator.requests[0].filters.filter == '^(cart|cart::crate|cart/crate|arm)$'
    set_parameters(tf.listener, simulator='')
    count = len(simulator.requests)
    pose_of(tf, 'wall')
    assert len(simulator.requests) <= count + 1


def wait_for_line(tf, bridge, text):
    """Answer calls until the bridge has logged a line."""
    tf.listener.wait(lambda: bridge.count_of(text), bridge.lines)


@pytest.mark.parametrize(('simulator', 'prefix'), [
    ('/', ''), (f'{SIMULATOR}/get_entities_states', SIMULATOR)])
def test_names_of_entities_may_be_others(bridge, tf, simulator, prefix):
    Simulator(tf, prefix=prefix, **{'/World': 0.0, '/World/cart': 3.0, '/World/arm': 4.0})
    set_parameters(tf.listener, simulator=simulator)
    wait_for_line(
        tf, bridge, f'"arm" in the answers of {prefix}/get_entities_states; for "/World/cart", '
        'set simulator_entity to "/World/{model}"')
    set_parameters(tf.listener, simulator_entity='/World/{model}')
    tf.wait_for_frames('cart/deck', 'arm/base')
    assert tf.last['cart/deck'].transform.translation.x == 3.0


def test_a_nested_model_keeps_its_place_unless_it_has_a_pose(bridge, tf):
    simulator = Simulator(tf, cart=3.0)
    set_parameters(tf.listener, simulator=SIMULATOR, model_pose_topics=['/tracker/{model}/pose'])
    tf.wait_for_frames('cart/crate/box')
    assert pose_of(tf, 'cart::crate').x == 3.0
    wait_for_line(tf, bridge, 'does not give the poses of "cart::crate", which keep their places')
    tracker = Tracker(tf)
    tracker.sec = 10 * simulator.sec
    tracker.move(1.0, 'cart/crate/box', topic='/tracker/cart/crate/pose')
    count = len(simulator.requests)
    tf.listener.wait(lambda: len(simulator.requests) > count + 3, 'calls')
    simulator.sec = 10 * tracker.sec
    tf.listener.wait(
        lambda: tf.last['cart/deck'].header.stamp.sec > simulator.sec - 10, tf.last)
    assert pose_of(tf, 'cart::crate').x == pytest.approx(1.0)


def test_other_entities_have_frames_while_they_exist(bridge, tf):
    simulator = Simulator(tf, **{'/World/cart': 3.0, '/World/wall': 5.0, '/spare/part': 6.0})
    set_parameters(
        tf.listener, simulator=SIMULATOR, simulator_others=True,
        simulator_entity='/World/{model}')
    tf.wait_for_frames('spare/part')
    found = tf.last['spare/part']
    assert (found.header.frame_id, found.transform.translation.x) == ('world', 6.0)
    assert pose_of(tf, 'spare/part').x == 6.0
    simulator.entities['ball'] = simulator.entities.pop('/spare/part')
    tf.wait_for_frames('ball')
    wait_for_line(tf, bridge, '1 frame no longer published, which TF listeners keep')
    tf.last.clear()
    tf.wait_for_frames('ball', 'cart/deck')
    assert not tf.last.keys() & {'World/wall', 'World/cart', 'spare/part'}
    reload(tf.listener)
    assert pose_of(tf, 'ball').x == 6.0
    set_parameters(tf.listener, simulator_others=False)
    wait_for_line(tf, bridge, 'which TF listeners keep until they are restarted: "ball"')


def test_a_simulator_may_start_later_and_be_stopped(bridge, tf):
    set_parameters(tf.listener, simulator=SIMULATOR, simulator_rate=100.0)
    bridge.wait_for_line(f'no poses of models from {SIMULATOR}/get_entities_states: there is no')
    simulator = Simulator(tf, Result.RESULT_INCORRECT_STATE, cart=3.0)
    tf.listener.wait(lambda: len(simulator.requests) > 2, 'calls')
    simulator.result = Result.RESULT_OK
    tf.wait_for_frames('cart/deck')
    bridge.wait_for_line(
        r'the simulator answers with result 3, which is not OK: paused\n[FATAL] at 5001')
    assert bridge.count_of('no poses of models') == 2


def test_the_newest_of_two_sources_counts(bridge, tf):
    tracker = Tracker(tf)
    simulator = Simulator(tf, cart=3.0)
    set_parameters(
        tf.listener, simulator=SIMULATOR, model_pose_topics=['/tracker/{model}/pose'])
    tf.wait_for_frames('cart/deck')
    tracker.sec = simulator.sec + 1000
    words = f'"cart" come from several publishers at once on {SIMULATOR}/get_entities_states and'

    def is_told():
        tracker.move(4.0)
        return bridge.count_of(words)

    tf.listener.wait(is_told, bridge.lines)
    count = len(simulator.requests)
    tf.listener.wait(lambda: len(simulator.requests) > count + 3, 'calls')
    assert pose_of(tf, 'cart').x == 4.0
    assert bridge.count_of(words) == 1
