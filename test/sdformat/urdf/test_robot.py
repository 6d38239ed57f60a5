# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Reading URDF: what is refused, and what is left out with a warning."""

import math

import pytest
from sdf_texts import errors_of
from sdf_texts import only_error
from urdf_texts import joint
from urdf_texts import link
from urdf_texts import robot
from urdf_texts import shape

from sdf_pose_bridge import load_text
from sdf_pose_bridge.problems import MOST_PROBLEMS

TWO = link('a') + link('b')
LIMIT = '<limit effort="1" velocity="1"/>'


@pytest.mark.parametrize(('text', 'message'), [
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
     'effort of <limit> is "x", which is not a number'),
    (robot(TWO + joint('j', 'a', 'b', 'continuous', '<axis xyz="1 0"/>')),
     'xyz of <axis> is "1 0", which is not 3 numbers'),
    (robot(TWO + joint('j', 'a', 'b', 'continuous', '<mimic/>')), 'the <mimic> names no joint'),
    (robot(TWO + joint('j', 'a', 'b', 'continuous', '<dynamics/>')), 'neither damping nor'),
    (robot(TWO + joint('j', 'a', 'b', 'continuous', '<safety_controller/>')),
     '<safety_controller> has no k_velocity'),
])
def test_broken_robot_is_refused(text, message):
    error = only_error(text)
    assert error.code == 'PARSING_ERROR'
    assert message in error.message


NOT_FINITE = '<origin xyz="0 0 inf"/>'


@pytest.mark.parametrize('text', [
    robot(TWO + joint('j', 'a', 'b', 'fixed', NOT_FINITE)),
    robot(link('a', shape('visual', NOT_FINITE))),
    robot(link('a', '<visual><geometry><box size="nan 1 1"/></geometry></visual>')),
    robot(NOT_FINITE + link('a')),
])
def test_vector_that_is_not_finite_is_refused(text):
    error = only_error(text)
    assert error.code == 'ELEMENT_INVALID'
    assert 'the numbers must be finite' in error.message


def test_link_with_two_parents_is_refused():
    error = only_error(robot(TWO + joint('j', 'a', 'b') + joint('k', 'a', 'b')))
    assert error.code == 'DUPLICATE_NAME'
    assert '"b" is already the child of joint "j"' in error.message


def test_error_names_line_and_element():
    error = only_error(robot(TWO + '\n' + joint('j', 'a', 'b', 'hinge')))
    assert (error.line, error.element) == (2, '/robot[@name="r"]/joint[@name="j"]')


def test_all_errors_are_reported():
    errors = errors_of(
        robot(TWO + '\n' + joint('j', 'a', 'c') + '\n' + joint('k', 'd', 'b')))
    assert [error.line for error in errors] == [2, 3]


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
    '<visual><geometry><sphere radius="1"/></geometry><material/></visual>',
])
def test_link_is_read_up_to_a_fault(broken):
    sphere = '<visual><geometry><sphere radius="1"/></geometry></visual>'
    scene = load_text(robot(link('a', sphere + broken + sphere)))
    assert [name for name in scene.names if 'visual' in name] == ['r::a::a_visual']
    assert 'libsdformat reads the link no further' in scene.warnings[0].message


def test_mass_counts_though_the_moments_are_missing():
    text = '<robot name="r"><link name="a"><inertial><mass value="1"/></inertial></link></robot>'
    scene = load_text(text)
    assert 'r::a' in scene.names
    assert '<inertial> has no <inertia>' in scene.warnings[0].message


def test_center_of_mass_counts_though_the_mass_is_missing():
    turned = '<inertial><origin rpy="0 0 0.3"/></inertial>'
    text = robot(f'<link name="a">{turned}</link>' + link('b') + joint('j', 'a', 'b'))
    assert load_text(text).pose('r::a::inertial')[5] == pytest.approx(math.sin(0.15))


def test_links_in_a_cycle_are_left_out_with_a_warning():
    scene = load_text(robot(
        link('c') + TWO + joint('j', 'a', 'b') + joint('k', 'b', 'a')))
    assert 'r::a' not in scene.names
    assert 'its joints form a cycle' in scene.warnings[0].message
