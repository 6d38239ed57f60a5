# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Reading elements: the top of a file, poses, scoped names, depth, what only some kinds have."""

import math

import pytest
from sdf_texts import (
    assert_at,
    codes_of,
    errors_of,
    errors_of_file,
    errors_of_files,
    fixed_joint,
    INCLUDES_LEAF,
    joint,
    LINK,
    LINK_CHILDREN,
    link_with,
    model_file,
    names_of,
    only_error,
    posed,
    scene_from_files,
    TWO_LINKS,
    warning_codes,
    world_file,
    write_files,
)

from sdf_pose_bridge import load, load_text

WAYPOINT = ('<actor name="a"><script><trajectory id="0" type="walk"><waypoint><time>0</time>'
            '<pose>{}</pose></waypoint></trajectory></script></actor>')


# The top of a file

@pytest.mark.parametrize(('second', 'code'), [
    ('<model name="k"><link name="l"/></model>', 'ELEMENT_INCORRECT_TYPE'),
    ('<light name="k" type="point"/>', 'ELEMENT_INCORRECT_TYPE'),
    ('<actor name="k"/>', 'ELEMENT_INCORRECT_TYPE'),
    ('<model name="m"><link name="l"/></model>', 'DUPLICATE_NAME'),
])
def test_second_element_at_the_top_is_refused_by_its_name(second, code):
    error = only_error(model_file(LINK).replace('</sdf>', second + '</sdf>'))
    assert error.code == code
    assert ('"m"' if code == 'DUPLICATE_NAME' else '"k"') in error.message


def test_second_pose_is_ignored_with_a_warning():
    scene = load_text(link_with(
        '<pose>1 0 0 0 0 0</pose><pose relative_to="x">2 0 0 0 0 0</pose>'))
    assert scene.pose('m::l').x == 1.0
    assert [warning.message for warning in scene.warnings] == [
        'a second <pose> is ignored; the first one counts']


@pytest.mark.parametrize('tag', ['light', 'actor'])
def test_light_or_actor_at_the_top(tag):
    scene = load_text(f'<sdf version="1.9">{posed(tag, "x", "1 2 3 0 0 0")}</sdf>')
    assert_at(scene, 'x', (1, 2, 3))


LINK_OF_ACTOR = '<link name="l"><pose relative_to="nowhere">1 0 0 0 0 0</pose>{}</link>'


@pytest.mark.parametrize(('content', 'code'), [
    ('<visual name="v"><geometry/></visual>' * 2, 'DUPLICATE_NAME'),
    ('<sensor name="s" type="nose"/>', 'ATTRIBUTE_INVALID'),
    ('<visual name="v"><geometry/><material><script><name>n</name></script></material></visual>',
     'ELEMENT_INVALID'),
    ('<visual name="v"><pose>1 2</pose><geometry/></visual>', 'ELEMENT_INVALID'),
])
def test_wrong_content_of_a_link_of_an_actor_is_refused(content, code):
    text = world_file(f'<actor name="a">{LINK_OF_ACTOR.format(content)}</actor>')
    assert codes_of(text) == [code]


def test_links_and_joints_of_an_actor_are_no_elements():
    joint = '<joint name="j" type="fixed"><parent>l</parent><child>nowhere</child></joint>'
    content = LINK_OF_ACTOR.format('<visual name="v"><geometry/></visual>')
    scene = load_text(world_file(f'<actor name="a">{content * 2}{joint * 2}</actor>'))
    assert (scene.names, scene.warnings) == (('world', 'a'), ())


def test_world_beside_a_model():
    text = '<sdf version="1.9"><world name="w"/><model name="m"><link name="l"/></model></sdf>'
    assert load_text(text).names == ('world', '__root__', 'm', 'm::l')


@pytest.mark.parametrize('content', ['', '<frame name="f"/>', '<link name="l"/>', '<x:model/>'])
def test_file_without_elements_at_its_top(content):
    assert names_of(load_text(f'<sdf version="1.9">{content}</sdf>')) == []


# Names with the separator

@pytest.mark.parametrize('text', [
    '<sdf version="1.9"><model name="a::b"><link name="l"/></model></sdf>',
    model_file('<link name="a::b"/>'),
    model_file(LINK + '<frame name="::"/>'),
    link_with('<visual name="a::b"/>'),
    model_file(LINK + '<gripper name="a::b"/>'),
    model_file(LINK + '<audio name="a::b" filename="f"/>'),
    model_file(LINK + '<unknown name="a::b"/>'),
    world_file('<physics name="a::b" type="ode"/>'),
])
def test_name_with_the_separator_is_refused(text):
    assert codes_of(text)[0] == 'RESERVED_NAME'


