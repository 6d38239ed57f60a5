# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Versions: which exist, and how files of old ones are converted to the newest grammar."""

import itertools

import pytest
from sdf_texts import (
    codes_of,
    errors_of,
    fixed_joint,
    KINDS_IN_MODELS,
    LINK,
    model_file,
    names_of,
    part_of_model,
    TWO_LINKS,
    world_file,
)

from sdf_pose_bridge import load_text
from sdf_pose_bridge.sdformat.documents import document_from_file
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.versions import version_numbers


@pytest.mark.parametrize('version', [
    '', '1', '1.1', '1.13', '2.0', '1.6.0', ' 1.9 ', '1.09', 'latest', '-1.9', '\u0661.9',
    '1.' + '9' * 5000,
])
def test_version_that_does_not_exist_is_refused(version):
    assert codes_of(model_file(LINK, version=version)) == ['CONVERSION_ERROR']


@pytest.mark.parametrize('minor', range(2, 13))
def test_every_version_is_read_with_the_newest_grammar(minor):
    frame = '<frame name="f"><pose degrees="1" relative_to="l"/></frame>'
    scene = load_text(model_file(LINK + frame, version=f'1.{minor}'))
    assert names_of(scene) == ['m', 'm::l', 'm::f']


@pytest.mark.parametrize(('text', 'numbers'), [
    ('1.10', (1, 10)), ('', ()), ('1.x', ()), ('\u0661.9', ()), ('1.' + '9' * 5000, ()),
])
def test_numbers_of_a_version(text, numbers):
    assert version_numbers(text) == numbers


def converted(text):
    """Return the ``sdf`` element of a text in the newest version."""
    return document_from_file('f', Sources(texts={'f': text})).root


# Deprecated elements

CAMERA = '<link name="l"><sensor name="s" type="camera"><camera>{}</camera></sensor></link>'
SENSOR = '<link name="l"><sensor name="s" type="imu">{}</sensor></link>'
SCREW = ('<link name="l"/><joint name="j" type="screw"><parent>world</parent><child>l</child>{}'
         '</joint>')


@pytest.mark.parametrize(('content', 'version', 'new'), [
    (CAMERA.format('<optical_frame_id>o</optical_frame_id>'), '1.12', '<frame_id>'),
    (CAMERA.format('<optical_frame_id>o</optical_frame_id>'), '1.11', ''),
    (SENSOR.format('<gz_frame_id>f</gz_frame_id>'), '1.12', '<frame_id>'),
    (SENSOR.format('<gz_frame_id>f</gz_frame_id>'), '1.11', ''),
    (SCREW.format('<thread_pitch>1</thread_pitch>'), '1.10', '<screw_thread_pitch>'),
    (SCREW.format('<thread_pitch>1</thread_pitch>'), '1.9', ''),
    (LINK + '<plugin filename="p"><joint><thread_pitch/></joint></plugin>', '1.12', ''),
])
def test_deprecated_element_is_a_warning_that_names_the_new_one(content, version, new):
    warnings = load_text(model_file(content, version=version)).warnings
    assert ['is deprecated' in warning.message and new in warning.message
            for warning in warnings if not warning.is_for_gazebo] == [True] * bool(new)


# 1.3 to 1.6: elements without poses

OLD_PHYSICS = ('<physics type="ode"><update_rate>1</update_rate><gravity>0 0 2</gravity><ode>'
               '<solver><dt>3</dt></solver></ode><magnetic_field>0 0 4</magnetic_field><bullet>'
               '<dt>5</dt></bullet></physics><frame name="f"/>')


@pytest.mark.parametrize(('version', 'in_physics', 'in_world'), [
    ('1.3', {'real_time_update_rate': '1', 'max_step_size': '5'}, 'gravity magnetic_field'),
    ('1.4', {}, 'gravity magnetic_field'), ('1.5', {}, 'gravity magnetic_field'), ('1.6', {}, ''),
])
def test_old_elements_move_to_the_end_of_another_element(version, in_physics, in_world):
    world = converted(world_file(OLD_PHYSICS, version=version)).find('world')
    tags = [each.tag for each in world.find('physics')]
    assert {each.tag: each.text for each in world.find('physics')[tags.index('bullet') + 1:]} == (
        in_physics)
    assert [each.tag for each in world][2:] == in_world.split()


# 1.6 to 1.7: references of poses

TWO_POSED_LINKS = ('<link name="a"><pose>1 0 0 0 0 0</pose></link>'
                   '<link name="b"><pose {}>1 0 0 0 0 0</pose></link>')


