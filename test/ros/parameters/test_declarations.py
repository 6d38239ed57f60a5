# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Declarations of parameters: what settings of them mean together."""

import json
import re

import pytest
from sdf_texts import joint, model_file, plugin

from sdf_pose_bridge.cli.main import main
from sdf_pose_bridge.export.published_scene import LoadRequest
from sdf_pose_bridge.ros.parameters.declarations import Declaration, DECLARATIONS
from sdf_pose_bridge.ros.parameters.given import settings_from_values
from sdf_pose_bridge.tf.joint_positions import UnreportedJoints
from sdf_pose_bridge.tf.tree import TfOptions


def test_what_is_read_has_all_that_a_load_needs():
    settings = settings_from_values({
        'sdf_file': 'cell.sdf', 'kinds': ['auto'], 'frame_prefix': 'r/',
        'unreported_joints': 'zero', 'use_joint_states': True})
    request = settings.load_request
    assert request.source == 'cell.sdf'
    assert request.tf_options == TfOptions(kinds=None, frame_prefix='r/', use_joint_states=True)
    assert request.unreported_joints is UnreportedJoints.ZERO


DERIVED = {'tf_options', 'follows_models', 'has_joint_links', 'others'}
"""Fields that are made of several parameters, or of none."""


@pytest.mark.parametrize('record', [TfOptions, LoadRequest])
def test_each_field_of_a_record_is_a_parameter(record):
    assert {*record._fields} - DERIVED <= DECLARATIONS.keys()


@pytest.mark.parametrize('record', [TfOptions, LoadRequest])
def test_a_field_has_the_default_value_of_its_parameter(record):
    defaults = {
        name: default for name, default in record._field_defaults.items() if name not in DERIVED}
    assert {name: DECLARATIONS[name].convert(DECLARATIONS[name].default)
            for name in defaults} == defaults


def test_gz_bridge_writes_parameters_that_the_node_takes(tmp_path, capsys):
    plugins = (plugin('JointStatePublisher')
               + plugin('PosePublisher', '<publish_model_pose>true</publish_model_pose>'))
    (tmp_path / 'm.sdf').write_text(model_file(
        '<link name="l"/><link name="k"/>'
        + joint('<parent>l</parent><child>k</child>', 'j', 'revolute') + plugins))
    assert main([
        'gz_bridge', str(tmp_path / 'm.sdf'), '--node', '--world-name', 'w', '--skip-missing',
        '-I', str(tmp_path)]) == 0
    written = {name: json.loads(value) for name, value in re.findall(
        r'^ {4}(\w+): (.*)$', capsys.readouterr().out, re.MULTILINE)}
    assert written.pop('use_sim_time') is True
    assert written.keys() == {
        'sdf_file', 'resource_paths', 'on_missing_include', 'model_name', 'use_joint_states',
        'joint_states_topics', 'model_pose_topics', 'model_pose_frames'}
    assert settings_from_values(written).values['model_pose_frames']


@pytest.mark.parametrize('name', DECLARATIONS)
def test_the_default_is_a_value_that_is_allowed(name):
    DECLARATIONS[name].convert(DECLARATIONS[name].default)


@pytest.mark.parametrize(('name', 'end'), [
    ('root_frame', '; at most 255 characters'), ('on_missing_include', 'error, skip'),
    ('pose_topics', '; at most 1000 values of at most 255 characters'), ('watch', 'true or false'),
])
def test_the_rule_of_a_text_names_its_limit(name, end):
    assert DECLARATIONS[name].rule.endswith(end)


@pytest.mark.parametrize(('default', 'most'), [('', 0), ([], 0), ('a', 0), (1.0, 9), (True, 9)])
def test_a_text_without_a_limit_cannot_be_declared(default, most):
    with pytest.raises(TypeError, match='needs most_characters'):
        Declaration(default, 'What it is.', 'its rule', str, most_characters=most)
