# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Reading files into trees: the outermost element, its version, the top model's pose."""

import pytest
from sdf_texts import assert_at, codes_of, LINK, model_file, names_of, only_error

from sdf_pose_bridge import load_text


@pytest.mark.parametrize(('text', 'code', 'named'), [
    ('<sdf/>', 'FILE_READ', 'version'),
    ('<sdf Version="1.9"/>', 'FILE_READ', 'version'),
    ('<sdf x:version="1.9"/>', 'FILE_READ', 'version'),
    ('<gazebo version="1.9"/>', 'PARSING_ERROR', '<gazebo>'),
    ('<model name="m"/>', 'PARSING_ERROR', '<model>'),
    ('<SDF version="1.9"/>', 'PARSING_ERROR', '<SDF>'),
    ('<robot name="r"/>', 'PARSING_ERROR', 'robot'),
    ('<x:sdf version="1.9"/>', 'PARSING_ERROR', '<x:sdf>'),
    ('<x:sdf xmlns:x="urn:x" version="1.9"/>', 'PARSING_ERROR', '<x:sdf>'),
])
def test_other_outermost_element_is_refused(text, code, named):
    error = only_error(f'\n{text}')
    assert (error.code, error.line) == (code, 2)
    assert named in error.message


def test_elements_beside_the_outermost_one_are_told():
    scene = load_text('<robot/>\n' + model_file(LINK))
    assert names_of(scene) == ['m', 'm::l']
    assert 'elements beside the outermost element' in scene.warnings[0].message
    assert scene.warnings[0].place.line == 2


def test_error_has_the_outermost_element():
    assert only_error('<gazebo version="1.9"/>').element == '/gazebo'


# The model at the top of a file

@pytest.mark.parametrize(('content', 'version'), [
    ('<pose relative_to="l">1 0 0 0 0 0</pose>', '1.9'),
    ('<pose relative_to="nowhere"/>', '1.9'),
    ('<pose frame="l">1 0 0 0 0 0</pose>', '1.6'),
])
def test_reference_of_the_top_model_is_refused(content, version):
    error = only_error(model_file(f'\n{content}{LINK}', version=version))
    assert (error.code, error.line) == ('ATTRIBUTE_INVALID', 2)
    assert 'relative_to="' in error.message


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
