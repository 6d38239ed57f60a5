# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Files that xacro or another program has to expand first."""

import pytest
from sdf_texts import errors_of_file, LINK, model_file, only_error
from urdf_texts import joint, link, origin

from sdf_pose_bridge import load_text, SdfError

XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
TWO = link('a') + link('b')


def sdf(content):
    return f'<sdf version="1.10" {XACRO}><model name="m">\n{content}</model></sdf>'


def urdf(content):
    return f'<robot name="r" {XACRO}>\n{content}</robot>'


@pytest.mark.parametrize(('text', 'found'), [
    (sdf(LINK + '<xacro:include filename="arm.xacro"/>'), '<xacro:include>'),
    (sdf('<link name="$(arg side)_arm"/>'), 'name="$(arg side)_arm" of <link>'),
    (sdf('<link name="a"><pose>${x} 0 0 0 0 0</pose></link>'), '"${x} 0 0 0 0 0" in <pose>'),
    (sdf('<link name="a"><pose relative_to="${f}"/></link>'), 'relative_to="${f}" of <pose>'),
    (sdf('<include><uri>model://${arm}</uri></include>'), '"model://${arm}" in <uri>'),
    (urdf(TWO + joint('j', 'a', 'b', 'fixed', origin('0 0 ${h}'))),
     'xyz="0 0 ${h}" of <origin>'),
    (urdf(link('a') + '<xacro:macro name="wheel"><link name="w"/></xacro:macro>'),
     '<xacro:macro>'),
    (urdf(link('${prefix}a')), 'name="${prefix}a" of <link>'),
])
def test_unexpanded_file_is_refused(text, found):
    error = only_error(text)
    assert (error.code, error.line) == ('PARSING_ERROR', 2)
    assert error.message.startswith(f'{found} is for xacro')


@pytest.mark.parametrize(('name', 'command'), [
    ('my arm.sdf.xacro', "xacro 'my arm.sdf.xacro' -o 'my arm.sdf'"),
    ('arm.urdf', 'xacro arm.urdf -o expanded_arm.urdf'),
    ('arm.urdf.xacro', 'xacro arm.urdf.xacro -o arm.urdf'),
    ('arm.xacro', 'xacro arm.xacro -o arm.urdf'),
    ('old.xacro', 'xacro old.xacro -o expanded_expanded_old.urdf'),
])
def test_the_error_tells_the_command(tmp_path, name, command):
    path = tmp_path / name
    for existing in ('old.urdf', 'expanded_old.urdf'):
        (tmp_path / existing).touch()
    write = sdf if '.sdf' in name else urdf
    path.write_text(write('<link name="${a}"/>'))
    (error,) = errors_of_file(path)
    assert error.message.endswith(f': {command}')


def test_for_a_text_there_is_no_command():
    with pytest.raises(SdfError) as caught:
        load_text(sdf('<link name="${a}"/>'), 'robot_description')
    assert caught.value.message.endswith('and read the file that it writes')


def test_an_included_file_is_refused_too(tmp_path):
    (tmp_path / 'arm.sdf').write_text(sdf('<link name="${a}"/>'))
    path = tmp_path / 'cell.sdf'
    path.write_text('<sdf version="1.10"><world name="w"><include><uri>arm.sdf</uri></include>'
                    '</world></sdf>')
    (error,) = errors_of_file(path)
    assert (error.file, error.line) == (str(tmp_path / 'arm.sdf'), 2)


def test_declarations_plugins_and_topics_may_stay():
    sensor = '<sensor name="s" type="imu"><topic>$(arg namespace)/imu</topic></sensor>'
    scene = load_text(sdf(
        '<xacro:arg name="namespace" default=""/><xacro:property name="p" value="${1 + 1}"/>'
        f'<link name="a">{sensor}</link>'
        '<plugin name="${p}" filename="$(arg x)"><pose>${p}</pose><xacro:if/></plugin>'))
    assert 'm::a::s' in scene.names
    (warning,) = scene.warnings
    assert warning.message == (
        'value="${1 + 1}" of <xacro:property> is for xacro or launch files and is not expanded; '
        'no frame depends on it, but names in Gazebo may')


@pytest.mark.parametrize(('text', 'found'), [
    (urdf(link('a') + '<ros2_control name="c" type="system"><joint name="j"><command_interface '
          'name="position"><param name="min">${-2*pi}</param></command_interface></joint>'
          '</ros2_control>'), '"${-2*pi}" in <param>'),
    (urdf(link('a') + '<transmission name="${t}"><type>x</type></transmission>'),
     'name="${t}" of <transmission>'),
    (sdf('<link name="a"><visual name="v"><geometry><sphere/></geometry><material><script>'
         '<uri>file://media</uri><name>Gazebo/$(arg color)</name></script></material></visual>'
         '</link>'), '"Gazebo/$(arg color)" in <name>')])
