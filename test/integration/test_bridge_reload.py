# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What a running bridge notices, what it replaces, and what it keeps when something is wrong."""

import signal

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from bridge_process import STARTED
from changes import (
    BRIDGE,
    last_x,
    listen_to_tf,
    Monitor,
    reload,
    replace,
    set_parameters,
    wait_for_x,
    world,
)
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped, TransformStamped
from listener import latched
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from slow_file import SlowFile

INCLUDING = """<sdf version="1.10"><world name="w">
  <include><uri>model://box</uri></include>
</world></sdf>"""


def box(x, name='box'):
    return (f'<sdf version="1.10"><model name="{name}">'
            f'<link name="l"><pose>{x} 0 0 0 0 0</pose></link></model></sdf>')


def config(file):
    return f'<model><name>box</name><sdf version="1.10">{file}</sdf></model>'


@pytest.fixture(name='start')
def start_with_file(start_bridge, tmp_path):
    """Starts a bridge; ``start(path, *parameters)``."""
    def start(path, *parameters):
        arguments = [word for parameter in parameters for word in ('-p', parameter)]
        return start_bridge(
            '--ros-args', '-p', f'sdf_file:={path}', '-p', f'resource_paths:=[{tmp_path}]',
            *arguments).wait_until_started()
    return start


@pytest.fixture(name='bridge')
def bridge_on_file(start, file):
    return start(file)


@pytest.fixture(name='listener')
def listener_to_tf(bridge, start_listener):
    listener = start_listener()
    listen_to_tf(listener)
    wait_for_x(listener, 1.0)
    return listener


@pytest.fixture
def models(tmp_path):
    """A world that includes a model directory."""
    (tmp_path / 'box').mkdir()
    (tmp_path / 'box/model.config').write_text(config('a.sdf'), encoding='utf-8')
    (tmp_path / 'box/a.sdf').write_text(box(1), encoding='utf-8')
    (tmp_path / 'w.sdf').write_text(INCLUDING, encoding='utf-8')
    return tmp_path


def listen_to_transforms(listener, quality):
    """Keep the x of each transform that arrives one by one."""
    found = []
    listener.node.create_subscription(
        TransformStamped, f'{BRIDGE}/transforms',
        lambda message: found.append((message.child_frame_id, message.transform.translation.x)),
        quality)
    return found


def error_lines(bridge):
    return [line for line in bridge.lines if line.startswith('[ERROR]')]


# What was published is really replaced


@pytest.mark.parametrize('quality', [latched(10), 10], ids=['latched', 'volatile'])
def test_a_moved_frame_is_moved_on_every_topic(bridge, file, listener, quality):
    transforms = listen_to_transforms(listener, quality)
    places = []
    listener.node.create_subscription(
        PoseStamped, f'{BRIDGE}/poses/crate/body',
        lambda message: places.append(message.pose.position.x), quality)
    listener.wait(
        lambda: listener.node.count_publishers(f'{BRIDGE}/transforms')
        and listener.node.count_publishers(f'{BRIDGE}/poses/crate/body'), lambda: 'publishers')
    if quality == 10:
        # A volatile listener gets nothing until the publisher has discovered it.
        set_parameters(listener, publish_rate=100.0)
        listener.wait(lambda: transforms and places, lambda: 'what is published again')
        set_parameters(listener, publish_rate=0.0)
    replace(file, world(2))
    wait_for_x(listener, 2.0)
    listener.wait(lambda: ('crate/body', 2.0) in transforms, lambda: transforms)
    listener.wait(lambda: places[-1:] == [2.0], lambda: places)


@pytest.mark.parametrize(('new', 'expected'), [
    (world(2, 'box'), {('box/body', 2.0), ('box', 0.0)}),
    (world(2, extra='<frame name="f"/>'), {('crate/body', 2.0), ('crate', 0.0), ('f', 0.0)}),
    ('<sdf version="1.10"><world name="w"><frame name="f"/></world></sdf>', {('f', 0.0)}),
    ('<sdf version="1.10"><world name="w"/></sdf>', set()),
], ids=['as many', 'more', 'fewer', 'none'])
def test_a_late_listener_gets_nothing_of_what_was_before(
        bridge, file, listener, start_listener, new, expected):
    replace(file, new)
    bridge.wait_for_line(STARTED, 2)
    late = start_listener()
    transforms = listen_to_transforms(late, latched(100))
    listen_to_tf(late)
    late.wait(lambda: late.tf_messages and expected <= set(transforms), lambda: transforms)
    set_parameters(late, watch=True)  # by the answer, whatever came with the rest is here
    assert sorted(transforms) == sorted(expected)
    assert {each.child_frame_id for each in late.tf_messages[0].transforms} == {
        frame for frame, _ in expected}


