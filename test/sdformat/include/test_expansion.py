# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What a file includes, put in the place of its includes: what stays, what is kept."""

import pytest

from sdf_pose_bridge.sdformat.document_reading import document_from_file
from sdf_pose_bridge.sdformat.include.expansion import expanded
from sdf_pose_bridge.sdformat.include.inclusions import document_set
from sdf_pose_bridge.sdformat.include.resources import resource_finder

LEAF = """<sdf version="1.9">
<model name="leaf">
<pose>0 0 1 0 0 0</pose>
<link name="body"/>
</model></sdf>"""


@pytest.fixture
def expand(tmp_path):
    """Write files, and expand the one called ``mid``."""
    def expand_files(content, **others):
        files = {'leaf': LEAF, 'mid': _mid(content), **others}
        for name, text in files.items():
            (tmp_path / f'{name}.sdf').write_text(text)
        document = document_from_file(tmp_path / 'mid.sdf')
        documents = document_set(document, resource_finder([tmp_path], {}))
        return expanded(document, documents.inclusions)
    return expand_files


def _mid(content):
    return f'<sdf version="1.9"><model name="mid"><link name="base"/>\n{content}</model></sdf>'


def _include(content='', uri='leaf.sdf', attributes=''):
    return f'<include {attributes}><uri>{uri}</uri>{content}</include>'


def _tags(expansion):
    return [xml.tag for xml in expansion.document.root.find('model')]


@pytest.mark.parametrize('include', [
    '<include/>',
    '<include><uri>none.sdf</uri></include>',
    _include('<name> </name>'),
    _include('<static>maybe</static>'),
    _include('<placement_frame>body</placement_frame>'),
    _include('<pose/><placement_frame>__root__</placement_frame>'),
    _include(attributes='merge="maybe"'),
])
def test_an_include_that_has_an_error_stays(expand, include):
    expansion = expand(include)
    assert _tags(expansion) == ['link', 'include']
    assert len(expansion.inclusions) == 1


@pytest.mark.parametrize('content', [
    '',
    '<model name="a"><link name="l"/></model><model name="b"><link name="l"/></model>',
    '<light name="sun" type="point"/>',
    '<model name="a"><pose relative_to="x"/><link name="l"/></model>',
    '<model name="a"><link name="x::l"/></model>',
])
def test_an_include_of_a_file_that_has_an_error_stays(expand, content):
    expansion = expand(_include(uri='bad.sdf'), bad=f'<sdf version="1.9">{content}</sdf>')
    assert _tags(expansion) == ['link', 'include']


def test_an_include_that_merges_stays_with_a_copy_of_its_own(expand):
    expansion = expand(_include(attributes='merge="true"'))
    (include, inclusion), = expansion.inclusions.items()
    assert include.tag == 'include'
    # The merged link has a pose now, as parameters may change it.
    assert inclusion.document.root.find('model/link/pose') is not None


def test_the_original_keeps_its_include(expand, tmp_path):
    expansion = expand(_include())
    assert _tags(expansion) == ['link', 'model']
    again = document_from_file(tmp_path / 'mid.sdf')
    assert [xml.tag for xml in again.root.find('model')] == ['link', 'include']


def test_the_include_overrides(expand):
    expansion = expand(_include(
        '<name>kid</name><static>true</static><placement_frame>body</placement_frame>'
        '<pose relative_to="base">1 2 3 0 0 0</pose>'))
    model = expansion.document.root.find('model/model')
    assert dict(model.attrib) == {'name': 'kid', 'placement_frame': 'body'}
    assert model.findtext('static') == 'true'
    assert [pose.text for pose in model.iterchildren('pose')] == ['1 2 3 0 0 0']
    assert model.find('pose').get('relative_to') == 'base'


def test_what_was_included_keeps_its_file_and_line(expand, tmp_path):
    expansion = expand(_include())
    link = expansion.document.root.find('model/model/link')
    assert expansion.document.origin(link).path == str(tmp_path / 'leaf.sdf')
    assert link.sourceline == 4


def test_what_is_placed_by_its_include_stands_there(expand, tmp_path):
    expansion = expand(_include('<pose>1 2 3 0 0 0</pose>'))
    model = expansion.document.root.find('model/model')
    document = expansion.document
    assert [document.origin(xml).path for xml in (model, model.find('pose'))] == [
        str(tmp_path / 'mid.sdf')] * 2
    assert model.sourceline == 2
    assert document.origin(model.find('link')).path == str(tmp_path / 'leaf.sdf')


def test_includes_in_includes_are_expanded(expand, tmp_path):
    inner = f'<sdf version="1.9"><model name="inner">{_include()}</model></sdf>'
    expansion = expand(_include(uri='inner.sdf'), inner=inner)
    link = expansion.document.root.find('model/model/model/link')
    assert expansion.document.origin(link).path == str(tmp_path / 'leaf.sdf')
    assert expansion.inclusions == {}
