# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Names, attributes and poses of elements: what is wrong with them, and what they mean."""

import pytest
from sdf_texts import assert_at
from sdf_texts import codes_of
from sdf_texts import element
from sdf_texts import errors_of
from sdf_texts import fixed_joint
from sdf_texts import model_file
from sdf_texts import names_of
from sdf_texts import only_error
from sdf_texts import posed
from sdf_texts import TWO_LINKS
from sdf_texts import world_file

import sdf_pose_bridge

LINK = '<link name="l"/>'
LINK_CHILDREN = [
    'visual', 'collision', 'sensor', 'light', 'particle_emitter', 'projector']
WAYPOINT = ('<actor name="a"><script><trajectory id="0" type="walk"><waypoint><time>0</time>'
            '<pose>{}</pose></waypoint></trajectory></script></actor>')


def link_with(content):
    return model_file(f'<link name="l">{content}</link>')


def scene_of(text):
    return sdf_pose_bridge.load_text(text)


# Names

@pytest.mark.parametrize('text', [
    '<sdf version="1.9"><model><link name="l"/></model></sdf>',
    '<sdf version="1.9"><world/></sdf>',
    model_file('<link/>'),
    model_file(LINK + '<frame/>'),
    model_file(LINK + '<model><link name="l"/></model>'),
    model_file(TWO_LINKS + '<joint type="fixed"><parent>a</parent><child>b</child></joint>'),
    world_file('<frame/>'),
    world_file('<light type="point"/>'),
    *(link_with(element(tag, '').replace('name=""', '')) for tag in LINK_CHILDREN),
])
def test_a_name_is_missing(text):
    assert codes_of(text)[0] == 'ATTRIBUTE_MISSING'


@pytest.mark.parametrize('name', ['', ' ', '\t'])
@pytest.mark.parametrize('text', [
    '<sdf version="1.9"><model name="{}"><link name="l"/></model></sdf>',
    '<sdf version="1.9"><world name="{}"/></sdf>',
    model_file('<link name="{}"/>'),
    model_file(LINK + '<frame name="{}"/>'),
    link_with('<visual name="{}"/>'),
])
def test_a_name_is_empty(text, name):
    assert codes_of(text.format(name))[0] == 'ATTRIBUTE_INVALID'


@pytest.mark.parametrize('name', ['world', '__model__', '__root__', '____', ' __x__ '])
@pytest.mark.parametrize('text', [
    '<sdf version="1.9"><model name="{}"><link name="l"/></model></sdf>',
    '<sdf version="1.9"><world name="{}"/></sdf>',
    model_file('<link name="{}"/>'),
    model_file(LINK + '<frame name="{}"/>'),
    model_file(LINK + '<model name="{}"><link name="l"/></model>'),
    model_file(TWO_LINKS + fixed_joint('{}', 'a', 'b')),
    world_file('<light name="{}" type="point"/>'),
    *(link_with(element(tag, '{}')) for tag in LINK_CHILDREN),
])
def test_a_name_is_reserved(text, name):
    error = only_error(text.format(name))
    assert error.code == 'RESERVED_NAME'
    assert f'"{name.strip()}"' in error.message


def test_only_actors_may_have_reserved_names():
    scene = scene_of(world_file('<actor name="__a__"><pose>1 0 0 0 0 0</pose></actor>'))
    assert_at(scene, '__a__', (1, 0, 0))


@pytest.mark.parametrize('name', [
    '___', '__x_', 'World', 'a b', 'a/b', 'a.b', ':a', 'a:b', 'größe', '手', '1', '&lt;', '"'])
def test_a_name_is_allowed(name):
    escaped = name.replace('"', '&quot;')
    scene = scene_of(model_file(f'<link name="{escaped}"/>'))
    assert names_of(scene)[1] == 'm::' + name.replace('&lt;', '<')


@pytest.mark.parametrize('text', [
    '<sdf version="1.9"><model name="a::b"><link name="l"/></model></sdf>',
    model_file('<link name="a::b"/>'),
    model_file(LINK + '<frame name="::"/>'),
    link_with('<visual name="a::b"/>'),
    model_file(LINK + '<gripper name="a::b"/>'),
    model_file(LINK + '<plugin name="a::b" filename="f"/>').replace('<plugin', '<audio'),
    world_file('<physics name="a::b"/>'),
])
def test_a_name_holds_the_separator(text):
    assert codes_of(text)[0] == 'RESERVED_NAME'


def test_the_name_of_an_include_holds_the_separator(tmp_path):
    (tmp_path / 'n.sdf').write_text(model_file(LINK))
    include = '<include><uri>n.sdf</uri><name>a::b</name></include>'
    (tmp_path / 'w.sdf').write_text(world_file(include))
    with pytest.raises(sdf_pose_bridge.SdfError) as caught:
        sdf_pose_bridge.load(tmp_path / 'w.sdf')
    assert caught.value.code == 'RESERVED_NAME'


