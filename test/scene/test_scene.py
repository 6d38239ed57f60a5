# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The scene: unknown names, poses relative to any frame, read-only arrays."""

import copy

from matrices import assert_same_pose, matrix_from_rpy
import numpy as np
import pytest
from sdf_texts import fixed_joint, model_file, world_file

from sdf_pose_bridge import load_text, UnknownFrameError
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene

TWO_WORLDS = """
    <sdf version="1.10">
      <world name="day">
        <model name="table"><pose>1 2 0 0 0 0</pose>
          <link name="top"><pose>0 0 1 0 0 0</pose></link>
        </model>
        <frame name="noon"><pose>0 0 9 0 0 0</pose></frame>
      </world>
      <world name="night">
        <model name="table"><pose>5 5 0 0 0 0</pose>
          <link name="top"><pose>0 0 1 0 0 0</pose></link>
        </model>
      </world>
    </sdf>"""
WORLD_AND_MODEL = """
    <sdf version="1.10">
      <world name="w">
        <model name="table"><pose>1 2 0 0 0 0</pose>
          <link name="top"><pose>0 0 1 0 0 0</pose></link>
        </model>
      </world>
      <model name="chair"><pose>1 2 0 0 0 0</pose>
        <link name="top"><pose>0 0 1 0 0 0</pose></link>
      </model>
    </sdf>"""


@pytest.fixture
def scene():
    return load_text(world_file("""
        <model name="table"><pose>1 2 0 0 0 0.7</pose>
          <link name="top"><pose>0 0 1 0 0 0</pose></link>
        </model>
        <model name="chair"><pose>1 2 0 0 0 -0.2</pose>
          <link name="top"><pose>0 0 1 0 0 0</pose></link>
        </model>
        <light name="sun" type="point"/>
        <light name="chair" type="point"/>"""))


@pytest.fixture
def worlds():
    return load_text(TWO_WORLDS)


@pytest.mark.parametrize(('elements', 'names'), [
    (['table'], ['table', 'table::top']), (['table::top', 'table'], ['table', 'table::top']),
    (['sun'], ['sun']), ([], [])])
def test_elements_that_are_in_others(scene, elements, names):
    found = scene.are_in([*map(scene.names.index, elements), -1])
    assert np.array(scene.names)[found].tolist() == names


# Unknown names

@pytest.mark.parametrize('name', ['', 'tabel', 'table::', 'table::to', 'w', 'w::table', '::table'])
def test_unknown_name_is_refused(scene, name):
    with pytest.raises(UnknownFrameError) as caught:
        scene.pose(name)
    assert f'"{name}"' in caught.value.message
    assert caught.value.code == 'UNKNOWN_FRAME'
    assert isinstance(caught.value, LookupError)


def test_unknown_reference_is_refused_with_the_file_and_a_hint(scene):
    with pytest.raises(UnknownFrameError, match=r'^<text>: .*"tabel".*did you mean "table"'):
        scene.pose('chair', 'tabel')


@pytest.mark.parametrize(('name', 'options', 'message'), [
    ('table', {}, r'"table".*more than one.*day.*night'),
    ('noon', {'world': 'night'}, '"noon" names nothing in world "night"$'),
    ('noon', {'world': 'dusk'}, '"noon" names nothing in world "dusk"'),
])
def test_name_of_no_world_or_of_several_is_refused(worlds, name, options, message):
    with pytest.raises(UnknownFrameError, match=message):
        worlds.pose(name, **options)


def test_model_may_be_left_out_in_a_model_file():
    scene = load_text(model_file('<link name="lift"/><link name="hand"/>'))
    assert scene.index('lift') == scene.index('m/lift') == scene.index('m::lift')
    with pytest.raises(UnknownFrameError, match=r'"lft".*did you mean "lift"'):
        scene.pose('lft')


@pytest.mark.parametrize(('text', 'names'), [
    (TWO_WORLDS.replace('table"><pose>5 5', 'bed"><pose>5 5'), ('noon', 'bed')),
    (WORLD_AND_MODEL, ('table', 'chair')), (WORLD_AND_MODEL, ('chair', 'table')),
])
def test_pose_relative_to_what_is_not_in_the_same_world_is_refused(text, names):
    with pytest.raises(UnknownFrameError):
        load_text(text).pose(*names)


def test_name_of_two_children_of_a_link_is_refused():
    scene = load_text(model_file(
        '<link name="l"><visual name="x"/><collision name="x"/></link>'))
    with pytest.raises(UnknownFrameError, match=r'more than one.*: a visual in the file.*coll'):
        scene.pose('m::l::x')


# Poses

def test_pose_in_the_root(scene):
    assert_same_pose(scene.pose('table::top'), matrix_from_rpy(1, 2, 1, 0, 0, 0.7))


def test_pose_relative_to_another_frame(scene):
    table = matrix_from_rpy(1, 2, 0, 0, 0, 0.7)
    top = matrix_from_rpy(1, 2, 1, 0, 0, -0.2)
    assert_same_pose(scene.pose('chair::top', 'table'), np.linalg.inv(table) @ top)


