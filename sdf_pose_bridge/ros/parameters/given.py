# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Convert values of parameters to settings, at the start of the node and in calls of services.

The services are rclpy's; those that set parameters are answered here.
"""

from __future__ import annotations

import array
from collections.abc import Awaitable, Callable, Collection, Iterable, Mapping, Sequence
import json
import shlex
from typing import Any

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    SetParameters,
    SetParametersAtomically,
)
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, HistoryPolicy, ReliabilityPolicy
from rclpy.service import Service
from rclpy.task import Future

from sdf_pose_bridge.nearest_names import hint_from_names
from sdf_pose_bridge.printed_text import printable, shortened
from sdf_pose_bridge.ros.background import wake
from sdf_pose_bridge.ros.parameters.declarations import (
    DECLARATIONS,
    Settings,
    SettingsError,
    Value,
)
from sdf_pose_bridge.ros.parameters.rules import check_size, MOST_CHARACTERS, MOST_VALUES

MOST_REASONS = 20
"""Number of results of a rejected call that contain the reason."""

QOS_OVERRIDES = 'qos_overrides.'
"""Prefix of the names of parameters that override the quality of service of topics, as in nodes of
rclcpp and rclpy: ``qos_overrides.<topic>.<publisher or subscription>.<policy>``."""

_LARGEST_DEPTH = 2**31 - 1
"""Largest depth of a queue that rclpy and Fast DDS accept."""

_POLICIES = {
    'reliability': ReliabilityPolicy, 'durability': DurabilityPolicy, 'history': HistoryPolicy}

_OF_PUBLISHER = ('publisher.history', 'publisher.depth', 'publisher.reliability')
_OVERRIDABLE = {
    'joint_states': ('subscription.reliability', 'subscription.durability'),
    'parameter_events': (), 'tf': _OF_PUBLISHER, 'tf_static': _OF_PUBLISHER}
"""The policies that parameters can override, for the topics of robot_state_publisher."""

_NAMES_OF_TYPES = {
    Parameter.Type.STRING: 'a string', Parameter.Type.BOOL: 'true or false',
    Parameter.Type.INTEGER: 'an integer', Parameter.Type.DOUBLE: 'a number',
    Parameter.Type.STRING_ARRAY: 'a list of strings',
    Parameter.Type.BOOL_ARRAY: 'a list of booleans',
    Parameter.Type.INTEGER_ARRAY: 'a list of integers',
    Parameter.Type.DOUBLE_ARRAY: 'a list of numbers', Parameter.Type.BYTE_ARRAY: 'a list of bytes',
}


def settings_from_node(
    node: Node, defaults: Mapping[str, Value] | None = None, file: str = '',
    advice: str = 'parameter sdf_file is not set',
) -> Settings:
    """
    Declare all parameters on a node with their given values, and convert these.

    :param defaults: defaults of parameters, where they differ from the declared defaults.
    :param file: the file to publish, unless parameters name a file or a text.
    :param advice: the message if there is neither a file nor a text.
    :raises SettingsError: if a value has the wrong type or is not allowed.
    """
    given = _given_parameters(node)
    defaults = dict(defaults or {})
    if not {'sdf_file', 'robot_description'}.intersection(given):
        defaults['sdf_file'] = file
    parameters = _parameters_at_start(given, defaults)
    sentences = _sentences_about_overrides(given)
    if sentences:
        raise SettingsError(sentences)
    settings = changed_settings(
        Settings({}), parameters,
        f'{advice}; in a parameter file, they are below the name of this node, '
        f'{node.get_fully_qualified_name()}')
    for parameter in parameters:
        _declare(node, parameter)
    return settings


def settings_from_values(values: Mapping[str, Any]) -> Settings:
    """
    Convert values of parameters without a node.

    :param values: values by the names of parameters; other parameters have their defaults.
    :raises SettingsError: if there is no such parameter, or a value has the wrong type or is not
        allowed.
    """
    if unknown := values.keys() - DECLARATIONS.keys():
        raise SettingsError([
            f'there is no parameter {name}{hint_from_names(name, DECLARATIONS)}'
            for name in sorted(unknown)])
    given = {name: Parameter(name, value=value) for name, value in values.items()}
    return changed_settings(Settings({}), _parameters_at_start(given, {}))


def changed_settings(
    settings: Settings, parameters: Iterable[Parameter], advice: str = '',
) -> Settings:
    """
    Convert new values of parameters.

    :param parameters: the new values, as :func:`parameter_with_type` returns them; parameters that
        are not declared here are ignored.
    :param advice: at the start of the node, the message if there is neither a file nor a text;
        other messages show how to write a value on the command line then.
    :raises SettingsError: if a value has the wrong type or is not allowed.
    """
    values = dict(settings.values)
    sentences = []
    for given in parameters:
        if given.name in DECLARATIONS:
            try:
                values[given.name] = _converted(given, shows_command_line=bool(advice))
            except ValueError as error:
                sentences.append(f'parameter {given.name} {error}')
    sources = [values.get(name) for name in ('sdf_file', 'robot_description')]
    if all(sources):
        sentences.insert(
            0, 'parameters sdf_file and robot_description are both set; set one of them, and the '
            'other one to an empty string')
    elif sources == ['', '']:
        sentences.insert(
            0, advice or 'parameter sdf_file is not set, nor is robot_description; set one of '
            'them')
    elif sources[1] and '<' not in sources[1]:
        sentences.insert(
            0, f'parameter robot_description is "{shortened(sources[1])}", which is no text of '
            'SDFormat or URDF; the parameter sdf_file takes a path')
    if sentences:
        raise SettingsError(sentences)
    return Settings(values)


def warnings_about_unknown_parameters(
    node: Node, known_elsewhere: Collection[str] = (),
) -> list[str]:
    """
    Find parameters that were given when the node was started, but that it does not have.

    :param known_elsewhere: names of parameters of other nodes, which cause no warning. If there
        are any, names that resemble no name of a parameter are left out, too.
    """
    warnings = []
    for name in _given_parameters(node):
        reason = _reason_without_effect(name)
        if reason:
            warnings.append(f'parameter {name} has no effect here; {reason}')
        elif not (name in DECLARATIONS or node.has_parameter(name)
                  or name.startswith(QOS_OVERRIDES) or name in known_elsewhere):
            hint = hint_from_names(name, DECLARATIONS)
            if hint or not known_elsewhere:
                warnings.append(f'there is no parameter "{name}", so it has no effect{hint}')
    return warnings


def _reason_without_effect(name: str) -> str:
    """Return why a parameter of robot_state_publisher changes nothing here; else empty."""
    if name == 'description_from_topic':
        return 'set robot_description to the text, or sdf_file to a file'
    topic, _, policy = name.removeprefix(QOS_OVERRIDES).partition('.')
    known = _OVERRIDABLE.get(topic.rpartition('/')[2])
    if not name.startswith(QOS_OVERRIDES) or not policy or known is None or policy in known:
        return ''
    return f'of {topic}, one can override {", ".join(known) or "nothing"}'


class ParameterServices:
    """
    The parameter services of rclpy, with other callbacks.

    It must be made before the executor of the node spins.

    :param node: the node that offers them.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self.group = MutuallyExclusiveCallbackGroup()
        """Callback group of the services that set parameters."""
        self._set_parameters: Future = Future()
        for service in node.services:
            # rclpy's callbacks set the parameters of a call one after the other and block the
            # executor. The file would be read for each of them, with settings that nobody
            # requested. The services stay, as clients may have found them already.
            if service.srv_type is SetParameters:
                self._replace(service, self._set_each)
            elif service.srv_type is SetParametersAtomically:
                self._replace(service, self._set_atomically)
            elif service.srv_type in (DescribeParameters, GetParameters, GetParameterTypes):
                service.callback = _without_repetition(service.callback)

    def _replace(self, service: Service, callback: Callable[[Any, Any], Awaitable[Any]]) -> None:
        service.callback = callback
        service.callback_group = self.group
        self.group.add_entity(service)

    def start(
        self, set_parameters: Callable[[list[Parameter]], Awaitable[SetParametersResult]],
    ) -> None:
        """
        Answer the calls that set parameters; until then they wait.

        A call sets all of its parameters or none. Calls that are too large are rejected first.

        :param set_parameters: sets declared parameters, and returns the result for the response.
        """
        self._set_parameters.set_result(set_parameters)
        wake(self._node.executor)

    async def _result(self, messages: Sequence[ParameterMessage]) -> SetParametersResult:
        set_parameters = await self._set_parameters
        try:
            parameters = _parameters_from_messages(self._node, messages)
        except (ValueError, TypeError) as error:
            return SetParametersResult(successful=False, reason=str(error))
        result: SetParametersResult = await set_parameters(parameters)
        return result

    async def _set_each(
        self, request: SetParameters.Request, response: SetParameters.Response,
    ) -> SetParameters.Response:
        count = len(request.parameters)
        found = other = await self._result(request.parameters)
        if not found.successful:
            other = SetParametersResult(
                successful=False, reason='the first result of this answer says why')
        response.results = ([found] * MOST_REASONS + [other] * count)[:count]
        return response

    async def _set_atomically(
        self, request: SetParametersAtomically.Request, response: SetParametersAtomically.Response,
    ) -> SetParametersAtomically.Response:
        response.result = await self._result(request.parameters)
        return response


