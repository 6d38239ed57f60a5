# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Values of another type than their parameter has."""

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from rclpy.parameter import Parameter

from sdf_pose_bridge.ros.parameter_types import hint_about_command_line
from sdf_pose_bridge.ros.parameter_types import parameter_with_type
from sdf_pose_bridge.ros.parameter_types import words_about_wrong_type

TYPE = Parameter.Type


@pytest.mark.parametrize(('type_', 'value', 'wanted'), [
    (TYPE.BOOL, True, TYPE.DOUBLE), (TYPE.STRING, '1', TYPE.DOUBLE),
    (TYPE.DOUBLE, 1.0, TYPE.STRING), (TYPE.INTEGER, 1, TYPE.BOOL),
    (TYPE.INTEGER_ARRAY, [1], TYPE.STRING_ARRAY), (TYPE.NOT_SET, None, TYPE.STRING_ARRAY),
])
def test_a_value_with_another_meaning_stays(type_, value, wanted):
    given = Parameter('p', type_, value)
    assert parameter_with_type(given, wanted) is given


@pytest.mark.parametrize(('type_', 'value', 'wanted', 'converted'), [
    (TYPE.INTEGER, 10, TYPE.DOUBLE, 10.0),
    (TYPE.INTEGER, -(2 ** 63), TYPE.DOUBLE, -2.0 ** 63),
    (TYPE.BYTE_ARRAY, [], TYPE.STRING_ARRAY, []),
    (TYPE.DOUBLE_ARRAY, [], TYPE.STRING_ARRAY, []),
])
def test_a_value_with_the_same_meaning_is_converted(type_, value, wanted, converted):
    found = parameter_with_type(Parameter('p', type_, value), wanted)
    assert (found.name, found.type_, found.value) == ('p', wanted, converted)
    assert type(found.value) is type(converted)


def test_a_wrong_type_is_explained():
    given = Parameter('p', TYPE.INTEGER, 5)
    assert words_about_wrong_type(given, TYPE.STRING) == (
        'is 5, which is an integer; it must be a string')
    assert hint_about_command_line(given, TYPE.STRING) == ''', so quote it twice: -p "p:='5'"'''
    assert hint_about_command_line(given, TYPE.BOOL) == ''
