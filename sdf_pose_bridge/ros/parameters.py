# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The node's parameters: declared with a description and a constraint each, read as settings."""

from __future__ import annotations

import array
from collections.abc import Awaitable
from collections.abc import Callable
from collections.abc import Iterable
from collections.abc import Sequence
from typing import Any
from typing import NamedTuple

from rcl_interfaces.msg import FloatingPointRange
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterDescriptor
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.callback_groups import CallbackGroup
from rclpy.exceptions import InvalidParameterTypeException
from rclpy.exceptions import InvalidParameterValueException
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_service import ParameterService

from sdf_pose_bridge.names import hint_from_names
from sdf_pose_bridge.ros.settings import FASTEST_RATE
from sdf_pose_bridge.ros.settings import Problem
from sdf_pose_bridge.ros.settings import PUBLISHED_KINDS
from sdf_pose_bridge.ros.settings import Settings
from sdf_pose_bridge.ros.settings import settings_from_values
from sdf_pose_bridge.ros.settings import SettingsError
from sdf_pose_bridge.tf.tree import DEFAULT_KINDS

Value = str | bool | float | list[str]


class _Declaration(NamedTuple):
    name: str
    default: Value
    description: str
    constraint: str


PARAMETERS = (
    _Declaration(
        'sdf_file', '',
        'The SDFormat file to publish.',
        'required: the path of a file or of a model directory, or a file://, package:// or '
        'model:// URI, such as package://name/worlds/cell.sdf',
    ),
    _Declaration(
        'root_frame', 'world',
        'The TF frame that stands for the SDF world, or for the implicit root of a model file.',
        'not empty, no leading slash',
    ),
    _Declaration(
        'anchor_models', 'all',
        'Which top-level models get a transform from root_frame. "none" leaves that to others, '
        'such as odometry or a localization node.',
        'one of all, static, none',
    ),
    _Declaration(
        'model', '',
        'Publish this model of a world alone; everything if empty.',
        'the name of a model as in SDF: robot, or robot::arm for a nested one',
    ),
    _Declaration(
        'frame_names', 'auto',
        'How frame ids are made: "scoped" keeps the names of all models (robot/arm/tool), '
        '"relative" leaves out that of the top-level model (arm/tool), "auto" is relative for a '
        'model file and scoped for a world.',
        'one of auto, scoped, relative',
    ),
    _Declaration(
        'frame_separator', '/',
        'What stands for "::" in frame ids. "/" is what ros_gz_bridge makes of it.',
        'not empty',
    ),
    _Declaration(
        'frame_prefix', '',
        'Stands before every frame id but that of root_frame, with nothing between them.',
        'no leading slash',
    ),
    _Declaration(
        'kinds', [name for name, kind in PUBLISHED_KINDS.items() if kind in DEFAULT_KINDS],
        'Which kinds of element become frames.',
        f'some of {", ".join(PUBLISHED_KINDS)}',
    ),
    _Declaration(
        'pose_topics', ['*'],
        'Which frames get a topic ~/poses/<frame> with their pose in root_frame.',
        'glob patterns for frame ids, such as robot/* (which matches robot/arm/tool too); '
        'none if empty; * alone means none where there are more than 1000 frames, ?* means all',
    ),
    _Declaration(
        'optical_frames', True,
        'Adds an optical frame (REP 103: z forward, x right, y down) for each camera, named by '
        'its <optical_frame_id>, or like the camera with _optical behind.',
        'true or false',
    ),
    _Declaration(
        'resource_paths', [],
        'Directories searched for model:// and relative URIs before those that '
        'GZ_SIM_RESOURCE_PATH and SDF_PATH name.',
        'paths of directories; empty ones are passed over',
    ),
    _Declaration(
        'publish_rate', 0.0,
        'How often everything is published again, in Hz, for listeners that cannot be latched; '
        '0.0 for once, which is enough for all others.',
        '0.0 for never, else up to 100.0',
    ),
    _Declaration(
        'watch', True,
        'Reads the file again when it, or a file that it includes, has changed.',
        'true or false',
    ),
    _Declaration(
        'on_missing_include', 'error',
        'What to do about an include that cannot be found: "error" refuses the file, "skip" '
        'leaves the include out with a warning.',
        'one of error, skip',
    ),
)
"""All parameters, in the order in which they are explained to people."""

