# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Offer the services that set parameters instead of rclpy's, which offers the others."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Sequence
from typing import Any

from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    SetParameters,
    SetParametersAtomically,
)
from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_parameters

from sdf_pose_bridge.names import hint_from_names, printable, shortened
from sdf_pose_bridge.ros.given_parameters import parameter_with_type
from sdf_pose_bridge.ros.parameters import DECLARATIONS
from sdf_pose_bridge.ros.setting_rules import MOST_VALUES

MOST_REASONS = 20
"""Number of results of a rejected call that contain the reason."""

_KINDS_OF_LISTS = ('byte', 'bool', 'integer', 'double', 'string')


def restrict_parameter_services(node: Node) -> None:
    """
    Restrict rclpy's parameter services, before a client can have found them.

    The services that set parameters are removed: they set the parameters of a call one after the
    other and block the executor. The file would be read for each of them, with settings that
    nobody requested. The services that read parameters by their names return nothing if a name is
    repeated: a few bytes could request gigabytes.
    """
    for service in list(node.services):
        if service.srv_type in (SetParameters, SetParametersAtomically):
            node.destroy_service(service)
        elif service.srv_type in (DescribeParameters, GetParameters, GetParameterTypes):
            service.callback = _without_repetition(service.callback)


def _without_repetition(callback: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    def answer(request: Any, response: Any) -> Any:
        is_unique = len(set(request.names)) == len(request.names)
        return callback(request, response) if is_unique else response
    return answer


def add_setting_services(
    node: Node, group: CallbackGroup,
    set_parameters: Callable[[list[Parameter]], Awaitable[SetParametersResult]],
) -> None:
    """
    Offer the services that set parameters; a call sets all of its parameters or none.

    Calls that are too large are rejected first.

    :param group: callback group of the services.
    :param set_parameters: sets declared parameters, and returns the result for the response.
    """
    async def result(messages: Sequence[ParameterMessage]) -> SetParametersResult:
        try:
            parameters = _parameters_from_messages(node, messages)
        except (ValueError, TypeError) as error:
            return SetParametersResult(successful=False, reason=str(error))
        return await set_parameters(parameters)

    async def set_each(
        request: SetParameters.Request, response: SetParameters.Response,
    ) -> SetParameters.Response:
        count = len(request.parameters)
        found = other = await result(request.parameters)
        if not found.successful:
            other = SetParametersResult(
                successful=False, reason='the first result of this answer says why')
        response.results = ([found] * MOST_REASONS + [other] * count)[:count]
        return response

    async def set_atomically(
        request: SetParametersAtomically.Request, response: SetParametersAtomically.Response,
    ) -> SetParametersAtomically.Response:
        response.result = await result(request.parameters)
        return response

    for service_type, name, callback in (
            (SetParameters, 'set_parameters', set_each),
            (SetParametersAtomically, 'set_parameters_atomically', set_atomically)):
        node.create_service(
            service_type, f'~/{name}', callback, qos_profile=qos_profile_parameters,
            callback_group=group)


def _parameters_from_messages(
    node: Node, messages: Sequence[ParameterMessage],
) -> list[Parameter]:
    """
    Return the parameters of a call.

    :return: the parameters, without read-only ones that keep their values, such as in a dump that
        "ros2 param load" sets.
    :raises ValueError: if there is no such parameter, or no such type, or if there are too many
        parameters or values.
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
        for kind in _KINDS_OF_LISTS:
            count = len(getattr(message.value, f'{kind}_array_value'))
            if count > MOST_VALUES:
                msg = (f'parameter {message.name} is a list of {count} values; a list can have at '
                       f'most {MOST_VALUES}')
                raise ValueError(msg)
        parameter = Parameter.from_parameter_msg(message)
        if message.name in DECLARATIONS:
            parameter = parameter_with_type(parameter, DECLARATIONS[message.name].type_)
        if not (node.describe_parameter(message.name).read_only
                and node.get_parameter(message.name).value == parameter.value):
            parameters.append(parameter)
    return parameters
