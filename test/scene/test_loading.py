# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Loading: all errors of a file, each with file, line, element, value and rule."""

import gc
from pathlib import Path

import pytest
from sdf_texts import errors_of, LINK, model_file

from sdf_pose_bridge import load, load_text
from sdf_pose_bridge.errors import LoadError

WRONG_FILE = """<?xml version="1.0"?>
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
ERRORS = [
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
    (21, 'JOINT_PARENT_SAME_AS_CHILD', '"b"', 'joint[@name="j4"]'),
    (22, 'MODEL_WITHOUT_LINK', '"m::n"', 'model[@name="n"]'),
    (22, 'POSE_RELATIVE_TO_INVALID', '"none"', 'model[@name="n"]'),
    (22, 'ELEMENT_INVALID', '"x"', 'model[@name="n"]/pose'),
    (23, 'ATTRIBUTE_MISSING', 'no name', 'link'),
]


@pytest.fixture(scope='module')
def file_errors():
    return errors_of(WRONG_FILE)


def test_all_errors_are_reported(file_errors):
    expected = sorted((line, code) for line, code, _, _ in ERRORS)
    assert sorted((error.line, error.code) for error in file_errors) == expected


@pytest.mark.parametrize('expected', ERRORS, ids=lambda expected: f'{expected[0]}')
def test_error_has_the_value_and_the_element(file_errors, expected):
    line, code, value, element = expected
    error = next(e for e in file_errors if (e.line, e.code) == (line, code))
    assert value in error.message
    assert error.element.startswith('/sdf/model[@name="m"]')
    assert error.element.endswith(element)


def test_messages_have_one_line(file_errors):
    assert all(error.message.strip() and '\n' not in error.message for error in file_errors)


def test_error_has_the_path_as_it_was_opened(tmp_path, monkeypatch):
    (tmp_path / 'bad.sdf').write_text('<sdf version="1.9"><model name="m"/></sdf>')
    monkeypatch.chdir(tmp_path)
    with pytest.raises(LoadError) as caught:
        load('bad.sdf')
    assert caught.value.file == 'bad.sdf'


@pytest.mark.parametrize('as_path', [str, Path])
def test_path_can_be_a_string_or_a_path(tmp_path, as_path):
    (tmp_path / 'größe 1.sdf').write_text(model_file('<link name="l"/>'))
    scene = load(as_path(tmp_path / 'größe 1.sdf'))
    assert scene.path == str(tmp_path / 'größe 1.sdf')


@pytest.mark.parametrize('is_enabled', [True, False])
def test_garbage_collection_is_as_before(is_enabled):
    was_enabled = gc.isenabled()
    try:
        (gc.enable if is_enabled else gc.disable)()
        errors_of(WRONG_FILE)
        load_text(model_file('<link name="l"/>'))
        assert gc.isenabled() == is_enabled
    finally:
        (gc.enable if was_enabled else gc.disable)()


def test_unknown_choice_for_missing_includes_is_refused():
    with pytest.raises(ValueError, match='ignore'):
        load_text(model_file('<link name="l"/>'), on_missing_include='ignore')


def test_resource_path_that_is_not_a_directory_is_a_warning():
    # The text is replaced like that of a file.
    texts = {'<text>': model_file(LINK)}
    (warning,) = load_text('', resource_paths=['nowhere'], texts=texts).warnings
    assert warning.message == 'resource_paths names "nowhere", which is not a directory'