_TYPES = {
    str: Parameter.Type.STRING, bool: Parameter.Type.BOOL, float: Parameter.Type.DOUBLE,
    list: Parameter.Type.STRING_ARRAY}
_DEFAULT_TYPES = {
    declaration.name: _TYPES[type(declaration.default)] for declaration in PARAMETERS}
_LIST_TYPES = (
    Parameter.Type.BYTE_ARRAY, Parameter.Type.BOOL_ARRAY, Parameter.Type.INTEGER_ARRAY,
    Parameter.Type.DOUBLE_ARRAY, Parameter.Type.STRING_ARRAY)
_RATES = FloatingPointRange(from_value=0.0, to_value=FASTEST_RATE)
_TYPE_WORDS = {
    Parameter.Type.STRING: 'a string', Parameter.Type.BOOL: 'true or false',
    Parameter.Type.INTEGER: 'an integer', Parameter.Type.DOUBLE: 'a number with a decimal point',
    Parameter.Type.STRING_ARRAY: 'a list of strings',
    Parameter.Type.BOOL_ARRAY: 'a list of booleans',
    Parameter.Type.INTEGER_ARRAY: 'a list of integers',
    Parameter.Type.DOUBLE_ARRAY: 'a list of numbers', Parameter.Type.BYTE_ARRAY: 'a list of bytes',
}


def settings_from_node(node: Node) -> Settings:
    """
    Declare all parameters on a node and judge what they were set to.

    :param node: the node.
    :return: its settings.
    :raises SettingsError: if any value has the wrong type or breaks its rule; it has a sentence
        for each that does.
    """
    values: dict[str, object] = {}
    wrong_types: dict[str, Problem] = {}
    for declaration in PARAMETERS:
        name = declaration.name
        try:
            values[name] = _declared(node, declaration)
        except InvalidParameterTypeException:
            wrong_types[name] = Problem(name, _sentence_on_override(node, declaration))
            values[name] = declaration.default
        except InvalidParameterValueException as error:
            sentence = f'parameter {name} must be {declaration.constraint}: {error}'
            wrong_types[name] = Problem(name, sentence)
            values[name] = declaration.default
    problems = list(wrong_types.values())
    try:
        settings = settings_from_values(values)
    except SettingsError as error:
        problems += [each for each in error.problems if each.parameter not in wrong_types]
    if problems:
        raise SettingsError(problems)
    return settings


def changed_settings(node: Node, parameters: Iterable[Parameter]) -> Settings:
    """
    Judge what the settings of a node would be after a change.

    :param node: the node, whose parameters are declared.
    :param parameters: the new values; those of other parameters stay.
    :return: the settings.
    :raises SettingsError: if any value breaks its rule, or is no value at all.
    """
    names = [declaration.name for declaration in PARAMETERS]
    values = {name: node.get_parameter(name).value for name in names}
    values.update({each.name: each.value for each in parameters if each.name in names})
    missing = [
        Problem(name, f'parameter {name} cannot be without a value')
        for name, value in values.items() if value is None]
    if missing:
        raise SettingsError(missing)
    return settings_from_values(values)


