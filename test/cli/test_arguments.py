# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Arguments that several commands have: kinds, directories and formats."""

import pytest
from sdf_texts import element, LINK, model_file, world_file, write_files

from sdf_pose_bridge import Kind
from sdf_pose_bridge.cli.arguments import tf_options_from_arguments
from sdf_pose_bridge.cli.input_files import scene_of
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


@pytest.mark.parametrize(('arguments', 'code', 'reason'), [
    ('graph bad.sdf', 1, 'bad.sdf:3: ELEMENT_INVALID: '),
    ('graph good.sdf --model n', 1, 'there is no model "n"'),
    ('graph good.sdf -o nowhere/a.dot', 1, 'nowhere/a.dot: FILE_WRITE: the file cannot '),
    ('graph good.sdf -o a.gif', 2, '"a.gif" must end with one of .svg, .png, .pdf, .dot'),
    ('graph good.sdf bad.sdf', 2, 'unrecognized arguments: bad.sdf'),
    ('view bad.sdf -o a.html', 1, 'bad.sdf:3: ELEMENT_INVALID: '),
    ('view good.sdf -o a.html --model n', 1, 'there is no model "n"'),
    ('view good.sdf -o nowhere/a.html', 1, 'nowhere/a.html: FILE_WRITE: the file cannot '),
    ('view good.sdf -o a.svg', 2, '"a.svg" must end with one of .html, .png'),
    ('urdf bad.sdf', 1, 'bad.sdf:3: ELEMENT_INVALID'),
    ('urdf none.sdf', 1, 'FILE_READ'),
    ('urdf models.sdf', 1, 'the file has the models "table", "robot"; choose one by --model'),
    ('urdf models.sdf --model rubot', 1, 'there is no model "rubot" to publish; did you mean'),
    ('urdf good.sdf -o none/a.urdf', 1, (
        'none/a.urdf: FILE_WRITE: the file cannot be written: no such file or directory')),
    ('urdf good.sdf --frame-separator=', 2, 'at least one character'),
    ('gz_bridge none.sdf', 1, 'FILE_READ'),
    ('gz_bridge states.sdf', 1, 'ELEMENT_MISSING: the joint_states of model "m" is on'),
    ('gz_bridge good.sdf --world-name w', 1, (
        'good.sdf has a world; --model-name and --world-name')),
    ('gz_bridge good.sdf --only joint', 2, (
        '"joint" has another name than joints, poses, odometry')),
    ('gz_bridge good.sdf -o none/a.yaml', 1, 'none/a.yaml: FILE_WRITE: '),
])
def test_wrong_input_gives_one_error(run_main, files, arguments, code, reason):
    if arguments.startswith('view'):
        pytest.importorskip('viser', reason='needs viser')
    models = ''.join(element('model', name, LINK) for name in ('table', 'robot'))
    plugin = '<plugin filename="gz-sim-joint-state-publisher-system" name=""/>'
    write_files(files, models=world_file(models), states=model_file(LINK + plugin))
    done = run_main(*arguments.split())
    assert (done.returncode, done.stdout) == (code, '')
    assert reason in done.stderr
