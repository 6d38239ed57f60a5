# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Services that show parameters: they answer as those of rclpy do, but for what is too much."""

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from rcl_interfaces.msg import ParameterDescriptor
from rcl_interfaces.srv import DescribeParameters, GetParameters, GetParameterTypes, ListParameters
import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter

from sdf_pose_bridge.ros.parameter_services import add_parameter_services

SECONDS = 20.0


@pytest.fixture(name='answers')
def answers_of_services(make_node):
    """Returns what the added services and those of rclpy answer to a request."""
    nodes = [make_node('theirs'), rclpy.create_node(
        'added', context=make_node('asking').context, start_parameter_services=False)]
    add_parameter_services(nodes[1], ReentrantCallbackGroup(), None)
    for node in nodes:
        node.declare_parameter('a.number', 3.5, ParameterDescriptor(description='A number.'))
        node.declare_parameter('a.b.names', ['x', 'y'])
        node.declare_parameter('empty', Parameter.Type.INTEGER)
    executor = SingleThreadedExecutor(context=nodes[0].context)
    for node in nodes:
        executor.add_node(node)

    def ask(service_type, name, request):
        found = []
        for node in nodes:
            client = nodes[0].create_client(service_type, f'/{node.get_name()}/{name}')
            assert client.wait_for_service(SECONDS)
            future = client.call_async(request)
            executor.spin_until_future_complete(future, SECONDS)
            found.append(future.result())
        return found

    yield ask
    executor.shutdown()
    nodes[1].destroy_node()


NAMES = [['a.number', 'a.b.names'], ['empty'], ['a.number', 'empty'], ['a.number', 'no'], [], ['']]


@pytest.mark.parametrize(('service_type', 'name'), [
    (DescribeParameters, 'describe_parameters'), (GetParameters, 'get_parameters'),
    (GetParameterTypes, 'get_parameter_types')])
def test_parameters_are_shown_as_rclpy_shows_them(answers, service_type, name):
    for names in NAMES:
        added, theirs = answers(service_type, name, service_type.Request(names=names))
        assert added == theirs


@pytest.mark.parametrize(('prefixes', 'depth'), [
    ([], 0), ([], 1), (['a'], 0), (['a'], 1), (['a.b'], 2), (['no'], 0), ([''], 1)])
def test_parameters_are_listed_as_rclpy_lists_them(answers, prefixes, depth):
    request = ListParameters.Request(prefixes=prefixes, depth=depth)
    theirs, added = (
        {*answer.result.names} - {'start_type_description_service'}
        for answer in answers(ListParameters, 'list_parameters', request))
    assert added == theirs


@pytest.mark.parametrize(('service_type', 'name', 'field'), [
    (DescribeParameters, 'describe_parameters', 'descriptors'),
    (GetParameters, 'get_parameters', 'values'),
    (GetParameterTypes, 'get_parameter_types', 'types')])
def test_more_names_than_a_call_can_have_are_not_answered(answers, service_type, name, field):
    for count, found in ((1000, 1000), (1001, 0)):
        _, added = answers(service_type, name, service_type.Request(names=['a.number'] * count))
        assert len(getattr(added, field)) == found
