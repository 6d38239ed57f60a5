# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Callers that ask for anything, in any number, and leave when they like."""

import array
from importlib import import_module
import math
import sys
import time

import pytest

pytest.importorskip('hypothesis', reason='needs hypothesis')
from changes import (
    BRIDGE,
    call,
    listen_to_tf,
    parameter_value,
    reload,
    replace,
    set_parameters,
    wait_for_x,
    world,
)
from deadline import wait_until
from hypothesis import given, settings
from hypothesis import strategies as st
from listener import Answer
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)
from rclpy.qos import qos_profile_parameters
from sizes import size
from slow_file import SlowFile
from std_srvs.srv import Trigger

from sdf_pose_bridge.geometry.formats import POSE_FORMATS
from sdf_pose_bridge.ros.parameters.declarations import DECLARATIONS
from sdf_pose_bridge_interfaces.srv import ConvertPoses, ConvertRotation, LookupPose

LONG_NAME = 'abcdefghijklmnopqrstuvwxyz' * 7
CALLS = size(200, 100_000)
CLIENTS = size(50, 100)
NUMBERS = size(16_000, 1_000_000)

# Messages hold UTF-8, which has no surrogates.
TEXTS = st.text(st.characters(exclude_categories=['Cs']), max_size=20) | st.sampled_from(
    ['', 'world', 'crate', 'crate::body', 'crate/body', '::', '/', '*', '[', 'a\0b', 'x' * 10_000])
FORMATS = st.sampled_from([*POSE_FORMATS]) | TEXTS
NAMES = st.sampled_from([*DECLARATIONS, 'use_sim_time', 'start_type_description_service']) | TEXTS
VALUES = {
    'boolean': st.booleans(), 'double': st.floats() | st.sampled_from([0.0, 1e308, math.pi / 2]),
    'int64': st.integers(-2**63, 2**63 - 1), 'octet': st.binary(min_size=1, max_size=1),
    'uint8': st.sampled_from([
        0, 1, ParameterType.PARAMETER_STRING, ParameterType.PARAMETER_STRING_ARRAY])
    | st.integers(0, 255),
    'uint64': st.integers(0, 2**64 - 1),
}
"""Strategies by the types of fields; integers of 8 bits name the field that has the value."""

SERVICES = {
    'convert_rotation': (ConvertRotation, TEXTS), 'convert_poses': (ConvertPoses, FORMATS),
    'lookup_pose': (LookupPose, TEXTS), 'reload': (Trigger, TEXTS),
    'set_parameters': (SetParameters, NAMES),
    'set_parameters_atomically': (SetParametersAtomically, NAMES),
    'get_parameters': (GetParameters, NAMES), 'get_parameter_types': (GetParameterTypes, NAMES),
    'describe_parameters': (DescribeParameters, NAMES), 'list_parameters': (ListParameters, TEXTS),
}
"""Types of services, and what texts in requests are."""


def values_of_type(name, texts):
    """Return a strategy of values for fields of a type."""
    if name.startswith('sequence<'):
        item = name.removeprefix('sequence<').removesuffix('>')
        return st.lists(values_of_type(item, texts), max_size=32 if item == 'double' else 3)
    if '/' in name:
        package, name = name.split('/')
        return messages(getattr(import_module(f'{package}.msg'), name), texts)
    return texts if name == 'string' else VALUES[name]


def messages(message_type, texts):
    """Return a strategy of messages, with any values in all fields."""
    return st.fixed_dictionaries({
        field: values_of_type(name, texts)
        for field, name in message_type.get_fields_and_field_types().items()
    }).map(lambda values: message_type(**values))


REQUESTS = st.one_of(*(
    st.tuples(st.just(service_type), st.just(name), messages(service_type.Request, texts))
    for name, (service_type, texts) in SERVICES.items()))

LEAVING_CLIENT = f"""
import rclpy
from std_srvs.srv import Trigger

rclpy.init()
node = rclpy.create_node('leaving')
client = node.create_client(Trigger, '{BRIDGE}/reload')
# The first requests are lost, until the bridge has discovered the client.
node.create_timer(0.5, lambda: client.call_async(Trigger.Request()))
rclpy.spin(node)
"""


@pytest.fixture
def listener(bridge, start_listener):
    return start_listener()


def test_whatever_is_asked_is_answered(bridge, listener):
    @settings(max_examples=CALLS, database=None)
    @given(REQUESTS)
    def ask(request):
        service_type, name, content = request
        answer = listener.call(service_type, f'{BRIDGE}/{name}', content)
        if hasattr(answer, 'success'):
            assert answer.success or answer.message
        assert 'internal' not in str(answer)[:1000]

    ask()
    assert not bridge.count_of('internal error')


