# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Values given to a real node: wrong ones, right ones, and what people can read of them."""

from pathlib import Path
import shlex

import pytest
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import (
    DescribeParameters,
    GetParameters,
    GetParameterTypes,
    SetParameters,
    SetParametersAtomically,
)
from rclpy.parameter import Parameter

from sdf_pose_bridge.ros.parameters.declarations import DECLARATIONS, SettingsError
from sdf_pose_bridge.ros.parameters.given import (
    changed_settings,
    parameter_with_type,
    ParameterServices,
    settings_from_node,
    settings_from_values,
    warnings_about_unknown_parameters,
)
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.limits import MissingInclude
from sdf_pose_bridge.tf.anchors import AnchorModels
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.tree import TfOptions

TYPE = Parameter.Type


@pytest.fixture
def given(make_node):
    """Makes nodes with a file and other parameters; ``given(*words, **parameters)``."""
    def make(*words, **parameters):
        values = {'sdf_file': 'cell.sdf', **parameters}
        return make_node('bridge', *words, *(
            word for name, value in values.items() for word in ('-p', f'{name}:={value}')))
    return make


@pytest.fixture
def settings(given):
    return settings_from_node(given())


@pytest.mark.parametrize(('name', 'value', 'sentence'), [
    ('sdf_file', '5', 'is 5, which is an integer; it must be a string, so quote it twice: '),
    ('optical_frames', 'maybe', 'is maybe, which is a string; it must be true or false'),
    ('kinds', 'link,frame',
     ('is link,frame, which is a string; it must be a list of strings: '
      '-p \'kinds:=["link", "frame"]\'')),
    ('pose_topics', '[1, 2]', 'is [1, 2], which is a list of integers; it must be a list of '),
    ('publish_rate', 'fast', 'is fast, which is a string; it must be a number'),
    ('anchor_models', 'some,all', 'is "some,all"; it must be one of auto, all, static, none'),
])
def test_a_wrong_value_on_the_command_line_is_named_once(given, name, value, sentence):
    with pytest.raises(SettingsError) as refusal:
        settings_from_node(given(**{name: value}))
    (found,) = refusal.value.sentences
    assert found.startswith(f'parameter {name} {sentence}')


@pytest.mark.parametrize(('name', 'value', 'expected'), [
    ('frame_prefix', '5', '5'), ('pose_topics', '$(id)\';a,"b', ("$(id)';a", '"b'))])
def test_the_advised_argument_sets_the_value(given, name, value, expected):
    with pytest.raises(SettingsError) as refusal:
        settings_from_node(given(**{name: value}))
    words = shlex.split(refusal.value.sentences[0].rpartition(': ')[2])
    assert getattr(settings_from_node(given(*words)), name) == expected


def test_a_whole_number_is_a_number(given):
    node = given(publish_rate=10)
    assert settings_from_node(node).publish_rate == 10.0
    assert node.get_parameter('publish_rate').type_ is Parameter.Type.DOUBLE


def test_the_separator_of_sdf_can_be_kept_as_its_description_says(given):
    words = """-p "frame_separator:='::'\""""
    assert words in DECLARATIONS['frame_separator'].description
    settings = settings_from_node(given(*shlex.split(words)))
    assert settings.frame_separator == '::'


def test_unknown_parameters_are_named_with_the_nearest_one(given):
    node = given(frame_prefx='r1/', color=3, use_sim_time='true')
    sentences = [
        'there is no parameter "frame_prefx", so it has no effect; did you mean "frame_prefix"?',
        'there is no parameter "color", so it has no effect']
    assert warnings_about_unknown_parameters(node) == sentences
    settings_from_node(node)
    assert warnings_about_unknown_parameters(node) == sentences


def test_all_wrong_values_are_named(given):
    with pytest.raises(SettingsError) as refusal:
        settings_from_node(given(sdf_file="''", kinds='[rope]', frame_names='x', watch=1))
    assert [sentence.split()[1] for sentence in refusal.value.sentences] == [
        'sdf_file', 'frame_names', 'kinds', 'watch']


def test_without_a_file_the_advice_of_the_program_and_the_name_for_a_parameter_file_are_told(
        make_node):
    with pytest.raises(SettingsError, match=r'^advice; in .* name of this node, /bridge'):
        settings_from_node(make_node('bridge'), advice='advice')


def test_a_file_and_a_text_together_are_refused(settings):
    with pytest.raises(SettingsError, match='sdf_file and robot_description are both set'):
        changed_settings(settings, [Parameter('robot_description', value='<sdf/>')])
    both = [Parameter('robot_description', value='<sdf/>'), Parameter('sdf_file', value='')]
    changed = changed_settings(settings, both)
    assert changed.load_request.source == 'robot_description'
    assert changed.robot_description == '<sdf/>'