def test_topics_of_frames_come_and_go_with_them_and_with_the_patterns(bridge, file, listener):
    def topics():
        prefix = f'{BRIDGE}/poses/'
        names = [name for name, _ in listener.node.get_topic_names_and_types()]
        return {name[len(prefix):] for name in names if name.startswith(prefix)}

    def wait_for_topics(*expected):
        listener.wait(lambda: topics() == set(expected), topics)

    wait_for_topics('crate', 'crate/body')
    replace(file, world(1, 'box'))
    wait_for_topics('box', 'box/body')
    set_parameters(listener, pose_topics=['*/body'])
    wait_for_topics('box/body')
    set_parameters(listener, pose_topics=['box::*', 'box'])
    wait_for_topics('box')
    bridge.wait_for_line('no ~/poses/... topics for "box::*" in pose_topics')
    set_parameters(listener, pose_topics=['*'])
    wait_for_topics('box', 'box/body')


def test_a_frame_that_loses_its_transform_alone_is_named(bridge, listener):
    set_parameters(listener, anchor_models='none')
    line = bridge.wait_for_line('1 frame without a parent now')
    assert line.endswith('restarted: "crate/body"')
    assert not any('no longer published' in each for each in bridge.lines)


# What is noticed


def test_a_half_written_file_that_is_finished_later_is_taken(file, listener):
    monitor = Monitor(listener)
    text = world(8)
    with file.open('w', encoding='utf-8') as half:
        half.write(text[:40])
        half.flush()
        monitor.wait_for(DiagnosticStatus.ERROR)
        half.write(text[40:])
    wait_for_x(listener, 8.0)
    monitor.wait_for(DiagnosticStatus.OK)


def test_a_link_that_is_led_elsewhere_is_noticed(start, start_listener, file, tmp_path):
    link, other = tmp_path / 'link.sdf', tmp_path / 'other.sdf'
    other.write_text(world(9), encoding='utf-8')
    link.symlink_to(file)
    start(link)
    listener = start_listener()
    listen_to_tf(listener)
    wait_for_x(listener, 1.0)
    new = tmp_path / 'new'
    new.symlink_to(other)
    new.replace(link)
    wait_for_x(listener, 9.0)


@pytest.mark.parametrize(('address', 'frame'), [('w.sdf', 'box/l'), ('box', 'l')])
def test_a_manifest_that_names_another_file_is_noticed(
        start, start_listener, models, address, frame):
    start(models / address, 'anchor_models:=all')
    listener = start_listener()
    listen_to_tf(listener)
    wait_for_x(listener, 1.0, frame)
    (models / 'box/b.sdf').write_text(box(2), encoding='utf-8')
    replace(models / 'box/model.config', config('b.sdf'))
    wait_for_x(listener, 2.0, frame)


def test_the_repair_of_a_file_that_is_newly_included_is_noticed(bridge, file, models, listener):
    (models / 'box/a.sdf').write_text('<sdf', encoding='utf-8')
    replace(file, INCLUDING)
    bridge.wait_for_line('box/a.sdf:1: FILE_READ')
    replace(models / 'box/a.sdf', box(3))
    wait_for_x(listener, 3.0, 'box/l')


def test_a_missing_include_that_appears_is_noticed(bridge, file, listener, tmp_path):
    replace(file, INCLUDING)
    bridge.wait_for_line('URI_LOOKUP')
    (tmp_path / 'new').mkdir()
    (tmp_path / 'new/model.config').write_text(config('a.sdf'), encoding='utf-8')
    (tmp_path / 'new/a.sdf').write_text(box(4), encoding='utf-8')
    (tmp_path / 'new').rename(tmp_path / 'box')
    wait_for_x(listener, 4.0, 'box/l')


def test_simulated_time_that_stands_still_keeps_no_change_from_being_noticed(
        start, file, start_listener):
    start(file, 'use_sim_time:=true')
    listener = start_listener()
    listen_to_tf(listener)
    wait_for_x(listener, 1.0)
    replace(file, world(2))
    wait_for_x(listener, 2.0)
    Monitor(listener).wait_for(DiagnosticStatus.OK)


def test_what_changed_while_nobody_watched_is_read_when_watching_begins(
        start, file, start_listener):
    start(file, 'watch:=false')
    listener = start_listener()
    listen_to_tf(listener)
    wait_for_x(listener, 1.0)
    replace(file, world(2))
    assert set_parameters(listener, watch=True)[0].successful
    wait_for_x(listener, 2.0)


# What is kept when something is wrong


def test_a_failure_is_reported_until_a_load_succeeds(bridge, file, listener):
    monitor = Monitor(listener)
    monitor.wait_for(DiagnosticStatus.OK)
    replace(file, 'not XML')
    monitor.wait_for(DiagnosticStatus.ERROR)
    assert set_parameters(listener, publish_rate=1.0, pose_topics=[''])[0].successful
    assert monitor.wait_for_more().level == DiagnosticStatus.ERROR
    assert not reload(listener).success
    assert not reload(listener).success
    assert len(error_lines(bridge)) == 2, 'the announcement and one error'
    assert last_x(listener) == 1.0
    replace(file, world(2))
    assert reload(listener).success
    monitor.wait_for(DiagnosticStatus.OK)
    replace(file, 'not XML')
    bridge.wait_for_line('the frames published before stay', 2)


