# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Merged models: what cannot be merged, what moves, and which references are replaced."""

import pytest
from sdf_texts import (
    assert_at,
    errors_of_files,
    fixed_joint,
    KINDS_IN_MODELS,
    LINK,
    names_of,
    part_of_model,
    posed,
    scene_from_files,
    warning_codes,
    write_files,
)

from sdf_pose_bridge import load

PROXY = '_merged__arm__model__'


def arm(content, attributes=''):
    """Put content into the model that is merged."""
    return f'<sdf version="1.9">\n<model name="arm" {attributes}>{content}</model></sdf>'


ARM = arm(
    '<pose>0 0 1 0 0 0</pose>' + posed('link', 'upper', '1 0 0 0 0 0')
    + '<frame name="f"><pose>0 1 0 0 0 0</pose></frame>')


def include(content='', uri='arm.sdf'):
    return f'<include merge="true"><uri>{uri}</uri>{content}</include>'


def in_model(content):
    return ('<sdf version="1.9"><model name="m"><link name="base"><pose>0 0 10 0 0 0</pose></link>'
            f'\n{content}</model></sdf>')


def in_world(content):
    return f'<sdf version="1.10"><world name="w">\n{content}</world></sdf>'


@pytest.fixture
def scene_of(tmp_path):
    """Load a text that merges ``arm.sdf``."""
    return lambda main, **texts: scene_from_files(tmp_path, main=main, **{'arm': ARM, **texts})


@pytest.fixture
def errors_in(tmp_path):
    return lambda main, **texts: errors_of_files(tmp_path, main=main, **{'arm': ARM, **texts})


@pytest.mark.parametrize(('flags', 'name'), [
    (['true', 'True', 'TRUE', '1', ' 1 '], 'm::f'),
    (['false', 'tRuE', ' true', 'true ', '0', ''], 'm::arm::f')])
def test_flag_of_a_merge_has_few_spellings(scene_of, flags, name):
    for flag in flags:
        main = in_model(include().replace('"true"', f'"{flag}"'))
        assert name in scene_of(main).names, flag


# What cannot be merged

@pytest.mark.parametrize('tag', ['light', 'actor'])
def test_only_a_model_is_merged(errors_in, tag):
    text = f'<sdf version="1.9">{posed(tag, "x", "")}</sdf>'
    (error,) = errors_in(in_world(include()), arm=text)
    assert (error.code, error.line) == ('MERGE_INCLUDE_UNSUPPORTED', 2)


@pytest.mark.parametrize(('content', 'name'), [
    (LINK, 'link[@name="l"]'),
    ('<model name="n"><link name="l"/></model><gripper name="g"/>', 'gripper[@name="g"]'),
])
def test_link_or_gripper_is_not_merged_into_a_world(errors_in, content, name):
    (error,) = errors_in(in_world(include()), arm=arm(content))
    assert error.code == 'MERGE_INCLUDE_UNSUPPORTED'
    assert name in error.message
    assert error.file.endswith('arm.sdf')


@pytest.mark.parametrize('content', [
    '<link name="base"/>', '<link name="l"/><frame name="base"/>',
    '<link name="l"/><model name="base"><link name="l"/></model>',
])
def test_merged_element_with_a_name_of_the_parent_is_refused(errors_in, content):
    (error,) = errors_in(in_model(include()), arm=arm(content))
    assert error.code == 'DUPLICATE_NAME'
    assert '"base"' in error.message


@pytest.mark.parametrize(('content', 'code'), [
    ('<link name="l"><pose relative_to="base"/></link>', 'POSE_RELATIVE_TO_INVALID'),
    ('<link name="l"/><frame name="f" attached_to="base"/>', 'FRAME_ATTACHED_TO_INVALID'),
    ('<link name="l"/>' + fixed_joint('j', 'base', 'l'), 'JOINT_PARENT_LINK_INVALID'),
    ('<link name="l"/><link name="l"/>', 'DUPLICATE_NAME'),
])
def test_merged_file_has_to_be_valid_by_itself(errors_in, content, code):
    (error,) = errors_in(in_model(include()), arm=arm(content))
    assert (error.code, error.line) == (code, 2)
    assert error.file.endswith('arm.sdf')


@pytest.mark.parametrize('content', [
    '', '<link name="base"/><frame name="f" attached_to="l"/>',
    '<link name="base"/>' + fixed_joint('j', 'base', 'l'),
    f'<link name="base"><pose relative_to="{PROXY}"/></link>',
], ids=['no link', 'frame', 'joint', 'pose'])
def test_nothing_else_follows_from_a_wrong_merged_file(errors_in, content):
    main = f'<sdf version="1.9"><model name="m">{content}{include()}</model></sdf>'
    errors = errors_in(main, arm=arm('<link name="l"><pose>1 2</pose></link>'))
    assert [(error.code, error.file[-7:]) for error in errors] == [('ELEMENT_INVALID', 'arm.sdf')]


