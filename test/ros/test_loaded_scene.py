# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What a load leaves behind, as a node may go through thousands of them; and paths that fail."""

import gc

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from sdf_texts import world_file

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.ros.loaded_scene import content_from_settings
from sdf_pose_bridge.ros.settings import settings_from_values

GOOD = '<model name="m"><link name="l"><pose>1 0 0 0 0 0</pose></link><frame name="f"/></model>'
BAD = GOOD.replace('<pose>', '<pose relative_to="x">')
VALUES = {
    'root_frame': 'map', 'anchor_models': 'all', 'model': '', 'frame_names': 'auto',
    'frame_separator': '/', 'frame_prefix': '', 'kinds': ['model', 'link'], 'pose_topics': [],
    'optical_frames': True, 'resource_paths': [], 'on_missing_include': 'error',
    'publish_rate': 0.0, 'watch': True,
}


@pytest.mark.parametrize('text', [GOOD, BAD], ids=['good', 'bad'])
def test_nothing_is_left_that_only_a_search_for_garbage_would_free(tmp_path, text):
    path = tmp_path / 'cell.sdf'
    path.write_text(world_file(text), encoding='utf-8')
    settings = settings_from_values({**VALUES, 'sdf_file': str(path)})

    def load():
        try:
            content_from_settings(settings)
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


def test_a_path_that_is_too_long_is_said_to_be():
    settings = settings_from_values({**VALUES, 'sdf_file': '/' + 'x' * 1000})
    with pytest.raises(SdfError, match='File name too long'):
        content_from_settings(settings)
