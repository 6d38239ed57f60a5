# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Files that xacro has not expanded are refused, unless what is left to do changes no frame."""

import pytest
from sdf_texts import errors_of_file
from sdf_texts import LINK
from sdf_texts import only_error
from urdf_texts import joint
from urdf_texts import link
from urdf_texts import origin

from sdf_pose_bridge import load_text
from sdf_pose_bridge import SdfError

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
])
def test_the_error_tells_the_command(tmp_path, name, command):
    path = tmp_path / name
    path.write_text(sdf('<link name="${a}"/>'), encoding='utf-8')
    (error,) = errors_of_file(path)
    assert error.message.endswith(f': {command}')


def test_for_a_text_there_is_no_command():
    with pytest.raises(SdfError) as caught:
        load_text(sdf('<link name="${a}"/>'), 'robot_description')
    assert caught.value.message.endswith('has to be read')


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


def test_a_dollar_alone_is_no_expression():
    assert 'm::$a' in load_text(sdf('<link name="$a"/>')).names


def test_other_encodings_are_checked():
    text = sdf('<link name="${a}"/>').encode('utf-16')
    assert only_error(text).message.startswith('name="${a}" of <link>')
