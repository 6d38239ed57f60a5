# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Names and positions of joints."""

import numpy as np
import pytest
from sdf_texts import joint, model_file, world_file

from sdf_pose_bridge.errors import JointPositionError
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.tf.joint_positions import (
    JointPositions,
    LARGEST_POSITION,
    leading_dofs,
    scene_at_positions,
    UnreportedJoints,
)
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

ENDS = '<parent>a</parent><child>b</child>'
LINKS = '<link name="a"/><link name="b"/><link name="c"/>'
ONE_JOINT = LINKS + joint(ENDS, 'j', 'revolute')
MIMIC = (
    '<axis><xyz>0 0 1</xyz><mimic joint="{}"><multiplier>2</multiplier>'
    '<offset>1</offset><reference>0.5</reference></mimic></axis>')


def model(name, content=''):
    return f'<model name="{name}">{ONE_JOINT}{content}</model>'


def positions_of(text, *arguments, **options):
    scene = load_text(text)
    tree = tf_tree_from_scene(scene, TfOptions(use_joint_states=True))
    return JointPositions(scene, tree.moving.motion, *arguments, **options)


def update(positions, stamp_ns=0, **values):
    selection = positions.selection(list(values))
    return positions.update(selection, np.array(list(values.values()), float), stamp_ns)


def values_of(positions):
    return dict(zip(positions.names, positions.values.tolist(), strict=True))


def following(leader='j', name='k', parent='b', child='c'):
    """Write a joint that follows another one."""
    return joint(
        f'<parent>{parent}</parent><child>{child}</child>{MIMIC.format(leader)}', name, 'revolute')


LEADER = LINKS + joint(f'{ENDS}<axis><xyz>0 0 1</xyz></axis>', 'j', 'revolute')
TWO_MODELS = world_file(model('x') + model('y'))


def positions_in_model(content=ONE_JOINT):
    return positions_of(model_file(content, version='1.11'))


def test_leading_joints_are_in_file_order():
    joints = ''.join(
        joint(f'<parent>{ends[0]}</parent><child>{ends[1]}</child><axis/>', ends, 'revolute')
        for ends in ('da', 'db', 'ae'))
    scene = load_text(model_file(
        f'{LINKS}<link name="d"/><link name="e"/>{joints}{following("da")}', version='1.11'))
    assert [dof.name for dof in leading_dofs(scene)] == ['da', 'db', 'ae']


# Names

@pytest.mark.parametrize('name', ['', 'zz', 'm/zz', 'zz::j', 'J', 'j_axis2', '/j'])
def test_unknown_names(name):
    positions = positions_in_model()
    assert positions.unknown([name]) == [name]
    assert not len(positions.selection([name]).dofs)


@pytest.mark.parametrize(('text', 'only_model', 'names', 'dofs'), [
    (model_file(LINKS + joint(ENDS, 'j', 'revolute')), '', ['j', 'm/j', 'm::j'], [0, 0, 0]),
    (world_file(model('x') + model('y')), '', ['y::j', 'j', 'y/j'], [1, 1]),
    (world_file(f'{model("x")}</world><world name="v">{model("y")}'), '', ['y/j', 'j'], [0]),
    (world_file(f'<model name="m">{ONE_JOINT}{model("m")}</model>'), '', ['m/j', 'm/m/j'], [0, 1]),
    (world_file('<model name="n">' * 12 + ONE_JOINT + '</model>' * 12), '',
     ['n::' * 12 + 'j', 'n::' * 11 + 'j', 'n::' * 9 + 'j'], [0, 0]),
    (world_file(model('x') + model('y') + model('yy')), 'y', ['j', 'x/j'], [1]),
    (model_file(LINKS + joint(ENDS, 'b', 'revolute') + joint(
        '<parent>b</parent><child>c</child>', 'k_joint', 'revolute'), version='1.6'),
     '', ['b_joint', 'b', 'k_joint', 'k'], [0, 0, 1]),
], ids=['of a model file', 'of a world', 'of one of two worlds', 'itself', 'deep',
        'of one of several models', 'of a joint that is renamed'])
def test_names(text, only_model, names, dofs):
    assert positions_of(text, only_model).selection(names).dofs.tolist() == dofs


