# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Reading files into trees: the outermost element, its version, the top model's pose."""

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

from sdf_pose_bridge import load, load_text


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