def _without_repetition(callback: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    """Wrap a callback: a request that repeats a name, perhaps for gigabytes, gets no values."""
    def answer(request: Any, response: Any) -> Any:
        is_unique = len(set(request.names)) == len(request.names)
        return callback(request, response) if is_unique else response
    return answer


def _given_parameters(node: Node) -> Mapping[str, Parameter]:
    # No public name shows those that are not declared. rclpy 7 to 10 have this one.
    given: Mapping[str, Parameter] = node._parameter_overrides  # noqa: SLF001
    return given


def _sentences_about_overrides(given: Mapping[str, Parameter]) -> list[str]:
    """Find values that their policy of the quality of service does not have."""
    sentences = []
    for name, parameter in given.items():
        policy, value = name.rpartition('.')[2], parameter.value
        known = [each.name.lower() for each in _POLICIES.get(policy, ()) if each.name != 'UNKNOWN']
        rule = ''
        if known and value not in known:
            rule = f'one of {", ".join(known)}'
        elif policy == 'depth' and (
                parameter.type_ is not Parameter.Type.INTEGER or not 0 <= value <= _LARGEST_DEPTH):
            rule = f'an integer from 0 to {_LARGEST_DEPTH}'
        if rule and name.startswith(QOS_OVERRIDES):
            sentences.append(f'parameter {name} is {value}; it must be {rule}')
    return sentences


def _parameters_at_start(
    given: Mapping[str, Parameter], defaults: Mapping[str, Value],
) -> list[Parameter]:
    parameters = []
    for name, declaration in DECLARATIONS.items():
        type_, default = declaration.type_, defaults.get(name, declaration.default)
        parameter = given.get(name, Parameter(name, type_, default))
        if parameter.type_ is Parameter.Type.NOT_SET:
            # rclpy treats an empty list on the command line as no value.
            is_list = type_ is Parameter.Type.STRING_ARRAY
            parameter = Parameter(name, type_, [] if is_list else default)
        parameters.append(parameter_with_type(parameter, type_))
    return parameters


def _declare(node: Node, parameter: Parameter) -> None:
    declaration = DECLARATIONS[parameter.name]
    descriptor = ParameterDescriptor(
        description=declaration.description, additional_constraints=declaration.rule,
        read_only=declaration.is_read_only)
    if declaration.maximum is not None:
        descriptor.floating_point_range = [
            FloatingPointRange(from_value=0.0, to_value=declaration.maximum)]
    # rclpy cannot tell the type of an empty list.
    is_empty = parameter.value == []
    node.declare_parameter(
        parameter.name, parameter.type_ if is_empty else parameter.value, descriptor,
        ignore_override=True)
    if is_empty:
        node.set_parameters([parameter])


def _converted(given: Parameter, *, shows_command_line: bool) -> Any:
    declaration = DECLARATIONS[given.name]
    check_size(given.value, declaration.most_characters or MOST_CHARACTERS)
    if given.type_ is declaration.type_:
        return declaration.convert(given.value)
    if given.type_ is Parameter.Type.NOT_SET:
        msg = 'cannot be without a value'
        raise ValueError(msg)
    value = list(given.value) if isinstance(given.value, array.array) else given.value
    shown = printable(shortened(str(value)))
    msg = (f'is {shown}, which is {_NAMES_OF_TYPES[given.type_]}; it must be '
           f'{_NAMES_OF_TYPES[declaration.type_]}')
    if shows_command_line and declaration.type_ is Parameter.Type.STRING:
        msg += f', so quote it twice: {_argument(given.name, json.dumps(shown))}'
    elif (shows_command_line and declaration.type_ is Parameter.Type.STRING_ARRAY
            and given.type_ is Parameter.Type.STRING):
        items = [item.strip() for item in given.value.split(',')]
        msg += f': {_argument(given.name, json.dumps(items))}'
    raise ValueError(msg)


def _argument(name: str, value: str) -> str:
    """Return the arguments of a program that set a parameter, quoted for the shell."""
    return shlex.join(['-p', f'{name}:={value}'])


def parameter_with_type(given: Parameter, wanted: Parameter.Type) -> Parameter:
    """
    Convert a value to another type of the same meaning.

    :return: an integer as a number, or an empty list of any type as a list of strings, if that is
        the wanted type; otherwise the value as it was given.
    """
    if wanted is Parameter.Type.DOUBLE and given.type_ is Parameter.Type.INTEGER:
        return Parameter(given.name, wanted, float(given.value))
    if (wanted is Parameter.Type.STRING_ARRAY and given.type_.name.endswith('ARRAY')
            and not len(given.value)):
        return Parameter(given.name, wanted, [])
    return given


def _parameters_from_messages(node: Node, messages: Sequence[ParameterMessage]) -> list[Parameter]:
    """
    Return the parameters of a call; of several values of one, the last.

    :return: the parameters, without read-only ones that keep their values, such as in a dump that
        "ros2 param load" sets.
    :raises ValueError: if there is no such parameter, or no such type, or if there are too many
        parameters.
    """
    if len(messages) > MOST_VALUES:
        msg = f'a call can set at most {MOST_VALUES} parameters, and this one has {len(messages)}'
        raise ValueError(msg)
    parameters = []
    for message in {each.name: each for each in messages}.values():
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
