# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Reading files into trees: the outermost element, its version, the top model's pose, xacro."""

import pytest
from sdf_texts import (
    assert_at,
    codes_of,
    errors_of,
    errors_of_file,
    LINK,
    model_file,
    names_of,
    only_error,
    write_files,
)
from urdf_texts import joint, link, origin

from sdf_pose_bridge import load, load_text, SdfError


@pytest.mark.parametrize(('text', 'code'), [
    ('<sdf/>', 'FILE_READ'),
    ('<sdf Version="1.9"/>', 'FILE_READ'),
    ('<sdf x:version="1.9"/>', 'FILE_READ'),
    ('<gazebo version="1.9"/>', 'PARSING_ERROR'),
    ('<model name="m"/>', 'PARSING_ERROR'),
    ('<SDF version="1.9"/>', 'PARSING_ERROR'),
    ('<robot name="r"/>', 'PARSING_ERROR'),
    ('<x:sdf version="1.9"/>', 'PARSING_ERROR'),
    ('<x:sdf xmlns:x="urn:x" version="1.9"/>', 'PARSING_ERROR'),
])
def test_other_outermost_element_is_refused(text, code):
    assert codes_of(text) == [code]


def test_missing_version_is_named_in_the_message():
    assert 'version' in only_error('<sdf/>').message


def test_outermost_element_is_named_in_the_message():
    error = only_error('\n<gazebo version="1.9"/>')
    assert '<gazebo>' in error.message
    assert (error.line, error.element) == (2, '/gazebo')


# The model at the top of a file

def test_reference_of_the_top_model_is_refused():
    error = only_error(model_file('\n<pose relative_to="l">1 0 0 0 0 0</pose>' + LINK))
    assert (error.code, error.line) == ('ATTRIBUTE_INVALID', 2)
    assert 'relative_to="l"' in error.message


def test_reference_of_the_top_model_of_an_included_file_is_refused(tmp_path):
    write_files(
        tmp_path, leaf=model_file('<pose relative_to="l"/>' + LINK),
        main='<sdf version="1.10"><world name="w"><include><uri>leaf.sdf</uri></include>'
             '</world></sdf>')
    (error,) = errors_of_file(tmp_path / 'main.sdf')
    assert (error.code, error.file) == ('ATTRIBUTE_INVALID', str(tmp_path / 'leaf.sdf'))


def test_old_reference_of_the_top_model_is_refused():
    text = model_file('<pose frame="l">1 0 0 0 0 0</pose>' + LINK, version='1.6')
    assert codes_of(text) == ['ATTRIBUTE_INVALID']


def test_nothing_else_follows_from_the_reference_of_the_top_model():
    assert len(errors_of(model_file('<pose relative_to="nowhere"/>' + LINK))) == 1


def test_empty_reference_of_the_top_model_is_accepted():
    scene = load_text(model_file('<pose relative_to="">1 0 0 0 0 0</pose>' + LINK))
    assert_at(scene, 'm', (1, 0, 0))


# Text and bytes

def test_text_may_be_bytes():
    text = model_file('<link name="größe"/>')
    assert load_text(text.encode()).names == load_text(text).names


def test_name_of_the_text_is_that_of_the_file():
    assert load_text(model_file(LINK), 'a.sdf').files == ('a.sdf',)


@pytest.mark.parametrize('text', [
    model_file('<link name="a::b"/>'), model_file('<link name="a&#58;:b"/>'),
    model_file('<link name="a:&#x3a;b"/>'), model_file('<link name="a::b"/>').encode('UTF-16'),
], ids=['plain', 'decimal reference', 'hexadecimal reference', 'UTF-16'])
def test_separator_in_a_name_is_found(text):
    assert 'RESERVED_NAME' in codes_of(text)


def test_file_with_a_name_in_utf_8_is_read(tmp_path):
    (tmp_path / 'größe 1.sdf').write_text(model_file(LINK))
    assert names_of(load(tmp_path / 'größe 1.sdf')) == ['m', 'm::l']


XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
TWO = link('a') + link('b')


def sdf(content):
    return f'<sdf version="1.10" {XACRO}><model name="m">\n{content}</model></sdf>'


def urdf(content):
    return f'<robot name="r" {XACRO}>\n{content}</robot>'


@pytest.mark.parametrize(('text', 'found'), [
    (sdf(LINK + '<xacro:include filename="arm.xacro"/>'), '<xacro:include>'),
    (sdf('<xacro:if value="1">' + LINK + '</xacro:if>'), '<xacro:if>'),
    (sdf('<link name="${side}_arm"/>'), 'name="${side}_arm" of <link>'),
    (sdf('<link name="$(arg side)_arm"/>'), 'name="$(arg side)_arm" of <link>'),
    (sdf('<link name="a"><pose>${x} 0 0 0 0 0</pose></link>'), '"${x} 0 0 0 0 0" in <pose>'),
    (sdf('<link name="a"><pose relative_to="${f}"/></link>'), 'relative_to="${f}" of <pose>'),
    (sdf('<include><uri>model://${arm}</uri></include>'), '"model://${arm}" in <uri>'),
    (urdf(TWO + joint('j', 'a', 'b', 'fixed', origin('0 0 ${h}'))),
     'xyz="0 0 ${h}" of <origin>'),
    (urdf(link('a') + '<xacro:wheel name="left"/>'), '<xacro:wheel>'),
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
])
def test_the_error_tells_the_command(tmp_path, name, command):
    path = tmp_path / name
    write = sdf if '.sdf' in name else urdf
    path.write_text(write('<link name="${a}"/>'), encoding='utf-8')
    (error,) = errors_of_file(path)
    assert error.message.endswith(f': {command}')


def test_for_a_text_there_is_no_command():
    with pytest.raises(SdfError) as caught:
        load_text(sdf('<link name="${a}"/>'), 'robot_description')
    assert caught.value.message.endswith('and read the file that it writes')


def test_an_included_file_is_refused_too(tmp_path):
    (tmp_path / 'arm.sdf').write_text(sdf('<link name="${a}"/>'), encoding='utf-8')
    path = tmp_path / 'cell.sdf'
    path.write_text('<sdf version="1.10"><world name="w"><include><uri>arm.sdf</uri></include>'
                    '</world></sdf>', encoding='utf-8')
    (error,) = errors_of_file(path)
    assert (error.file, error.line) == (str(tmp_path / 'arm.sdf'), 2)


def test_declarations_plugins_and_topics_may_stay():
    sensor = '<sensor name="s" type="imu"><topic>$(arg namespace)/imu</topic></sensor>'
    scene = load_text(sdf(
        '<xacro:arg name="namespace" default=""/><xacro:property name="p" value="${1 + 1}"/>'
        f'<link name="a">{sensor}</link>'
        '<plugin name="${p}" filename="$(arg x)"><pose>${p}</pose><xacro:if/></plugin>'))
    assert 'm::a::s' in scene.names
    assert scene.warnings == ()


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
    (tmp_path / 'm.sdf.xacro').write_text(sdf(MESH), encoding='utf-8')
    (error,) = errors_of_file(tmp_path / 'm.sdf.xacro')
    assert error.code == 'PARSING_ERROR'


def test_a_dollar_alone_is_no_expression():
    assert 'm::$a' in load_text(sdf('<link name="$a"/>')).names


def test_other_encodings_are_checked():
    text = sdf('<link name="${a}"/>').encode('utf-16')
    assert only_error(text).message.startswith('name="${a}" of <link>')
