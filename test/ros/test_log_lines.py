# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What goes to the log: one line for each thing, whatever names a file holds."""

import ast
from pathlib import Path
import re

import pytest
from sdf_texts import fixed_joint, joint, model_file, world_file
from tf_checks import tree_of
import urdf_texts as urdf

from sdf_pose_bridge.errors import LoadError, ParsingError, Place, SdfError
from sdf_pose_bridge.export.published_scene import LoadRequest
from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.problems import MOST_PROBLEMS
from sdf_pose_bridge.ros import log_lines
from sdf_pose_bridge.ros.log_lines import (
    line_about_detached_models,
    line_about_rest,
    line_from_text,
    lines_about_lost_frames,
    lines_about_scene,
    lines_from_error,
    lines_from_warnings,
    MOST_LINES,
    text_about_defect,
)
from sdf_pose_bridge.ros.parameters.declarations import SettingsError
from sdf_pose_bridge.ros.publishing.state_report import StateReport
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.anchors import AnchorModels
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

AXIS = '<axis><xyz>0 0 1</xyz>{}</axis>'
MIMIC = ('<mimic joint="j"><multiplier>2</multiplier><offset>0</offset><reference>0</reference>'
         '</mimic>')
ENDS = '<parent>{}</parent><child>{}</child>'


def test_each_error_of_a_file_has_its_line_with_its_place():
    errors = [ParsingError(f'fact {line}', Place('a.sdf', line)) for line in (3, 7)]
    assert lines_from_error(LoadError(errors)) == [
        'a.sdf:3: PARSING_ERROR: fact 3', 'a.sdf:7: PARSING_ERROR: fact 7']


def test_the_error_of_a_missing_include_names_the_parameter_that_leaves_it_out():
    with pytest.raises(SdfError) as caught:
        load_text(world_file('<include><uri>https://a.org/1.0/b/models/c</uri></include>'))
    (line,) = lines_from_error(caught.value)
    assert line.endswith('; on_missing_include "skip" leaves it out')


@pytest.mark.parametrize(('prefix', 'asks'), [
    ('', False), ('robot1/', False), ('robot1_', False), ('robot1', True)])
def test_a_prefix_that_runs_into_the_names_is_asked_about(prefix, asks):
    _, *lines = lines_about_scene(loaded_scene_from_request(LoadRequest(
        '', model_file('<link name="l"/>'), tf_options=TfOptions(frame_prefix=prefix))))
    asked = [line.partition('did you mean ')[2] for line in lines if 'did you mean' in line]
    assert asked == ['"robot1/"?'] * asks


@pytest.mark.parametrize(('lines', 'last'), [
    (lines_from_error(LoadError([
        ParsingError(f'fact {line}', Place('a.sdf', line)) for line in range(MOST_LINES + 1)])),
     '1 more error; "sdf_pose check" shows all of them'),
    (lines_from_error(SettingsError(['wrong'] * (MOST_LINES + 2))), '2 more errors'),
    (lines_from_warnings([f'warning {number}' for number in range(MOST_LINES + 7)]),
     '7 more warnings'),
], ids=['errors', 'sentences about settings', 'warnings'])
def test_a_flood_ends_with_its_size(lines, last):
    assert len(lines) == MOST_LINES + 1
    assert lines[-1] == f'not shown: {last}'


def test_each_sentence_about_settings_has_its_line():
    error = SettingsError(['first', 'second'])
    assert lines_from_error(error) == ['first', 'second']


@pytest.mark.parametrize(('name', 'shown'), [
    ('a\nb', r'a\nb'), ('a\r\x1b[31mb', r'a\r\x1b[31mb'), ('a\u2028b', r'a\u2028b'),
    ('größe 1', 'größe 1'),
])
def test_a_name_cannot_write_a_line_of_its_own(name, shown):
    assert lines_from_error(ParsingError(name, Place('f'))) == [f'f: PARSING_ERROR: {shown}']


def test_text_of_others_is_one_short_line():
    line = line_from_text('a\n[FATAL] ' + 'x' * 10_000)
    assert line.startswith(r'a\n[FATAL] xxx')
    assert len(line) < 2100


