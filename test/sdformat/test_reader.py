# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Elements of a file: what is wrong with names, attributes and values, and what is read."""

import pytest
from sdf_texts import assert_at
from sdf_texts import codes_of
from sdf_texts import element
from sdf_texts import errors_of
from sdf_texts import joint
from sdf_texts import model_file
from sdf_texts import names_of
from sdf_texts import only_error
from sdf_texts import posed
from sdf_texts import TWO_LINKS
from sdf_texts import warning_codes
from sdf_texts import world_file

import sdf_pose_bridge
from sdf_pose_bridge import Kind

LINK = '<link name="l"/>'
LINK_CHILDREN = [
    'visual', 'collision', 'sensor', 'light', 'particle_emitter', 'projector']


def link_with(content):
    return model_file(f'<link name="l">{content}</link>')


def scene_of(text):
    return sdf_pose_bridge.load_text(text)


def sensor_facts(content):
    scene = scene_of(link_with(f'<sensor name="s" type="custom">{content}</sensor>'))
    return scene.sensors[scene.index('m::l::s')]


# The top of a file

def test_two_models_at_the_top():
    error = only_error(
        '<sdf version="1.9"><model name="a"><link name="l"/></model>'
        '<model name="b"><link name="l"/></model></sdf>')
    assert error.code == 'ELEMENT_INCORRECT_TYPE'
    assert '"b"' in error.message


def test_two_models_of_one_name_at_the_top():
    model = '<model name="a"><link name="l"/></model>'
    assert codes_of(f'<sdf version="1.9">{model}{model}</sdf>') == ['DUPLICATE_NAME']


@pytest.mark.parametrize('second', ['<light name="k" type="point"/>', '<actor name="k"/>'])
def test_a_model_and_something_else_at_the_top(second):
    assert codes_of(model_file(LINK).replace('</sdf>', second + '</sdf>')) == [
        'ELEMENT_INCORRECT_TYPE']


@pytest.mark.parametrize('tag', ['light', 'actor'])
def test_a_light_or_an_actor_alone(tag):
    scene = scene_of(f'<sdf version="1.9">{posed(tag, "x", "1 2 3 0 0 0")}</sdf>')
    assert_at(scene, 'x', (1, 2, 3))


def test_relative_to_of_a_light_at_the_top_is_not_resolved():
    scene = scene_of(f'<sdf version="1.9">{posed("light", "x", "1 2 3 0 0 0", "y")}</sdf>')
    assert_at(scene, 'x', (1, 2, 3))


def test_relative_to_of_a_model_at_the_top():
    error = only_error(model_file('<pose relative_to="l">1 0 0 0 0 0</pose>' + LINK))
    assert error.code == 'ATTRIBUTE_INVALID'
    assert 'relative_to="l"' in error.message


def test_blank_relative_to_of_a_model_at_the_top():
    scene = scene_of(model_file('<pose relative_to=" ">1 0 0 0 0 0</pose>' + LINK))
    assert_at(scene, 'm', (1, 0, 0))


def test_an_empty_file():
    assert names_of(scene_of('<sdf version="1.9"/>')) == []


# Models

@pytest.mark.parametrize('value', ['maybe', '2', 'yes', '-1'])
def test_static_is_no_boolean(value):
    error = errors_of(model_file(f'<static>{value}</static>' + LINK))[0]
    assert error.code == 'ELEMENT_INVALID'
    assert f'"{value}"' in error.message


@pytest.mark.parametrize(('value', 'is_static'), [
    ('true', True), (' 1 ', True), ('TRUE', True), ('false', False), ('0', False), ('', False),
])
def test_static(value, is_static):
    scene = scene_of(model_file(f'<static>{value}</static>' + LINK))
    assert (scene.index('m') in scene.static_models) == is_static


def test_static_is_not_handed_down():
    scene = scene_of(model_file(
        '<static>true</static><model name="n"><link name="l"/></model>'))
    assert scene.static_models == {scene.index('m')}


# Joints

def test_a_joint_has_no_type():
    text = model_file(TWO_LINKS + '<joint name="j"><parent>a</parent><child>b</child></joint>')
    assert codes_of(text) == ['ATTRIBUTE_MISSING']