@pytest.mark.parametrize('version', ['1.4', '1.5', '1.6'])
def test_unknown_frame_of_an_old_pose_is_an_error(version):
    text = model_file(TWO_POSED_LINKS.format('frame="x"'), version=version)
    assert codes_of(text) == ['POSE_RELATIVE_TO_INVALID']


def test_frame_of_a_newer_pose_is_ignored_with_a_warning():
    scene = load_text(model_file(TWO_POSED_LINKS.format('frame="a"'), version='1.7'))
    assert scene.pose('m::b').x == 1.0
    assert scene.warnings[0].message.endswith('since version 1.7 it is relative_to')


@pytest.mark.parametrize('content', [
    '<plugin name="p" filename="f"><pose frame="nowhere"/></plugin>',
    '<x:y><pose frame="nowhere"/></x:y>',
])
def test_foreign_elements_are_not_converted(content):
    root = converted(model_file(LINK + content, version='1.6'))
    assert root.find('.//pose').get('frame') == 'nowhere'


# 1.4 to 1.5 and 1.6 to 1.7: axes

def file_with_axis(axis, version):
    joint = ('<joint name="j" type="revolute"><parent>a</parent><child>b</child>'
             f'<axis>{axis}</axis></joint>')
    return model_file(TWO_LINKS + joint, version=version)


def frame_of_axis(text):
    return converted(text).find('.//xyz').get('expressed_in')


@pytest.mark.parametrize(('versions', 'flags', 'frame'), [
    ('1.4 1.5 1.6', ['true', '1', 'True', 'TRUE', ' true '], '__model__'),
    ('1.4 1.6', ['false', '0', '', 'maybe', 'tRuE'], None),
    ('1.7', ['true'], None),
    ('1.3 1.4', [None], '__model__'),
    ('1.5 1.6', [None], None),
])
def test_frame_of_an_old_axis(versions, flags, frame):
    for version, flag in itertools.product(versions.split(), flags):
        written = '' if flag is None else (
            f'<use_parent_model_frame>{flag}</use_parent_model_frame>')
        text = file_with_axis(f'<xyz>1 0 0</xyz>{written}', version)
        assert frame_of_axis(text) == frame, (version, flag)
        assert 'm::j' in load_text(text).names


def test_default_frame_of_an_axis_in_an_old_nested_model_is_the_joint():
    inner = ('<model name="n"><link name="k"/><joint name="j" type="revolute"><parent>world'
             '</parent><child>k</child><axis><xyz>1 0 0</xyz></axis></joint></model>')
    assert frame_of_axis(model_file(LINK + inner, version='1.4')) is None


@pytest.mark.parametrize(('axis', 'version'), [
    ('', '1.4'), ('<use_parent_model_frame>1</use_parent_model_frame>', '1.6')])
def test_axis_in_the_old_model_frame_must_have_a_direction(axis, version):
    assert codes_of(file_with_axis(axis, version)) == ['ELEMENT_INVALID']


@pytest.mark.parametrize(('axis', 'version'), [
    ('', '1.5'), ('<use_parent_model_frame>0</use_parent_model_frame>', '1.4')])
def test_axis_in_the_old_joint_frame_has_a_default_direction(axis, version):
    assert 'm::j' in load_text(file_with_axis(axis, version)).names


# 1.7 to 1.8: names such as nested::link become nested models

NESTED = """
  <frame name="n::__model__" attached_to="n::b"><pose>0 0 1 0 0 0</pose></frame>
  <link name="n::a"><pose relative_to="n::__model__">1 0 0 0 0 0</pose></link>
  <link name="n::b"/>
"""


def world(content, version='1.7'):
    return (f'<sdf version="{version}"><world name="w"><model name="m">{content}</model></world>'
            '</sdf>')


@pytest.mark.parametrize(('content', 'code'), [
    (NESTED + fixed_joint('n::j', 'base', 'n::a'), 'CONVERSION_ERROR'),
    (NESTED + fixed_joint('n::j', 'n::a', 'base'), 'CONVERSION_ERROR'),
    ('<link name="n::l"><visual name="v"><pose relative_to="base"/><geometry/></visual></link>',
     'CONVERSION_ERROR'),
    ('<link name="n::l"><pose relative_to="base"/></link>', 'POSE_RELATIVE_TO_INVALID'),
    ('<model name="::n"><link name="l"/></model>', 'CONVERSION_ERROR'),
    ('<link name="n::"/>', 'CONVERSION_ERROR'),
])
def test_reference_from_a_nested_model_to_outside_cannot_be_converted(content, code):
    assert codes_of(world(f'<link name="base"/>{content}')) == [code]


