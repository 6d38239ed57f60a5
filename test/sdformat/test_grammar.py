# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The grammar: which kinds there are and where they stand; a new kind is one entry."""

import json
import os
from pathlib import Path
import re
import shutil
import sys

from command_line import completed
from folders import ROOT
import pytest
from sdf_texts import element, LINK, LINK_CHILDREN, link_with, model_file, names_of, world_file

from sdf_pose_bridge import Kind, load_text
from sdf_pose_bridge.sdformat.grammar import (
    Definition,
    definition_of,
    STANDALONE_ELEMENTS,
    ValueType,
)
from sdf_pose_bridge.sdformat.specification import CHOICES
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

PACKAGE = ROOT / 'sdf_pose_bridge'


# Definitions

@pytest.mark.parametrize('item', [
    'mass::double', 'depth:doubel', '@name:', '@', 'name!!', 'x:double[0', 'x:double[0,]]', '*:',
    '**', 'x=', 'x=y=z', 'link!=lnk', 'x;y'])
def test_item_of_a_definition_that_is_misspelt_is_an_error(item):
    with pytest.raises(ValueError, match=re.escape(f'"{item}"')):
        Definition('box', f'size:vector3 {item}')


def test_misspelt_definition_is_an_error_when_the_grammar_is_imported(tmp_path):
    shutil.copytree(PACKAGE, tmp_path / PACKAGE.name)
    specification = tmp_path / PACKAGE.name / 'sdformat/specification.py'
    text = specification.read_text()
    assert text.count("'audio': 'device!'") == 1
    specification.write_text(text.replace("'device!'", "'device!:strng'"))
    done = completed(
        [sys.executable, '-c', f'import {PACKAGE.name}.sdformat.grammar'], cwd=tmp_path,
        env={**os.environ, 'PYTHONPATH': str(tmp_path)})
    assert '"strng" in the definition "device!:strng" is not a type of values' in done.stderr


# Kinds

@pytest.mark.parametrize('content', [
    '<link name="l"><frame name="f"><pose>no</pose></frame></link>',
    '<link name="l"><visual name="v"><link name="k"/></visual></link>',
    LINK + '<gripper name="g"><link name="k"/></gripper>',
    LINK + '<tool><link name="k"/></tool>',
])
def test_element_in_a_place_where_its_kind_cannot_stand_is_skipped(content):
    names = names_of(load_text(model_file(content)))
    assert {'m::f', 'm::l::f', 'm::k', 'm::l::v::k'}.isdisjoint(names)


def test_elements_have_their_kinds():
    scene = load_text(world_file(
        '<model name="m"><link name="l"><inertial/>'
        + ''.join(element(tag, tag) for tag in LINK_CHILDREN)
        + '</link><frame name="f"/></model><light name="sun" type="point"/><actor name="a"/>'))
    assert [Kind(kind).label for kind in scene.kinds] == [
        'world', 'model', 'link', 'inertial', *LINK_CHILDREN, 'frame', 'light', 'actor']


def test_label_of_a_kind_is_its_tag():
    assert Kind.PARTICLE_EMITTER.label == 'particle_emitter'


def test_references_can_name_four_kinds():
    assert {kind.label for kind in Kind if kind.is_frame} == {'model', 'link', 'joint', 'frame'}


@pytest.mark.parametrize('kind', Kind)
def test_parameters_of_includes_can_add_every_kind(kind):
    assert STANDALONE_ELEMENTS[kind.label] == kind.label


@pytest.mark.parametrize(
    'kind', [kind for kind in Kind if 'link' in kind.parents and kind.has_name])
def test_kinds_in_a_link_may_share_a_name(kind):
    others = ''.join(element(tag, kind.label) for tag in LINK_CHILDREN if tag != kind.label)
    scene = load_text(link_with(others + element(kind.label, kind.label)))
    tree = tf_tree_from_scene(scene, TfOptions(kinds=frozenset(Kind), optical_frames=False))
    assert len(tree.frame_ids) == len(scene.names) - 1


def test_number_of_a_kind_is_its_position():
    assert [int(kind) for kind in Kind] == list(range(len(Kind)))


# Definitions

def test_definition_has_attributes():
    attribute = definition_of('joint', has_frames=True).attributes['type']
    assert (attribute.value_type, attribute.required, attribute.choice) == (
        ValueType.CHOICE, '!', CHOICES['joint_type'])