@pytest.mark.parametrize('kind', ['', 'glue', 'hinge', 'fix ed'])
def test_a_joint_has_an_unknown_type(kind):
    text = model_file(TWO_LINKS + joint('<parent>a</parent><child>b</child>', kind=kind))
    assert codes_of(text) == ['ATTRIBUTE_INVALID']


@pytest.mark.parametrize('kind', [
    'ball', 'continuous', 'fixed', 'gearbox', 'prismatic', 'revolute', 'revolute2', 'screw',
    'universal', 'FIXED', ' fixed ',
])
def test_a_joint_has_a_type(kind):
    text = model_file(TWO_LINKS + joint('<parent>a</parent><child>b</child>', kind=kind))
    assert scene_of(text).joints[0].type == kind.strip().lower()


@pytest.mark.parametrize(('content', 'kind', 'code'), [
    ('<parent>a</parent>', 'fixed', 'ELEMENT_MISSING'),
    ('<child>a</child>', 'revolute', 'ELEMENT_MISSING'),
    ('<parent>a</parent>', 'ball', 'JOINT_CHILD_LINK_INVALID'),
    ('<child>a</child>', 'ball', 'JOINT_PARENT_LINK_INVALID'),
])
def test_a_joint_misses_an_end(content, kind, code):
    assert codes_of(model_file(TWO_LINKS + joint(content, kind=kind))) == [code]


def test_a_joint_misses_both_ends():
    assert codes_of(model_file(TWO_LINKS + joint(''))) == ['ELEMENT_MISSING'] * 2


# Sensors

@pytest.mark.parametrize(('content', 'frame_id'), [
    ('', ''),
    ('<gz_frame_id>a/b</gz_frame_id>', 'a/b'),
    ('<ignition_frame_id> a </ignition_frame_id>', 'a'),
    ('<ignition_frame_id>old</ignition_frame_id><gz_frame_id>new</gz_frame_id>', 'new'),
    ('<gz_frame_id/>', ''),
])
def test_the_frame_id_of_a_sensor(content, frame_id):
    assert sensor_facts(content).frame_id == frame_id


@pytest.mark.parametrize(('content', 'is_camera', 'name'), [
    ('', False, ''),
    ('<camera/>', True, ''),
    ('<camera><optical_frame_id>eye</optical_frame_id></camera>', True, 'eye'),
    ('<optical_frame_id>eye</optical_frame_id>', False, ''),
])
def test_a_camera(content, is_camera, name):
    facts = sensor_facts(content)
    assert (facts.is_camera, facts.optical_frame_id) == (is_camera, name)


# The rest

def test_kinds():
    scene = scene_of(world_file(
        '<model name="m"><link name="l"><inertial/>'
        + ''.join(element(tag, tag) for tag in LINK_CHILDREN)
        + '</link><frame name="f"/></model><light name="sun" type="point"/><actor name="a"/>'))
    assert [Kind(kind).label for kind in scene.kinds] == [
        'world', 'model', 'link', 'inertial', *LINK_CHILDREN, 'frame', 'light', 'actor']


@pytest.mark.parametrize('where', [
    '<link name="l"><frame name="f"><pose>no</pose></frame></link>',
    '<link name="l"><visual name="v"><link name="k"/></visual></link>',
    LINK + '<gripper name="g"><link name="k"/></gripper>',
    LINK + '<tool><link name="k"/></tool>',
])
def test_elements_in_the_wrong_place_are_no_elements(where):
    assert {'m::f', 'm::l::f', 'm::k'}.isdisjoint(names_of(scene_of(model_file(where))))


def test_relative_to_of_an_inertial_is_ignored_with_a_warning():
    scene = scene_of(link_with(
        '<inertial><pose relative_to="nowhere">1 0 0 0 0 0</pose></inertial>'))
    assert warning_codes(scene) == ['WARNING']
    assert scene.poses[-1, 0] == 1.0


def test_relative_to_of_an_actor_is_ignored_with_a_warning():
    scene = scene_of(world_file(posed('actor', 'a', '1 0 0 0 0 0', 'nowhere')))
    assert warning_codes(scene) == ['WARNING']
    assert_at(scene, 'a', (1, 0, 0))


def test_lines_are_told():
    scene = scene_of('<sdf version="1.9">\n<model name="m">\n\n<link\n name="l"/></model></sdf>')
    assert scene.lines[scene.index('m')] == 2
    assert scene.lines[scene.index('m::l')] in (4, 5)