def test_one_call_that_sets_the_file_and_more_reads_it_once(file, listener):
    set_parameters(listener, sdf_file=str(file), frame_prefix='a/', publish_rate=0.0, watch=True)
    replace(file, world(2))
    wait_for_x(listener, 2.0, 'a/crate/body')
    assert len(listener.tf_messages) == 3


def test_parameters_that_change_nothing_publish_nothing(file, listener):
    set_parameters(listener, root_frame='world', publish_rate=0.0, watch=True, pose_topics=['*'])
    replace(file, world(2))
    wait_for_x(listener, 2.0)
    assert len(listener.tf_messages) == 2


REFUSED = [
    ({'publish_rate': float('nan')}, 'is nan; it must be 0.0 for never, or from 0.001 to 100.0'),
    ({'publish_rate': 101}, 'is 101.0; it must be 0.0 for never, or from 0.001 to 100.0'),
    ({'publish_rate': 100.5}, 'is 100.5; it must be 0.0 for never, or from 0.001 to 100.0'),
    ({'publish_rate': 1e-12}, 'is 1e-12; it must be 0.0 for never, or from 0.001 to 100.0'),
    ({'kinds': [True]}, 'is [True], which is a list of booleans; it must be a list of strings'),
    ({'sdf_file': ''}, 'parameter sdf_file is not set'),
    ({'sdf_file': '/'}, '/: FILE_READ: the directory has no model.config'),
    ({'sdf_file': 'not_there.sdf'}, '/not_there.sdf: FILE_READ: the file cannot be read'),
    ({'sdf_file': 'model://not_there'}, 'is found neither in resource_paths nor'),
    ({'sdf_file': 'a\0b'}, 'FILE_READ'),
    ({'model': 'crat'}, 'there is no model "crat" to publish; did you mean "crate"?'),
    ({'frame_prefix': 'a', 'kinds': ['linc']}, 'parameter kinds is "linc"'),
    ({'frame_prefix': 'a', 'frame_name': 'b'},
     'there is no parameter "frame_name"; did you mean "frame_names"?'),
    ({'x' * 1000: 'a'}, f'there is no parameter "{"x" * 38}...{"x" * 38}"'),
]


def test_what_cannot_be_taken_is_answered_and_changes_nothing(bridge, listener):
    for values, reason in REFUSED:
        results = set_parameters(listener, **values)
        assert len(results) == len(values)
        assert not [result for result in results if result.successful], values
        assert all(reason in result.reason for result in results), results
    monitor = Monitor(listener)
    monitor.wait_for(DiagnosticStatus.OK)
    assert len(listener.tf_messages) == 1
    assert not error_lines(bridge)


def test_more_parameters_than_a_call_can_set_are_refused(listener):
    parameter = Parameter(
        name='watch', value=ParameterValue(type=ParameterType.PARAMETER_BOOL, bool_value=False))
    answer = listener.call(
        SetParameters, f'{BRIDGE}/set_parameters',
        SetParameters.Request(parameters=[parameter] * 1001))
    assert len(answer.results) == 1001
    assert answer.results[0].reason == (
        'a call can set at most 1000 parameters, and this one has 1001')


@pytest.mark.parametrize('service', [SetParameters, SetParametersAtomically])
def test_a_value_that_is_none_is_answered_and_the_node_lives_on(listener, service):
    name = {SetParameters: 'set_parameters', SetParametersAtomically: 'set_parameters_atomically'}
    for type_ in (ParameterType.PARAMETER_NOT_SET, 200):
        parameter = Parameter(name='root_frame', value=ParameterValue(type=type_))
        answer = listener.call(
            service, f'{BRIDGE}/{name[service]}', service.Request(parameters=[parameter]))
        result = answer.result if hasattr(answer, 'result') else answer.results[0]
        assert not result.successful
        assert result.reason
    assert reload(listener).success


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_it_well_while_it_reads_another_file(bridge, listener, tmp_path, number):
    slow = SlowFile(tmp_path / 'slow.sdf')
    request = SetParameters.Request(parameters=[Parameter(
        name='sdf_file', value=ParameterValue(
            type=ParameterType.PARAMETER_STRING, string_value=str(slow.path)))])
    client = listener.node.create_client(SetParameters, f'{BRIDGE}/set_parameters')
    listener.wait(client.service_is_ready, lambda: 'the service')
    client.call_async(request)
    with slow.opened():
        bridge.send(number)
        assert bridge.wait_for_end() == 0, '\n'.join(bridge.lines)
    assert not [line for line in bridge.lines if 'Traceback' in line or 'rror' in line]
