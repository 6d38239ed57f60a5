# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A bridge that reads a file which takes long."""

from changes import (
    asked_to_reload,
    asked_to_set,
    call,
    last_x,
    Monitor,
    parameter_value,
    set_parameters,
    wait_for_x,
    world,
)
from diagnostic_msgs.msg import DiagnosticStatus
import pytest
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from slow_file import SlowFile

from sdf_pose_bridge_interfaces.srv import ConvertRotation, LookupPose


@pytest.fixture
def slow(tmp_path):
    return SlowFile(tmp_path / 'slow.sdf')


def assert_services_answer(listener):
    answer = call(listener, ConvertRotation)
    assert answer.success, answer.message
    assert call(listener, LookupPose, frame='crate::body').pose.pose.position.x == 1.0
    assert parameter_value(listener, 'root_frame').string_value == 'world'


def test_services_answer_and_diagnostics_go_on_while_a_parameter_has_a_file_read(slow, listener):
    monitor = Monitor(listener)
    setting = asked_to_set(listener, sdf_file=str(slow.path))
    with slow.opened():
        assert_services_answer(listener)
        assert monitor.wait_for_more().level == DiagnosticStatus.OK
        assert not setting.done()
        assert last_x(listener) == 1.0
        slow.write(world(2))
    (result,) = listener.response(setting).results
    assert result.successful, result.reason
    wait_for_x(listener, 2.0)


def test_services_answer_while_a_changed_file_is_read(file, slow, listener):
    slow.path.replace(file)
    with slow.opened():
        assert_services_answer(listener)
        slow.write(world(2))
    wait_for_x(listener, 2.0)


def test_what_is_asked_for_during_a_reload_comes_after_it(file, listener, tmp_path):
    other = tmp_path / 'other.sdf'
    other.write_text(world(5))
    set_parameters(listener, watch=False)
    slow = SlowFile(file, world(1))
    slow.hold()
    reloading = asked_to_reload(listener)
    with slow.opened():
        setting = asked_to_set(listener, sdf_file=str(other))
        assert_services_answer(listener)
        assert not setting.done()
        slow.write(world(2))
    assert listener.response(reloading).success
    assert listener.response(setting).results[0].successful
    wait_for_x(listener, 5.0)
    places = [each.transforms[-1].transform.translation.x for each in listener.tf_messages]
    assert sorted(places) == places
    assert 2.0 in {
        each.transform.translation.x for message in listener.tf_messages
        for each in message.transforms}


def test_an_empty_list_of_another_type_is_taken_for_a_list_of_strings(listener):
    set_parameters(listener, resource_paths=['x'])
    parameter = ParameterMessage(name='resource_paths', value=ParameterValue(
        type=ParameterType.PARAMETER_BYTE_ARRAY))
    (result,) = call(listener, SetParameters, parameters=[parameter]).results
    assert result.successful, result.reason
    assert parameter_value(listener, 'resource_paths') == ParameterValue(
        type=ParameterType.PARAMETER_STRING_ARRAY)
