# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Each format is read as SDFormat, and named in messages and in the scene."""

import pytest
from sdf_texts import LINK, model_file

from sdf_pose_bridge import load_text
from sdf_pose_bridge.errors import ParsingError
from sdf_pose_bridge.export.published_scene import LoadRequest
from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.sdformat.pose_writing import PoseText
from sdf_pose_bridge.sdformat.source_formats import SourceFormat

TEXTS = {
    SourceFormat.SDFORMAT: model_file(LINK + '<lnik/>'),
    SourceFormat.URDF: '<robot name="m"><link name="l"/><lnik/></robot>',
}
FORMATS = pytest.mark.parametrize('source_format', SourceFormat)


@FORMATS
def test_a_file_has_the_format_of_its_outermost_element(source_format):
    text = TEXTS[source_format]
    scene = load_text(text)
    assert (scene.source_format, scene.names[1:]) == (source_format, ('m', 'm::l'))
    assert PoseText(text.encode(), 'f').source_format is source_format


@FORMATS
def test_a_misspelt_element_is_told_with_the_format(source_format):
    warning = load_text(TEXTS[source_format]).warnings[0]
    assert f'is not defined in {source_format.title}' in warning.message


@FORMATS
def test_readers_of_robot_description_get_the_text(source_format):
    text = TEXTS[source_format]
    assert loaded_scene_from_request(LoadRequest('', text)).description == text


def test_no_pose_is_set_in_another_format():
    with pytest.raises(ParsingError, match='<mujoco>, it must be <sdf> or <robot>'):
        PoseText(b'<mujoco/>', 'f')
