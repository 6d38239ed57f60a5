# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Values that no pose depends on, but that libsdformat refuses."""

import math

import pytest

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st
from sdf_texts import codes_of, link_with, model_file, only_error, TWO_LINKS, world_file

from sdf_pose_bridge import load_text
from sdf_pose_bridge.sdformat.grammar import Definition
from sdf_pose_bridge.sdformat.values import boolean_from_text, judged_value, numbers_from_text


def value_of(value_type):
    """Return the rule for values of a type."""
    return Definition('x', f':{value_type}').value


def visual(content):
    return link_with(f'<visual name="v">{content}</visual>')


def ambient(text):
    return visual(f'<material><ambient>{text}</ambient></material>')


def box(size):
    return visual(f'<geometry><box><size>{size}</size></box></geometry>')


def axis(content):
    return model_file(
        TWO_LINKS + '<joint name="j" type="revolute"><parent>a</parent><child>b</child>'
        f'<axis>{content}</axis></joint>')


def surface(content):
    return link_with(f'<collision name="c"><surface>{content}</surface></collision>')


def ode(content):
    return surface(f'<friction><ode>{content}</ode></friction>')


def spherical_coordinates(content):
    return world_file(f'<spherical_coordinates>{content}</spherical_coordinates>')


def model(content):
    return model_file(f'<link name="l"/>{content}')


def mass(text):
    return link_with(f'<inertial><mass>{text}</mass></inertial>')


REFUSED = {
    'ELEMENT_INVALID': {
        mass: ['heavy', '-1e400', '1e-400'],
        link_with: ['<gravity>maybe</gravity>'],
        world_file: [
            '<gravity/>', '<physics type="ode"><max_step_size> </max_step_size></physics>',
            '<gui><camera name="c"><pose rotation_format="x"/></camera></gui>',
            '<atmosphere type="thin"/>'],
        box: ['', '1 x 1 1', '1,1,1'],
        visual: [
            '<transparency>,</transparency>', '<visibility_flags>x1</visibility_flags>'],
        ambient: ['1 1 2 1', '1 1 5e-0_1', '1 1 1 1 1', '1 1 1 red', '1 1 -0.1'],
        axis: [
            '<xyz>0 0 9.999999974752427e-7</xyz>', '<xyz>0 1</xyz>',
            '<xyz>0 0 1</xyz><limit><lower>low</lower></limit>'],
        ode: ['<mu>-1</mu>'],
        surface: ['<bounce><restitution_coefficient>1.1</restitution_coefficient></bounce>'],
        model: ['<static>2</static>', '<static>-1</static>'],
        spherical_coordinates: [
            '<surface_model>MARS</surface_model>',
            '<world_frame_orientation>NED</world_frame_orientation>'],
    },
    'ATTRIBUTE_MISSING': {
        link_with: ['<light name="x"/>', '<sensor name="x"/>'],
        model: [
            '<plugin name="p"/>', '<gripper/>',
            '<link name="k"/><joint name="j"><parent>l</parent><child>k</child></joint>'],
    },
    'ATTRIBUTE_INVALID': {
        link_with: [
            '<sensor name="x" type=""/>', '<light name="x" type=" "/>', '<inertial auto="maybe"/>',
            '<sensor name="s" type="eye"/>', '<sensor name="s" type="Camera"/>',
            '<light name="s" type="bulb"/>', '<particle_emitter name="s" type="sphere"/>'],
        model: ['<plugin name="p" filename=""/>', '<gripper name=""/>'],
        world_file: ['<gui fullscreen="2"/>'],
    },
}
"""Contents of files or elements, by the code of the error."""


@pytest.mark.parametrize(('code', 'file_with', 'content'), [
    (code, file_with, content) for code, files in REFUSED.items()
    for file_with, contents in files.items() for content in contents])
def test_wrong_value_is_refused(code, file_with, content):
    assert codes_of(file_with(content)) == [code]