def test_names_inside_one_model_are_not_those_of_others():
    positions = positions_of(world_file(
        model('x') + f'<model name="y"><model name="z">{LINKS}'
        f'{joint(ENDS, "k", "revolute")}</model>{ONE_JOINT}</model>'))
    assert positions.models == ('x', 'y')
    names = ['j', 'y/j', 'y::z::k', 'z/k', 'k', 'x/j']
    selection = positions.selection(names, 'y')
    found = [positions.names[dof] for dof in selection.dofs]
    assert found == ['y/j', 'y/j', 'y/z/k', 'y/z/k', 'y/z/k']
    assert positions.unknown(names, 'y') == ['x/j']
    assert positions.hint('jj', 'y') == '; did you mean "j"?'


def test_joints_that_no_message_can_name_are_not_missing():
    text = world_file(f'{model("x")}{model("y")}</world><world name="v">{model("z")}')
    assert positions_of(text).unreported() == (['x/j', 'y/j'], [])
    assert positions_of(text, 'y').unreported() == (['y/j'], [])


def test_a_joint_with_several_degrees_of_freedom_is_missing_once():
    positions = positions_in_model(LINKS + joint(ENDS, 'j', 'ball'))
    assert positions.unreported() == (['j_yaw'], [])
    positions.update(positions.selection(positions.names[:1]), np.zeros(1))
    assert positions.unreported() == (['j_pitch'], [])
    positions.update(positions.selection(positions.names), np.zeros(3))
    assert positions.unreported() == ([], [])


@pytest.mark.parametrize('text', [
    model_file(ONE_JOINT),
    world_file(f'<model name="m"><static>true</static>{LINKS}</model>'),
    world_file('<model name="m"><link name="a"/></model><model name="n"><link name="a"/></model>'
               '<joint name="j" type="revolute"><parent>m::a</parent><child>n::a</child>'
               '<axis><xyz>0 0 1</xyz></axis></joint>'),
])
def test_only_models_of_a_world_with_joints_that_move_are_listed_or_one_that_was_spawned(text):
    assert positions_of(text).models == ()
    spawned = positions_of(text, is_spawned=True)
    assert spawned.models == (('m',) if text == model_file(ONE_JOINT) else ())


def test_a_message_about_a_joint_is_one_about_all_joints_of_its_model():
    second = joint('<parent>b</parent><child>c</child>', 'k', 'revolute')
    follower = joint(
        f'<parent>x::c</parent><child>y::c</child>{MIMIC.format("x::j")}', 'f', 'revolute')
    positions = positions_of(world_file(
        f'<model name="x">{LEADER}{second}</model>{model("y")}{follower}', version='1.11'))
    for name, stamps_ns in (('x/k', [5, 5, -1, -1]), ('x/j', [5, 5, 5, -1])):
        update(positions, 5, **{name: 0.5})
        assert positions.stamps_ns.tolist() == stamps_ns


def test_the_second_joint_that_a_screw_joint_has_in_urdf_is_not_unknown():
    positions = positions_in_model(
        LINKS + joint(ENDS, 'j', 'screw')
        + joint('<parent>b</parent><child>c</child>', 'k', 'revolute'))
    assert positions.unknown(['j', 'j_slide', 'k_slide']) == ['k_slide']


# Positions

@pytest.mark.parametrize('value', [np.nan, np.inf, -np.inf, 1.1e9, -1e300])
def test_positions_that_are_no_positions_are_not_taken(value):
    positions = positions_in_model()
    update(positions, j=0.5)
    assert update(positions, j=value) == ['j']
    assert positions.values.tolist() == [0.5]


def test_a_wrong_position_leaves_the_others():
    positions = positions_of(TWO_MODELS)
    selection = positions.selection(['x/j', 'y/j'])
    for value in (1.0, 2.0):  # of one time
        assert positions.update(selection, np.array([np.nan, value]), 5) == ['x/j']
    assert positions.values.tolist() == [0.0, 2.0]
    assert positions.is_reported.tolist() == [False, True]


def test_a_follower_stays_while_its_leader_has_no_position():
    positions = positions_in_model(LEADER + following())
    assert update(positions, j=np.nan) == ['j']
    assert values_of(positions) == {'j': 0.0, 'k': 0.0}
    assert not positions.is_reported.any()
    assert positions.unreported() == (['j'], [])