def test_name_with_the_separator_in_an_old_file_that_a_newer_file_includes_is_refused(tmp_path):
    (error,) = errors_of_files(
        tmp_path, main=INCLUDES_LEAF, leaf=model_file('<link name="a::b"/>', version='1.6'))
    assert (error.code, error.file) == ('RESERVED_NAME', str(tmp_path / 'leaf.sdf'))


def test_name_with_the_separator_in_an_old_file_is_accepted():
    scene = load_text(model_file('<link name="a::b"/>', version='1.7'))
    assert names_of(scene) == ['m', 'm::a::b']


@pytest.mark.parametrize('attributes', ['', 'merge="true"'])
def test_name_of_an_include_with_the_separator_in_an_old_file_is_accepted(tmp_path, attributes):
    include = f'<include {attributes}><uri>leaf.sdf</uri><name>a::b</name></include>'
    main = model_file('<link name="k"/>' + include, version='1.6')
    scene = scene_from_files(tmp_path, leaf=model_file(LINK), main=main)
    assert 'm::k' in scene.names


@pytest.mark.parametrize('content', [
    '<plugin name="p" filename="f"><link name="a::b"><pose>no</pose></link></plugin>',
    '<plugin name="p" filename="f"><model name="world"/></plugin>',
    '<x:y><link name="a::b"/></x:y>',
])
def test_foreign_elements_are_not_read(content):
    assert names_of(load_text(model_file(LINK + content))) == ['m', 'm::l']


# Elements of a state

def test_light_of_a_state_needs_no_type():
    light = '<light name="sun"><pose>0 0 1 0 0 0</pose></light>'
    assert names_of(load_text(world_file(f'<state world_name="w">{light}</state>'))) == []


@pytest.mark.parametrize(('content', 'code'), [
    ('<light/>', 'ATTRIBUTE_MISSING'),
    ('<insertions><light name="sun"/></insertions>', 'ATTRIBUTE_MISSING'),
    ('<model name="m"><pose>1 2</pose></model>', 'ELEMENT_INVALID'),
])
def test_wrong_element_of_a_state_is_refused(content, code):
    assert codes_of(world_file(f'<state world_name="w">{content}</state>')) == [code]


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
def test_wrong_pose_is_refused(pose):
    assert codes_of(link_with(pose)) == ['ELEMENT_INVALID']


@pytest.mark.parametrize('content', [
    '<link name="k"><pose>&#160;</pose></link>', '<static>\u2003</static>',
    '<link name="k"><inertial><mass>\u0085</mass></inertial></link>',
    '<link name="k"><pose><!-- c -->&#160;<!-- c -->0 0 0 0 0 0</pose></link>'])
def test_white_space_of_unicode_is_no_blank_value(content):
    assert codes_of(model_file(LINK + content)) == ['ELEMENT_INVALID']


def test_carriage_return_is_part_of_an_attribute():
    scene = load_text(model_file('<link name="&#13;x"/>' + posed('frame', 'f', '', '&#13;x')))
    assert names_of(scene) == ['m', 'm::\rx', 'm::f']


@pytest.mark.parametrize('value', ['yes', 'maybe', '2', 'true false', 'tru', '&#13;true'])
def test_degrees_that_are_no_boolean_are_refused(value):
    error = only_error(link_with(f'<pose degrees="{value}"/>'))
    assert error.code == 'ATTRIBUTE_INVALID'
    assert 'is not a boolean' in error.message


@pytest.mark.parametrize('text', [
    model_file('<pose>zz</pose>' + LINK),
    *(model_file(TWO_LINKS + content) for content in (
        posed('frame', 'f', 'zz'), '<model name="n"><pose>zz</pose><link name="l"/></model>',
        '<joint name="j" type="fixed"><parent>a</parent><child>b</child><pose>zz</pose></joint>')),
    *(world_file(content) for content in (
        posed('frame', 'f', 'zz'), posed('light', 'f', 'zz'), posed('actor', 'f', 'zz'),
        '<gui><camera name="c"><pose>zz</pose></camera></gui>',
        '<state world_name="w"><model name="m"><pose>zz</pose></model></state>',
        WAYPOINT.format('zz'))),
    *(link_with(posed(tag, 'x', 'zz')) for tag in LINK_CHILDREN),
    *map(link_with, (
        '<inertial><pose>zz</pose></inertial>',
        '<sensor name="s" type="camera"><camera><pose>zz</pose></camera></sensor>',
        '<audio_source><uri>a.wav</uri><pose>zz</pose></audio_source>',
        '<audio_source><pose>1 2</pose></audio_source>',
        '<pose>1 0 0 0 0 0</pose><pose>zz</pose>')),
])
def test_every_pose_is_checked(text):
    assert codes_of(text) == ['ELEMENT_INVALID']


