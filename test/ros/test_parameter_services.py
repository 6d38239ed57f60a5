# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The parameter services of rclpy, as far as they are kept."""

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)

from sdf_pose_bridge.ros.parameter_services import restrict_parameter_services


@pytest.fixture(name='services')
def restricted_services(make_node):
    node = make_node('bridge')
    node.declare_parameter('a', 3.5)
    node.declare_parameter('b', ['x', 'y'])
    restrict_parameter_services(node)
    return {service.srv_type: service for service in node.services}


def test_those_that_set_parameters_are_removed(services):
    assert SetParameters not in services
    assert SetParametersAtomically not in services
    assert ListParameters in services


@pytest.mark.parametrize(('service_type', 'field'), [
    (DescribeParameters, 'descriptors'), (GetParameters, 'values'), (GetParameterTypes, 'types')])
@pytest.mark.parametrize(('names', 'count'), [(['a', 'b'], 2), (['a'], 1), (['a', 'a'], 0)])
def test_a_name_that_is_repeated_gets_nothing(services, service_type, field, names, count):
    response = services[service_type].callback(
        service_type.Request(names=names), service_type.Response())
    assert len(getattr(response, field)) == count
