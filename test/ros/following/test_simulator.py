# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Calls of a simulator, and its answers."""

import sys
import time
from types import SimpleNamespace

from deadline import spin_until
import pytest

pytest.importorskip('simulation_interfaces', reason='needs simulation_interfaces')

from moving_models import Models
from rclpy.service import Service
from rclpy.task import Future
from sdf_texts import fixed_joint, world_file
from simulation_interfaces.msg import EntityState, Result
from simulation_interfaces.srv import GetEntitiesStates

from sdf_pose_bridge.export.published_scene import LoadRequest
from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.ros.following import simulator as module
from sdf_pose_bridge.ros.following.simulator import Simulator
from sdf_pose_bridge.ros.following.state_messages import WARNING_PERIOD_S
from sdf_pose_bridge.ros.parameters.given import settings_from_values
from sdf_pose_bridge.ros.parameters.rules import MOST_CHARACTERS
from sdf_pose_bridge.tf.tree import TfOptions

SERVICE = '/sim/get_entities_states'


def follow(simulator, *names, **settings):
    """Ask for the poses of models a hundred times a second."""
    text = world_file(''.join(f'<model name="{name}"><link name="l"/></model>' for name in names))
    request = LoadRequest('', text, tf_options=TfOptions(follows_models=True))
    simulator.follow(
        loaded_scene_from_request(request).joint_positions,
        settings_from_values({'sdf_file': 'a.sdf', 'simulator_rate': 100.0, **settings}))


@pytest.fixture(name='simulator')
def make_simulator(node):
    found = Simulator(node, SERVICE, lambda: None)
    follow(found, 'a')
    yield found
    found.end()


@pytest.fixture
def service(node, make_node):
    """Starts a service; ``service(names, states)`` returns the requests."""
    server = make_node('sim')
    node.executor.add_node(server)
    requests = []

    def start(names, states):
        def answer(request, response):
            requests.append(request)
            response.result.result = Result.RESULT_OK
            response.entities, response.states = names, [EntityState()] * states
            return response
        server.create_service(GetEntitiesStates, SERVICE, answer)
        return requests

    return start


def spin_as_long_as_many_calls(node):
    ticks = []
    timer = node.create_timer(0.01, lambda: ticks.append('tick'))
    spin_until(node.executor, lambda: len(ticks) == 20)
    node.destroy_timer(timer)


def test_without_the_package_a_line_says_what_to_install(node, monkeypatch, capfd):
    monkeypatch.setitem(sys.modules, 'simulation_interfaces.srv', None)
    simulator = Simulator(node, SERVICE, lambda: None)
    follow(simulator, 'a')
    simulator.end()
    assert not simulator.has_answers
    log = capfd.readouterr().err
    assert log.count('the package simulation_interfaces is not installed; install it') == 1


@pytest.mark.parametrize(('names', 'settings', 'expression'), [
    (['a'], {}, '^(a)$'),
    (['a', 'b'], {'simulator_entity': '/World/{model}'}, '^(/World/a|/World/b)$'),
    (['a', 'b'], {'simulator_entity': 'robot'}, '^(robot)$'),
    (['a'], {'simulator_others': True}, ''),
    (['a.b*', '[x]', 'y-1 ^$', '\\'], {}, r'^(a\.b\*|\[x\]|y-1 \^\$|\\)$'),
])
def test_names_are_escaped_in_the_expression(simulator, names, settings, expression):
    follow(simulator, *names, **settings)
    assert simulator._request.filters.filter == expression