def test_definition_has_children_with_values():
    assert definition_of('box').children['size'].value_type is ValueType.THREE_NUMBERS


def test_definition_has_children_with_ranges():
    value = definition_of('bounce').children['restitution_coefficient'].value
    assert (value.minimum, value.maximum) == (0.0, 1.0)


def test_definition_depends_on_the_parent_element():
    contents = [definition_of(parent).children['limit'].identifier for parent in ('axis', 'axis2')]
    assert contents == ['axis/limit', 'axis2/limit']


def test_definition_has_required_children():
    assert definition_of('axis').required_children == {'xyz', 'limit'}


def test_frames_depend_on_some_children_only():
    def tags_of(definition):
        return {tag for tag, child in definition.children.items() if child.concerns_frames}

    definition = definition_of('visual', has_frames=True)
    assert tags_of(definition) == {'pose', 'geometry', 'material'}
    assert tags_of(definition.children['geometry']) == {'mesh'}


def test_element_of_a_state_is_no_frame():
    assert definition_of('model_state').children['frame'].kind is None


def test_unknown_identifier_is_refused():
    with pytest.raises(KeyError):
        definition_of('unicycle')


# A new kind: all that knows it is one line of the grammar

BEAM = "    BEAM = 'link', '@name! pose length:double'\n"
AFTER_KINDS = '\n    @property\n    def label'
MAIN = """<sdf version="1.10"><world name="w">
<model name="m"><pose>0 0 1 0 0 0</pose>
  <link name="l"><pose>1 0 0 0 0 1.5707963267948966</pose>
    <beam name="b"><pose>1 0 0 0 0 0</pose><length>2.5</length></beam>
    <beam name="at_frame"><pose relative_to="f">1 0 0 0 0 0</pose></beam>
    <beam name="at_nested_link"><pose relative_to="n::k">1 0 0 0 0 0</pose></beam>
    <beam name="nowhere"><pose relative_to="zzz"/></beam>
    <visual name="b"/><sensor name="b" type="imu"/>
  </link>
  <frame name="f"><pose>0 5 0 0 0 0</pose></frame>
  <model name="n"><pose>0 0 7 0 0 0</pose>
    <link name="k"><beam name="b"><pose degrees="true">0 1 0 0 0 180</pose></beam></link>
  </model>
  <include merge="true"><uri>crane.sdf</uri><pose>10 0 0 0 0 0</pose></include>
</model>
<include><uri>crane.sdf</uri><name>c</name><pose>0 20 0 0 0 0</pose><experimental:params>
  <beam element_id="jib" action="add" name="added"><pose>0 0 2 0 0 0</pose></beam>
</experimental:params></include>
</world></sdf>"""
CRANE = """<sdf version="1.8"><model name="crane"><link name="jib">
<beam name="b"><pose rotation_format="quat_xyzw">0 0 3 0 0 1 0</pose><length>1</length></beam>
</link></model></sdf>"""
WRONG = """<sdf version="1.10"><model name="m"><link name="l">
<beam><pose>1 0 0 0 0 0</pose></beam>
<beam name="b"/>
<beam name="b"/>
<beam name="p"><pose>1 2 3</pose></beam>
<beam name="q"><length>long</length></beam>
<beam name="world"/>
</link></model></sdf>"""
PROGRAM = """
import json
import sdf_pose_bridge
from sdf_pose_bridge import Kind
from sdf_pose_bridge.tf.tree import tf_tree_from_scene
from sdf_pose_bridge.tf.tree import TfOptions

scene = sdf_pose_bridge.load('main.sdf', resource_paths=['.'])
try:
    sdf_pose_bridge.load('wrong.sdf')
except sdf_pose_bridge.SdfError as error:
    errors = error.errors
tree = tf_tree_from_scene(scene, TfOptions(kinds=frozenset(Kind)))
default_tree = tf_tree_from_scene(scene)
print(json.dumps({
    'package': sdf_pose_bridge.__file__,
    'warnings': [(warning.code, warning.place.line) for warning in scene.warnings],
    'errors': [(error.code, error.line) for error in errors],
    'parents': [
        (scene.names[element], parent)
        for element, parent in zip(tree.elements.tolist(), tree.parent_ids)
        if scene.kinds[element] == Kind.BEAM],
    'frame_ids': tree.frame_ids,
    'default_kinds': sorted({Kind(scene.kinds[i]).label for i in default_tree.elements.tolist()}),
}))
"""