@pytest.mark.parametrize('text', [
    link_with('<sensor name="s" type="camera"><camera><pose>1 0 0 0 0 0</pose></camera></sensor>'),
    world_file('<gui><camera name="c"><pose relative_to="x">1 0 0 0 0 0</pose></camera></gui>'),
    world_file('<state world_name="w"><model name="m"><pose>1 0 0 0 0 0</pose></model></state>'),
    world_file(WAYPOINT.format('1 0 0 0 0 0')),
])
def test_poses_that_are_no_frames_move_nothing(text):
    assert not load_text(text).poses[:, :3].any()


@pytest.mark.parametrize(('attributes', 'yaw_rad'), [
    *((each, 1.0) for each in (
        'degrees=""', 'degrees=" "', 'degrees="false"', 'degrees="0"', 'degrees=" FALSE "',
        'rotation_format=""', 'rotation_format=" "', 'rotation_format=" euler_rpy "',
        'relative_to=""', 'relative_to=" "', 'frame="x"', 'unknown="x"')),
    *((f'degrees="{each}"', math.pi / 180.0) for each in ('true', '1', ' True ', 'TRUE')),
])
def test_angles_are_radians_unless_degrees_are_true(attributes, yaw_rad):
    scene = load_text(link_with(f'<pose {attributes}>1 0 0 0 0 1</pose>'))
    assert_at(scene, 'm::l', (1, 0, 0, 0, 0, math.sin(yaw_rad / 2.0), math.cos(yaw_rad / 2.0)))


# References that have no effect

@pytest.mark.parametrize('text', [
    link_with('<inertial><pose relative_to="nowhere">1 0 0 0 0 0</pose></inertial>'),
    world_file('<actor name="a"><pose relative_to="nowhere">1 0 0 0 0 0</pose></actor>'),
    f'<sdf version="1.9">{posed("light", "x", "1 0 0 0 0 0", "y")}</sdf>',
])
def test_reference_that_has_no_effect_is_ignored_with_a_warning(text):
    scene = load_text(text)
    assert warning_codes(scene) == ['WARNING']
    assert scene.poses[-1, 0] == 1.0


# Depth: libxml2 allows 256 levels in one file, so more need several files

TOO_DEEP = 'the file exceeds the limits of a load: the limit depth is 300'


def nested_models(depth, content):
    return '<model name="mm"><pose>0 0 1 0 0 0</pose>' * depth + content + '</model>' * depth


def file_of_nested_models(depth, content):
    return f'<sdf version="1.9">{nested_models(depth, content)}</sdf>'


def write_nested_files(folder, count, depth, attributes=''):
    """Write files of nested models, each of which includes the next in its innermost model."""
    for number in range(count):
        include = f'<include {attributes}><uri>{number + 1}.sdf</uri></include>'
        content = include if number < count - 1 else LINK
        write_files(folder, **{str(number): file_of_nested_models(depth, content)})
    return folder / '0.sdf'


@pytest.mark.parametrize('attributes', ['', 'merge="true"'])
@pytest.mark.parametrize(('count', 'depth'), [(2, 160), (4, 100), (60, 7), (64, 250)])
def test_elements_nested_too_deep_over_several_files_are_refused(
        tmp_path, count, depth, attributes):
    (error,) = errors_of_file(write_nested_files(tmp_path, count, depth, attributes))
    assert (error.code, error.message) == ('LIMIT', TOO_DEEP)


def test_elements_added_too_deep_are_refused(tmp_path):
    params = ('<experimental:params><model element_id="' + '::'.join(['mm'] * 199)
              + '" name="added" action="add">' + nested_models(150, LINK)
              + '</model></experimental:params>')
    (error,) = errors_of_files(
        tmp_path, leaf=file_of_nested_models(200, LINK),
        main=world_file(f'<include><uri>leaf.sdf</uri>{params}</include>'))
    assert (error.message, error.file) == (TOO_DEEP, str(tmp_path / 'main.sdf'))


@pytest.mark.parametrize('depth', [200, 250])
def test_deep_elements_in_one_file_are_read(depth):
    scene = load_text(file_of_nested_models(depth, LINK))
    assert_at(scene, '::'.join(['mm'] * depth + ['l']), (0, 0, depth))


def test_deep_elements_over_several_files_are_read(tmp_path):
    scene = load(write_nested_files(tmp_path, 14, 20))
    assert_at(scene, '::'.join(['mm'] * 280 + ['l']), (0, 0, 280))


def test_error_in_a_deep_element_has_its_path():
    error = only_error(file_of_nested_models(200, '<link name="l"><pose>1 2</pose></link>'))
    assert error.element == '/sdf' + '/model[@name="mm"]' * 200 + '/link[@name="l"]/pose'


# The implicit root cannot be named