@pytest.mark.parametrize(('content', 'given', 'values'), [
    (LEADER + following(), {'j': 2.0}, {'k': 4.0}),
    (LEADER + following(), {'k': 7.0, 'j': 2.0}, {}),
    (LINKS + joint(ENDS + MIMIC.format('k'), 'j', 'revolute') + following(), {'j': 2.0},
     {'k': 4.0}),
    (LEADER + '<link name="d"/><link name="e"/>' + following() + following('k', 'l', 'c', 'd')
     + following('j', 'i', 'c', 'e'), {'j': 2.0}, {'k': 4.0, 'l': 8.0, 'i': 4.0})])
def test_a_joint_follows(content, given, values):
    positions = positions_in_model(content)
    assert not any(values_of(positions).values())
    update(positions, 5, **given)
    assert values_of(positions) == {**given, **values}
    update(positions, 5, j=LARGEST_POSITION)
    assert values_of(positions) == {**given, **values, 'j': LARGEST_POSITION}
    update(positions, 3, j=1.0)
    assert values_of(positions) == {**given, **values, 'j': LARGEST_POSITION}


def test_joints_of_the_same_name_continue_in_another_scene():
    before = positions_in_model()
    update(before, 5, j=2.0)
    after = positions_in_model(
        LINKS + joint(ENDS, 'i', 'revolute')
        + joint('<parent>b</parent><child>c</child>', 'j', 'revolute'))
    values = after.values
    after.take_over(before)
    update(after, 4, j=1.0)
    assert values_of(after) == {'i': 0.0, 'j': 2.0}
    assert values.tolist() == [0.0, 0.0]
    assert after.is_reported.tolist() == [name == 'j' for name in after.names]
    assert after.stamps_ns.tolist() == [5, 5]


def with_limits(name, lower, upper):
    """Return a joint of ``a`` with limits."""
    limit = f'<lower>{lower}</lower><upper>{upper}</upper>'
    return joint(f'{ENDS}<axis><limit>{limit}</limit></axis>', name, 'revolute').replace(
        '>b<', f'>{name}b<') + f'<link name="{name}b"/>'


def test_a_joint_with_one_position_has_it_without_a_message():
    text = model_file(
        LINKS + with_limits('free', -1, 1) + with_limits('zero', 0, 0)
        + with_limits('bent', 0.5, 0.5) + with_limits('far', 1e10, 1e10))
    positions = positions_of(text)
    assert values_of(positions) == {'free': 0.0, 'zero': 0.0, 'bent': 0.5, 'far': 0.0}
    assert positions.unreported() == (['free', 'far'], [])
    after = positions_of(text.replace('0.5', '0.75'))
    after.take_over(positions)
    assert values_of(after)['bent'] == 0.75


# Stamps

def test_an_older_position_does_not_count():
    positions = positions_of(TWO_MODELS)
    update(positions, 5, **{'x/j': 0.5})
    update(positions, 3, **{'x/j': 0.25, 'y/j': 0.25})
    assert values_of(positions) == {'x/j': 0.5, 'y/j': 0.25}
    assert positions.stamps_ns.tolist() == [5, 3]
    update(positions, 5, **{'x/j': 0.75})
    assert values_of(positions)['x/j'] == 0.75


def test_stamps_can_be_ignored_or_forgotten():
    positions = positions_in_model()
    positions.forget_stamps()
    assert positions.reported_count == 0
    update(positions, 5, j=0.5)
    positions.update(positions.selection(['j']), np.array([0.25]), 4, ignore_stamps=True)
    assert positions.values.tolist() == [0.25]
    positions.forget_stamps()
    update(positions, 1, j=0.75)
    assert (positions.values.tolist(), positions.stamps_ns.tolist()) == ([0.75], [1])


def test_positions_of_one_time_stay_together():
    positions = positions_in_model()
    before = positions.values
    update(positions, j=0.5)
    assert before.tolist() == [0.0]


# Free models

def free_positions(*names, others=(), content='', **options):
    """Return the coordinates of a world with models, each of which has a joint."""
    scene = load_text(world_file(''.join(model(name, content) for name in names)))
    tree = tf_tree_from_scene(
        scene, TfOptions(use_joint_states=True, follows_models=True, others=others))
    return JointPositions(scene, tree.moving.motion, **options)


def place(positions, dof, x, stamp_ns=5):
    pose = np.array([[x, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]])
    return positions.update(positions.selection_of_models([dof]), pose, stamp_ns)


def x_of(positions, dof):
    return positions.values[positions.selection_of_models([dof]).coordinates[0, 0]]


