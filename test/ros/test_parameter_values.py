# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The values of parameters: those of another type, and the rules of single parameters.

Rules refuse a value with the words that a sentence ends with, or make the setting of it.
"""

import math
from pathlib import Path

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from rclpy.parameter import Parameter

from sdf_pose_bridge.ros import parameter_values as rules
from sdf_pose_bridge.ros.parameter_values import hint_about_command_line
from sdf_pose_bridge.ros.parameter_values import parameter_with_type
from sdf_pose_bridge.ros.parameter_values import words_about_wrong_type
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.tree import AnchorModels

TYPE = Parameter.Type


@pytest.mark.parametrize(('rule', 'value', 'words'), [
    (rules.root_frame_setting, '', 'is ""; it must be a frame id'),
    (rules.root_frame_setting, '/map', 'is "/map"; it must be without a leading slash'),
    (rules.root_frame_setting, 'ma\np', 'it must be without control characters'),
    (rules.prefix_setting, '/r1', 'is "/r1"; it must be without a leading slash'),
    (rules.prefix_setting, 'r\x001', 'it must be without control characters'),
    (rules.separator_setting, '', 'is ""; it must be at least one character'),
    (rules.separator_setting, '\t', 'it must be without control characters'),
    (rules.root_frame_setting, 'x' * 256, 'has a value of 256 characters; it must have at'),
    (rules.prefix_setting, 'x' * 256, 'has a value of 256 characters; it must have at most 255'),
    (rules.separator_setting, '_' * 9, 'has a value of 9 characters; it must have at most 8'),
    (rules.rate_setting, 0.0009, 'is 0.0009; it must be 0.0 for never, or from 0.001 to 100.0'),
    (rules.rate_setting, 100.1, 'is 100.1; it must be 0.0 for never'),
    (rules.rate_setting, -1.0, 'is -1.0; it must be 0.0 for never'),
    (rules.rate_setting, math.nan, 'is nan; it must be 0.0 for never'),
    (rules.choice_setting(AnchorModels), 'ALL', 'is "ALL"; it must be one of '),
    (rules.kinds_setting, [], 'is []; it must be at least one of model, '),
    (rules.kinds_setting, ['link', 'links'], 'is "links"; it must be made of model, '),
    (rules.kinds_setting, ['world'], 'is "world"; it must be made of model, '),
    (rules.patterns_setting, ['a'] * 1001, 'has 1001 patterns; it must have at most 1000'),
    (rules.path_setting, 'x' * 4097, 'has a value of 4097 characters; it must have at'),
    (rules.patterns_setting, ['*', 'x' * 256], 'has a value of 256 characters; it must have at'),
    (rules.directories_setting, ['a'] * 1001, 'has 1001 directories; it must have at most 1000'),
    (rules.directories_setting, ['x' * 4097], 'has a value of 4097 characters; it must have at'),
])
def test_refused(rule, value, words):
    with pytest.raises(ValueError, match=r'it must|is not set') as refusal:
        rule(value)
    assert words in str(refusal.value)
    assert str(refusal.value).isprintable()


@pytest.mark.parametrize(('rule', 'value', 'setting'), [
    (rules.root_frame_setting, 'map', 'map'),
    (rules.prefix_setting, '', ''),
    (rules.prefix_setting, 'r1/', 'r1/'),
    (rules.prefix_setting, 'x' * 255, 'x' * 255),
    (rules.separator_setting, '::', '::'),
    (rules.rate_setting, 0.0, 0.0),
    (rules.rate_setting, 0.001, 0.001),
    (rules.rate_setting, 100.0, 100.0),
    (rules.choice_setting(AnchorModels), 'static', AnchorModels.STATIC),
    (rules.kinds_setting, ['link', 'light', 'link'], frozenset({Kind.LINK, Kind.LIGHT})),
    (rules.patterns_setting, ['*'] * 1000, ('*',) * 1000),
    (rules.patterns_setting, [], ()),
    (rules.directories_setting, ['', 'models', ''], (Path('models'),)),
])
def test_taken(rule, value, setting):
    assert rule(value) == setting


def test_directories_may_begin_with_that_of_the_user(monkeypatch):
    monkeypatch.setenv('HOME', '/home/me')
    assert rules.directories_setting(['~/models']) == (Path('/home/me/models'),)


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
