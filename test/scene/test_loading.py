# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Loading: all errors of a file at once, each with file, line, element, value and rule."""

from pathlib import Path

import pytest
from sdf_texts import codes_of
from sdf_texts import errors_of
from sdf_texts import model_file

import sdf_pose_bridge
from sdf_pose_bridge.errors import LoadError

MANY_WRONG = """<?xml version="1.0"?>
<sdf version="1.9">
  <model name="m" canonical_link="no_link">
    <link name="a">
      <pose>1 2 3</pose>
      <visual name="v"/>
      <visual name="v"/>
      <sensor name="__s__" type="imu"/>
    </link>
    <link name="b"><pose relative_to="nowhere"/></link>
    <frame name="b"/>
    <frame name="p" attached_to="q"/>
    <frame name="q" attached_to="p"/>
    <frame name="r" attached_to="nothing"/>
    <joint name="j1" type="fixed">
      <parent>a</parent>
      <child>c</child>
    </joint>
    <joint name="j2" type="glue"><parent>a</parent><child>b</child></joint>
    <joint name="j3" type="fixed"><parent>a</parent></joint>
    <joint name="j4" type="fixed"><parent>b</parent><child>b</child></joint>
    <model name="n" placement_frame="none"><pose rotation_format="x"/></model>
    <link/>
  </model>
</sdf>
"""
MANY_ERRORS = [
    (3, 'MODEL_CANONICAL_LINK_INVALID', '"no_link"', 'model[@name="m"]'),
    (5, 'ELEMENT_INVALID', '"1 2 3" has 3', 'link[@name="a"]/pose'),
    (7, 'DUPLICATE_NAME', '"v"', 'visual[@name="v"]'),
    (8, 'RESERVED_NAME', '"__s__"', 'sensor[@name="__s__"]'),
    (10, 'POSE_RELATIVE_TO_INVALID', '"nowhere"', 'link[@name="b"]/pose'),
    (11, 'DUPLICATE_NAME', '"b"', 'frame[@name="b"]'),
    (12, 'FRAME_ATTACHED_TO_CYCLE', '"m::p" -> "m::q" -> "m::p"', 'frame[@name="p"]'),
    (14, 'FRAME_ATTACHED_TO_INVALID', '"nothing"', 'frame[@name="r"]'),
    (17, 'JOINT_CHILD_LINK_INVALID', '"c"', 'joint[@name="j1"]/child'),
    (19, 'ATTRIBUTE_INVALID', '"glue"', 'joint[@name="j2"]'),
    (20, 'ELEMENT_MISSING', 'no <child>', 'joint[@name="j3"]'),
    (21, 'JOINT_PARENT_SAME_AS_CHILD', '"m::b"', 'joint[@name="j4"]'),
    (22, 'MODEL_WITHOUT_LINK', '"m::n"', 'model[@name="n"]'),
    (22, 'POSE_RELATIVE_TO_INVALID', '"none"', 'model[@name="n"]'),
    (22, 'ELEMENT_INVALID', '"x"', 'model[@name="n"]/pose'),
    (23, 'ATTRIBUTE_MISSING', 'no name', 'link'),
]


@pytest.fixture(scope='module')
def many_errors():
    return errors_of(MANY_WRONG)


def test_all_errors_are_told_at_once(many_errors):
    expected = sorted((line, code) for line, code, _, _ in MANY_ERRORS)
    assert sorted((error.line, error.code) for error in many_errors) == expected


def test_errors_stand_in_the_order_of_the_file(many_errors):
    lines = [error.line for error in many_errors]
    assert lines == sorted(lines)


@pytest.mark.parametrize('expected', MANY_ERRORS, ids=lambda expected: f'{expected[0]}')
def test_an_error_names_value_and_element(many_errors, expected):
    line, code, value, element = expected
    error = next(e for e in many_errors if (e.line, e.code) == (line, code))
    assert value in error.message
    assert error.element.startswith('/sdf/model[@name="m"]')
    assert error.element.endswith(element)


def test_every_error_names_the_file(many_errors):
    assert {error.file for error in many_errors} == {'file.sdf'}


def test_the_error_speaks_for_the_first():
    with pytest.raises(LoadError) as caught:
        sdf_pose_bridge.load_text(MANY_WRONG, 'file.sdf')
    error = caught.value
    assert (error.code, error.line) == (error.errors[0].code, 3)
    assert error.message == error.errors[0].message


def test_the_text_of_the_error_has_a_line_for_each(many_errors):
    with pytest.raises(LoadError) as caught:
        sdf_pose_bridge.load_text(MANY_WRONG, 'file.sdf')
    assert str(caught.value).splitlines() == [str(error) for error in many_errors]


def test_one_line_of_it():
    error = errors_of('<sdf version="1.9">\n<model name="m"/>\n</sdf>')[0]
    assert str(error).startswith('file.sdf:2: MODEL_WITHOUT_LINK: ')


def test_messages_are_one_line_each(many_errors):
    assert all(error.message.strip() and '\n' not in error.message for error in many_errors)


def test_the_codes_of_one_defect_are_not_repeated():
    assert codes_of(model_file(
        '<link name="a"/><link name="b"><pose relative_to="x"/></link>'
        '<frame name="f" attached_to="b"/><visual/>')) == ['POSE_RELATIVE_TO_INVALID']


def test_warnings_are_kept_with_errors():
    text = model_file(
        '<link name="a"><visual name="v"><pose relative_to="x"/></visual></link>'
        '<frame name="f" attached_to="y"/>')
    with pytest.raises(LoadError) as caught:
        sdf_pose_bridge.load_text(text)
    assert [warning.code for warning in caught.value.warnings] == ['POSE_RELATIVE_TO_INVALID']
    assert [error.code for error in caught.value.errors] == ['FRAME_ATTACHED_TO_INVALID']


def test_warnings_have_places():
    scene = sdf_pose_bridge.load_text(
        '<sdf version="1.9">\n<model name="m"><link name="a">\n<visual name="v">\n'
        '<pose relative_to="x"/></visual></link></model></sdf>', 'file.sdf')
    warning = scene.warnings[0]
    assert warning.place == (
        'file.sdf', 4,
        '/sdf/model[@name="m"]/link[@name="a"]/visual[@name="v"]/pose')
    assert str(warning).startswith('file.sdf:4: POSE_RELATIVE_TO_INVALID: ')


def test_a_file_is_named_as_it_was_opened(tmp_path, monkeypatch):
    (tmp_path / 'bad.sdf').write_text('<sdf version="1.9"><model name="m"/></sdf>')
    monkeypatch.chdir(tmp_path)
    with pytest.raises(LoadError) as caught:
        sdf_pose_bridge.load('bad.sdf')
    assert caught.value.file == 'bad.sdf'


@pytest.mark.parametrize('as_path', [str, Path])
def test_a_path_may_be_text_or_a_path(tmp_path, as_path):
    (tmp_path / 'größe 1.sdf').write_text(model_file('<link name="l"/>'))
    scene = sdf_pose_bridge.load(as_path(tmp_path / 'größe 1.sdf'))
    assert scene.path == str(tmp_path / 'größe 1.sdf')


def test_text_may_be_bytes():
    text = model_file('<link name="größe"/>')
    assert sdf_pose_bridge.load_text(text.encode()).names == sdf_pose_bridge.load_text(text).names


def test_loading_leaves_nothing_behind():
    text = model_file('<link name="l"/>')
    first = sdf_pose_bridge.load_text(text)
    errors_of(MANY_WRONG)
    second = sdf_pose_bridge.load_text(text)
    assert first.names == second.names
    assert first.poses is not second.poses