@pytest.mark.parametrize('name', ['arm', 'arm::upper', 'm'])
def test_name_of_the_merged_model_is_not_visible(errors_in, name):
    (error,) = errors_in(in_model(include() + posed('frame', 'g', '', name)))
    assert error.code == 'POSE_RELATIVE_TO_INVALID'


def test_model_is_not_merged_twice(errors_in):
    codes = {error.code for error in errors_in(in_model(include() * 2))}
    assert codes == {'DUPLICATE_NAME'}


# The merged file is checked with what the include overrides

@pytest.mark.parametrize(('text', 'content', 'code'), [
    (ARM, '<name>__x__</name>', 'RESERVED_NAME'),
    (arm('<static>1</static><frame name="f"/>'), '<static>false</static>', 'MODEL_WITHOUT_LINK'),
    (arm('<static>1</static><link name="l"/>', 'canonical_link="zzz"'), '<static>0</static>',
     'MODEL_CANONICAL_LINK_INVALID'),
    (ARM, '<pose/><placement_frame>zzz</placement_frame>', 'POSE_RELATIVE_TO_INVALID'),
    (ARM, '<pose>1 2</pose>', 'ELEMENT_INVALID'),
    (ARM, '<pose relative_to="zzz"/>', 'POSE_RELATIVE_TO_INVALID'),
    (ARM, '<pose relative_to="__root__"/>', 'ATTRIBUTE_INVALID'),
    (ARM, '<static>maybe</static>', 'ELEMENT_INVALID'),
    (ARM.replace('"arm"', '"world"'), '', 'RESERVED_NAME'),
    (arm('<frame name="f"/>'), '', 'MODEL_WITHOUT_LINK'),
    (ARM.replace('"arm"', '"arm" placement_frame="zzz"'), '', 'POSE_RELATIVE_TO_INVALID'),
])
def test_wrong_file_or_override_gives_one_error(errors_in, text, content, code):
    (error,) = errors_in(in_model(include(content)), arm=text)
    assert error.code == code


@pytest.mark.parametrize(('text', 'content'), [
    (ARM.replace('"arm"', '"world"'), '<name>arm</name>'),
    (arm('<frame name="f"/>'), '<static>true</static>'),
    (ARM.replace('"arm"', '"arm" placement_frame="zzz"'),
     '<pose/><placement_frame>f</placement_frame>'),
], ids=['name', 'static', 'placement frame'])
def test_override_corrects_a_wrong_file(scene_of, text, content):
    scene = scene_of(in_model(include(content)), arm=text)
    assert {f'm::{PROXY}', 'm::f'} < set(scene.names)


# What moves

def test_content_moves_to_the_place_of_the_include(scene_of):
    scene = scene_of(in_model(
        '<frame name="a"/>' + include() + posed('frame', 'b', '1 0 0 0 0 0', PROXY)))
    assert names_of(scene) == [
        'm', 'm::base', 'm::a', f'm::{PROXY}', 'm::upper', 'm::f', 'm::b']
    assert_at(scene, 'm::b', (1, 0, 1))


@pytest.mark.parametrize('frame', ['upper', 'f', 'n::k', '__model__'])
def test_placement_frame_of_the_file_places_the_merged_elements(scene_of, frame):
    text = arm(
        '<pose>5 0 0 0 0 0</pose>' + posed('link', 'upper', '1 0 0 0 0 0')
        + '<frame name="f" attached_to="upper"><pose>0 1 0 0 0 0</pose></frame>'
        + '<model name="n"><link name="k"><pose>0 0 1 0 0 0</pose></link></model>',
        f'placement_frame="{frame}"')
    name = f'm::{PROXY if frame == "__model__" else frame}'
    scene = scene_of(in_model(include()), arm=text)
    assert_at(scene, name, (5, 0, 0))
    proxy = scene.index(f'm::{PROXY}')
    assert scene.names[scene.placements.get(proxy, proxy)] == name


def test_proxy_frame_is_attached_to_the_canonical_link(scene_of):
    text = ARM.replace('"arm"', '"arm" canonical_link="lower"').replace(
        '<frame', '<link name="lower"/><frame')
    scene = scene_of(in_model(include()), arm=text)
    body = scene.bodies[scene.index(f'm::{PROXY}')]
    assert scene.names[body] == 'm::lower'