def test_poses_and_positions_have_coordinates_of_their_own():
    positions = free_positions('p', 'q')
    assert positions.names == ('p/j', 'q/j', 'p', 'q')
    assert positions.free_models == ('p', 'q')
    update(positions, 3, **{'q/j': 0.5})
    assert not place(positions, 3, 2.0)
    assert positions.values.tolist() == [0, 0.5, *[0] * 6, 1, 2.0, *[0] * 5, 1]
    assert positions.unreported() == (['p/j'], ['p'])
    assert positions.stamps_ns.tolist() == [-1, 5, -1, 5]


@pytest.mark.parametrize('unreported', UnreportedJoints)
def test_other_bodies_are_known_when_they_are_reported(unreported):
    positions = free_positions('p', others=('x', 'y'), unreported=unreported)
    assert (positions.names, positions.free_models) == (('p/j', 'p', 'x', 'y'), ('p',))
    is_zero = unreported is UnreportedJoints.ZERO
    assert positions.is_known.tolist() == [is_zero, is_zero, False, False]
    place(positions, 3, 2.0)
    assert positions.is_known.tolist()[2:] == [False, True]
    assert positions.stamps_ns.tolist() == [-1, -1, 5, 5]
    assert (x_of(positions, 2), x_of(positions, 3)) == (0.0, 2.0)
    positions.update(positions.selection_of_models([2, 3]), np.outer([3, 4], np.ones(7)), 5)
    assert x_of(positions, 2) == 3.0


def test_a_nested_model_has_a_place_in_the_model_around_it():
    nested = '<model name="n"><pose>1 0 0 0 0 0</pose><link name="l"/></model>'
    positions = free_positions('p', content=nested)
    assert positions.all_models == positions.free_models == ('p', 'p::n')
    outer, place = positions.nested_models['p::n']
    assert (outer, [*place]) == ('p', [1, 0, 0, 0, 0, 0, 1])


@pytest.mark.parametrize('x', [np.nan, np.inf, -1e10])
def test_a_pose_that_cannot_be_used_is_ignored(x):
    positions = free_positions('p')
    place(positions, 1, 1.0)
    assert place(positions, 1, x, 6) == ['p']
    assert x_of(positions, 1) == 1.0


def test_reported_poses_are_taken_over_by_models_of_the_same_name():
    before, after = free_positions('p', 'q'), free_positions('q', 'j', 'p')
    place(before, 3, 2.0)
    update(before, 3, **{'p/j': 0.5})
    after.take_over(before)
    assert (x_of(after, 3), x_of(after, 4), x_of(after, 5)) == (2.0, 0.0, 0.0)
    assert after.values[:3].tolist() == [0.0, 0.0, 0.5]
    assert after.unreported() == (['q/j', 'j/j'], ['j', 'p'])


def test_a_model_does_not_take_over_the_position_of_a_joint():
    before, after = positions_of(world_file(model('p') + model('q') + joint(
        '<parent>p::a</parent><child>q::a</child>', 'j', 'revolute'))), free_positions('j')
    update(before, j=0.5)
    after.take_over(before)
    assert after.reported_count == 0


# Scenes at a configuration

def limited(limit=''):
    axis = f'<axis><xyz>0 0 1</xyz>{limit}</axis>'
    return load_text(model_file(
        LINKS + joint(ENDS + axis, 'j', 'prismatic') + following(), version='1.11'))


@pytest.mark.parametrize(('name', 'value', 'words'), [
    ('i', 1.0, '"i" is not the name of one moving joint; the moving joints are "j", '),
    ('j', np.nan, 'must be finite'),
])
def test_a_wrong_configuration_is_refused(name, value, words):
    with pytest.raises(JointPositionError, match=words):
        scene_at_positions(limited(), {name: value})


def test_a_scene_at_a_configuration_has_other_poses():
    before = limited()
    after = scene_at_positions(before, {'j': 0.25})
    assert after.pose('m::b')[:3] == (0.0, 0.0, 0.25)
    assert before.pose('m::b')[:3] == (0.0, 0.0, 0.0)
    assert not after.poses.flags.writeable


def test_a_position_beyond_its_limits_is_warned_of():
    before = limited('<limit><lower>-1</lower><upper>1</upper></limit><odd/>')
    assert scene_at_positions(before, {'j': 1.0}).warnings == before.warnings
    *others, warning = scene_at_positions(before, {'j': 1.5}).warnings
    assert (*others,) == before.warnings != ()
    assert '1.5 of "j" is beyond its limits, -1 to 1' in warning.message