ACCEPTED = {
    mass: [' 1.5kg ', '', ' \n ', 'true', '1_000', 'inf', '1e-300'],
    link_with: ['<gravity>1</gravity>', '<unknown><mass>heavy</mass></unknown>'],
    box: ['1 1 1 1'],
    visual: [
        '<visibility_flags>0x0F</visibility_flags>', '<transparency>-.5</transparency>',
        '<transparency>5.</transparency>',
        '<material><render_order>1.2e-38</render_order></material>'],
    ambient: ['1 1 0.5', '1 1 nan', '1 1_0 0.5x', '1 1_0 0.5'],
    axis: ['<xyz>0 0 9.99999997475243e-7</xyz>'],
    ode: ['<mu>1e9</mu>'],
    surface: ['<bounce><restitution_coefficient>1_0</restitution_coefficient></bounce>'],
    model: [
        '<plugin name="p" filename="f"><inertial><mass>x</mass></inertial><plugin/></plugin>',
        '<x:inertial><mass>heavy</mass></x:inertial>'],
}


@pytest.mark.parametrize(('file_with', 'content'), [
    (file_with, content) for file_with, contents in ACCEPTED.items() for content in contents])
def test_value_that_libsdformat_accepts_is_accepted(file_with, content):
    assert load_text(file_with(content)).names


@pytest.mark.parametrize('text', [
    mass(' ' * 100_000), axis(f'<xyz>{" " * 100_000}1 0 0</xyz>'),
], ids=['a number', 'an axis'])
def test_long_runs_of_white_space_are_read_fast(text):
    assert load_text(text).names


def test_message_has_the_value_the_element_and_the_rule():
    error = only_error(model('<static>maybe</static>'))
    assert error.message == '"maybe" of <static> is not a boolean (true, false, 1 or 0)'


def test_message_has_the_range():
    assert only_error(ode('<mu>-1</mu>')).message == '"-1" of <mu> must be at least 0'


def test_long_value_is_cut_in_the_message():
    assert len(only_error(visual(f'<transparency>{"x" * 10_000}</transparency>')).message) < 200


# Where libsdformat stops at what it does not know, it drops the rest of a number, but not of three

@pytest.mark.parametrize(('text', 'value_type'), [
    ('nan 0 1', 'vector3'), ('1 inf 1', 'vector3'),
    ('1 1 1e999', 'vector3'), ('1abc 2 3', 'vector3'),
    ('1e 2 3', 'vector3'), ('1 2 x', 'axis'),
    ('1,2', 'vector2'),
    ('1e999', 'double'), ('1e-400', 'double'), ('truex', 'double'),
    ('1e39', 'float'), ('-1e-38', 'float'), ('x', 'float'),
    ('2147483648', 'int'), ('-2147483649', 'int'),
    ('18446744073709551616', 'uint'), ('0x', 'time'),
    ('9' * 5000, 'int'), ('0x1' + '0' * 5000, 'double'),
    ('1', 'time'), ('1.5 2', 'time'), ('1 2147483648', 'time'),
    ('1 1 1e-320', 'color'),
    ('x', 'double'), ('.', 'double'), ('\u00bd', 'double'),
    ('\u0661', 'double'), ('.5', 'int'), ('\u0661', 'int'),
    ('1 2', 'vector3'), ('1 1 \u0661', 'vector3'),
    ('1', 'vector2'), ('yes', 'bool'), ('1 2', 'color'),
    ('0 0 0 0 0', 'color'), ('1 1 1.5', 'color'),
])
def test_text_that_is_not_of_a_type(text, value_type):
    fault, _ = judged_value(text, value_of(value_type))
    assert fault


