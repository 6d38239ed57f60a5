# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Take the values that parameters are given: when the node is started, and by its services."""

from __future__ import annotations

import array
from collections.abc import Awaitable
from collections.abc import Callable
from collections.abc import Container
from collections.abc import Iterable
from collections.abc import Mapping
from collections.abc import Sequence
import contextlib
from typing import Any

from rcl_interfaces.msg import FloatingPointRange
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterDescriptor
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import DescribeParameters
from rcl_interfaces.srv import GetParameters
from rcl_interfaces.srv import GetParameterTypes
from rcl_interfaces.srv import ListParameters
from rcl_interfaces.srv import SetParameters
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.callback_groups import CallbackGroup
from rclpy.exceptions import ParameterNotDeclaredException
from rclpy.exceptions import ParameterUninitializedException
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_parameters

from sdf_pose_bridge.names import hint_from_names
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.names import shortened
from sdf_pose_bridge.ros.parameters import DECLARATIONS
from sdf_pose_bridge.ros.parameters import Settings
from sdf_pose_bridge.ros.parameters import SettingsError
from sdf_pose_bridge.ros.parameters import Value
from sdf_pose_bridge.ros.qos_overrides import QOS_OVERRIDES
from sdf_pose_bridge.ros.qos_overrides import sentences_about_overrides
from sdf_pose_bridge.ros.setting_rules import MOST_VALUES

MOST_REASONS = 20
"""How many results of a call that sets parameters have the reason why none is set."""

MOST_CHARACTERS_OF_REPEATED = 1_000_000
"""How long the values may be together in an answer that has some of them several times."""

WARNING_PERIOD_S = 10.0

_KINDS_OF_LISTS = ('byte', 'bool', 'integer', 'double', 'string')

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
) -> Settings:
    """
    Declare all parameters on a node with the values that it was given, and convert these.

    :param defaults: defaults of parameters, where they differ from those of their declarations.
    :param file: the file to publish, unless parameters say what to publish.
    :raises SettingsError: if a value has the wrong type or is not allowed.
    """
    given = _given_parameters(node)
    defaults = dict(defaults or {})
    if not {'sdf_file', 'robot_description'}.intersection(given):
        defaults['sdf_file'] = file
    parameters = _parameters_at_start(given, defaults)
    sentences = sentences_about_overrides(given)
    if sentences:
        raise SettingsError(sentences)
    settings = changed_settings(Settings({}), parameters, shows_command_line=True)
    for parameter in parameters:
        _declare(node, parameter)
    return settings


def settings_from_values(values: Mapping[str, Any]) -> Settings:
    """
    Convert values of parameters without a node.

    :param values: values by the names of parameters; the others have their defaults.
    :raises SettingsError: if a value has the wrong type or is not allowed.
    """
    given = {name: Parameter(name, value=value) for name, value in values.items()}
    return changed_settings(Settings({}), _parameters_at_start(given, {}))


def changed_settings(
    settings: Settings, parameters: Iterable[Parameter], *, shows_command_line: bool = False,
) -> Settings:
    """
    Convert new values of parameters.

    :param parameters: the new values, as :func:`parameter_with_type` returns them; parameters that
        are not declared here are ignored.
    :param shows_command_line: whether to show how to write a value on the command line.
    :raises SettingsError: if a value has the wrong type or is not allowed.
    """
    values = dict(settings.values)
    sentences = []
    for given in parameters:
        if given.name in DECLARATIONS:
            try:
                values[given.name] = _converted(given, shows_command_line=shows_command_line)
            except ValueError as error:
                sentences.append(f'parameter {given.name} {error}')
    sources = [values.get(name) for name in ('sdf_file', 'robot_description')]
    if all(sources):
        sentences.insert(
            0, 'parameters sdf_file and robot_description are both set; set one of them, and the '
            'other one to an empty string')
    elif sources == ['', '']:
        sentences.insert(
            0, 'parameter sdf_file is not set; name the file to publish: --ros-args -p '
            'sdf_file:=cell.sdf after "ros2 run ...", sdf_file:=cell.sdf after "ros2 launch '
            '..."; or set robot_description to its text')
    if sentences:
        raise SettingsError(sentences)
    return Settings(values)


def warnings_about_unknown_parameters(
    node: Node, known_elsewhere: Container[str] = (), *, only_misspelt: bool = False,
) -> list[str]:
    """
    Find parameters that were given when the node was started, but that it does not have.

    :param known_elsewhere: names that mean nothing here, and need no warning.
    :param only_misspelt: whether to leave out those that are not like the name of a parameter.
    """
    hints = {
        name: hint_from_names(name, DECLARATIONS) for name in _given_parameters(node)
        if name not in DECLARATIONS and not node.has_parameter(name)
        and not name.startswith(QOS_OVERRIDES) and name not in known_elsewhere}
    return [
        f'there is no parameter "{name}", so it has no effect{hint}'
        for name, hint in hints.items() if hint or not only_misspelt]