def python_with_beam(folder, *arguments):
    """Run Python where the package is the copy in a folder that knows beams."""
    done = completed(
        [sys.executable, *arguments], cwd=folder, env={**os.environ, 'PYTHONPATH': str(folder)})
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.fixture(scope='module')
def beam_folder(tmp_path_factory):
    """Return a folder with the files above and a copy of the package with one more kind."""
    folder = tmp_path_factory.mktemp('beams')
    shutil.copytree(
        PACKAGE, folder / 'sdf_pose_bridge', ignore=shutil.ignore_patterns('__pycache__'))
    grammar = folder / 'sdf_pose_bridge' / 'sdformat' / 'grammar.py'
    members, rest = grammar.read_text().split(AFTER_KINDS)
    grammar.write_text(members + BEAM + AFTER_KINDS + rest)
    for name, content in (('main', MAIN), ('crane', CRANE), ('wrong', WRONG)):
        (folder / f'{name}.sdf').write_text(content)
    return folder


@pytest.fixture(scope='module')
def beams(beam_folder):
    """Return what the program says of the files."""
    return python_with_beam(beam_folder, '-c', PROGRAM)


@pytest.fixture(scope='module')
def beam_poses(beam_folder):
    """Return the poses of all beams, as the command line prints them, by name."""
    answer = python_with_beam(
        beam_folder, '-m', 'sdf_pose_bridge', 'poses', '--json', '--kinds', 'beam', 'main.sdf')
    assert {row['kind'] for row in answer['elements']} == {'beam'}
    return {row['name']: row['pose'] for row in answer['elements']}


def test_copy_of_the_package_is_used(beams, beam_folder):
    assert Path(beams['package']).is_relative_to(beam_folder)


@pytest.mark.parametrize(('code', 'line'), [
    ('ATTRIBUTE_MISSING', 2), ('DUPLICATE_NAME', 4), ('ELEMENT_INVALID', 5),
    ('ELEMENT_INVALID', 6), ('RESERVED_NAME', 7),
], ids=['no name', 'name in use', 'bad pose', 'bad length', 'reserved name'])
def test_wrong_element_of_a_new_kind_is_refused(beams, code, line):
    assert [code, line] in beams['errors']


def test_right_elements_of_a_new_kind_have_no_errors(beams):
    assert len(beams['errors']) == 5


@pytest.mark.parametrize(('name', 'pose'), [
    ('m::l::b', (1, 1, 1, 0, 0, 0.5 ** 0.5, 0.5 ** 0.5)),
    ('m::l::at_frame', (1, 5, 1, 0, 0, 0, 1)),
    ('m::l::at_nested_link', (1, 0, 8, 0, 0, 0, 1)),
    ('m::n::k::b', (0, 1, 8, 0, 0, 1, 0)),
    ('m::jib::b', (10, 0, 4, 0, 0, 1, 0)),
    ('c::jib::b', (0, 20, 3, 0, 0, 1, 0)),
    ('c::jib::added', (0, 20, 2, 0, 0, 0, 1)),
], ids=[
    'link', 'frame', 'nested link', 'nested model', 'merged model', 'included model', 'params'])
def test_element_of_a_new_kind_has_a_pose(beam_poses, name, pose):
    assert beam_poses[name] == pytest.approx(pose, abs=1e-12)


def test_element_of_a_new_kind_with_an_unknown_reference_is_left_out(beams, beam_poses):
    assert len(beam_poses) == 7
    assert beams['warnings'] == [['POSE_RELATIVE_TO_INVALID', 7]]


def test_element_of_a_new_kind_is_a_tf_frame_in_its_link_if_asked_for(beams):
    assert dict(beams['parents']) == {
        'm::l::b': 'm/l', 'm::l::at_frame': 'm/l', 'm::l::at_nested_link': 'm/l',
        'm::n::k::b': 'm/n/k', 'm::jib::b': 'm/jib', 'c::jib::b': 'c/jib',
        'c::jib::added': 'c/jib'}


def test_element_of_a_new_kind_may_share_its_name_with_other_kinds(beams):
    assert {'m/l/beam/b', 'm/l/visual/b', 'm/l/b'} <= set(beams['frame_ids'])


def test_element_of_a_new_kind_is_no_tf_frame_by_default(beams):
    assert 'beam' not in beams['default_kinds']


def test_element_of_an_unknown_kind_is_skipped():
    assert names_of(load_text(link_with('<beam name="b"><pose>no</pose></beam>'))) == [
        'm', 'm::l']
