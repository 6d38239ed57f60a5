# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters on a real node: what is given wrong, what is given, and what people can read."""

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from rclpy.parameter import Parameter

from sdf_pose_bridge.ros.parameters import changed_settings
from sdf_pose_bridge.ros.parameters import PARAMETERS
from sdf_pose_bridge.ros.parameters import settings_from_node
from sdf_pose_bridge.ros.settings import SettingsError
from sdf_pose_bridge.tf.tree import TfOptions

FILE = ('-p', 'sdf_file:=cell.sdf')


@pytest.mark.parametrize(('name', 'value', 'sentence'), [
    ('sdf_file', '5', 'is 5, which is an integer; it must be a string, so quote it twice: '),
    ('model', 'true', 'is True, which is true or false; it must be a string, so quote it twice'),
    ('optical_frames', 'maybe', 'is maybe, which is a string; it must be true or false'),
    ('kinds', 'link', 'is link, which is a string; it must be a list of strings: -p "kinds:=['),
    ('pose_topics', '[1, 2]', 'is [1, 2], which is a list of integers; it must be a list of '),
    ('resource_paths', '[0.5]', 'is [0.5], which is a list of numbers; it must be a list of '),
    ('anchor_models', 'some', 'is "some"; it must be one of all, static, none'),
    ('kinds', '[]', 'is []; it must be at least one of'),
])
def test_a_wrong_value_is_named_once_with_its_rule(make_node, name, value, sentence):
    node = make_node('bridge', '-p', 'sdf_file:=cell.sdf', '-p', f'{name}:={value}')
    with pytest.raises(SettingsError) as refusal:
        settings_from_node(node)
    (problem,) = refusal.value.problems
    assert problem.sentence.startswith(f'parameter {name} {sentence}')


def test_without_a_file_the_sentence_says_how_to_name_one(make_node):
    with pytest.raises(SettingsError, match=r'-p sdf_file:=cell\.sdf'):
        settings_from_node(make_node('bridge'))


def test_defaults(make_node):
    settings = settings_from_node(make_node('bridge', *FILE))
    assert settings.sdf_file == 'cell.sdf'
    assert settings.tf_options == TfOptions()
    assert settings.pose_topics == ('*',)
    assert settings.resource_paths == ()


def test_an_empty_list_can_be_given(make_node):
    node = make_node('bridge', *FILE, '-p', 'pose_topics:=[]')
    assert settings_from_node(node).pose_topics == ()
    parameter = node.get_parameter('pose_topics')
    assert (parameter.type_, parameter.value) == (Parameter.Type.STRING_ARRAY, [])


def test_values_come_from_the_command_line(make_node):
    settings = settings_from_node(make_node(
        'bridge', *FILE, '-p', 'pose_topics:=[robot/*]', '-p', 'optical_frames:=false',
        '-p', 'root_frame:=map'))
    assert settings.pose_topics == ('robot/*',)
    assert settings.tf_options == TfOptions(root_frame='map', optical_frames=False)


def test_every_parameter_explains_itself(make_node):
    node = make_node('bridge', *FILE)
    settings_from_node(node)
    for declaration in PARAMETERS:
        descriptor = node.describe_parameter(declaration.name)
        assert descriptor.description.endswith('.')
        assert descriptor.additional_constraints
        typical = [''] if declaration.default == [] else declaration.default
        assert Parameter.Type(descriptor.type) is Parameter.Type.from_parameter_value(typical)


def test_a_rate_out_of_range_is_refused(make_node):
    node = make_node('bridge', *FILE, '-p', 'publish_rate:=500.0')
    with pytest.raises(SettingsError, match=r'parameter publish_rate must be 0\.0 for never'):
        settings_from_node(node)


def test_a_whole_number_for_a_rate_says_how_to_write_it(make_node):
    node = make_node('bridge', *FILE, '-p', 'publish_rate:=5')
    with pytest.raises(SettingsError, match=r'-p publish_rate:=5\.0'):
        settings_from_node(node)


def test_a_change_is_judged_together_with_what_stays(make_node):
    node = make_node('bridge', *FILE, '-p', 'root_frame:=map')
    settings_from_node(node)
    settings = changed_settings(node, [Parameter('frame_prefix', value='a/')])
    assert settings.tf_options == TfOptions(root_frame='map', frame_prefix='a/')


def test_a_change_to_no_value_is_refused(make_node):
    node = make_node('bridge', *FILE)
    settings_from_node(node)
    with pytest.raises(SettingsError, match='parameter root_frame cannot be without a value'):
        changed_settings(node, [Parameter('root_frame', Parameter.Type.NOT_SET)])
