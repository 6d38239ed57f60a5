# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Reading URDF: what is refused or left out, and joints named as links."""

import math

from lxml import etree
import numpy as np
import pytest
from sdf_texts import errors_of, only_error, world_file
from urdf_texts import joint, link, origin, robot, shape

from sdf_pose_bridge import load, load_text, scene_at_positions
from sdf_pose_bridge.problems import MOST_PROBLEMS
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.urdf.robot import robot_from_tree
from sdf_pose_bridge.tf.tree import tf_tree_from_scene

TWO = link('a') + link('b')
NOT_FINITE = '<origin xyz="0 0 inf"/>'
REFUSED = {'PARSING_ERROR': [
    (f'<robot>{link("a")}</robot>', 'the robot has no name'),
    (robot(''), 'the robot has no <link>'),
    (robot('<link/>' + link('a')), 'the link has no name'),
    (robot(link('a') + link('a')), 'there is another link named "a"'),
    (robot(TWO), 'one link has no parent; here these have none: "a", "b"'),
    (robot(link('a') + joint('j', 'a', 'a')), 'here these have none: no link'),
    (robot('<material name="m"/><material name="m"/>' + link('a')),
     'there is another material named "m"'),
    (robot(TWO + '<joint type="fixed"><parent link="a"/><child link="b"/></joint>'),
     'the joint has no name'),
    (robot(TWO + joint('j', 'a', 'c')), '"c" is not a link'),
    (robot(TWO + '<joint name="j" type="fixed"><parent link="a"/></joint>'),
     'the joint names no child link'),
    (robot(TWO + joint('j', 'a', 'b', 'hinge')),
     'type="hinge" of <joint> must be one of continuous, fixed'),
    (robot(TWO + joint('j', 'a', 'b', 'revolute')), 'the revolute joint has no <limit>'),
    (robot(TWO + joint('j', 'a', 'b', 'prismatic', '<limit effort="1"/>')),
     '<limit> has no velocity'),
    (robot(TWO + joint('j', 'a', 'b', 'continuous', '<limit effort="x" velocity="1"/>')),
     'effort of <limit> is "x"; it must be a number such as'),
    (robot(TWO + joint('j', 'a', 'b', 'continuous', '<axis xyz="1 0"/>')),
     'xyz of <axis> is "1 0"; it must be three numbers such as'),
    (robot(TWO + joint('j', 'a', 'b', 'fixed', NOT_FINITE)),
     'xyz of <origin> is "0 0 inf"; it must be three numbers such as'),
    (robot(TWO + joint('j', 'a', 'b', 'continuous', '<mimic/>')), '<mimic> has no joint'),
    (robot(TWO + joint('j', 'a', 'b', 'continuous', '<dynamics/>')), 'neither damping nor'),
    (robot(TWO + joint('j', 'a', 'b', 'continuous', '<safety_controller/>')),
     '<safety_controller> has no k_velocity'),
], 'ELEMENT_INVALID': [
    (robot(NOT_FINITE + link('a')), 'Gazebo reads it as 0 0 inf'),
], 'DUPLICATE_NAME': [
    (robot(TWO + joint('j', 'a', 'b') + joint('k', 'a', 'b')),
     '"b" is already the child of joint "j"'),
]}


@pytest.mark.parametrize(('code', 'text', 'message'), [
    (code, *case) for code, cases in REFUSED.items() for case in cases])
def test_broken_robot_is_refused(code, text, message):
    error = only_error(text)
    assert error.code == code
    assert message in error.message


def test_error_names_line_and_element():
    error = only_error(robot(TWO + '\n' + joint('j', 'a', 'b', 'hinge')))
    assert (error.line, error.element) == (2, '/robot[@name="r"]/joint[@name="j"]')
    error = only_error(robot(TWO + joint('j', 'a', 'b', content='\n' + NOT_FINITE)))
    assert (error.line, error.element) == (2, '/robot[@name="r"]/joint[@name="j"]/origin')


def test_all_errors_are_reported():
    wrong = '<axis xyz="1 0"/><dynamics damping="x"/>'
    errors = errors_of(robot(
        TWO + '\n' + joint('j', 'a', 'c') + '\n' + joint('k', 'd', 'b', 'continuous', wrong)))
    assert [error.line for error in errors] == [2, 3, 3, 3]


def test_number_of_errors_is_bounded():
    errors = errors_of(robot(''.join(joint(f'j{i}', 'a', 'c') for i in range(500))))
    assert len(errors) == MOST_PROBLEMS + 1
    assert '901 more' in errors[-1].message


@pytest.mark.parametrize('broken', [
    '<visual><geometry><capsule/></geometry></visual>',
    '<visual/>',
    '<visual><geometry><sphere/></geometry></visual>',
    '<visual><geometry><mesh/></geometry></visual>',
    '<visual><origin rpy="0"/><geometry><sphere radius="1"/></geometry></visual>',
    '<visual><geometry><box size="nan 1 1"/></geometry></visual>',
    '<visual><geometry><sphere radius="1"/></geometry><material/></visual>',
    '<collision/>',
])
def test_link_is_read_up_to_a_fault(broken):
    sphere = '<visual><geometry><sphere radius="1"/></geometry></visual>'
    scene = load_text(robot(link('a', sphere + broken + sphere)))
    is_first = 'visual' in broken  # visuals are read before collisions
    assert [name for name in scene.names if 'visual' in name] == [
        'r::a::a_visual', 'r::a::a_visual_1'][:1 if is_first else 2]
    assert 'ROS and Gazebo read it no further' in scene.warnings[0].message


