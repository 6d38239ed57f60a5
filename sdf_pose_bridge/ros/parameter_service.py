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
from typing import Any

from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_service import ParameterService

from sdf_pose_bridge.names import hint_from_names
from sdf_pose_bridge.ros.parameter_types import parameter_with_type
from sdf_pose_bridge.ros.parameters import DECLARATIONS


class AtomicParameterService(ParameterService):
    """
    The parameter services of a node; a call that sets parameters sets all of them or none.

    :param node: the node.
    :param group: callback group of the services that set parameters.
    :param set_parameters: sets declared parameters, and returns what the services answer.
    """

    def __init__(
        self, node: Node, group: CallbackGroup,
        set_parameters: Callable[[list[Parameter]], Awaitable[SetParametersResult]],
    ) -> None:
        super().__init__(node)
        self._set_parameters = set_parameters
        # The parent class makes the services, and takes no group for them.
        for service in node.services:
            if service.srv_type in (SetParameters, SetParametersAtomically):
                service.callback_group = group
                group.add_entity(service)

    async def _set_parameters_callback(self, request: Any, response: Any) -> Any:
        result = await self._result(request.parameters)
        response.results = [result] * len(request.parameters)
        return response

    async def _set_parameters_atomically_callback(self, request: Any, response: Any) -> Any:
        response.result = await self._result(request.parameters)
        return response

    async def _result(self, messages: Sequence[ParameterMessage]) -> SetParametersResult:
        node = self._get_node()
        for name in (message.name for message in messages):
            if not node.has_parameter(name):
                msg = f'there is no parameter "{name}"{hint_from_names(name, DECLARATIONS)}'
                return SetParametersResult(successful=False, reason=msg)
        try:
            parameters = [_parameter_from_message(message) for message in messages]
        except (ValueError, TypeError) as error:  # a type that does not exist
            return SetParametersResult(successful=False, reason=str(error))
        # "ros2 param load" of a dump also sets read-only parameters, to the values that they have.
        return await self._set_parameters([
            each for each in parameters
            if not node.describe_parameter(each.name).read_only
            or node.get_parameter(each.name).value != each.value])


def _parameter_from_message(message: ParameterMessage) -> Parameter:
    parameter = Parameter.from_parameter_msg(message)
    declaration = DECLARATIONS.get(message.name)
    return parameter_with_type(parameter, declaration.type_) if declaration else parameter
