# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The parameter services of the node.

rclpy's own services set the parameters of a call one after the other, without waiting: the file
would be read for each of them, in states that nobody asked for, while no other callback runs.
"""

from __future__ import annotations

from collections.abc import Awaitable
from collections.abc import Callable
from collections.abc import Sequence

from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_service import ParameterService

from sdf_pose_bridge.names import hint_from_names
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.names import shortened
from sdf_pose_bridge.ros.parameter_values import MOST_VALUES
from sdf_pose_bridge.ros.parameter_values import parameter_with_type
from sdf_pose_bridge.ros.parameters import DECLARATIONS
from sdf_pose_bridge.ros.services import SERVICE_QOS


def add_parameter_services(
    node: Node, group: CallbackGroup,
    set_parameters: Callable[[list[Parameter]], Awaitable[SetParametersResult]],
) -> None:
    """
    Offer the parameter services of a node; a call that sets parameters sets all of them or none.

    :param group: callback group of the services that set parameters.
    :param set_parameters: sets declared parameters, and returns what the services answer.
    """
    async def result(messages: Sequence[ParameterMessage]) -> SetParametersResult:
        try:
            parameters = _parameters_from_messages(node, messages)
        except (ValueError, TypeError) as error:
            return SetParametersResult(successful=False, reason=str(error))
        return await set_parameters(parameters)

    async def answer(
        request: SetParameters.Request, response: SetParameters.Response,
    ) -> SetParameters.Response:
        response.results = [await result(request.parameters)] * len(request.parameters)
        return response

    async def answer_atomically(
        request: SetParametersAtomically.Request, response: SetParametersAtomically.Response,
    ) -> SetParametersAtomically.Response:
        response.result = await result(request.parameters)
        return response

    own = [
        node.create_service(
            service_type, f'~/{name}', callback, qos_profile=SERVICE_QOS, callback_group=group)
        for service_type, name, callback in (
            (SetParameters, 'set_parameters', answer),
            (SetParametersAtomically, 'set_parameters_atomically', answer_atomically))]
    # It takes no callbacks for single services. While there are two of a kind, no call is lost.
    ParameterService(node)
    for service in list(node.services):
        if service.srv_type in (SetParameters, SetParametersAtomically) and service not in own:
            node.destroy_service(service)


def _parameters_from_messages(
    node: Node, messages: Sequence[ParameterMessage],
) -> list[Parameter]:
    """
    Return the parameters that a call wants to set.

    :return: the parameters, without read-only ones that keep their values, which "ros2 param load"
        of a dump sets too.
    :raises ValueError: if there is no such parameter, or no such type, or if there are too many.
    """
    if len(messages) > MOST_VALUES:
        msg = f'a call can set at most {MOST_VALUES} parameters, and this one has {len(messages)}'
        raise ValueError(msg)
    parameters = []
    for message in messages:
        if not node.has_parameter(message.name):
            msg = (f'there is no parameter "{printable(shortened(message.name))}"'
                   f'{hint_from_names(message.name, DECLARATIONS)}')
            raise ValueError(msg)
        parameter = Parameter.from_parameter_msg(message)
        if message.name in DECLARATIONS:
            parameter = parameter_with_type(parameter, DECLARATIONS[message.name].type_)
        if not (node.describe_parameter(message.name).read_only
                and node.get_parameter(message.name).value == parameter.value):
            parameters.append(parameter)
    return parameters