@pytest.mark.parametrize('kind', KINDS_IN_MODELS, ids=lambda kind: kind.label)
def test_every_kind_in_a_model_moves_into_the_nested_model(kind):
    part = part_of_model(kind, 'n::x').replace('>a<', '>n::a<').replace('>b<', '>n::b<')
    nested = '<link name="n::a"/><link name="n::b"><pose>1 0 0 0 0 0</pose></link>' + part
    scene = load_text(world(nested))
    assert scene.pose('m::n::x', relative_to='m::n')[5] != 0.0


def test_names_with_the_separator_are_refused_in_newer_files():
    assert set(codes_of(world(NESTED, '1.8'))) == {'RESERVED_NAME'}


def test_canonical_link_of_a_nested_model_is_that_of_its_model_frame():
    scene = load_text(world('<link name="base"/>' + NESTED))
    assert scene.canonical_links[scene.index('m::n')] == scene.index('m::n::b')


@pytest.mark.parametrize(('content', 'name', 'position'), [
    ('<link name="b::l"/>', 'm::b::l', (0, 0, 0)),
    # References to the frame of the model, and to names in the new model.
    (NESTED, 'm::n::a', (1, 0, 1)),
    (('<link name="n::l"><pose relative_to="k">1 0 0 0 0 0</pose></link>'
      '<link name="n::k"><pose>0 5 0 0 0 0</pose></link>'), 'm::n::l', (1, 5, 0)),
    ('<link name="n::l"><pose>5 0 0 0 0 0</pose></link><frame name="n::f" attached_to="n::l"/>',
     'm::n::f', (5, 0, 0)),
    ('<link name="a::b::c"/>', 'm::a::b::c', (0, 0, 0)),
    (('<model name="n::k"><frame name="f"><pose>0 3 0 0 0 0</pose></frame>'
      '<link name="l"><pose relative_to="f">1 0 0 0 0 0</pose></link></model>'),
     'm::n::k::l', (1, 3, 0)),
])
def test_models_are_nested_as_deep_as_their_names(content, name, position):
    scene = load_text(world(f'<link name="base"/>{content}'))
    assert scene.pose(name)[:3] == position
    parts = name.split('::')
    assert {'m::base', *('::'.join(parts[:end]) for end in range(1, len(parts)))} < {*scene.names}


NESTED_ALREADY = '<model name="k"><link name="l"/><link name="p::a"/></model>'


@pytest.mark.parametrize(('content', 'names'), [
    (NESTED_ALREADY + '<link name="n::a"/>', ['k', 'k::l', 'k::p', 'k::p::a', 'n::a']),
    ('<link name="n::a"/>' + NESTED_ALREADY + '<link name="n::b"/><link name="o::b"/>',
     ['k', 'k::l', 'k::p', 'k::p::a', 'o::b', 'n', 'n::a', 'n::b']),
    (NESTED_ALREADY + NESTED_ALREADY.replace('"k"', '"j"'),
     ['k', 'k::l', 'k::p', 'k::p::a', 'j', 'j::l', 'j::p::a']),
])
def test_a_model_that_is_nested_already_stops_the_conversion(content, names):
    assert names_of(load_text(world(content)))[1:] == [f'm::{name}' for name in names]


@pytest.mark.parametrize('name', ['k::l', 'k::__model__', 'k::p::a'])
@pytest.mark.parametrize('file', [world, model_file], ids=['world', 'model'])
def test_name_of_an_element_in_a_nested_model_is_refused_outside_of_it(file, name):
    (error,) = errors_of(file(f'{NESTED_ALREADY}\n<frame name="{name}"/>', version='1.7'))
    assert (error.code, error.line) == ('DUPLICATE_NAME', 2)


@pytest.mark.parametrize('name', ['n::', '::n'])
def test_name_without_a_part_is_accepted_where_the_conversion_stops(name):
    assert f'm::{name}' in load_text(world(f'{NESTED_ALREADY}<link name="{name}"/>')).names


def test_world_stays_the_parent_of_a_joint():
    scene = load_text(world(
        '<link name="n::l"/>'
        '<joint name="n::j" type="fixed"><parent>world</parent><child>n::l</child></joint>'))
    assert scene.joints[0].parent == 0


def test_scoped_names_stay_in_a_model_file():
    scene = load_text(model_file('<link name="n::l"/>', version='1.7'))
    assert scene.names == ('__root__', 'm', 'm::n::l')


def test_moved_elements_keep_their_lines():
    scene = load_text(world('\n<link name="base"/>' + NESTED))
    assert [scene.place(scene.index(f'm::n{name}')).line for name in ('', '::a', '::b')] == [
        3, 4, 5]
