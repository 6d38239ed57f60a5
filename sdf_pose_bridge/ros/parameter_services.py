# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Offer the services that read and set parameters; calls that are too large are rejected."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Sequence
import contextlib
from typing import Any

from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    ListParameters,
    SetParameters,
    SetParametersAtomically,
)
from rclpy.callback_groups import CallbackGroup
from rclpy.exceptions import ParameterNotDeclaredException, ParameterUninitializedException
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_parameters

from sdf_pose_bridge.names import hint_from_names, printable, shortened
from sdf_pose_bridge.ros.given_parameters import parameter_with_type
from sdf_pose_bridge.ros.parameters import DECLARATIONS
from sdf_pose_bridge.ros.setting_rules import MOST_VALUES

MOST_REASONS = 20
"""Number of results of a rejected call that contain the reason."""

MOST_CHARACTERS_OF_REPEATED = 1_000_000
"""Largest number of characters of all values in a response that repeats some of them."""

WARNING_PERIOD_S = 10.0

_KINDS_OF_LISTS = ('byte', 'bool', 'integer', 'double', 'string')


def add_parameter_services(
    node: Node, group: CallbackGroup,
    set_parameters: Callable[[list[Parameter]], Awaitable[SetParametersResult]],
) -> None:
    """
    Offer the parameter services of a node; a call that sets parameters sets all of them or none.

    rclpy's services set the parameters of a call one after the other and block the executor: the
    file would be read for each of them, with settings that nobody requested.

    Calls that are too large are rejected first.

    :param group: callback group of the services that set parameters.
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

    services = [
        (SetParameters, 'set_parameters', set_each, group),
        (SetParametersAtomically, 'set_parameters_atomically', set_atomically, group),
        *((type_, name, read, None) for type_, name, read in _reading_services(node))]
    for service_type, name, callback, callback_group in services:
        node.create_service(
            service_type, f'~/{name}', callback, qos_profile=qos_profile_parameters,
            callback_group=callback_group)


def _reading_services(node: Node) -> list[tuple[type, str, Callable[[Any, Any], Any]]]:
    """Return types, names and callbacks of the services that read parameters, as rclpy's do."""
    def has_too_much(names: Sequence[str], values: Sequence[object] = ()) -> bool:
        """Return whether a response would be too large; it has no field for the reason."""
        reason = ''
        if len(names) > MOST_VALUES:
            reason = f'{len(names)} names; it can have at most {MOST_VALUES}'
        elif len(set(names)) < len(names):
            size = sum(len(value) for value in values if isinstance(value, str))
            if size > MOST_CHARACTERS_OF_REPEATED:
                reason = f'names again and again, whose values have {size} characters together'
        if reason:
            node.get_logger().warning(
                f'a call that reads parameters is not answered: it has {reason}',
                throttle_duration_sec=WARNING_PERIOD_S)
        return bool(reason)

    # If a name is not declared, or has no value, these services return nothing at all.
    def describe(
        request: DescribeParameters.Request, response: DescribeParameters.Response,
    ) -> DescribeParameters.Response:
        if not has_too_much(request.names):
            with contextlib.suppress(ParameterNotDeclaredException):
                response.descriptors = node.describe_parameters(request.names)
        return response

    def values(
        request: GetParameters.Request, response: GetParameters.Response,
    ) -> GetParameters.Response:
        if has_too_much(request.names):
            return response
        with contextlib.suppress(ParameterNotDeclaredException, ParameterUninitializedException):
            parameters = node.get_parameters(request.names)
            if not has_too_much(request.names, [parameter.value for parameter in parameters]):
                response.values = [parameter.get_parameter_value() for parameter in parameters]
        return response

    def types(
        request: GetParameterTypes.Request, response: GetParameterTypes.Response,
    ) -> GetParameterTypes.Response:
        if not has_too_much(request.names):
            with contextlib.suppress(ParameterNotDeclaredException):
                response.types = [
                    Parameter.Type(type_).value
                    for type_ in node.get_parameter_types(request.names)]
        return response

    def names(
        request: ListParameters.Request, response: ListParameters.Response,
    ) -> ListParameters.Response:
        if not has_too_much(request.prefixes):
            with contextlib.suppress(TypeError, ValueError):
                response.result = node.list_parameters(request.prefixes, request.depth)
        return response

    return [
        (DescribeParameters, 'describe_parameters', describe),
        (GetParameters, 'get_parameters', values),
        (GetParameterTypes, 'get_parameter_types', types),
        (ListParameters, 'list_parameters', names)]


def _parameters_from_messages(
    node: Node, messages: Sequence[ParameterMessage],
) -> list[Parameter]:
    """
    Return the parameters of a call.

    :return: the parameters, without read-only ones that keep their values, such as those of a dump
        that "ros2 param load" sets.
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