@pytest.mark.parametrize(('text', 'value_type', 'numbers'), [
    ('1.22.28 0.26', 'vector3', [1.22, 0.28, 0.26]),
    ('1-2-3', 'vector3', [1, -2, -3]),
    ('1 2 3abc', 'vector3', [1, 2, 3]),
    ('1 2 0x10', 'vector3', [1, 2, 0]),
    ('1 2 1e-400', 'vector3', [1, 2, 0]),
    ('1 2 3 4', 'vector3', [1, 2, 3]),
    ('0x10', 'int', [16]), ('-0x10', 'int', [0]),
    ('0XfF', 'uint', [255]), ('-1', 'uint', [-1]),
    ('4294967296', 'uint', [4294967296]), ('1.5', 'int', [1]),
    ('0x1p3', 'double', [8]), ('1.5abc', 'double', [1.5]),
    ('1_0', 'double', [1]), ('TRUE', 'double', [1]),
    ('-inf', 'double', [-math.inf]), ('12 34', 'time', [12, 34]),
    ('+.5 5.', 'vector2', [0.5, 5]),
])
def test_numbers_as_libsdformat_reads_them(text, value_type, numbers):
    assert list(numbers_from_text(text, value_of(value_type).value_type)) == numbers


@pytest.mark.parametrize(('text', 'warning'), [
    (box('1.22.28 0.26'), '"1.22.28 0.26" of <size> is read as 1.22 0.28 0.26, as by Gazebo'),
    (mass('1,5'), '"1,5" of <mass> is read as 1, as by Gazebo'),
    (link_with('<pose>1.5m 0 0 0 0 0</pose>'),
     'the pose "1.5m 0 0 0 0 0" is read as 1.5 0 0 0 0 0, as by Gazebo'),
    (link_with('<pose>1 0 0 0 0 0</pose><pose>1, 0 0 0 0 0</pose>'),
     'the pose "1, 0 0 0 0 0" is read as 1 0 0 0 0 0, as by Gazebo'),
    (visual('<material><pbr><metal><light_map uv_set="1.5">m</light_map></metal></pbr>'
            '</material>'),
     'uv_set="1.5" of <light_map> is read as 1, as by Gazebo'),
])
def test_numbers_that_are_read_otherwise_have_a_warning(text, warning):
    assert warning in [each.message for each in load_text(text).warnings]


def test_mask_in_hexadecimal_has_no_warning():
    mask = '<contact><collide_bitmask>0x0F</collide_bitmask></contact>'
    assert not load_text(surface(mask)).warnings


@pytest.mark.parametrize(
    'value_type', ['string', 'frame', 'bool', 'double', 'vector3', 'axis', 'color'])
@given(st.data())
def test_frequent_form_needs_no_other_check(value_type, data):
    rule = Definition('x', f'!:{value_type}').value
    text = data.draw(st.from_regex(rule.is_plain.__self__, fullmatch=True))
    assert judged_value(text, rule) == ('', '')


@pytest.mark.parametrize(('text', 'value_type'), [
    ('__root__', 'frame'), ('0 0 0', 'axis'), ('0.0 0 0.0000001', 'axis'), ('1e-9 0 0', 'axis'),
    (' ', 'string'), ('1 1 2', 'color'), ('True', 'bool')])
def test_form_that_may_be_wrong_is_checked(text, value_type):
    assert not value_of(value_type).is_plain(text)


@pytest.mark.parametrize('text', ['1 2 3', ' 1\t2\n3 ', '+1 .5 1e-3', '1. 2. 3.'])
def test_plain_numbers_have_no_warning(text):
    assert not load_text(box(text)).warnings


def state(content):
    return world_file(f'<state world_name="w">{content}</state>')