def test_what_is_in_a_plugin_is_not_looked_at():
    scene = scene_of(model_file(
        LINK + '<plugin name="p" filename="f"><link name="a::b"><pose>no</pose></link>'
        '<model name="world"/></plugin>'))
    assert names_of(scene) == ['m', 'm::l']


@pytest.mark.parametrize('second', [
    '<link name="l"/>', '<link name=" l "/>', '<frame name="l"/>',
    '<model name="l"><link name="k"/></model>', fixed_joint('l', 'l', 'k') + '<link name="k"/>',
])
def test_siblings_share_a_name(second):
    assert codes_of(model_file(LINK + second)) == ['DUPLICATE_NAME']


@pytest.mark.parametrize('second', [
    '<model name="a"><link name="l"/></model>', '<frame name="a"/>',
    fixed_joint('a', 'a', 'b') + '<model name="b"><link name="l"/></model>',
])
def test_siblings_in_a_world_share_a_name(second):
    error = only_error(world_file('<model name="a"><link name="l"/></model>' + second))
    assert error.code == 'DUPLICATE_NAME'
    assert '"a"' in error.message


@pytest.mark.parametrize('tag', LINK_CHILDREN)
def test_children_of_a_link_share_a_name(tag):
    assert codes_of(link_with(element(tag, 'x') * 2)) == ['DUPLICATE_NAME']


def test_sensors_of_a_joint_share_a_name():
    sensor = '<sensor name="s" type="imu"/>'
    assert codes_of(model_file(TWO_LINKS + fixed_joint('j', 'a', 'b', sensor * 2))) == [
        'DUPLICATE_NAME']


@pytest.mark.parametrize('content', [
    '<light name="x" type="point"/>' * 2, '<actor name="x"/>' * 2,
    '<frame name="x"/>' * 3,
])
def test_things_in_a_world_share_a_name(content):
    assert set(codes_of(world_file(content))) == {'DUPLICATE_NAME'}


def test_worlds_share_a_name():
    assert codes_of('<sdf version="1.9"><world name="w"/><world name="w"/></sdf>') == [
        'DUPLICATE_NAME']


def test_children_of_different_kinds_may_share_a_name():
    scene = scene_of(link_with(''.join(element(tag, 'x') for tag in LINK_CHILDREN)))
    assert names_of(scene).count('m::l::x') == len(LINK_CHILDREN)


def test_a_light_and_an_actor_may_share_the_name_of_a_model():
    scene = scene_of(world_file(
        '<model name="x"><link name="l"/></model><light name="x" type="point"/>'
        '<actor name="x"/>'))
    assert names_of(scene) == ['x', 'x::l', 'x', 'x']


def test_the_same_name_in_other_scopes_is_another():
    scene = scene_of(model_file(
        '<link name="x"><visual name="x"/></link><model name="n"><link name="x"/></model>'))
    assert names_of(scene) == ['m', 'm::x', 'm::x::x', 'm::n', 'm::n::x']


# Poses

@pytest.mark.parametrize('pose', [
    '<pose>1 2 3</pose>', '<pose>a b c d e f</pose>', '<pose>0 0 0 0 0 nan</pose>',
    '<pose>1 2 3 <!-- and --> 0 0 0</pose>', '<pose>0 0 0 0 0 0 1</pose>',
    '<pose rotation_format="quat_xyzw">0 0 0 0 0 0</pose>',
    '<pose rotation_format="quat_xyzw">0 0 0 0 0 0 0</pose>',
    '<pose rotation_format="quat_wxyz">0 0 0 0 0 0 1</pose>',
    '<pose rotation_format="QUAT_XYZW">0 0 0 0 0 0 1</pose>',
    '<pose rotation_format="quat_xyzw" degrees="true">0 0 0 0 0 0 1</pose>',
    '<pose rotation_format="quat_xyzw" degrees="true"/>',
    '<pose rotation_format="quat_xyzw" degrees="1"/>',
])
def test_a_pose_is_wrong(pose):
    assert codes_of(model_file(f'<link name="l">{pose}</link>')) == ['ELEMENT_INVALID']


@pytest.mark.parametrize('value', ['yes', 'maybe', '2', 'true false', 'tru'])
def test_degrees_is_no_boolean(value):
    error = errors_of(model_file(f'<link name="l"><pose degrees="{value}"/></link>'))[0]
    assert error.code == 'ATTRIBUTE_INVALID'
    assert f'"{value}"' in error.message


