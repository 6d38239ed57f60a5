# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The node's parameters: declared with a description and a constraint each, read as settings."""

from __future__ import annotations

import array
from typing import NamedTuple

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.exceptions import InvalidParameterTypeException
from rclpy.node import Node
from rclpy.parameter import Parameter

from sdf_pose_bridge.settings import Problem
from sdf_pose_bridge.settings import PUBLISHED_KINDS
from sdf_pose_bridge.settings import Settings
from sdf_pose_bridge.settings import settings_from_values
from sdf_pose_bridge.settings import SettingsError
from sdf_pose_bridge.tf_tree import DEFAULT_KINDS

Value = str | bool | list[str]


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
        'none if empty',
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
        'on_missing_include', 'error',
        'What to do about an include that cannot be found: "error" refuses the file, "skip" '
        'leaves the include out with a warning.',
        'one of error, skip',
    ),
)
"""All parameters, in the order in which they are explained to people."""

_TYPES = {
    str: Parameter.Type.STRING, bool: Parameter.Type.BOOL, list: Parameter.Type.STRING_ARRAY}
_TYPE_WORDS = {
    Parameter.Type.STRING: 'a string', Parameter.Type.BOOL: 'true or false',
    Parameter.Type.INTEGER: 'an integer', Parameter.Type.DOUBLE: 'a number',
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
            wrong_types[name] = Problem(name, _sentence_on_type(node, declaration))
            values[name] = declaration.default
    problems = list(wrong_types.values())
    try:
        settings = settings_from_values(values)
    except SettingsError as error:
        problems += [each for each in error.problems if each.parameter not in wrong_types]
    if problems:
        raise SettingsError(problems)
    return settings


def _declared(node: Node, declaration: _Declaration) -> object:
    name, default = declaration.name, declaration.default
    type_ = _TYPES[type(default)]
    # rclpy cannot tell the type of an empty list, and takes one from the command line for no value
    # at all. Such a parameter has to be set once more, so none is read-only from the beginning.
    value = node.declare_parameter(
        name, type_ if default == [] else default, _descriptor(declaration)).value
    if value is None:
        value = [] if type_ is Parameter.Type.STRING_ARRAY else default
        node.set_parameters([Parameter(name, type_, value)])
    node.set_descriptor(name, _descriptor(declaration, read_only=True))
    return value


def _descriptor(declaration: _Declaration, *, read_only: bool = False) -> ParameterDescriptor:
    return ParameterDescriptor(
        type=_TYPES[type(declaration.default)].value,
        description=declaration.description,
        additional_constraints=declaration.constraint,
        read_only=read_only,
    )


def _sentence_on_type(node: Node, declaration: _Declaration) -> str:
    name = declaration.name
    given = node.declare_parameter(name, None, ParameterDescriptor(dynamic_typing=True))
    value = list(given.value) if isinstance(given.value, array.array) else given.value
    wanted = _TYPES[type(declaration.default)]
    sentence = (
        f'parameter {name} is {value}, which is {_TYPE_WORDS[given.type_]}; '
        f'it must be {_TYPE_WORDS[wanted]}')
    if wanted is Parameter.Type.STRING:
        sentence += f', so quote it twice: -p "{name}:=\'{value}\'"'
    elif given.type_ is Parameter.Type.STRING and wanted is Parameter.Type.STRING_ARRAY:
        sentence += f': -p "{name}:=[\'{value}\']"'
    return sentence