def test_first_merged_link_can_be_the_canonical_link_of_the_parent(scene_of):
    main = '<sdf version="1.9"><model name="m">' + include() + '<link name="l"/></model></sdf>'
    scene = scene_of(main)
    assert scene.names[scene.canonical_links[scene.index('m')]] == 'm::upper'


def test_placement_frame_that_is_renamed_by_the_merge_places_its_model(scene_of):
    scene = scene_of("""
        <sdf version="1.6">
          <model name="m">
            <link name="base"><pose>0 0 10 0 0 0</pose></link>
            <link name="f"/>
            <include merge="true">
              <uri>arm.sdf</uri>
              <pose/>
              <placement_frame>f</placement_frame>
            </include>
            <link name="last"/>
          </model>
        </sdf>""",
        arm=ARM.replace('1.9', '1.6'))
    assert_at(scene, 'm::f_frame', (0, 0, 0))
    assert_at(scene, f'm::{PROXY}', (0, -1, 0))


@pytest.mark.parametrize('params', [
    '<link element_id="upper"><pose action="modify">0 5 0 0 0 0</pose></link>',
    '<link element_id="upper" action="replace" name="upper"><pose>3 0 0 0 0 0</pose></link>',
])
def test_parameters_of_an_outer_include_do_not_place_the_merged_model_anew(scene_of, params):
    middle = in_model(include('<pose>7 0 0 0 0 0</pose><placement_frame>upper</placement_frame>'))
    scene = scene_of(
        in_world('<include><uri>middle.sdf</uri><experimental:params>' + params
                 + '</experimental:params></include>'), middle=middle)
    assert_at(scene, f'm::{PROXY}', (6, 0, 0))
    assert_at(scene, 'm::f', (6, 1, 0))


def test_parameters_of_an_outer_include_place_the_proxy_frame_in_the_plain_format(scene_of):
    middle = in_model(include('<pose degrees="true">7 0 0 0 0 90</pose>'))
    scene = scene_of(
        in_world('<include><uri>middle.sdf</uri><experimental:params>'
                 f'<frame element_id="{PROXY}"><pose action="modify">0 5 0 0 0 '
                 '1.5707963267948966</pose></frame></experimental:params></include>'),
        middle=middle)
    assert_at(scene, 'm::upper', (0, 6, 0))


def test_pose_that_is_added_to_a_merged_link_without_one_has_no_effect(scene_of):
    scene = scene_of(
        in_world('<include><uri>middle.sdf</uri><experimental:params><link element_id="lower">'
                 '<pose action="add">1 2 3 0 0 0</pose></link></experimental:params></include>'),
        middle=in_model(include('<pose>7 0 0 0 0 0</pose>')), arm=arm('<link name="lower"/>'))
    assert_at(scene, 'm::lower', (7, 0, 0))


def test_doubtful_pose_of_a_merge_is_warned_of_once(scene_of):
    visual = posed('visual', 'v', '', 'zzz')
    doubtful = '<pose>0 0 0 0 0 90</pose>'
    scene = scene_of(
        in_model(f'{include(doubtful)}\n<model name="k">{include("<name>x</name>" + doubtful)}'
                 '</model>'),
        arm=arm(f'\n<link name="l">{visual}</link>'))
    assert [(warning.code, warning.place.line) for warning in scene.warnings] == [
        ('WARNING', 2), ('WARNING', 3), *[('POSE_RELATIVE_TO_INVALID', 3)] * 2]


def test_placement_frame_in_a_cycle_is_reported_as_the_cycle_alone(errors_in):
    frame = '<frame name="{}"><pose relative_to="{}"/></frame>'
    errors = errors_in(in_model(include('<pose/><placement_frame>f</placement_frame>')),
                       arm=arm(LINK + frame.format('f', 'g') + frame.format('g', 'f')))
    assert {error.code for error in errors} == {'POSE_RELATIVE_TO_CYCLE'}


def test_other_content_of_the_merged_model_is_dropped(scene_of):
    text = arm('<static>true</static><self_collide>true</self_collide><unknown/>' + LINK)
    assert not scene_of(in_model(include()), arm=text).static_models


def test_plugins_move_with_the_content(tmp_path):
    write_files(tmp_path, main=in_model(include()), arm=arm(
        LINK + '<plugin name="p" filename="f"/>'))
    scene = load(tmp_path / 'main.sdf', plugins=True)
    assert [each.name for each in scene.plugins[scene.index('m')]] == ['p']


