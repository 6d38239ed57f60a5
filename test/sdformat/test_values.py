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
from sdf_pose_bridge.sdformat.grammar import Definition, ValueType
from sdf_pose_bridge.sdformat.values import boolean_from_text, judged_value, numbers_from_text


def is_of_type(text, value_type):
    fault, _ = judged_value(text, Definition('x', f':{value_type.label}').value)
    return not fault


def visual(content):
    return link_with(f'<visual name="v">{content}</visual>')


def material(content):
    return visual(f'<material>{content}</material>')


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


REFUSED = {
    'ELEMENT_INVALID': [
        link_with('<inertial><mass>heavy</mass></inertial>'),
        link_with('<inertial><mass>-1e400</mass></inertial>'),
        link_with('<inertial><mass>1e-400</mass></inertial>'),
        link_with('<gravity>maybe</gravity>'),
        world_file('<gravity/>'),
        world_file('<physics type="ode"><max_step_size> </max_step_size></physics>'),
        world_file('<gui><camera name="c"><pose rotation_format="x"/></camera></gui>'),
        box(''),
        box('1 x 1 1'),
        box('1,1,1'),
        visual('<transparency>,</transparency>'),
        visual('<visibility_flags>x1</visibility_flags>'),
        material('<ambient>1 1 2 1</ambient>'),
        material('<ambient>1 1 5e-0_1</ambient>'),
        material('<ambient>1 1 1 1 1</ambient>'),
        material('<ambient>1 1 1 red</ambient>'),
        material('<ambient>1 1 -0.1</ambient>'),
        axis('<xyz>0 0 9.9e-7</xyz>'),
        axis('<xyz>0 1</xyz>'),
        axis('<xyz>0 0 1</xyz><limit><lower>low</lower></limit>'),
        ode('<mu>-1</mu>'),
        surface('<bounce><restitution_coefficient>1.1</restitution_coefficient></bounce>'),
        model_file('<link name="l"/><static>2</static>'),
        model_file('<static>-1</static><link name="l"/>'),
        world_file('<atmosphere type="thin"/>'),
        spherical_coordinates('<surface_model>MARS</surface_model>'),
        spherical_coordinates('<world_frame_orientation>NED</world_frame_orientation>'),
    ],
    'ATTRIBUTE_MISSING': [
        link_with('<light name="x"/>'),
        link_with('<sensor name="x"/>'),
        model_file('<link name="l"/><plugin name="p"/>'),
        model_file('<link name="l"/><gripper/>'),
        model_file(TWO_LINKS + '<joint name="j"><parent>a</parent><child>b</child></joint>'),
    ],
    'ATTRIBUTE_INVALID': [
        link_with('<sensor name="x" type=""/>'),
        link_with('<light name="x" type=" "/>'),
        model_file('<link name="l"/><plugin name="p" filename=""/>'),
        model_file('<link name="l"/><gripper name=""/>'),
        link_with('<inertial auto="maybe"/>'),
        world_file('<gui fullscreen="2"/>'),
        link_with('<sensor name="s" type="eye"/>'),
        link_with('<sensor name="s" type="Camera"/>'),
        link_with('<light name="s" type="bulb"/>'),
        link_with('<particle_emitter name="s" type="sphere"/>'),
    ],
}


@pytest.mark.parametrize(('code', 'text'), [
    (code, text) for code, texts in REFUSED.items() for text in texts])
def test_wrong_value_is_refused(code, text):
    assert codes_of(text) == [code]


@pytest.mark.parametrize('text', [
    link_with('<inertial><mass> 1.5kg </mass></inertial>'),
    link_with('<inertial><mass/></inertial>'),
    link_with('<inertial><mass> \n </mass></inertial>'),
    link_with('<inertial><mass>true</mass></inertial>'),
    link_with('<inertial><mass>1_000</mass></inertial>'),
    link_with('<gravity>1</gravity>'),
    box('1 1 1 1'),
    visual('<visibility_flags>0x0F</visibility_flags>'),
    visual('<transparency>-.5</transparency>'),
    visual('<transparency>5.</transparency>'),
    material('<ambient>1 1 0.5</ambient>'),
    material('<ambient>1 1 nan</ambient>'),
    material('<render_order>1.2e-38</render_order>'),
    link_with('<inertial><mass>inf</mass></inertial>'),
    link_with('<inertial><mass>1e-300</mass></inertial>'),
    material('<ambient>1 1_0 0.5x</ambient>'),
    material('<ambient>1 1_0 0.5</ambient>'),
    axis('<xyz>0 0 1e-6</xyz>'),
    ode('<mu>1e9</mu>'),
    surface('<bounce><restitution_coefficient>1_0</restitution_coefficient></bounce>'),
    link_with('<unknown><mass>heavy</mass></unknown>'),
    model_file('<link name="l"/><plugin name="p" filename="f"><inertial><mass>x</mass></inertial>'
               '<plugin/></plugin>'),
    model_file('<link name="l"/><x:inertial><mass>heavy</mass></x:inertial>'),
])
def test_value_that_libsdformat_accepts_is_accepted(text):
    assert load_text(text).names


