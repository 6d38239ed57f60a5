# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What diagnostics say of a state: its level, its sentence and its values."""

import re

from diagnostic_msgs.msg import DiagnosticStatus
from folders import ROOT
import pytest
from rclpy.qos import DurabilityPolicy

from sdf_pose_bridge.export.published_scene import LoadRequest
from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.ros.parameters.given import settings_from_node
from sdf_pose_bridge.ros.publishing.diagnostics import Diagnostics, status_from_scene
from sdf_pose_bridge.ros.publishing.state_report import StateReport

NOTHING_MISSING = StateReport()
LOADED_AT_NS = 1767323045_678900000
GOOD = '<sdf version="1.10"><model name="m"><link name="l"/></model></sdf>'
LIGHT = '<light name="i" type="point"><pose relative_to="x"/></light>'


@pytest.fixture
def status_of(make_node, tmp_path):
    def status(text, *failure, states=NOTHING_MISSING):
        path = tmp_path / 'cell.sdf'
        path.write_text(text)
        node = make_node('bridge', '-p', f'sdf_file:={path}', '-p', 'root_frame:=map')
        loaded = loaded_scene_from_request(settings_from_node(node).load_request)
        return status_from_scene(
            loaded._replace(read_since_ns=LOADED_AT_NS, seconds=12.3456), failure, states,
            'left/bridge')
    return status


def values_of(status):
    return {value.key: value.value for value in status.values}


def with_lights(count):
    lights = ''.join(LIGHT.replace('"i"', f'"i{number}"') for number in range(count))
    return GOOD.replace('<link name="l"/>', f'<link name="l">{lights}</link>')


def test_a_good_load_is_ok(status_of):
    status = status_of(GOOD)
    assert status.level == DiagnosticStatus.OK
    assert (status.name, status.message) == ('left/bridge: file', 'serving cell.sdf')


@pytest.mark.parametrize(('count', 'words'), [(1, '1 warning'), (2, '2 warnings')])
def test_warnings_of_what_is_served_are_counted(status_of, count, words):
    status = status_of(with_lights(count))
    assert status.level == DiagnosticStatus.WARN
    assert status.message == f'serving cell.sdf with {words}'
    assert 'relative_to="x" names no frame' in values_of(status)['first warning']


def test_joints_that_nobody_reports_are_a_warning(status_of):
    status = status_of(GOOD, states=StateReport(['arm/elbow', 'arm/wrist']))
    assert status.level == DiagnosticStatus.WARN
    assert status.message.startswith(
        'no message has named 2 joints yet, for example "arm/elbow";')
    values = values_of(status)
    assert values['joints not reported'] == '2'
    assert values['first joint not reported'] == 'arm/elbow'


def test_messages_with_old_stamps_are_a_warning(status_of):
    status = status_of(with_lights(1), states=StateReport(['j'], problems=['from /a', 'from /b']))
    assert (status.level, status.message) == (DiagnosticStatus.WARN, 'from /a; from /b')
    assert values_of(status)['problems of topics'] == '2'


def test_a_failed_load_is_an_error_whatever_is_served(status_of):
    status = status_of(with_lights(1), 'cell.sdf:3: first', 'cell.sdf:4: second',
                       states=StateReport(failures=['internal error']))
    assert status.level == DiagnosticStatus.ERROR
    assert status.message == (
        'the last load failed, the scene before it is published: cell.sdf:3: first')


def test_the_page_about_the_topic_lists_the_values(status_of):
    page = (ROOT / 'docs/ros_interface.md').read_text()
    (row,) = (line for line in page.splitlines() if line.startswith('| `/diagnostics` |'))
    assert re.findall('`([^`]+)`', row)[1:] == [value.key for value in status_of(GOOD).values]


def test_the_values_describe_what_is_served_and_what_is_wrong(status_of, tmp_path):
    status = status_of(GOOD, 'first', 'second')
    values = values_of(status)
    assert values == {
        'time to load': '12346 ms',
        'file': str(tmp_path / 'cell.sdf'), 'root frame': 'map', 'frames': '2', 'transforms': '1',
        'files read': '1', 'last good load': '2026-01-02T03:04:05+00:00', 'warnings': '0',
        'first warning': '', 'last error': 'first\nsecond', 'joints not reported': '0',
        'first joint not reported': '', 'models not reported': '0',
        'first model not reported': '', 'problems of topics': '0'}


def test_text_of_others_is_escaped(status_of):
    name = 'a\n\x1b[2J'
    for states in (StateReport([name], models=[name]), StateReport(problems=[name])):
        status = status_of(with_lights(1).replace('"x"', '"&#10;x"'), states=states)
        assert all(text.isprintable() for text in (
            status.message, *(each.value for each in status.values)))


def test_the_topic_is_there_while_it_is_switched_on(make_node):
    node = make_node('bridge')
    diagnostics = Diagnostics(node, tuple)
    topics = []
    for on in (False, True, True, False, True):
        diagnostics.switch(on=on)
        diagnostics.publish()
        topics.append([each.topic_name for each in node.publishers].count('/diagnostics'))
    assert topics == [0, 1, 1, 0, 1]


def test_the_topic_keeps_messages_for_those_who_listen_already(make_node):
    node = make_node('bridge')
    Diagnostics(node, tuple).switch(on=True)
    quality, = (each.qos_profile for each in node.publishers if each.topic_name == '/diagnostics')
    assert (quality.depth, quality.durability) == (10, DurabilityPolicy.VOLATILE)


def test_a_message_has_the_status_of_the_node_and_of_its_last_load(make_node):
    report = StateReport(problems=['from /a'])
    diagnostics = Diagnostics(make_node('bridge', '-r', '__ns:=/left'), lambda: report)
    diagnostics.switch(on=True)
    assert not diagnostics._message.status
    loaded = loaded_scene_from_request(LoadRequest('', GOOD))
    diagnostics.update(loaded, ['first'])
    assert diagnostics._message.status == [
        status_from_scene(loaded, ['first'], report, 'left/bridge')]


def test_no_status_is_made_while_it_is_off(make_node):
    diagnostics = Diagnostics(make_node('bridge'), lambda: pytest.fail('it was made'))
    diagnostics.update(loaded=None)


def test_each_message_has_the_time_of_the_node(make_node):
    node = make_node('bridge')
    diagnostics = Diagnostics(node, tuple)
    before = node.get_clock().now().to_msg()
    diagnostics.switch(on=True)
    assert diagnostics._message.header.stamp.sec >= before.sec > 0