def test_merged_model_can_merge_another(scene_of):
    middle = in_model(include('<pose>0 0 100 0 0 0</pose>'))
    scene = scene_of(
        in_model(include('<pose>1000 0 0 0 0 0</pose>', 'middle.sdf')).replace('base', 'table'),
        middle=middle)
    assert_at(scene, 'm::upper', (1001, 0, 100))
    assert_at(scene, 'm::base', (1000, 0, 10))
    assert_at(scene, 'm::table', (0, 0, 10))
    assert {'m::_merged__arm__model__', 'm::_merged__m__model__'} < set(scene.names)


# References to the model frame

MODEL_FRAME_REFERENCES = """
    <sdf version="1.9">
      <model name="arm">
        <link name="a"><pose relative_to="__model__">1 0 0 0 0 0</pose></link>
        <link name="b"><pose>1 0 0 0 0 0</pose></link>
        <link name="c"><pose relative_to="a">1 0 0 0 0 0</pose></link>
        <frame name="f" attached_to="__model__"><pose>1 0 0 0 0 0</pose></frame>
        <frame name="g" attached_to="a"><pose relative_to="__model__">1 0 0 0 0 0</pose></frame>
        <model name="n"><pose relative_to="__model__">1 0 0 0 0 0</pose><link name="l"/></model>
        <joint name="j" type="fixed">
          <parent>__model__</parent>
          <child>b</child>
          <pose relative_to="__model__">1 0 0 0 0 0</pose>
        </joint>
      </model>
    </sdf>"""


@pytest.mark.parametrize(('name', 'x'), [
    ('a', 6), ('b', 6), ('c', 7), ('f', 6), ('g', 6), ('n', 6), ('n::l', 6), ('j', 6)])
def test_reference_to_the_model_frame_becomes_one_to_the_proxy_frame(scene_of, name, x):
    scene = scene_of(in_model(include('<pose>5 0 0 0 0 0</pose>')), arm=MODEL_FRAME_REFERENCES)
    assert_at(scene, f'm::{name}', (x, 0, 0))


@pytest.mark.parametrize('relative_to', ['', '__model__', 'a'])
@pytest.mark.parametrize('kind', KINDS_IN_MODELS, ids=lambda kind: kind.label)
def test_every_kind_in_a_model_keeps_its_place(scene_of, kind, relative_to):
    text = arm(
        posed('link', 'a', '1 0 0 0 0 1') + posed('link', 'b', '0 0 1 1 0 0')
        + part_of_model(kind, 'x', relative_to))
    main = in_model(include('<pose>5 0 0 0 0 1</pose>'))
    included = scene_of(main.replace('merge="true"', ''), arm=text)
    assert_at(scene_of(main, arm=text), 'm::x', included.pose('m::arm::x'))


def test_joint_holds_the_proxy_frame_in_place_of_the_model_frame(scene_of):
    scene = scene_of(in_model(include()), arm=MODEL_FRAME_REFERENCES)
    joint, = scene.joints
    assert [scene.names[index] for index in (joint.parent, joint.child)] == [f'm::{PROXY}', 'm::b']


def test_axis_in_the_model_frame_is_expressed_in_the_proxy_frame(scene_of):
    # The merged joint is valid in a world, which has no model frame.
    axis = '<axis><xyz expressed_in="__model__">1 0 0</xyz></axis>'
    text = arm(
        '<model name="a"><link name="l"/></model><model name="b"><link name="l"/></model>'
        + fixed_joint('j', 'a', 'b', axis))
    assert 'j' in scene_of(in_world(include()), arm=text).names


@pytest.mark.parametrize('tag', ['visual', 'collision', 'sensor', 'light'])
def test_reference_of_a_child_of_a_link_to_the_model_frame_means_the_parent(scene_of, tag):
    link = '<link name="a">' + posed(tag, 'x', '1 0 0 0 0 0', '__model__') + '</link>'
    scene = scene_of(in_model(include('<pose>5 0 0 0 0 0</pose>')), arm=arm(link))
    assert_at(scene, 'm::a::x', (1, 0, 0))
    assert warning_codes(scene) == ['WARNING']


def test_merged_poses_are_those_of_the_model_by_itself(scene_of, tmp_path):
    pose = '<pose>1 2 3 0.1 1.5707963 -0.3</pose>'
    text = arm(
        pose + posed('link', 'a', '1 2 3 0.4 0.5 0.6') + posed('link', 'b', '3 2 1 1 1 1', 'a')
        + fixed_joint('j', 'a', 'b', '<pose>0 0 1 0 0 1</pose>'))
    scene = scene_of(in_model(include()), arm=text)
    alone = load(tmp_path / 'arm.sdf')
    for name in ('a', 'b', 'j'):
        assert_at(scene, f'm::{name}', alone.pose(f'arm::{name}'))