@pytest.mark.parametrize('text', [
    model_file('<pose>zz</pose>' + LINK),
    model_file(LINK + posed('frame', 'f', 'zz')),
    model_file(LINK + '<model name="n"><pose>zz</pose><link name="l"/></model>'),
    model_file(TWO_LINKS + fixed_joint('j', 'a', 'b', '<pose>zz</pose>')),
    world_file(posed('frame', 'f', 'zz')),
    world_file(posed('light', 'f', 'zz')),
    world_file(posed('actor', 'f', 'zz')),
    *(link_with(posed(tag, 'x', 'zz')) for tag in LINK_CHILDREN),
    link_with('<inertial><pose>zz</pose></inertial>'),
    link_with('<sensor name="s" type="camera"><camera><pose>zz</pose></camera></sensor>'),
    link_with('<audio_source><uri>a.wav</uri><pose>zz</pose></audio_source>'),
    world_file('<gui><camera name="c"><pose>zz</pose></camera></gui>'),
    world_file('<state world_name="w"><model name="m"><pose>zz</pose></model></state>'),
    world_file(WAYPOINT.format('zz')),
    link_with('<pose>1 0 0 0 0 0</pose><pose>zz</pose>'),
])
def test_every_pose_is_judged(text):
    assert codes_of(text) == ['ELEMENT_INVALID']


@pytest.mark.parametrize('text', [
    link_with('<sensor name="s" type="camera"><camera><pose>1 0 0 0 0 0</pose></camera></sensor>'),
    world_file('<gui><camera name="c"><pose relative_to="x">1 0 0 0 0 0</pose></camera></gui>'),
    world_file('<state world_name="w"><model name="m"><pose>1 0 0 0 0 0</pose></model></state>'),
    world_file(WAYPOINT.format('1 0 0 0 0 0')),
])
def test_poses_that_are_no_frames_move_nothing(text):
    assert not scene_of(text).poses[:, :3].any()


@pytest.mark.parametrize('attribute', [
    'degrees=""', 'degrees=" "', 'degrees="false"', 'degrees="0"', 'degrees=" FALSE "',
    'rotation_format=""', 'rotation_format=" "', 'rotation_format=" euler_rpy "',
    'relative_to=""', 'relative_to=" "', 'frame="x"', 'unknown="x"',
])
def test_attributes_that_change_nothing(attribute):
    scene = scene_of(model_file(f'<link name="l"><pose {attribute}>1 0 0 0 0 1</pose></link>'))
    assert_at(scene, 'm::l', (1, 0, 0, 0, 0, 0.479425538604203, 0.8775825618903728))


@pytest.mark.parametrize('value', ['true', '1', ' True ', 'TRUE'])
def test_degrees(value):
    scene = scene_of(model_file(
        f'<link name="l"><pose degrees="{value}">1 0 0 180 0 0</pose></link>'))
    assert_at(scene, 'm::l', (1, 0, 0, 1, 0, 0, 0))


def test_a_quaternion_may_say_that_it_has_no_degrees():
    scene = scene_of(model_file(
        '<link name="l"><pose rotation_format="quat_xyzw" degrees="false">0 0 0 1 0 0 0</pose>'
        '</link>'))
    assert_at(scene, 'm::l', (0, 0, 0, 1, 0, 0, 0))


def test_an_empty_pose_still_has_a_reference():
    scene = scene_of(model_file(
        posed('link', 'a', '1 2 3 0 0 0') + posed('link', 'b', '', 'a')))
    assert_at(scene, 'm::b', (1, 2, 3))


def test_only_the_first_pose_counts():
    scene = scene_of(model_file(
        '<link name="l"><pose>1 0 0 0 0 0</pose><pose relative_to="x">2 0 0 0 0 0</pose></link>'))
    assert_at(scene, 'm::l', (1, 0, 0))


@pytest.mark.parametrize('content', ['<!-- c -->1 2 3 0 0 0', '<![CDATA[1 2 3 0 0 0]]>',
                                     '1 2 3 0 0 0<x/>', '1\r\n2\t3 0 0 0'])
def test_forms_of_text(content):
    assert_at(scene_of(model_file(posed('link', 'l', content))), 'm::l', (1, 2, 3))


def test_names_and_references_are_stripped():
    scene = scene_of(model_file(
        posed('link', ' a\n', '1 0 0 0 0 0') + posed('link', 'b', '1 0 0 0 0 0', '\ta ')))
    assert_at(scene, 'm::b', (2, 0, 0))


# References that may not be written

@pytest.mark.parametrize(('text', 'code'), [
    (model_file(posed('link', 'l', '', '__root__')), 'ATTRIBUTE_INVALID'),
    (model_file(LINK + '<frame name="f" attached_to="__root__"/>'), 'ATTRIBUTE_INVALID'),
    (model_file(LINK, attributes='canonical_link="__root__"'), 'ATTRIBUTE_INVALID'),
    (model_file(LINK, attributes='placement_frame="__root__"'), 'ATTRIBUTE_INVALID'),
    (model_file(LINK + fixed_joint('j', '__root__', 'l')), 'RESERVED_NAME'),
    (model_file(LINK + fixed_joint('j', 'l', '__root__')), 'RESERVED_NAME'),
])
def test_the_implicit_root_cannot_be_named(text, code):
    error = errors_of(text)[0]
    assert error.code == code
    assert '"__root__"' in error.message