def test_the_traceback_of_a_defect_writes_no_line_of_the_log():
    try:
        raise ValueError('a\n[FATAL] b\x1b[2J\n' * 1000)
    except ValueError:
        first, *lines = text_about_defect('a test').split('\n')
    assert first.startswith('internal error in a test: ')
    assert first.isprintable()
    assert all(line.startswith('    ') and line.isprintable() for line in lines)
    assert len(lines) == 100


def test_names_and_paths_cannot_write_lines_of_their_own(tmp_path):
    path, name = tmp_path / 'a\n[FATAL] b.sdf', 'a\n[FATAL] b'
    path.write_text(world_file(
        '<model name="m&#10;[FATAL]"><link name="a"/><link name="b"/>'
        + joint(ENDS.format('a', 'b') + AXIS.format(''), 'j', 'revolute') + '</model>'))
    loaded = loaded_scene_from_request(LoadRequest(
        str(path), '', tf_options=TfOptions(anchor_models=AnchorModels.NONE)))
    empty = tree_of(world_file(''))
    lines = [
        *lines_about_scene(loaded), *lines_about_lost_frames(loaded.tree, empty),
        StateReport([name]).line_about_unreported(),
        StateReport(models=[name]).line_about_unreported(),
        line_about_rest(loaded.tree),
        *lines_from_error(SettingsError([name])), *lines_from_error(ValueError(name)),
        *lines_from_warnings([name])]
    assert len(lines) == 9
    assert [r'\n[FATAL]' in line and line.isprintable() for line in lines] == [True] * 9


HARMLESS = {
    # Results of the functions of log_lines, or of functions that use them for names.
    'line', 'reason', 'topics.warning',
    # Numbers, words of this package, and names of topics and services, which ROS has checked.
    '1000.0 * seconds', 'MOST_PUBLISHERS', 'count', 'len(self._publishers)', 'models', 'name',
    'key.name', 'self._settings.publish_rate', 'self.name', 'source.name',
}


def parts(text):
    """Return what an expression puts into a text, without calls of the functions of log_lines."""
    if isinstance(text, ast.JoinedStr):
        return [each for value in text.values for each in parts(value)]
    if isinstance(text, ast.FormattedValue):
        return parts(text.value)
    if isinstance(text, ast.IfExp):
        return parts(text.body) + parts(text.orelse)
    if isinstance(text, ast.Call) and isinstance(text.func, ast.Name) and hasattr(
            log_lines, text.func.id):
        return []
    return [] if isinstance(text, ast.Constant) else [ast.unparse(text)]


def logged_texts():
    for path in Path(log_lines.__file__).parent.rglob('*.py'):
        for call in ast.walk(ast.parse(path.read_text())):
            if isinstance(call, ast.Call) and re.search(
                    r'(logger(\(\))?\.(debug|info|warning|error|fatal)|log_error)$',
                    ast.unparse(call.func)):
                yield pytest.param(call.args[0], id=f'{path.name} {call.lineno}')


@pytest.mark.parametrize('text', list(logged_texts()))
def test_all_text_of_others_that_is_logged_goes_through_one_function(text):
    assert HARMLESS.issuperset(parts(text))


def test_a_flood_that_the_load_has_cut_has_no_exact_size():
    errors = [
        ParsingError(f'fact {line}', Place('a.sdf')) for line in range(MOST_PROBLEMS + 1)]
    assert lines_from_error(LoadError(errors))[-1].startswith('not shown: at least 81 more errors')
    assert lines_from_warnings(errors)[-1].startswith('not shown: at least 81 more warnings')


def test_few_warnings_are_all_written():
    assert lines_from_warnings(['one', 'two']) == ['one', 'two']


def test_frames_that_tf_cannot_forget_are_named():
    def tree(names, anchor_models=AnchorModels.ALL):
        world = ''.join(
            f'<model name="{name}"><link name="l"/></model>' for name in names)
        return tree_of(
            world_file(world), kinds=frozenset({Kind.LINK}), anchor_models=anchor_models)

    assert lines_about_lost_frames(tree('ab'), tree('abc')) == []
    vanished, = lines_about_lost_frames(tree('abc'), tree('b'))
    assert vanished.startswith('2 frames no longer published')
    assert vanished.endswith('"a/l", "c/l"')
    detached, = lines_about_lost_frames(tree('a'), tree('a', AnchorModels.NONE))
    assert detached.startswith('1 frame without a parent now')
    assert detached.endswith('"a/l"')
    assert lines_about_lost_frames(tree('a', AnchorModels.NONE), tree('')) == []