@pytest.mark.parametrize(('name', 'value', 'sentence'), [
    ('sdf_file', '', 'is not set'),
    ('root_frame', 5, 'is 5, which is an integer; it must be a string'),
    ('frame_names', 'Auto', 'is "Auto"; it must be one of auto, scoped, relative'),
    ('model_name', 'a::b', 'is "a::b"; it must be the name of one model, without "::"'),
    ('model_name', '/a', 'is "/a"; it must be the name of one model, without "::"'),
])
def test_a_wrong_new_value_is_named_with_its_rule(settings, name, value, sentence):
    with pytest.raises(SettingsError) as refusal:
        changed_settings(settings, [Parameter(name, value=value)])
    (found,) = refusal.value.sentences
    assert found.startswith(f'parameter {name} {sentence}')


def test_a_path_is_no_text():
    with pytest.raises(SettingsError, match=r'"a\.sdf", which is no text .* takes a path'):
        settings_from_values({'robot_description': 'a.sdf'})


def test_a_change_to_no_value_is_refused(settings):
    with pytest.raises(SettingsError, match='parameter root_frame cannot be without a value'):
        changed_settings(settings, [Parameter('root_frame', Parameter.Type.NOT_SET)])


def test_defaults(settings):
    assert settings.sdf_file == 'cell.sdf'
    assert settings.tf_options == TfOptions()
    assert settings.pose_topics == ('*',)
    assert settings.resource_paths == ()
    assert settings.on_missing_include is MissingInclude.ERROR
    assert (settings.publish_rate, settings.watch) == (0.0, True)


def test_an_empty_list_can_be_given(given):
    node = given(pose_topics=[])
    assert settings_from_node(node).pose_topics == ()
    parameter = node.get_parameter('pose_topics')
    assert (parameter.type_, parameter.value) == (Parameter.Type.STRING_ARRAY, [])


def test_new_values_are_converted_and_the_others_stay(given):
    before = settings_from_node(given(root_frame='map'))
    settings = changed_settings(before, [Parameter(name, value=value) for name, value in {
        'sdf_file': 'a.sdf', 'anchor_models': 'static', 'model': 'r::arm',
        'frame_names': 'scoped', 'frame_separator': '.', 'frame_prefix': 'left_',
        'kinds': ['joint', 'joint', 'light'], 'pose_topics': ['r/*', 'tool'],
        'optical_frames': False, 'resource_paths': ['/models', '', '/more'],
        'on_missing_include': 'skip', 'publish_rate': 2.5, 'watch': False, 'use_sim_time': True,
    }.items()])
    assert settings.sdf_file == 'a.sdf'
    assert settings.pose_topics == ('r/*', 'tool')
    assert settings.resource_paths == (Path('/models'), Path('/more'))
    assert settings.on_missing_include is MissingInclude.SKIP
    assert (settings.publish_rate, settings.watch) == (2.5, False)
    assert settings.tf_options == TfOptions(
        root_frame='map', anchor_models=AnchorModels.STATIC, model='r::arm',
        frame_names=FrameNames.SCOPED, frame_separator='.', frame_prefix='left_',
        kinds=frozenset({Kind.JOINT, Kind.LIGHT}), optical_frames=False)
    assert before.tf_options == TfOptions(root_frame='map')


@pytest.mark.parametrize(('name', 'value', 'needs_load'), [
    ('sdf_file', 'other.sdf', True), ('kinds', ['link'], True), ('resource_paths', ['/m'], True),
    ('root_frame', 'world', False), ('pose_topics', ['a'], False), ('publish_rate', 1.0, False),
    ('watch', False, False),
])
def test_the_file_is_read_again_where_that_changes_anything(settings, name, value, needs_load):
    changed = changed_settings(settings, [Parameter(name, value=value)])
    assert (changed.load_request != settings.load_request) is needs_load


@pytest.fixture
def descriptors(given):
    node = given()
    settings_from_node(node)
    return node.describe_parameters(list(DECLARATIONS))


def test_only_the_permission_to_write_files_cannot_be_changed(descriptors):
    assert [each.name for each in descriptors if each.read_only] == ['allow_set_pose']


def test_rates_have_a_range(descriptors):
    assert {
        (each.name, number.from_value, number.to_value)
        for each in descriptors for number in each.floating_point_range} == {
            ('publish_rate', 0.0, 100.0), ('publish_frequency', 0.0, 1000.0),
            ('simulator_rate', 0.0, 100.0)}


def test_every_parameter_explains_itself(descriptors):
    for each in descriptors:
        assert each.description.endswith('.')
        assert each.additional_constraints
        typical = DECLARATIONS[each.name].default
        if typical in ([], ()):
            typical = ['']
        assert Parameter.Type(each.type) is Parameter.Type.from_parameter_value(typical), each.name


# Types


@pytest.mark.parametrize(('type_', 'value', 'wanted'), [
    (TYPE.BOOL, True, TYPE.DOUBLE), (TYPE.STRING, '1', TYPE.DOUBLE),
    (TYPE.INTEGER_ARRAY, [1], TYPE.STRING_ARRAY), (TYPE.NOT_SET, None, TYPE.STRING_ARRAY),
])
def test_a_value_with_another_meaning_stays(type_, value, wanted):
    given = Parameter('p', type_, value)
    assert parameter_with_type(given, wanted) is given


