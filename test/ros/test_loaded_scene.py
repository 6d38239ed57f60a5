# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What a load leaves in memory, as a node may load thousands of times; and paths that fail."""

import gc

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from sdf_texts import world_file

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.ros.loaded_scene import loaded_scene_from_settings
from sdf_pose_bridge.ros.loaded_scene import scene_with_shapes
from sdf_pose_bridge.ros.parameters import settings_from_node

GOOD = '<model name="m"><link name="l"><pose>1 0 0 0 0 0</pose></link><frame name="f"/></model>'
BAD = GOOD.replace('<pose>', '<pose relative_to="x">')


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
WITH_SHAPE = world_file(f'<model name="m"><link name="l">{VISUAL}</link></model>')


@pytest.fixture(name='reread')
def make_reread(make_node, tmp_path):
    """Loads a file, changes it and reads it with its shapes; ``reread(text)``."""
    path = tmp_path / 'cell.sdf'
    path.write_text(WITH_SHAPE, encoding='utf-8')
    settings = settings_from_node(make_node('bridge', '-p', f'sdf_file:={path}'))
    loaded = loaded_scene_from_settings(settings)
    assert not loaded.scene.shapes

    def reread(text):
        path.write_text(text, encoding='utf-8')
        return scene_with_shapes(loaded, settings)

    return reread


@pytest.mark.parametrize('text', [
    '', world_file(BAD), world_file(GOOD),
    WITH_SHAPE.replace('"l">', '"l"><pose>1 0 0 0 0 0</pose>'),
    WITH_SHAPE.replace('"v"', '"w"'),
], ids=['empty', 'bad', 'other elements', 'other pose', 'other name'])
def test_shapes_of_a_file_that_has_changed_are_refused(reread, text):
    assert reread(text) is None


def test_shapes_are_read_again(reread):
    (shape,) = reread(WITH_SHAPE).shapes.values()
    assert shape.type == 'box'
