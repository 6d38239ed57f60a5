# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Which file of a model its manifest names, and manifests that name none."""

import os
from pathlib import Path

import pytest

from sdf_pose_bridge import SdfError
from sdf_pose_bridge.sdformat.include.manifests import model_file_from_directory
from sdf_pose_bridge.sdformat.limits import Usage


def model_file(tmp_path, content, name='model.config'):
    """Write a manifest; return the file that it names."""
    (tmp_path / name).write_text(content)
    return model_file_from_directory(str(tmp_path), Usage())


@pytest.mark.parametrize(('content', 'code'), [
    ('<model><name>m</name></model>', 'PARSING_ERROR'),
    ('<model><sdf version="1.9"/></model>', 'PARSING_ERROR'),
    ('<sdf version="1.9"><sdf version="1.9">a.sdf</sdf></sdf>', 'PARSING_ERROR'),
    ('<model>', 'FILE_READ'),
    ('', 'FILE_READ'),
    ('<!DOCTYPE model [<!ENTITY e "a.sdf">]><model><sdf>&e;</sdf></model>', 'FILE_READ'),
])
def test_manifest_that_names_no_file_is_refused(tmp_path, content, code):
    with pytest.raises(SdfError) as refusal:
        model_file(tmp_path, content)
    assert refusal.value.code == code
    assert refusal.value.file == str(tmp_path / 'model.config')


def test_manifest_that_is_a_pipe_is_refused(tmp_path):
    os.mkfifo(tmp_path / 'model.config')
    with pytest.raises(SdfError, match='not a regular file'):
        model_file_from_directory(str(tmp_path), Usage())


def test_directory_without_a_manifest_is_refused(tmp_path):
    with pytest.raises(SdfError, match=r'has no model\.config'):
        model_file_from_directory(str(tmp_path), Usage())


@pytest.mark.parametrize(('entries', 'chosen'), [
    ([('1.9', 'a'), ('1.10', 'b')], 'b'),
    ([('1.6', 'a'), ('1.6', 'b')], 'a'),
    ([('1.99', 'a'), ('1.4', 'b')], 'b'),
    ([('latest', 'a'), ('1.4', 'b')], 'b'),
])
def test_newest_supported_version_is_chosen(tmp_path, entries, chosen):
    content = ''.join(f'<sdf version="{version}">{name}</sdf>' for version, name in entries)
    assert Path(model_file(tmp_path, f'<model>{content}</model>').path).name == chosen


def test_version_that_is_too_new_is_skipped_with_a_warning(tmp_path):
    found = model_file(
        tmp_path, '<model><sdf version="1.99">a</sdf><sdf version="1.9">b</sdf></model>')
    assert 'version 1.99 of the model is newer' in found.warnings[0].message


def test_entry_without_a_version_is_chosen_silently(tmp_path):
    found = model_file(tmp_path, '<model><sdf>a.sdf</sdf></model>')
    assert (Path(found.path).name, found.warnings) == ('a.sdf', ())


def test_deprecated_name_of_a_manifest_gives_a_warning(tmp_path):
    found = model_file(tmp_path, '<model><sdf version="1.9">a</sdf></model>', 'manifest.xml')
    assert 'manifest.xml is deprecated' in found.warnings[0].message


def test_model_config_comes_before_the_deprecated_manifest(tmp_path):
    (tmp_path / 'manifest.xml').write_text('<model><sdf version="1.9">old</sdf></model>')
    found = model_file(tmp_path, '<model><sdf version="1.9">new</sdf></model>')
    assert found == (str(tmp_path / 'new'), str(tmp_path / 'model.config'), ())