class SettingTogether(ParameterService):
    """
    The parameter services of a node, of which a call takes effect as a whole or not at all.

    rclpy's own set one parameter after the other: a file of parameters would be judged once for
    each, and the scene be read anew, in states between that nobody asked for.

    :param node: the node.
    :param group: keeps two calls that set parameters from running at the same time.
    :param prepare: does, before parameters are set, what judging them needs and takes long.
    :param take: does what follows when they have been set.
    """

    def __init__(
        self, node: Node, group: CallbackGroup,
        prepare: Callable[[Sequence[Parameter]], Awaitable[None]],
        take: Callable[[], Awaitable[None]],
    ) -> None:
        super().__init__(node)
        self._prepare = prepare
        self._take = take
        # The parent makes the services, and takes no group for them.
        for service in node.services:
            if service.srv_type in (SetParameters, SetParametersAtomically):
                service.callback_group = group
                group.add_entity(service)

    async def _set_parameters_callback(self, request: Any, response: Any) -> Any:
        result = await self._result_of_setting(request.parameters)
        response.results = [result] * len(request.parameters)
        return response

    async def _set_parameters_atomically_callback(self, request: Any, response: Any) -> Any:
        response.result = await self._result_of_setting(request.parameters)
        return response

    async def _result_of_setting(self, messages: Sequence[ParameterMessage]) -> Any:
        node = self._get_node()
        for message in messages:
            if not node.has_parameter(message.name):
                known = [declaration.name for declaration in PARAMETERS]
                return SetParametersResult(successful=False, reason=(
                    f'there is no parameter "{message.name}"'
                    f'{hint_from_names(message.name, known)}'))
        try:
            parameters = [_parameter_from_message(message) for message in messages]
            for each in parameters:
                wanted = _DEFAULT_TYPES.get(each.name, each.type_)
                if each.type_ not in (wanted, Parameter.Type.NOT_SET):
                    return SetParametersResult(
                        successful=False, reason=_sentence_on_type(each, wanted))
            # What "ros2 param dump" wrote has them too.
            parameters = [each for each in parameters if not _is_fixed_so(node, each)]
            await self._prepare(parameters)
            result = node.set_parameters_atomically(parameters)
        except (ValueError, TypeError) as error:  # a value of a type that does not exist
            return SetParametersResult(successful=False, reason=str(error))
        if result.successful:
            await self._take()
        return result


def _is_fixed_so(node: Node, given: Parameter) -> bool:
    is_fixed = node.describe_parameter(given.name).read_only
    return bool(is_fixed and node.get_parameter(given.name).value == given.value)


def _parameter_from_message(message: ParameterMessage) -> Parameter:
    parameter = Parameter.from_parameter_msg(message)
    # In [] there is nothing to tell what it is a list of, and the command line says: of booleans.
    is_list = parameter.type_ in _LIST_TYPES and _DEFAULT_TYPES.get(
        message.name) is Parameter.Type.STRING_ARRAY
    if is_list and not len(parameter.value):
        return Parameter(message.name, Parameter.Type.STRING_ARRAY, [])
    return parameter


def _declared(node: Node, declaration: _Declaration) -> object:
    name, default = declaration.name, declaration.default
    type_ = _TYPES[type(default)]
    # rclpy cannot tell the type of an empty list, and takes one from the command line for no value
    # at all. Such a parameter has to be set once more.
    value = node.declare_parameter(
        name, type_ if default == [] else default, _descriptor(declaration)).value
    if value is None:
        value = [] if type_ is Parameter.Type.STRING_ARRAY else default
        node.set_parameters([Parameter(name, type_, value)])
    return value


def _descriptor(declaration: _Declaration) -> ParameterDescriptor:
    is_number = isinstance(declaration.default, float)
    return ParameterDescriptor(
        type=_TYPES[type(declaration.default)].value,
        description=declaration.description,
        additional_constraints=declaration.constraint,
        floating_point_range=[_RATES] if is_number else [],
    )


def _sentence_on_override(node: Node, declaration: _Declaration) -> str:
    name = declaration.name
    given = node.declare_parameter(name, None, ParameterDescriptor(dynamic_typing=True))
    wanted = _TYPES[type(declaration.default)]
    sentence = _sentence_on_type(given, wanted)
    if wanted is Parameter.Type.STRING:
        sentence += f', so quote it twice: -p "{name}:=\'{_shown_value(given)}\'"'
    elif given.type_ is Parameter.Type.STRING and wanted is Parameter.Type.STRING_ARRAY:
        sentence += f': -p "{name}:=[\'{given.value}\']"'
    elif given.type_ is Parameter.Type.INTEGER and wanted is Parameter.Type.DOUBLE:
        sentence += f', such as: -p {name}:={given.value}.0'
    return sentence


def _sentence_on_type(given: Parameter, wanted: Parameter.Type) -> str:
    return (
        f'parameter {given.name} is {_shown_value(given)}, which is {_TYPE_WORDS[given.type_]}; '
        f'it must be {_TYPE_WORDS[wanted]}')


def _shown_value(given: Parameter) -> object:
    return list(given.value) if isinstance(given.value, array.array) else given.value
