# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Settings: every value is judged, and one that is refused is named with its rule."""

from pathlib import Path

import pytest

from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.ros.settings import settings_from_values
from sdf_pose_bridge.ros.settings import SettingsError
from sdf_pose_bridge.scene.loading import MissingInclude
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.tree import AnchorModels
from sdf_pose_bridge.tf.tree import TfOptions

VALUES = {
    'sdf_file': 'cell.sdf', 'root_frame': 'world', 'anchor_models': 'all', 'model': '',
    'frame_names': 'auto', 'frame_separator': '/', 'frame_prefix': '',
    'kinds': ['model', 'link', 'frame', 'sensor'], 'pose_topics': ['*'], 'optical_frames': True,
    'resource_paths': [], 'on_missing_include': 'error', 'publish_rate': 0.0, 'watch': True,
}


@pytest.mark.parametrize(('name', 'value', 'sentence'), [
    ('sdf_file', '', 'parameter sdf_file is not set'),
    ('root_frame', '', 'parameter root_frame is ""; it must be a frame id'),
    ('root_frame', '/map', 'parameter root_frame is "/map"; it must be without a leading slash'),
    ('root_frame', 'a\nb', r'parameter root_frame is "a\nb"; it must be without control'),
    ('anchor_models', 'some',
     'parameter anchor_models is "some"; it must be one of all, static, none'),
    ('on_missing_include', 'ignore', 'it must be one of error, skip'),
    ('frame_names', 'Auto', 'it must be one of auto, scoped, relative'),
    ('frame_separator', '', 'parameter frame_separator is ""; it must be at least one'),
    ('frame_prefix', '/robot/', 'parameter frame_prefix is "/robot/"; it must be without a'),
    ('kinds', [], 'parameter kinds is []; it must be at least one of model, link, joint'),
    ('publish_rate', -1.0, 'parameter publish_rate is -1.0; it must be from 0.0 to 100.0 Hz'),
    ('publish_rate', float('nan'), 'parameter publish_rate is nan; it must be from 0.0 to'),
    ('kinds', ['link', 'world'], 'parameter kinds is "world"; it must be made of model, link'),
])
def test_a_wrong_value_is_named_with_its_rule(name, value, sentence):
    with pytest.raises(SettingsError) as refusal:
        settings_from_values({**VALUES, name: value})
    assert [problem.parameter for problem in refusal.value.problems] == [name]
    assert refusal.value.problems[0].sentence.startswith(sentence) or (
        sentence in refusal.value.problems[0].sentence)


def test_all_wrong_values_are_named_at_once():
    with pytest.raises(SettingsError) as refusal:
        settings_from_values({**VALUES, 'sdf_file': '', 'kinds': ['rope'], 'frame_names': 'x'})
    assert [problem.parameter for problem in refusal.value.problems] == [
        'sdf_file', 'frame_names', 'kinds']


def test_the_defaults_are_those_of_the_tree():
    assert settings_from_values(VALUES).tf_options == TfOptions()


def test_values_reach_the_settings():
    settings = settings_from_values({
        'sdf_file': 'a.sdf', 'root_frame': 'map', 'anchor_models': 'static', 'model': 'r::arm',
        'frame_names': 'scoped', 'frame_separator': '.', 'frame_prefix': 'left_',
        'kinds': ['joint', 'joint', 'light'], 'pose_topics': ['r/*', 'tool'],
        'optical_frames': False, 'resource_paths': ['/models', '', '/more'],
        'on_missing_include': 'skip', 'publish_rate': 2.5, 'watch': False,
    })
    assert settings.sdf_file == 'a.sdf'
    assert settings.pose_topics == ('r/*', 'tool')
    assert settings.resource_paths == (Path('/models'), Path('/more'))
    assert settings.on_missing_include is MissingInclude.SKIP
    assert (settings.publish_rate, settings.watch) == (2.5, False)
    assert settings.tf_options == TfOptions(
        root_frame='map', anchor_models=AnchorModels.STATIC, model='r::arm',
        frame_names=FrameNames.SCOPED, frame_separator='.', frame_prefix='left_',
        kinds=frozenset({Kind.JOINT, Kind.LIGHT}), optical_frames=False)