def test_many_clients_at_once_are_all_answered(listener):
    # Every client receives the answers to all others, and by default keeps ten.
    clients = [
        listener.node.create_client(
            LookupPose, f'{BRIDGE}/lookup_pose', qos_profile=qos_profile_parameters)
        for _ in range(CLIENTS)]
    for client in clients:
        listener.wait(client.service_is_ready, 'the service')
    answers = [Answer(client, LookupPose.Request(frame='crate::body')) for client in clients]
    assert all(listener.response(answer).success for answer in answers)


def test_a_client_that_waits_for_the_node_is_answered(start_bridge, start_listener, file):
    listener = start_listener()
    client = listener.node.create_client(SetParameters, f'{BRIDGE}/set_parameters')
    start_bridge(sdf_file=file)
    # As rclcpp, which is told of each change; client.wait_for_service looks every 0.25 s.
    wait_until(client.service_is_ready, lambda: time.sleep(0.001))
    answer = Answer(client, SetParameters.Request(parameters=[
        Parameter(name='frame_prefix', value=value_of(string_value='r/'))]), may_be_lost=False)
    (result,) = listener.response(answer).results
    assert result.successful, result.reason
    listen_to_tf(listener)
    wait_for_x(listener, 1.0, 'r/crate/body')


def test_a_client_that_leaves_before_the_answer_harms_nobody(
        file, listener, start_program):
    set_parameters(listener, watch=False)
    slow = SlowFile(file, world(1))
    slow.hold()
    client = start_program([sys.executable, '-c', LEAVING_CLIENT])
    with slow.opened():
        client.send(9)
        client.wait_for_end()
        slow.write(world(2))
    assert reload(listener).success


def test_many_numbers_in_one_call_are_converted(listener):
    row = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.5, 2.0, -3.0, 1.0]
    # A first call is repeated if it takes long.
    for times in (0, NUMBERS // len(row)):
        answer = call(
            listener, ConvertPoses, from_format='franka_matrix', to_format='sdf_quat_xyzw',
            values=array.array('d', row) * times)
    assert answer.success, answer.message
    assert answer.values == array.array('d', [0.5, 2.0, -3.0, 0.0, 0.0, 0.0, 1.0]) * (
        NUMBERS // len(row))


def test_more_numbers_than_a_call_can_have_are_refused(listener):
    answer = call(
        listener, ConvertPoses, from_format='sdf_rpy', to_format='sdf_quat_xyzw',
        values=array.array('d', [0.0]) * 7_000_000)
    assert not answer.success
    assert answer.message == 'values has 7000000 numbers; a call can have at most 1000000'


# Calls that ask for much with few bytes, or repeat themselves


def value_of(**fields):
    return ParameterValue(
        type=getattr(ParameterType, f'PARAMETER_{next(iter(fields)).rpartition("_")[0].upper()}'),
        **fields)


def test_very_many_values_for_a_parameter_are_refused_in_one_sentence(listener):
    # Of a message of many megabytes the middleware may lose pieces, and repeat them after 3 s.
    parameters = [Parameter(
        name='sdf_file', value=value_of(integer_array_value=array.array('q', [7]) * 50_000))]
    parameters += [
        Parameter(name='publish_rate', value=value_of(double_value=0.0)) for _ in range(999)]
    results = call(listener, SetParameters, parameters=parameters).results
    assert len(results) == 1000
    assert not any(result.successful for result in results)
    assert results[0].reason == (
        'parameter sdf_file has 50000 values; it must have at most 1000')
    assert sum(len(result.reason) for result in results) < 100_000


def test_more_parameters_than_a_call_can_set_get_short_results(listener):
    parameters = [Parameter(name='watch', value=value_of(bool_value=True)) for _ in range(20_000)]
    answer = call(listener, SetParameters, parameters=parameters)
    assert answer.results[0].reason == (
        'a call can set at most 1000 parameters, and this one has 20000')
    assert answer.results[-1].reason == 'the first result of this answer says why'
    assert len(answer.results) == 20_000


def test_a_large_value_is_not_repeated(start_bridge, start_listener, tmp_path):
    text = f'<robot name="r"><link name="l"/><!-- {"x" * 1_000_000} --></robot>'
    path = tmp_path / 'parameters.yaml'
    path.write_text(f"/**: {{ros__parameters: {{robot_description: '{text}'}}}}")
    start_bridge('--ros-args', '--params-file', path).wait_until_started()
    listener = start_listener()
    name = 'robot_description'
    assert parameter_value(listener, name).string_value == text
    assert call(listener, GetParameters, names=[name] * 1000).values == []


def test_what_is_searched_among_many_long_names_is_answered(bridge, file, listener):
    frames = ''.join(f'<frame name="{LONG_NAME}{number}"/>' for number in range(20_000))
    replace(file, world(1, extra=frames))
    bridge.wait_for_line('publishing 20002 frames')
    answer = call(listener, LookupPose, frame=f'{LONG_NAME}x')
    assert '; did you mean ' in answer.message
    patterns = [f'*{number}{"a" * 200}b' for number in range(1000)]
    set_parameters(listener, pose_topics=patterns)
    bridge.wait_for_line('takes too long')