@pytest.mark.parametrize(('type_', 'value', 'wanted', 'converted'), [
    (TYPE.INTEGER, 10, TYPE.DOUBLE, 10.0),
    (TYPE.INTEGER, -(2 ** 63), TYPE.DOUBLE, -2.0 ** 63),
    (TYPE.DOUBLE_ARRAY, [], TYPE.STRING_ARRAY, []),
])
def test_a_value_with_the_same_meaning_is_converted(type_, value, wanted, converted):
    found = parameter_with_type(Parameter('p', type_, value), wanted)
    assert (found.name, found.type_, found.value) == ('p', wanted, converted)
    assert type(found.value) is type(converted)


# Services

@pytest.fixture
def node(make_node):
    node = make_node('bridge')
    node.declare_parameter('a', 3.5)
    node.declare_parameter('b', ['x', 'y'])
    return node


def service_of(node, service_type):
    (service,) = (service for service in node.services if service.srv_type is service_type)
    return service


def test_a_call_that_sets_parameters_waits_for_the_start(node):
    async def set_parameters(parameters):
        return SetParametersResult(successful=True, reason=f'{parameters[0].name} is set')

    services = ParameterServices(node)
    service = service_of(node, SetParameters)
    assert service.callback_group is services.group
    call = service.callback(SetParameters.Request(parameters=[
        Parameter('a', TYPE.DOUBLE, 1.0).to_parameter_msg()]), SetParameters.Response())
    call.send(None)
    services.start(set_parameters)
    with pytest.raises(StopIteration) as end:
        call.send(None)
    assert [each.reason for each in end.value.value.results] == ['a is set']


def test_of_several_values_of_a_parameter_in_a_call_only_the_last_is_looked_at(node):
    taken = []

    async def set_parameters(parameters):
        taken.extend((each.name, each.value) for each in parameters)
        return SetParametersResult(successful=True)

    services = ParameterServices(node)
    services.start(set_parameters)
    call = service_of(node, SetParametersAtomically).callback(
        SetParametersAtomically.Request(parameters=[
            Parameter(name, value=value).to_parameter_msg()
            for name, value in [('a', 1.0), ('b', ['z']), *[('a', 2.0)] * 900, ('a', 4.0)]]),
        SetParametersAtomically.Response())
    with pytest.raises(StopIteration):
        call.send(None)
    assert taken == [('a', 4.0), ('b', ['z'])]


@pytest.mark.parametrize(('service_type', 'field'), [
    (DescribeParameters, 'descriptors'), (GetParameters, 'values'), (GetParameterTypes, 'types')])
@pytest.mark.parametrize(('names', 'count'), [(['a', 'b'], 2), (['a'], 1), (['a', 'a'], 0)])
def test_a_name_that_is_repeated_gets_nothing(node, service_type, field, names, count):
    ParameterServices(node)
    response = service_of(node, service_type).callback(
        service_type.Request(names=names), service_type.Response())
    assert len(getattr(response, field)) == count


# Quality of service

@pytest.mark.parametrize(('policy', 'value', 'rule'), [
    ('reliability', 'sometimes', 'one of system_default, reliable, best_effort'),
    ('durability', 3, 'one of system_default, transient_local, volatile'),
    ('history', 'all', 'one of system_default, keep_last, keep_all'),
    ('depth', 'many', 'an integer from 0 to 2147483647'),
    ('depth', -1, 'an integer from 0 to 2147483647'),
    ('depth', 2**31, 'an integer from 0 to 2147483647'),
])
def test_a_value_that_no_policy_has_ends_the_start(given, policy, value, rule):
    with pytest.raises(SettingsError, match=f'.{policy} is {value}; it must be {rule}'):
        settings_from_node(given(**{f'qos_overrides./tf.publisher.{policy}': value}))


@pytest.mark.parametrize(('name', 'possible'), [
    ('/joint_states.subscription.history', 'subscription.reliability, subscription.durability'),
    ('/r1/tf.publisher.durability',
     'publisher.history, publisher.depth, publisher.reliability'),
    ('/parameter_events.publisher.depth', 'nothing'),
])
def test_an_override_without_effect_is_told(given, name, possible):
    name = f'qos_overrides.{name}'
    (warning,) = warnings_about_unknown_parameters(given(**{name: 1}))
    assert warning.startswith(f'parameter {name} has no effect here; of /')
    assert warning.endswith(f', one can override {possible}')


def test_a_description_from_a_topic_is_told_to_have_no_effect(given):
    (warning,) = warnings_about_unknown_parameters(
        given(description_from_topic='true'), ['use_tf_static'])
    assert warning == ('parameter description_from_topic has no effect here; set '
                       'robot_description to the text, or sdf_file to a file')


@pytest.mark.parametrize('name', [
    '/joint_states.subscription.reliability', '/tf_static.publisher.depth',
    '/scan.subscription.depth', '/tf', 'x'])
def test_other_overrides_are_not_told(given, name):
    assert warnings_about_unknown_parameters(given(**{f'qos_overrides.{name}': 1})) == []