def test_joints_that_stand_still_are_counted_where_they_are_published():
    ends = '<parent>a</parent><child>b</child>'
    arm = ('<model name="{}">{}<link name="a"/><link name="b"/>'
           + joint(ends, 'j', 'revolute') + fixed_joint('f', 'a', 'b') + '</model>')
    still = arm.format('still', '<static>true</static>')
    scene = load_text(world_file(arm.format('left', '') + arm.format('right', '') + still))
    for model, count in (('', '2 joints that can move, for example "left/j";'),
                         ('right', '1 joint that can move, for example "right/j";')):
        assert count in line_about_rest(tf_tree_from_scene(
            scene, TfOptions(model=model), finds_at_rest=True))
    assert line_about_rest(tf_tree_from_scene(
        load_text(world_file(still)), finds_at_rest=True)) == ''


@pytest.mark.parametrize('content', [
    joint(ENDS.format('a', 'b'), 'j', 'ball'),
    joint(ENDS.format('a', 'b') + AXIS.format(''), 'j', 'revolute')
    + joint(ENDS.format('b', 'c') + AXIS.format(MIMIC), 'k', 'revolute'),
])
def test_joints_that_stand_still_are_those_that_messages_have_to_name(content):
    scene = load_text(model_file(
        '<link name="a"/><link name="b"/><link name="c"/>' + content, version='1.11'))
    tree = tf_tree_from_scene(scene, TfOptions(use_joint_states=True), finds_at_rest=True)
    positions = JointPositions(scene, tree.moving.motion)
    (first,), _ = positions.unreported()
    assert line_about_rest(tree) == ''
    line = line_about_rest(tf_tree_from_scene(scene, finds_at_rest=True))
    assert line.startswith(f'fixed as in the file: 1 joint that can move, for example "{first}";')


def test_models_without_a_transform_from_the_root_are_named():
    def line(text, **options):
        return line_about_detached_models(
            tf_tree_from_scene(load_text(text), TfOptions(root_frame='map', **options)))

    arm = '<model name="arm"><link name="l"/><model name="hand"><link name="l"/></model></model>'
    assert line(world_file(arm)) == ''
    assert line(f'<sdf version="1.10">{arm}</sdf>') == (
        'no transform to "l", the root of its tree: odometry or localization can publish one, or '
        'this node from "map" with anchor_models "all"')
    assert '"arm/l", "b/l", the roots of their trees:' in line(
        world_file(f'{arm}<model name="b"><link name="l"/></model>'),
        anchor_models=AnchorModels.STATIC)


def test_a_leaf_beside_the_root_is_not_named():
    scene = load_text(
        '<sdf version="1.10"><model name="m"><link name="a"/><link name="b"/><frame name="f"/>'
        '<frame name="g" attached_to="f"/></model></sdf>')
    tree = tf_tree_from_scene(scene, TfOptions(kinds=frozenset({Kind.FRAME})))
    assert tree.parent_ids == ('', 'f')
    assert 'no transform to "f", the root' in line_about_detached_models(tree)
    tree = tf_tree_from_scene(scene, TfOptions(frame_prefix='r/'))
    assert 'no transform to "r/a", the root' in line_about_detached_models(tree)


def test_the_line_about_a_urdf_names_its_root_and_its_link_world():
    links = '<robot name="r"><link name="{}"/><link name="a"/>' + urdf.joint('j', '{}', 'a')
    for root in ('base', 'world'):
        scene = load_text(links.format(root, root) + '</robot>')
        tree = tf_tree_from_scene(scene, TfOptions(frame_prefix='r/'))
        assert f'no transform to "r/{root}", the root' in line_about_detached_models(tree)


def test_warnings_for_gazebo_are_counted():
    loaded = loaded_scene_from_request(LoadRequest('', model_file('<link name="l"/>')))
    for count, shown in (0, []), (1, ['1 warning']), (7, ['7 warnings']):
        lines = lines_about_scene(loaded._replace(gazebo_warning_count=count))
        assert [line.partition(' about Gazebo')[0].removeprefix('not shown: ')
                for line in lines if 'Gazebo' in line] == shown
