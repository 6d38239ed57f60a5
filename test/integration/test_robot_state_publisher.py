# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The executable that takes the place of robot_state_publisher in a launch file."""

from functools import partial

from changes import set_parameters
from listener import JointPublisher, latched
import pytest
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage
import urdf_texts as urdf

NODE = '/robot_state_publisher'
OWN = {'/tf', '/tf_static', '/robot_description'}
MOVING = '<axis xyz="0 0 1"/>'
URDF = urdf.robot(
    '<link name="base"/>' + urdf.link('upper') + urdf.link('finger') + urdf.link('thumb')
    + '<link name="tip"/>'
    + urdf.joint('turn', 'base', 'upper', 'continuous', MOVING)
    + urdf.joint('grip', 'upper', 'finger', 'continuous', MOVING)
    + urdf.joint(
        'follow', 'upper', 'thumb', 'continuous', MOVING + '<mimic joint="grip" multiplier="2"/>')
    + urdf.joint('end', 'finger', 'tip', 'fixed', urdf.origin('0 0 1'))
    + urdf.gazebo('<sensor name="imu" type="imu"/>', 'finger'))
FILE_TEXT = URDF
ARM = """<sdf version="1.11"><model name="arm"><link name="base">
<sensor name="eye" type="camera"/></link><link name="upper"/><frame name="f"/>
<joint name="turn" type="revolute"><parent>base</parent><child>upper</child>
  <axis><xyz>0 0 1</xyz></axis></joint></model></sdf>"""
PARAMETERS = """
robot_state_publisher:
  ros__parameters:
    robot_description: '{text}'
    publish_frequency: 1000
    ignore_timestamp: {ignores}
    use_tf_static: true
    speed_of_another_node: 3
    qos_overrides: {{/joint_states: {{subscription: {{reliability: best_effort}}}}}}
"""


@pytest.fixture
def start(start_bridge):
    return partial(start_bridge, program='robot_state_publisher')


@pytest.fixture
def listener(start_listener):
    return start_listener()


@pytest.fixture
def joints(listener):
    return JointPublisher(listener)


@pytest.fixture
def tf(listener):
    """Messages of ``/tf`` and ``/tf_static`` by these names."""
    found = {'/tf': [], '/tf_static': []}
    for name, quality in (('/tf', 100), ('/tf_static', latched(10))):
        listener.node.create_subscription(TFMessage, name, found[name].append, quality)
    return found


def parents_in(messages):
    return {
        each.child_frame_id: each.header.frame_id
        for message in messages for each in message.transforms}


def wait_for_stamp(listener, tf, sec):
    listener.wait(lambda: tf['/tf'][-1].transforms[0].header.stamp.sec == sec, tf)


def topics_of_node(listener):
    published = listener.names_and_types('publisher', NODE).keys()
    subscribed = listener.names_and_types('subscriber', NODE).keys()
    return published - {'/rosout', '/parameter_events'}, subscribed


def test_the_node_has_the_topics_of_robot_state_publisher_and_no_other(start, listener):
    start(robot_description=URDF).wait_until_started()
    descriptions = []
    listener.node.create_subscription(
        String, '/robot_description', descriptions.append, latched(1))
    listener.wait(lambda: descriptions, 'the description')
    assert descriptions[0].data == URDF
    listener.wait(
        lambda: topics_of_node(listener) == (OWN, {'/joint_states'}),
        lambda: topics_of_node(listener))


def test_links_have_the_parents_that_joints_name_once_these_are_reported(
        start, file, listener, joints, tf):
    program = start(file).wait_until_started()
    listener.wait(lambda: tf['/tf_static'], 'the fixed frame')
    listener.wait(lambda: joints.send({'turn': 0.5}) and tf['/tf'], 'the first message')
    wait_for_stamp(listener, tf, joints.send({'turn': 0.5}))
    assert parents_in(tf['/tf_static']) == {'tip': 'finger'}
    assert parents_in(tf['/tf']) == {'upper': 'base'}
    # On a busy machine the first message may come after the line.
    program.wait_for_line('no message has named ')
    wait_for_stamp(listener, tf, joints.send({'grip': 0.25}))
    assert parents_in(tf['/tf']) == {'upper': 'base', 'finger': 'upper', 'thumb': 'upper'}
    assert {each.child_frame_id for each in tf['/tf'][-1].transforms} == {'finger', 'thumb'}
    assert not [line for line in program.lines if line.startswith(('[WARN]', '[ERROR]'))]


def test_a_file_of_parameters_is_taken_with_all_its_names(start, listener, tmp_path, tf):
    file = tmp_path / 'parameters.yaml'
    file.write_text(PARAMETERS.format(text=URDF, ignores='false'))
    program = start('--ros-args', '--params-file', file).wait_until_started()
    listener.wait(lambda: tf['/tf_static'], 'the fixed frame')
    assert not [line for line in program.lines if line.startswith('[WARN]')]


def test_a_misspelt_parameter_is_reported(start, file):
    program = start(file, frame_prefx='left/')
    program.wait_for_line('there is no parameter "frame_prefx"')


def test_sdformat_has_links_frames_and_sensors_and_its_joints_move(start, listener, joints, tf):
    node = start(robot_description=ARM, frame_prefix='/left/')
    node.wait_for_line('Robot initialized')
    listener.wait(lambda: joints.send({'turn': 0.5}) and tf['/tf'], 'the first message')
    listener.wait(lambda: tf['/tf_static'], 'the fixed frames')
    assert parents_in(tf['/tf']) == {'left/upper': 'left/base'}
    assert parents_in(tf['/tf_static']) == {
        'left/arm': 'left/base', 'left/f': 'left/arm', 'left/base/eye': 'left/base',
        'left/base/eye_optical': 'left/base/eye'}


def test_everything_else_can_be_switched_on_and_off(start, file, listener):
    start(file).wait_until_started()
    others = {
        'publish_transforms': True, 'publish_visuals': True, 'publish_diagnostics': True,
        'pose_topics': ['base']}
    for values, extra in (
            (others, {'/diagnostics', *(f'{NODE}/{name}' for name in (
                'transforms', 'visuals', 'poses/base'))}),
            ({**dict.fromkeys(others, False), 'pose_topics': ['']}, set())):
        set_parameters(listener, NODE, **values)
        listener.wait(
            lambda extra=extra: topics_of_node(listener)[0] == OWN | extra,
            lambda: topics_of_node(listener))


@pytest.mark.parametrize(('arguments', 'line'), [
    ([], 'parameter robot_description is not set'),
    (['a.urdf', 'b\x1b.urdf'], r'argument "b\x1b.urdf" is not understood')])
def test_it_ends_with_a_sentence_where_there_is_nothing_to_publish(start, arguments, line):
    program = start(*arguments)
    program.wait_for_line(line)
    assert program.wait_for_end() == 1


def test_help(start):
    program = start('--help')
    program.wait_for_line('usage: ros2 run sdf_pose_bridge robot_state_publisher [robot.urdf]')
    assert program.wait_for_end() == 0
