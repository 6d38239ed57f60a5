# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The types of parameters: which values mean the same, and messages about wrong types."""

from __future__ import annotations

import array

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node
from rclpy.parameter import Parameter

TYPES = {
    str: Parameter.Type.STRING, bool: Parameter.Type.BOOL, float: Parameter.Type.DOUBLE,
    list: Parameter.Type.STRING_ARRAY}
"""The types of parameters that are used, by the type of their values in Python."""

_NAMES = {
    Parameter.Type.STRING: 'a string', Parameter.Type.BOOL: 'true or false',
    Parameter.Type.INTEGER: 'an integer', Parameter.Type.DOUBLE: 'a number',
    Parameter.Type.STRING_ARRAY: 'a list of strings',
    Parameter.Type.BOOL_ARRAY: 'a list of booleans',
    Parameter.Type.INTEGER_ARRAY: 'a list of integers',
    Parameter.Type.DOUBLE_ARRAY: 'a list of numbers', Parameter.Type.BYTE_ARRAY: 'a list of bytes',
}


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


def parameter_of_any_type(node: Node, name: str) -> Parameter:
    """
    Return a parameter as it was given when the node was started.

    :param node: the node, which has not declared the parameter.
    """
    given = node.declare_parameter(name, None, ParameterDescriptor(dynamic_typing=True))
    node.undeclare_parameter(name)
    return given


def words_about_wrong_type(given: Parameter, wanted: Parameter.Type) -> str:
    """
    Explain that a value has the wrong type.

    :return: the words that follow "parameter <name>" in a sentence.
    """
    return (f'is {_shown_value(given)}, which is {_NAMES[given.type_]}; it must be '
            f'{_NAMES[wanted]}')


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


def _shown_value(given: Parameter) -> object:
    return list(given.value) if isinstance(given.value, array.array) else given.value