@pytest.mark.parametrize('root', ['', 'world'])
def test_root_can_be_named(scene, root):
    assert scene.pose('table', root) == scene.pose('table')


def test_pose_of_the_root_relative_to_a_frame(scene):
    assert_same_pose(
        scene.pose('world', 'table'), np.linalg.inv(matrix_from_rpy(1, 2, 0, 0, 0, 0.7)))


def test_frame_is_found_before_a_light_of_the_same_name(scene):
    assert scene.pose('chair')[:3] == (1, 2, 0)


@pytest.mark.parametrize(('names', 'world', 'position'), [
    (['table'], 'day', (1, 2, 0)), (['table'], 'night', (5, 5, 0)), (['noon'], '', (0, 0, 9)),
    (['noon', 'table'], '', (-1, -2, 9))])
def test_pose_in_one_of_two_worlds(worlds, names, world, position):
    assert worlds.pose(*names, world=world)[:3] == position


# Structure

def test_elements_stand_after_their_parents(scene):
    assert all(parent < index for index, parent in enumerate(scene.parents.tolist()))


def test_scene_has_roots_and_names_of_worlds(worlds):
    assert worlds.world_names == {0: 'day', 4: 'night'}
    assert worlds.roots.tolist() == [0, 0, 0, 0, 4, 4, 4]


def test_joint_has_its_ends():
    scene = load_text(TWO_WORLDS.replace(
        '"night">', '"night">' + fixed_joint('j', 'world', 'table::top')))
    assert [(scene.own_name(each.parent), scene.names[each.child]) for each in scene.joints] == [
        ('night', 'table::top')]


def test_pose_is_relative_to_its_reference():
    scene = load_text(model_file("""
        <link name="a"/>
        <frame name="f"><pose relative_to="a">0 0 1 0 0 0</pose></frame>
        <frame name="g"/>"""))
    assert scene.names == ('__root__', 'm', 'm::a', 'm::f', 'm::g')
    assert scene.references.tolist() == [-1, 0, 1, 2, 1]


def test_own_name_has_no_scope(worlds):
    assert [worlds.own_name(index) for index in range(4)] == ['day', 'table', 'top', 'noon']


# Default references and ancestors

def test_default_reference_depends_on_the_kind():
    scene = load_text(model_file(
        '<link name="a"><visual name="v"><geometry><empty/></geometry></visual></link>'
        '<link name="b"><pose relative_to="a"/></link><frame name="f" attached_to="a"/>'
        '<frame name="g"/>'
        '<joint name="j" type="fixed"><parent>a</parent><child>b</child></joint>'))
    defaults = {
        scene.own_name(element): None if reference < 0 else scene.own_name(reference)
        for element, reference in enumerate(scene.default_references.tolist())}
    assert defaults == {
        '__root__': None, 'm': '__root__', 'a': 'm', 'v': 'a', 'b': 'm', 'f': 'a', 'g': 'm',
        'j': 'b'}


def test_default_reference_of_a_joint_that_is_only_warned_of():
    scene = load_text(model_file(
        '<link name="base"/><model name="n"><link name="a"/><frame name="f" attached_to="a"/>'
        '<joint name="j" type="fixed"><parent>a</parent><child>f</child></joint></model>'))
    assert [warning.code for warning in scene.warnings] == ['JOINT_PARENT_SAME_AS_CHILD']
    assert scene.joints == ()
    joint = scene.index('m::n::j')
    assert scene.default_references[joint] == scene.references[joint] == scene.index('m::n::f')


def test_ancestors_of_an_element(scene):
    found = scene.with_ancestors(scene.index('table::top'))
    assert [scene.names[each] for each in found] == ['table::top', 'table', 'world']


# Half turns

@pytest.mark.parametrize('quat_xyzw', [
    (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0.6, 0.8, 0, 0), (0.6, -0.8, 0, 0),
    (0, 0.6, -0.8, 0),
])
@pytest.mark.parametrize('sign', [1, -1])
def test_half_turn_between_elements_has_the_canonical_sign(quat_xyzw, sign):
    written = ' '.join(str(sign * component) for component in quat_xyzw)
    scene = load_text(model_file(
        '<link name="a"/><frame name="f">'
        f'<pose rotation_format="quat_xyzw">0 0 0 {written}</pose></frame>'))
    lookup = PoseLookup(scene, tf_tree_from_scene(scene))
    for names in (('m::f', 'm::a'), ('m::a', 'm::f')):
        assert scene.pose(*names)[3:] == quat_xyzw
        assert lookup.pose(*names).pose == scene.pose(*names)


# Immutability

@pytest.mark.parametrize('name', ['poses', 'names', 'warnings', 'anything'])
def test_fields_cannot_be_set(scene, name):
    with pytest.raises(AttributeError, match=f"cannot assign to field '{name}'"):
        setattr(scene, name, ())


def test_representation_of_a_scene(scene):
    assert repr(scene) == f'<Scene of {scene.path}: {len(scene.names)} elements>'


def test_copy_of_a_scene_is_not_equal(scene):
    copied = copy.deepcopy(scene)
    assert scene != copied
    assert not copied.poses.flags.writeable
