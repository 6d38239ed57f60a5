# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What a load leaves in memory, paths that fail, and texts in any encoding."""

import gc

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from lxml import etree
from rclpy.parameter import Parameter
from sdf_texts import model_file
from sdf_texts import world_file

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.ros.given_parameters import changed_settings
from sdf_pose_bridge.ros.given_parameters import settings_from_node
from sdf_pose_bridge.ros.loaded_scene import loaded_scene_from_settings
from sdf_pose_bridge.ros.loaded_scene import scene_with_shapes
from sdf_pose_bridge.ros.loaded_scene import unicode_text

GOOD = '<model name="m"><link name="l"><pose>1 0 0 0 0 0</pose></link><frame name="f"/></model>'
BAD = GOOD.replace('<pose>', '<pose relative_to="x">')

TEXT = '<robot name="größe"/>'


@pytest.mark.parametrize('text', [GOOD, BAD], ids=['good', 'bad'])
def test_nothing_is_left_that_only_a_search_for_garbage_would_free(make_node, tmp_path, text):
    path = tmp_path / 'cell.sdf'
    path.write_text(world_file(text), encoding='utf-8')
    settings = settings_from_node(make_node('bridge', '-p', f'sdf_file:={path}'))

    def load():
        try:
            loaded_scene_from_settings(settings)
        except SdfError:
            assert text is BAD

    load()
    gc.collect()
    gc.disable()
    try:
        load()
        assert gc.collect() == 0
    finally:
        gc.enable()


def test_a_path_that_is_too_long_is_said_to_be(make_node):
    settings = settings_from_node(make_node('bridge', '-p', f'sdf_file:=/{"x" * 1000}'))
    with pytest.raises(SdfError, match='File name too long'):
        loaded_scene_from_settings(settings)


VISUAL = '<visual name="v"><geometry><box/></geometry></visual>'
WITH_SHAPE = model_file(f'<link name="l">{VISUAL}</link>')


@pytest.fixture(name='reread')
def make_reread(make_node, tmp_path):
    """Loads a file, changes what it includes and reads shapes; ``reread(text)``."""
    path = tmp_path / 'cell.sdf'
    included = tmp_path / 'included.sdf'
    path.write_text(
        world_file('<include><uri>included.sdf</uri></include>'), encoding='utf-8')
    included.write_text(WITH_SHAPE, encoding='utf-8')
    settings = settings_from_node(make_node('bridge', '-p', f'sdf_file:={path}'))
    loaded = loaded_scene_from_settings(settings)
    assert not loaded.scene.shapes

    def reread(text):
        included.write_text(text, encoding='utf-8')
        return scene_with_shapes(loaded)

    return reread


@pytest.mark.parametrize('text', [
    '', model_file('<link name="l"><pose relative_to="x"/></link>'),
    model_file('<link name="k"/>'),
    WITH_SHAPE.replace('"l">', '"l"><pose>1 0 0 0 0 0</pose>'),
    WITH_SHAPE.replace('"v"', '"w"'),
], ids=['empty', 'bad', 'other elements', 'other pose', 'other name'])
def test_shapes_with_an_include_that_has_changed_are_refused(reread, text):
    assert reread(text) is None


def test_shapes_are_those_of_the_text_that_was_read(make_node, tmp_path):
    path = tmp_path / 'cell.sdf'
    path.write_text(WITH_SHAPE, encoding='utf-8')
    settings = settings_from_node(make_node('bridge', '-p', f'sdf_file:={path}'))
    loaded = loaded_scene_from_settings(settings)
    path.write_text('something else', encoding='utf-8')
    (shape,) = scene_with_shapes(loaded).shapes.values()
    assert shape.type == 'box'


def test_shapes_are_found_where_the_scene_was(make_node, tmp_path):
    models = tmp_path / 'models'
    models.mkdir()
    models.joinpath('included.sdf').write_text(WITH_SHAPE, encoding='utf-8')
    path = tmp_path / 'cell.sdf'
    path.write_text(
        world_file('<include><uri>included.sdf</uri></include>'), encoding='utf-8')
    loaded = loaded_scene_from_settings(settings_from_node(make_node(
        'bridge', '-p', f'sdf_file:={path}', '-p', f'resource_paths:=[{models}]')))
    assert scene_with_shapes(loaded).shapes


def test_a_text_has_the_name_of_its_parameter_and_no_file(make_node):
    settings = settings_from_node(make_node('bridge', '-p', f'robot_description:={WITH_SHAPE}'))
    loaded = loaded_scene_from_settings(settings)
    assert (str(loaded.path), loaded.text, loaded.files) == ('robot_description', WITH_SHAPE, ())
    bad = changed_settings(settings, [Parameter('robot_description', value='<sdf>\n<')])
    with pytest.raises(SdfError, match='robot_description:2: FILE_READ'):
        loaded_scene_from_settings(bad)


def test_shapes_are_read_again(reread):
    (shape,) = reread(WITH_SHAPE).shapes.values()
    assert shape.type == 'box'


@pytest.mark.parametrize('text', [TEXT, TEXT.encode(), TEXT.encode('utf-8-sig')])
def test_a_text_stays_as_it_is(text):
    assert unicode_text(text) == TEXT


@pytest.mark.parametrize('encoding', ['latin-1', 'utf-16'])
def test_another_encoding_is_converted(encoding):
    text = unicode_text(f'<?xml version="1.0" encoding="{encoding}"?>{TEXT}'.encode(encoding))
    assert etree.fromstring(text).get('name') == 'größe'