def add_parameter_services(
    node: Node, group: CallbackGroup,
    set_parameters: Callable[[list[Parameter]], Awaitable[SetParametersResult]],
) -> None:
    """
    Offer the parameter services of a node; a call that sets parameters sets all of them or none.

    rclpy's own services set the parameters of a call one after the other, without waiting: the
    file would be read for each of them, in states that nobody asked for, while no other callback
    runs.

    Calls are refused by their size before anything is done for them.

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
        count = len(request.parameters)
        found = other = await result(request.parameters)
        if not found.successful:
            other = SetParametersResult(
                successful=False, reason='the first result of this answer says why')
        response.results = ([found] * MOST_REASONS + [other] * count)[:count]
        return response

    async def answer_atomically(
        request: SetParametersAtomically.Request, response: SetParametersAtomically.Response,
    ) -> SetParametersAtomically.Response:
        response.result = await result(request.parameters)
        return response

    services = [
        (SetParameters, 'set_parameters', answer, group),
        (SetParametersAtomically, 'set_parameters_atomically', answer_atomically, group),
        *((type_, name, read, None) for type_, name, read in _reading_services(node))]
    for service_type, name, callback, callback_group in services:
        node.create_service(
            service_type, f'~/{name}', callback, qos_profile=qos_profile_parameters,
            callback_group=callback_group)


def _reading_services(node: Node) -> list[tuple[type, str, Callable[[Any, Any], Any]]]:
    """Return types, names and callbacks of the services that show parameters, as rclpy's do."""
    def has_too_much(names: Sequence[str], values: Sequence[object] = ()) -> bool:
        """Return whether an answer would be too large; it has no place for the reason then."""
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

    # Of names that are not declared, or have no value, these services return nothing at all.
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
    Return the parameters that a call wants to set.

    :return: the parameters, without read-only ones that keep their values, which "ros2 param load"
        of a dump sets too.
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


def _given_parameters(node: Node) -> Mapping[str, Parameter]:
    """Return what was given when the node was started, by names."""
    given: Mapping[str, Parameter] | None = getattr(node, '_parameter_overrides', None)
    return _given_declared_parameters(node) if given is None else given


def _given_declared_parameters(node: Node) -> Mapping[str, Parameter]:
    """
    Return values of those parameters that are declared here, in the public way of rclpy.

    It takes longer, and does not show parameters that are not declared here.
    """
    values = {}
    for name, declaration in DECLARATIONS.items():
        values[name] = node.declare_parameter(
            name, declaration.default, ParameterDescriptor(dynamic_typing=True))
        node.undeclare_parameter(name)
    return values


def _parameters_at_start(
    given: Mapping[str, Parameter], defaults: Mapping[str, Value],
) -> list[Parameter]:
    """Return all parameters with the values that they are given, or with their defaults."""
    parameters = []
    for name, declaration in DECLARATIONS.items():
        type_, value = declaration.type_, defaults.get(name, declaration.default)
        parameter = given.get(name)
        if parameter is not None and parameter.type_ is not Parameter.Type.NOT_SET:
            type_, value = parameter.type_, parameter.value
        elif parameter is not None and type_ is Parameter.Type.STRING_ARRAY:
            # rclpy reads an empty list on the command line as no value.
            value = []
        parameters.append(parameter_with_type(Parameter(name, type_, value), declaration.type_))
    return parameters


def _declare(node: Node, parameter: Parameter) -> None:
    declaration = DECLARATIONS[parameter.name]
    descriptor = ParameterDescriptor(
        description=declaration.description, additional_constraints=declaration.constraint,
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
    if given.type_ is not declaration.type_:
        words = words_about_wrong_type(given, declaration.type_)
        if shows_command_line:
            words += hint_about_command_line(given, declaration.type_)
        raise ValueError(words)
    return declaration.convert(given.value)


# Types


def parameter_with_type(given: Parameter, wanted: Parameter.Type) -> Parameter:
    """
    Give a value another type in which it has the same meaning.

    :return: an integer as a number, or an empty list of any type as a list of strings, if that is
        the wanted type; otherwise the value as it was given.
    """
    if wanted is Parameter.Type.DOUBLE and given.type_ is Parameter.Type.INTEGER:
        return Parameter(given.name, wanted, float(given.value))
    if (wanted is Parameter.Type.STRING_ARRAY and given.type_.name.endswith('ARRAY')
            and not len(given.value)):
        return Parameter(given.name, wanted, [])
    return given


def words_about_wrong_type(given: Parameter, wanted: Parameter.Type) -> str:
    """
    Explain that a value has the wrong type.

    :return: the words that follow "parameter <name>" in a sentence.
    """
    if given.type_ is Parameter.Type.NOT_SET:
        return 'cannot be without a value'
    return (f'is {_shown_value(given)}, which is {_NAMES_OF_TYPES[given.type_]}; it must be '
            f'{_NAMES_OF_TYPES[wanted]}')


def hint_about_command_line(given: Parameter, wanted: Parameter.Type) -> str:
    """
    Show how to write a value of the wrong type on the command line.

    :return: the end of a sentence; empty if there is nothing to show.
    """
    if wanted is Parameter.Type.STRING:
        return f', so quote it twice: -p "{given.name}:=\'{_shown_value(given)}\'"'
    if given.type_ is Parameter.Type.STRING and wanted is Parameter.Type.STRING_ARRAY:
        return f': -p "{given.name}:=[\'{given.value}\']"'
    return ''


def _shown_value(given: Parameter) -> str:
    value = list(given.value) if isinstance(given.value, array.array) else given.value
    return printable(shortened(str(value)))
