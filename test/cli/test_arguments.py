# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Arguments that several commands have: kinds, directories and formats."""

import pytest

from sdf_pose_bridge import Kind
from sdf_pose_bridge.cli.arguments import tf_options_from_arguments
from sdf_pose_bridge.cli.loading import scene_of
from sdf_pose_bridge.tf.tree import tf_tree_from_scene


def test_frames_are_those_of_the_chosen_kinds(options):
    chosen = options('--kinds', 'model,link', 'good.sdf')
    scene = scene_of('good.sdf', chosen)
    tree = tf_tree_from_scene(scene, tf_options_from_arguments(chosen))
    assert {Kind(scene.kinds[element]) for element in tree.elements} == {Kind.MODEL, Kind.LINK}


def test_an_unknown_kind_names_those_that_exist(options, capsys):
    with pytest.raises(SystemExit):
        options('--kinds', 'lnk', 'good.sdf')
    error = capsys.readouterr().err
    assert '"lnk" is not a kind of element; known are model' in error
    assert error.endswith('; did you mean "link"?\n')


def test_a_missing_directory_of_models_is_an_error(options, capsys):
    with pytest.raises(SystemExit):
        options('-I', 'nowhere', 'good.sdf')
    assert '"nowhere" is not a directory' in capsys.readouterr().err


@pytest.mark.parametrize(('command', 'formats'), [
    ('check', 'csv'), ('poses', 'github'), ('tree', 'github'), ('diff', 'xml')])
def test_unknown_format_is_refused(run_main, command, formats):
    done = run_main(command, '--format', formats, 'good.sdf', 'good.sdf')
    assert done.returncode == 2
    assert f"invalid choice: '{formats}'" in done.stderr