def test_mass_counts_though_the_moments_are_missing():
    text = '<robot name="r"><link name="a"><inertial><mass value="1"/></inertial></link></robot>'
    scene = load_text(text)
    assert 'r::a' in scene.names
    assert '<inertial> has no <inertia>' in scene.warnings[0].message


def test_center_of_mass_counts_though_the_mass_is_missing(tmp_path):
    turned = '<inertial><origin rpy="0 0 0.3"/></inertial>'
    text = robot(f'<link name="a">{turned}</link>' + link('b') + joint('j', 'a', 'b'))
    (tmp_path / 'r.urdf').write_text(text, encoding='utf-8')
    (tmp_path / 'w.sdf').write_text(
        world_file('<include><uri>r.urdf</uri></include>'), encoding='utf-8')
    assert load(tmp_path / 'w.sdf').pose('r::a::inertial')[5] == pytest.approx(math.sin(0.15))


@pytest.mark.parametrize('text', [
    robot(TWO + joint('j', 'a', 'b', content=origin(rpy='0 0 90'))),
    robot(link('a', shape('visual', origin(rpy='0 0 90')))),
    robot('<link name="a"><inertial><origin rpy="0 0 90"/></inertial></link>'),
    robot(origin(rpy='0 0 -90') + link('a')),
])
def test_angles_that_look_like_degrees_have_a_warning(text):
    messages = [warning.message for warning in load_text(text).warnings]
    sign = '-' if '-90' in text else ''
    assert (f'the angles rpy="0 0 {sign}90" of <origin> are radians; they look like degrees'
            in messages)


def test_a_turn_in_radians_has_no_warning():
    text = robot(TWO + joint(
        'j', 'a', 'b', content=origin(rpy='6.3 0 -6.3') + '<axis xyz="no axis"/>'))
    assert load_text(text).warnings == ()


def test_links_in_a_cycle_are_left_out_with_a_warning():
    scene = load_text(robot(
        link('c') + TWO + joint('j', 'a', 'b') + joint('k', 'b', 'a')))
    assert 'r::a' not in scene.names
    assert 'its joints form a cycle' in scene.warnings[0].message


@pytest.mark.parametrize('joint_type', ['continuous', 'fixed'])
def test_joint_gets_another_name_than_its_link_and_its_link_keeps_it(joint_type):
    scene = load_text(robot(TWO + joint('b', 'a', 'b', joint_type, origin('1 0 0'))))
    assert scene.names[scene.joints[0].element] == 'r::b_joint'
    assert scene.pose('r::b').x == 1.0
    (warning,) = scene.warnings
    assert 'has the name of link "b"; it is called "b_joint" here' in warning.message


def test_new_name_is_not_that_of_another_joint_or_link():
    scene = load_text(robot(
        TWO + link('b_joint1') + joint('b', 'a', 'b', 'continuous')
        + joint('b_joint', 'b', 'b_joint1')))
    assert {'r::b_joint', 'r::b_joint1', 'r::b_joint2'} <= set(scene.names)


@pytest.mark.parametrize('name', ['b', 'b_joint'])
def test_position_is_given_by_the_name_in_the_file_too(name):
    scene = load_text(robot(
        TWO + joint('b', 'a', 'b', 'continuous', '<axis xyz="0 0 1"/>')))
    assert scene_at_positions(scene, {name: np.pi}).pose('r::b').qz == pytest.approx(1.0)


def test_mimic_follows_a_joint_that_is_renamed():
    scene = load_text(robot(
        TWO + link('c') + joint('b', 'a', 'b', 'continuous', '<axis xyz="0 0 1"/>')
        + joint('k', 'a', 'c', 'continuous', '<axis xyz="0 0 1"/><mimic joint="b"/>')))
    assert scene_at_positions(scene, {'b': np.pi}).pose('r::c').qz == pytest.approx(1.0)


def test_robot_may_have_the_name_of_its_link():
    scene = load_text(robot(link('a') + link('r') + joint('j', 'a', 'r', content=origin('1 0 0'))))
    assert tf_tree_from_scene(scene).frame_ids == ('a', 'r')
    assert scene.pose('r').x == 1.0


@pytest.mark.parametrize(('name', 'joints'), [
    ('b', ['turn']), ('turn', ['turn']), ('c', ['turn', 'rep103']), ('a', []), ('none', [])])
def test_joints_that_can_move_a_link_or_joint(name, joints):
    text = robot(TWO + link('c') + joint('turn', 'a', 'b', 'fixed') + joint(
        'rep103', 'b', 'c', 'fixed', origin(rpy='-1.5708 0 -1.5708')))
    read = robot_from_tree(etree.fromstring(text), Sources(), is_included=False)
    assert [each.name for each in read.joints_to_move(name)] == joints