def test_what_is_read_for_no_frame_may_stay(text, found):
    (warning, *_) = load_text(text).warnings
    assert warning.message.startswith(f'{found} is for xacro or launch files')


MESH = ('<link name="l"><visual name="v"><geometry><mesh><uri>$(find arm)/arm.dae</uri></mesh>'
        '</geometry></visual></link>')


def test_location_of_a_mesh_may_stay_with_one_warning():
    scene = load_text(sdf(MESH + '<link name="k">' + MESH[len('<link name="l">'):]))
    assert 'm::k::v' in scene.names
    (warning,) = scene.warnings
    assert warning.message.startswith('"$(find arm)/arm.dae" in <uri> is for xacro')
    assert warning.place.line == 2


@pytest.mark.parametrize(('content', 'found'), [
    ('<link name="${a}"/>', 'name="${a}" of <link>'),
    ('<include><uri>$(find arm)/arm.sdf</uri></include>', '"$(find arm)/arm.sdf" in <uri>'),
])
def test_location_of_a_mesh_hides_nothing_else(content, found):
    error = only_error(sdf(MESH + content))
    assert error.message.startswith(f'{found} is for xacro')


def test_location_of_a_mesh_in_a_file_for_xacro_is_refused(tmp_path):
    (tmp_path / 'm.sdf.xacro').write_text(sdf(MESH))
    (error,) = errors_of_file(tmp_path / 'm.sdf.xacro')
    assert error.code == 'PARSING_ERROR'


def test_a_dollar_alone_is_no_expression():
    assert 'm::$a' in load_text(sdf('<link name="$a"/>')).names


def test_other_encodings_are_checked():
    text = sdf('<link name="${a}"/>').encode('utf-16')
    assert only_error(text).message.startswith('name="${a}" of <link>')


@pytest.mark.parametrize(('name', 'text', 'end'), [
    ('a.sdf.jinja', '{%- set h = 1 -%}<?xml version="1.0"?><sdf version="1.9"/>', 'Jinja'),
    ('a.sdf', '{% if x %}', 'Jinja'),
    ('a.sdf', '<% h = 1 %><sdf version="1.9"/>', 'ERB'),
    ('a.sdf.erb', 'h = 1', 'ERB'),
    ('a.sdf.em', 'h = 1', 'EmPy'),
])
def test_template_that_is_not_xml(tmp_path, name, text, end):
    (tmp_path / name).write_text(text)
    (error,) = errors_of_file(tmp_path / name)
    assert error.message.endswith(
        f'; the file is for {end}; run {end} first, and read the file that it writes')


@pytest.mark.parametrize(('name', 'other', 'end'), [
    ('a.sdf.j2', 'a.sdf', '; run Jinja first, and read "a.sdf" beside it'),
    ('a.sdf', 'a.sdf.jinja',
     '; run Jinja on "a.sdf.jinja" beside it first, and read the file that it writes')])
def test_the_file_beside_a_template_and_the_template_beside_a_file_are_named(
        tmp_path, name, other, end):
    (tmp_path / other).touch()
    (tmp_path / name).write_text('{{ a }}')
    (error,) = errors_of_file(tmp_path / name)
    assert error.message.endswith(end)


@pytest.mark.parametrize(('content', 'found'), [
    ('<link name="@(n)"/>', 'name="@(n)" of <link> is for EmPy'),
    ('<link name="a{{ n }}"/>', 'name="a{{ n }}" of <link> is for Jinja'),
    ('<link name="a"><sensor name="s" type="imu"><topic>@(n)</topic></sensor></link>',
     '"@(n)" in <topic> is for EmPy'),
    *((f'<link name="{name}"/>', f'name="{name}" of <link> is for Python\'s str.format')
      for name in ('{n}', 'a_{n:02d}', '{n.side}', '{n[0]!r}')),
])
def test_template_that_is_xml_has_one_warning(content, found):
    scene = load_text(model_file(content + '<link name="@(m)"/>'))
    (warning,) = scene.warnings
    assert warning.message.startswith(found)


@pytest.mark.parametrize('text', ['{}', '{1}', '{"a": 1}', '{ a }', '{a b}', '#{a}', '{a'])
def test_other_braces_are_no_template(text):
    topic = f'<sensor name="s" type="imu"><topic>{text}</topic></sensor>'
    assert load_text(model_file(f'<link name="l">{topic}</link>')).warnings == ()


def test_statement_before_the_first_element_has_a_warning():
    (warning,) = load_text('{% set a = 1 %}' + model_file(LINK)).warnings
    assert 'is for Jinja' in warning.message


def test_marks_of_templates_in_a_plugin_are_its_own():
    plugin = '<plugin name="p" filename="@(f)"><json>{{}}</json></plugin>'
    assert load_text(model_file(LINK + plugin)).warnings == ()