@pytest.mark.parametrize(('content', 'right', 'wrong'), [
    ('<model_state name="m"><pose>{}</pose></model_state>', '1 2 3 0 0 0', '1 2'),
    ('<model_state name="m"><link_state name="l"><force>{}</force></link_state></model_state>',
     '1 2 3', '1 2'),
    (('<model_state name="m"><joint_state name="j"><axis_state><position degrees="true">{}'
      '</position></axis_state></joint_state></model_state>'), '90', 'x'),
    ('<light_state name="s"><pose>{}</pose></light_state>', '', '1 2'),
    ('<joint_state name="j"><axis2_state><effort>{}</effort></axis2_state></joint_state>',
     '1', 'x'),
])
def test_values_of_a_state_by_the_names_of_version_1_12(content, right, wrong):
    scene = load_text(state(content.format(right)))
    assert (scene.names, scene.warnings) == (('world',), ())
    assert codes_of(state(content.format(wrong))) == ['ELEMENT_INVALID']


@pytest.mark.parametrize('content', [
    '<model_state name="m"><link name="l"><wrench>1 2</wrench></link></model_state>',
    '<model_state name="m"><joint name="j"><angle axis="0">x</angle></joint></model_state>',
    '<model name="m"><link_state name="l"><force>1 2</force></link_state></model>',
    '<model name="m"><link name="l"><force>1 2</force></link></model>',
])
def test_old_and_new_names_in_one_state_are_not_defined(content):
    (warning,) = load_text(state(content)).warnings
    assert ' is not defined in SDFormat' in warning.message


def test_state_of_a_model_in_the_model_has_no_frames():
    model_state = '<model_state name="s"><frame name="f"/><pose>1 0 0 0 0 0</pose></model_state>'
    scene = load_text(link_with('').replace('</model>', model_state + '</model>'))
    assert scene.names == ('__root__', 'm', 'm::l')


def test_horizontal_fov_may_be_as_small_as_any_libsdformat_reads():
    sensor = ('<sensor name="s" type="camera"><camera><horizontal_fov>{}</horizontal_fov></camera>'
              '</sensor>')
    load_text(link_with(sensor.format('0.001')))
    assert codes_of(link_with(sensor.format('0.0009'))) == ['ELEMENT_INVALID']


@pytest.mark.parametrize('tag', ['sim_time', 'wall_time', 'real_time'])
def test_time_of_a_state_is_two_integers(tag):
    assert not load_text(state(f'<{tag}>12 345</{tag}>')).warnings
    assert codes_of(state(f'<{tag}>12.5</{tag}>')) == ['ELEMENT_INVALID']


def test_empty_pose_of_a_waypoint_is_refused():
    waypoint = '<waypoint><time>0</time><pose>{}</pose></waypoint>'
    actor = ('<actor name="a"><script><trajectory id="0" type="t">{}</trajectory></script>'
             '<link name="l"/></actor>')
    load_text(world_file(actor.format(waypoint.format('1 2 3 0 0 0'))))
    assert codes_of(world_file(actor.format(waypoint.format('')))) == ['ELEMENT_INVALID']


# Booleans

@pytest.mark.parametrize(('value', 'texts'), [
    (True, ['true', 'True', 'TRUE', '1']),
    (False, ['false', 'False', 'FALSE', '0']),
    (None, ['yes', 'no', 't', '2', '-1', '01', '1.0', 'tru e', '\u0661', '\u00a01', ' 1', '']),
])
def test_boolean(value, texts):
    assert [boolean_from_text(text) for text in texts] == [value] * len(texts)


# Choices

def test_case_counts_in_a_choice_but_for_types_of_joints():
    def text(joint_type, light_type):
        return model_file(
            f'{TWO_LINKS}<joint name="j" type="{joint_type}"><parent>a</parent><child>b</child>'
            f'</joint><link name="l"><light name="i" type="{light_type}"/></link>')

    assert load_text(text('FIXED', 'spot')).joints[0].type == 'fixed'
    assert 'type="Spot" of <light> must be one of directional, point, spot' in str(
        only_error(text('fixed', 'Spot')))


def test_type_in_a_state_is_not_read():
    load_text(world_file(
        '<state world_name="w"><insertions><light name="l" type="bulb"/></insertions></state>'))