def test_a_call_without_an_answer_is_followed_by_a_second_one(
        node, simulator, service, monkeypatch):
    monkeypatch.setattr(module, 'SECOND_CALL_S', 0.1)
    monkeypatch.setattr(Service, 'send_response', lambda *_: None)
    requests = service(['a'], 1)
    spin_until(node.executor, lambda: len(requests) > 1)
    spin_as_long_as_many_calls(node)
    assert len(requests) == 2
    monkeypatch.setattr(module, 'LONGEST_CALL_S', 0.0)
    spin_until(node.executor, lambda: len(requests) > 2)
    assert simulator._problem.startswith('no answer in')
    assert len(simulator._calls) == 2
    monkeypatch.undo()
    spin_until(node.executor, lambda: simulator.has_answers)
    assert not simulator._problem
    assert not simulator._calls


def test_the_longest_time_counts_from_the_first_call_and_the_next_one_from_the_second(simulator):
    now, first, second = time.monotonic(), Future(), Future()
    answer = SimpleNamespace(
        entities=['a', 'b'], states=['', ''], result=Result(result=Result.RESULT_OK))
    simulator._calls = {first: now - module.LONGEST_CALL_S, second: now}
    first.set_result(answer)
    simulator._receive(first)
    assert simulator._due == now + module.AFTER_EXCESS[0][0]
    simulator._due, simulator._calls = 0.0, {first: now - module.LONGEST_CALL_S, second: now}
    simulator._ask()
    assert [*simulator._calls] == [second]


@pytest.mark.parametrize(('names', 'states', 'line'), [
    (['a', 'b', 'c'], 1, 'no poses of models from {}: the simulator answers with 3 names and 1'),
    (['a', 'b'], 2, 'few poses of models from {}: it has 2 entities, which are more than were'),
])
def test_a_wrong_number_is_told(node, simulator, service, names, states, line, capfd):
    requests, log = service(names, states), []

    def is_told():
        # A service that is not discovered yet is told before.
        log.append(capfd.readouterr().err)
        return line.format(SERVICE) in log[-1]

    spin_until(node.executor, is_told)
    assert log[-1].count(line.format(SERVICE)) == 1
    assert simulator.has_answers == (len(names) == states)
    if len(names) == states:
        spin_as_long_as_many_calls(node)
        assert len(requests) == 1
        follow(simulator, 'a', 'b')
        spin_until(node.executor, lambda: len(requests) > 1)


def test_after_two_answers_with_too_much_it_is_not_asked_until_a_change(
        node, simulator, service, monkeypatch, capfd):
    monkeypatch.setattr(module, 'AFTER_EXCESS', ((0.0, 'soon'), module.AFTER_EXCESS[1]))
    requests = service(['a', 'b', 'c'], 3)
    spin_until(node.executor, lambda: len(requests) == 2)
    spin_as_long_as_many_calls(node)
    assert len(requests) == 2
    line = 'it is not called again until a parameter is set or the file is read again'
    assert capfd.readouterr().err.count(line) == 1
    # Entities of the simulator, which have the file read again, are no such change.
    simulator._followed_others = ['before']
    follow(simulator, 'a')
    spin_as_long_as_many_calls(node)
    assert len(requests) == 2
    follow(simulator, 'a')
    spin_until(node.executor, lambda: len(requests) == 4)


def test_a_filter_that_would_be_too_long_is_none(simulator, monkeypatch):
    follow(simulator, 'a', 'b')
    monkeypatch.setattr(module, 'MOST_CHARACTERS_OF_FILTER', len('a|b'))
    follow(simulator, 'a', 'b')
    assert simulator._request.filters.filter == '^(a|b)$'
    follow(simulator, 'a', 'bc')
    assert simulator._request.filters.filter == ''


def test_the_last_answers_wait_and_their_cost_counts(simulator):
    simulator._answers.extend(range(module.MOST_WAITING + 1))
    simulator._costs_s.extend([0.0] + [1.0] * module._COSTS)
    assert (simulator._answers[0], min(simulator._costs_s)) == (1, 1.0)


def test_answers_that_take_long_are_asked_for_less_often(
        node, simulator, service, monkeypatch, capfd):
    monkeypatch.setattr(module, 'LARGEST_SHARE', 1e-2)
    service(['a'], 1)
    spin_until(node.executor, lambda: len(simulator._costs_s) == module._COSTS)
    log = capfd.readouterr().err
    assert log.count('times a second instead of 100, as an answer with 1 pose takes') == 1