@pytest.mark.parametrize('text', [
    link_with(f'<inertial><mass>{" " * 100_000}</mass></inertial>'),
    axis(f'<xyz>{" " * 100_000}1 0 0</xyz>'),
], ids=['a number', 'an axis'])
def test_long_runs_of_white_space_are_read_fast(text):
    assert load_text(text).names


def test_message_has_the_value_the_element_and_the_rule():
    error = only_error(model_file('<link name="l"/><static>maybe</static>'))
    assert error.message == '"maybe" of <static> is not a boolean (true, false, 1 or 0)'


def test_message_has_the_range():
    assert only_error(ode('<mu>-1</mu>')).message == '"-1" of <mu> must be at least 0'


def test_long_value_is_cut_in_the_message():
    assert len(only_error(visual(f'<transparency>{"x" * 10_000}</transparency>')).message) < 200


# Where libsdformat stops at what it does not know, it drops the rest of a number, but not of three

@pytest.mark.parametrize(('text', 'value_type'), [
    ('nan 0 1', ValueType.THREE_NUMBERS), ('1 inf 1', ValueType.THREE_NUMBERS),
    ('1 1 1e999', ValueType.THREE_NUMBERS), ('1abc 2 3', ValueType.THREE_NUMBERS),
    ('1e 2 3', ValueType.THREE_NUMBERS), ('1 2 x', ValueType.AXIS),
    ('1,2', ValueType.TWO_NUMBERS),
    ('1e999', ValueType.NUMBER), ('1e-400', ValueType.NUMBER), ('truex', ValueType.NUMBER),
    ('1e39', ValueType.FLOAT), ('-1e-38', ValueType.FLOAT), ('x', ValueType.FLOAT),
    ('2147483648', ValueType.INTEGER), ('-2147483649', ValueType.INTEGER),
    ('18446744073709551616', ValueType.UNSIGNED), ('0x', ValueType.TIME),
    ('9' * 5000, ValueType.INTEGER), ('0x1' + '0' * 5000, ValueType.NUMBER),
    ('1', ValueType.TIME), ('1.5 2', ValueType.TIME), ('1 2147483648', ValueType.TIME),
    ('1 1 1e-320', ValueType.COLOR),
    ('x', ValueType.NUMBER), ('.', ValueType.NUMBER), ('\u00bd', ValueType.NUMBER),
    ('\u0661', ValueType.NUMBER), ('.5', ValueType.INTEGER), ('\u0661', ValueType.INTEGER),
    ('1 2', ValueType.THREE_NUMBERS), ('1 1 \u0661', ValueType.THREE_NUMBERS),
    ('1', ValueType.TWO_NUMBERS), ('yes', ValueType.BOOLEAN), ('1 2', ValueType.COLOR),
    ('0 0 0 0 0', ValueType.COLOR), ('1 1 1.5', ValueType.COLOR),
])
def test_text_that_is_not_of_a_type(text, value_type):
    assert not is_of_type(text, value_type)


@pytest.mark.parametrize(('text', 'value_type', 'numbers'), [
    ('1.22.28 0.26', ValueType.THREE_NUMBERS, [1.22, 0.28, 0.26]),
    ('1-2-3', ValueType.THREE_NUMBERS, [1, -2, -3]),
    ('1 2 3abc', ValueType.THREE_NUMBERS, [1, 2, 3]),
    ('1 2 0x10', ValueType.THREE_NUMBERS, [1, 2, 0]),
    ('1 2 1e-400', ValueType.THREE_NUMBERS, [1, 2, 0]),
    ('1 2 3 4', ValueType.THREE_NUMBERS, [1, 2, 3]),
    ('0x10', ValueType.INTEGER, [16]), ('-0x10', ValueType.INTEGER, [0]),
    ('0XfF', ValueType.UNSIGNED, [255]), ('-1', ValueType.UNSIGNED, [-1]),
    ('4294967296', ValueType.UNSIGNED, [4294967296]), ('1.5', ValueType.INTEGER, [1]),
    ('0x1p3', ValueType.NUMBER, [8]), ('1.5abc', ValueType.NUMBER, [1.5]),
    ('1_0', ValueType.NUMBER, [1]), ('TRUE', ValueType.NUMBER, [1]),
    ('-inf', ValueType.NUMBER, [-math.inf]), ('12 34', ValueType.TIME, [12, 34]),
    ('+.5 5.', ValueType.TWO_NUMBERS, [0.5, 5]),
])
def test_numbers_as_libsdformat_reads_them(text, value_type, numbers):
    assert list(numbers_from_text(text, value_type)) == numbers


@pytest.mark.parametrize(('text', 'warning'), [
    (box('1.22.28 0.26'), '"1.22.28 0.26" of <size> is read as 1.22 0.28 0.26, as by Gazebo'),
    (link_with('<inertial><mass>1,5</mass></inertial>'),
     '"1,5" of <mass> is read as 1, as by Gazebo'),
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
    assert not Definition('x', f':{value_type}').value.is_plain(text)


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
