# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Names of siblings: missing, empty, reserved and duplicate names, and new ones in old files."""

import pytest
from sdf_texts import (
    assert_at,
    codes_of,
    element,
    errors_of,
    fixed_joint,
    LINK,
    LINK_CHILDREN,
    link_with,
    model_file,
    names_of,
    only_error,
    posed,
    TWO_LINKS,
    warning_codes,
    world_file,
)

from sdf_pose_bridge import load_text

# Missing, empty and reserved names

@pytest.mark.parametrize('text', [
    '<sdf version="1.9"><model><link name="l"/></model></sdf>',
    '<sdf version="1.9"><world/></sdf>',
    model_file('<link/>'),
    model_file(LINK + '<frame/>'),
    model_file(LINK + '<model><link name="l"/></model>'),
    model_file(TWO_LINKS + '<joint type="fixed"><parent>a</parent><child>b</child></joint>'),
    world_file('<frame/>'),
    world_file('<light type="point"/>'),
    world_file('<actor/>'),
    *(link_with(element(tag, '').replace('name=""', '')) for tag in LINK_CHILDREN),
])
def test_missing_name_is_refused(text):
    assert codes_of(text)[0] == 'ATTRIBUTE_MISSING'


@pytest.mark.parametrize('name', ['', ' ', '\t'])
@pytest.mark.parametrize('text', [
    '<sdf version="1.9"><model name="{}"><link name="l"/></model></sdf>',
    '<sdf version="1.9"><world name="{}"/></sdf>',
    model_file('<link name="{}"/>'),
    model_file(LINK + '<frame name="{}"/>'),
    link_with('<visual name="{}"/>'),
])
def test_empty_name_is_refused(text, name):
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
def test_reserved_name_is_refused(text, name):
    error = only_error(text.format(name))
    assert error.code == 'RESERVED_NAME'
    assert f'"{name.strip()}"' in error.message


def test_actor_may_have_a_reserved_name():
    scene = load_text(world_file('<actor name="__a__"><pose>1 0 0 0 0 0</pose></actor>'))
    assert_at(scene, '__a__', (1, 0, 0))


@pytest.mark.parametrize('name', [
    '___', '__x_', 'World', 'a b', 'a/b', 'a.b', ':a', 'a:b', 'größe', '手', '1', '&lt;', '"'])
def test_any_other_name_is_allowed(name):
    escaped = name.replace('"', '&quot;')
    scene = load_text(model_file(f'<link name="{escaped}"/>'))
    assert names_of(scene)[1] == 'm::' + name.replace('&lt;', '<')


def test_name_is_stripped():
    scene = load_text(model_file(
        posed('link', ' a\n', '1 0 0 0 0 0') + posed('link', 'b', '1 0 0 0 0 0', 'a')))
    assert_at(scene, 'm::b', (2, 0, 0))


# Duplicate names

NESTED = '<model name="l"><link name="k"/></model>'


@pytest.mark.parametrize('text', [
    model_file(LINK + '<link name=" l "/>'),
    model_file(LINK + NESTED),
    model_file(LINK + fixed_joint('l', 'l', 'k') + '<link name="k"/>'),
    *(link_with(element(tag, 'x') * 2) for tag in LINK_CHILDREN),
    model_file(TWO_LINKS + fixed_joint('j', 'a', 'b', '<sensor name="s" type="imu"/>' * 2)),
    '<sdf version="1.9"><world name="w"/><world name="w"/></sdf>',
    # What is renamed in files below 1.7.
    model_file(LINK + '<frame name="l"/>', version='1.7'),
    # What is not renamed in them.
    model_file(LINK + LINK, version='1.6'),
    model_file('<frame name="l"/><frame name="l"/>' + LINK, version='1.6'),
    model_file(LINK + '<frame name="l"/><frame name="l"/>', version='1.6'),
    model_file(NESTED * 2, version='1.6'),
    model_file(LINK + NESTED, version='1.6'),
    world_file(
        '<model name="a"><link name="l"/></model><model name="b"><link name="l"/></model>'
        + fixed_joint('a', 'a', 'b'), version='1.6'),
])
def test_two_elements_cannot_share_a_name(text):
    assert codes_of(text) == ['DUPLICATE_NAME']


@pytest.mark.parametrize('second', [
    '<model name="a"><link name="l"/></model>', '<frame name="a"/>',
    fixed_joint('a', 'a', 'b') + '<model name="b"><link name="l"/></model>',
])
def test_frames_of_a_world_cannot_share_a_name(second):
    error = only_error(world_file('<model name="a"><link name="l"/></model>' + second))
    assert error.code == 'DUPLICATE_NAME'
    assert '"a"' in error.message


@pytest.mark.parametrize('content', [
    '<light name="x" type="point"/>' * 2, '<actor name="x"/>' * 2, '<frame name="x"/>' * 3,
])
def test_elements_of_a_world_of_one_kind_cannot_share_a_name(content):
    errors = errors_of(world_file(content))
    assert {error.code for error in errors} == {'DUPLICATE_NAME'}
    article = 'an' if 'actor' in content else 'a'
    assert f' belongs to {article} ' in errors[0].message


def test_message_has_kind_and_place_of_the_other_element():
    error = only_error(model_file('\n<link name="a"/>\n<link name="l"/>\n<frame name="l"/>'))
    assert error.line == 4
    assert error.message == (
        'the name "l" belongs to a link of this scope already, see file.sdf:3')


def test_children_of_a_link_of_different_kinds_may_share_a_name():
    scene = load_text(link_with(''.join(element(tag, 'x') for tag in LINK_CHILDREN)))
    assert names_of(scene).count('m::l::x') == len(LINK_CHILDREN)


@pytest.mark.parametrize(('text', 'names'), [
    (world_file('<model name="x"><link name="l"/></model><light name="x" type="point"/>'
                '<actor name="x"/>'), ['x', 'x::l', 'x', 'x']),
    (model_file('<link name="x"><visual name="x"/></link>'
                '<model name="n"><link name="x"/></model>'),
     ['m', 'm::x', 'm::x::x', 'm::n', 'm::n::x']),
], ids=['a light and an actor', 'other scopes'])
def test_elements_that_may_share_a_name(text, names):
    assert names_of(load_text(text)) == names


# Elements of different kinds with one name in files below 1.7

J = '<joint name="l" type="fixed"><parent>l</parent><child>k</child></joint>'


@pytest.mark.parametrize(('content', 'name'), [
    (LINK + '<frame name="l"/>', 'm::l_frame'),
    (LINK + '<link name="k"/>' + J, 'm::l_joint'),
    ('<frame name="l"/><link name="k"/>' + LINK, 'm::l_link'),
    (LINK + '<link name="k"/><link name="l_joint"/>' + J, 'm::l_joint0'),
    (LINK + '<link name="k"/><link name="l_joint"/><frame name="l_joint0"/>' + J, 'm::l_joint1'),
])
def test_later_element_is_renamed_in_old_files(content, name):
    scene = load_text(model_file(content, version='1.6'))
    assert name in names_of(scene)
    assert warning_codes(scene) == ['WARNING']


def test_new_names_are_names_that_later_elements_cannot_have():
    scene = load_text(model_file(
        LINK + '<frame name="l"/><frame name="l_frame"/>', version='1.6'))
    assert names_of(scene) == ['m', 'm::l', 'm::l_frame', 'm::l_frame_frame']


def test_frame_of_a_world_is_renamed_in_old_files():
    scene = load_text(world_file(
        '<model name="a"><link name="l"/></model><frame name="a"/>', version='1.6'))
    assert names_of(scene) == ['a', 'a::l', 'a_frame']