@pytest.mark.parametrize(('content', 'attributes', 'code'), [
    ('<frame name="f"><pose relative_to="__root__"/></frame>', '', 'ATTRIBUTE_INVALID'),
    ('<frame name="f" attached_to="__root__"/>', '', 'ATTRIBUTE_INVALID'),
    ('', 'canonical_link="__root__"', 'ATTRIBUTE_INVALID'),
    ('', 'placement_frame="__root__"', 'ATTRIBUTE_INVALID'),
    (fixed_joint('j', '__root__', 'l'), '', 'RESERVED_NAME'),
    (fixed_joint('j', 'l', '__root__'), '', 'RESERVED_NAME'),
])
def test_reference_to_the_implicit_root_is_refused(content, attributes, code):
    error = errors_of(model_file(LINK + content, attributes=attributes))[0]
    assert error.code == code
    assert '"__root__"' in error.message


# Models

@pytest.mark.parametrize(('value', 'is_static'), [
    ('true', True), (' 1 ', True), ('TRUE', True), ('false', False), ('0', False), ('', False),
])
def test_model_is_static(value, is_static):
    scene = load_text(model_file(f'<static>{value}</static>' + LINK))
    assert (scene.index('m') in scene.static_models) == is_static


def test_nested_model_of_a_static_model_is_not_static():
    scene = load_text(model_file('<static>true</static><model name="n"><link name="l"/></model>'))
    assert scene.static_models == {scene.index('m')}


def sensor_with(content, sensor_type='custom'):
    scene = load_text(link_with(f'<sensor name="s" type="{sensor_type}">{content}</sensor>'))
    return scene.sensors[scene.index('m::l::s')]


def test_sensor_has_a_type():
    assert sensor_with('', ' imu ').type == 'imu'


@pytest.mark.parametrize(('content', 'frame_id'), [
    ('', ''),
    ('<gz_frame_id/>', ''),
    ('<gz_frame_id>a/b</gz_frame_id>', 'a/b'),
    ('<ignition_frame_id>a</ignition_frame_id>', ''),
    ('<gz_frame_id>old</gz_frame_id><frame_id>new</frame_id>', 'new'),
    ('<gz_frame_id>old</gz_frame_id><frame_id/>', 'old'),
])
def test_sensor_has_a_frame_id(content, frame_id):
    assert sensor_with(content).frame_id == frame_id


@pytest.mark.parametrize(('content', 'frame_id'), [
    ('<gz_frame_id> a </gz_frame_id><frame_id>b</frame_id>', 'a'), ('<frame_id>b</frame_id>', ''),
])
def test_harmonic_reads_one_element(content, frame_id):
    assert sensor_with(content).older_frame_id == frame_id


@pytest.mark.parametrize(('sensor_type', 'content', 'is_camera', 'optical_frame_id'), [
    ('custom', '', False, ''),
    ('custom', '<optical_frame_id>eye</optical_frame_id>', False, ''),
    ('custom', '<camera/>', True, ''),
    ('custom', '<camera><optical_frame_id>eye</optical_frame_id></camera>', True, 'eye'),
    ('gpu_lidar', '', False, ''), *((each, '', True, '') for each in (
        'camera depth_camera rgbd_camera thermal_camera segmentation_camera boundingbox_camera '
        'wide_angle_camera wideanglecamera multicamera thermal').split()),
])
def test_sensor_is_a_camera_by_its_type_or_content(
        sensor_type, content, is_camera, optical_frame_id):
    details = sensor_with(content, sensor_type)
    assert (details.is_camera, details.optical_frame_id) == (is_camera, optical_frame_id)


# What is URDF

def test_elements_of_urdf_are_kept():
    transmission = (
        '<transmission name="t">\n  <!-- a -->\n  <joint name="j"> b\n</joint>\n</transmission>')
    scene = load_text(model_file(
        f'{LINK}<ros2_control name="c"/>\n{transmission} <model name="n">{LINK}</model>'))
    assert dict(scene.urdf_texts) == {
        scene.index('m'): ('<ros2_control name="c"/>', transmission)}
    assert [warning.message for warning in scene.warnings] == [
        f'<{tag}> in <model> is not defined in SDFormat; URDF that is made of the model has it'
        for tag in ('ros2_control', 'transmission')]


# Hints

def test_nearest_type_is_named():
    text = model_file(TWO_LINKS + joint('<parent>a</parent><child>b</child>', joint_type='fix'))
    assert only_error(text).message.endswith('universal; did you mean "fixed"?')


@pytest.mark.parametrize('text', ['<sdf version="1.9"/>', '<sdf version="1.9"><!-- a --></sdf>'])
def test_file_with_nothing_in_it_is_a_warning(text):
    (warning,) = load_text(text).warnings
    assert warning.message == 'the file has no world, model, light or actor'