# What the answers say

@pytest.fixture
def answer(node, simulator):
    """Takes an answer about models; ``answer(*names)`` returns the values of each message."""
    return answer_about(Models(node), simulator)


def answer_about(models, simulator):
    simulator.follow(models.positions, settings_from_values(
        {'sdf_file': 'a.sdf', 'simulator_rate': 0.0, 'simulator_others': True}))

    def answer(*names):
        states = [EntityState() for _ in names]
        for number, state in enumerate(states):
            state.pose.position.x, state.header.stamp.nanosec = 1.0, 5 + number
        simulator._answers.append(SimpleNamespace(entities=names, states=states))
        return {
            models.positions.names[dof]: (*values[:2], message.frame_id, message.stamp_ns)
            for message in simulator.messages(models.streams)
            for dof, values in zip(
                message.stream.selection.changed, message.values.tolist(), strict=True)}
    answer.models = models
    return answer


def test_a_nested_model_without_a_pose_keeps_its_place_in_the_model_around_it(answer, capfd):
    for _ in range(2):
        assert answer('a') == {'a': (1.0, 0.0, '', 5), 'a/b': (0.0, 3.0, 'a', 5)}
    assert answer('a', 'a/b')['a/b'] == answer('a', 'a::b')['a/b'] == (1.0, 0.0, '', 6)
    assert answer() == {}
    assert capfd.readouterr().err.count('does not give the poses of "a::b"') == 1


def test_a_model_nested_in_one_that_is_not_free_has_the_newest_stamp(node, simulator):
    model = '<model name="{}"><pose>0 3 0 0 0 0</pose><link name="l"/>{}</model>'
    answer = answer_about(Models(node, text=world_file(
        model.format('a', '') + model.format('b', '')
        + model.format('c', model.format('n', '')) + fixed_joint('j', 'a', 'c'))), simulator)
    assert answer('b', 'a') == {
        'b': (1.0, 0.0, '', 5), 'a': (1.0, 0.0, '', 6), 'c/n': (0.0, 3.0, 'c', 6)}


def test_models_that_two_answers_lack_are_missing_unless_others_send_their_poses(
        simulator, answer):
    answer()
    assert simulator._to_tell == []
    answer()
    assert simulator._to_tell == ['a', 'a::b']
    answer.models.read('a')
    for _ in range(2):
        answer()
    assert simulator._to_tell == ['a::b']


def test_other_entities_are_in_order_if_their_names_are_not_too_long(simulator, answer):
    longest = 'x' * MOST_CHARACTERS
    answer('z', 'a', longest, longest + 'x', 'y')
    assert simulator.others == (longest, 'y', 'z')


def test_an_entity_without_a_name_is_left_out_and_told_once(simulator, answer, capfd):
    for _ in range(2):
        answer('', 'z')
    assert simulator.others == ('z',)
    assert capfd.readouterr().err.count('has an entity without a name, which is left out') == 1


def test_a_model_that_goes_soon_after_another_one_is_told_too(
        node, simulator, service, monkeypatch, capfd):
    log = []

    def has_told(name):
        log.append(capfd.readouterr().err)
        return f'no entity for "{name}' in ''.join(log)

    service([], 0)
    simulator._to_tell = ['a']
    spin_until(node.executor, lambda: has_told('a'))
    simulator._to_tell = ['b']
    spin_as_long_as_many_calls(node)
    assert not has_told('b')
    monkeypatch.setattr(time, 'monotonic', lambda now=time.monotonic: now() + WARNING_PERIOD_S)
    spin_until(node.executor, lambda: has_told('b'))
    spin_as_long_as_many_calls(node)
    assert ''.join(log).count('no entity for') == 2
