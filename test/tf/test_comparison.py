# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What is different between two scenes."""

import math

import numpy as np
import pytest
from sdf_texts import joint, LINK, model_file, posed, TWO_LINKS, world_file

from sdf_pose_bridge import load_text, SdfError, UnknownFrameError
from sdf_pose_bridge.tf.comparison import Change, differences_of_scenes
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

A = '<link name="a"><pose>1 0 0 0 0 0</pose></link>'
B = '<frame name="b"><pose relative_to="a">0 0 1 0 0 0</pose></frame>'


def differences(old, new, **options):
    return [
        (each.change.value, each.name, each.old_name)
        for each in differences_of_scenes(
            load_text(model_file(old)), load_text(model_file(new)), **options)]


def test_what_depends_on_a_moved_frame_moves_with_the_first_one():
    texts = (model_file(each + B + posed('frame', 'c', '0 0 0 0 0 0', 'b'))
             for each in (A, A.replace('1 0 0 0', '1 0 0 0.1')))
    assert [(each.change.value, each.name, each.moved_with)
            for each in differences_of_scenes(*map(load_text, texts))] == [
        ('moved', 'm::a', ''), ('moved', 'm::b', 'm::a'), ('moved', 'm::c', 'm::a')]


def test_what_moves_in_a_moved_frame_has_moved_by_itself():
    scenes = (load_text(model_file(text)) for text in (
        A + B, (A + B).replace('1 0 0 0', '1 0 0 0.1').replace('0 0 1', '0 0 2')))
    assert [each.moved_with for each in differences_of_scenes(*scenes)] == ['', '']


def test_in_a_frame_that_moves_too_nothing_has_moved():
    moved = A.replace('1 0 0', '1 0 5') + B
    assert differences(A + B + '<frame name="f"/>', moved + '<frame name="g"/>',
                       relative_to='m::a') == [
        ('moved', 'm', 'm'), ('renamed', 'm::g', 'm::f'), ('moved', 'm::g', 'm::f')]


def test_distance_and_angle_of_a_movement():
    old, new = (load_text(model_file(posed('link', 'a', f'{x} 0 0 0 0 {yaw}')))
                for x, yaw in ((1, 3.0), (1.5, -3.0)))
    moved, = differences_of_scenes(old, new)
    assert moved.distance_m == pytest.approx(0.5)
    assert moved.angle_rad == pytest.approx(2 * math.pi - 6.0)


@pytest.mark.parametrize(('x', 'tolerance', 'changes'), [
    (1, 0.0, []), (1.01, 0.02, []), (1.01, 0.005, [('moved', 'm::a', 'm::a')])])
def test_tolerance(x, tolerance, changes):
    assert differences(A, A.replace('1 0', f'{x} 0'), tolerance=tolerance) == changes


def test_renamed_with_what_it_holds():
    old = A + '<model name="n"><link name="k"/></model>'
    assert differences(old, old.replace('name="n"', 'name="o"')) == [
        ('renamed', 'm::o', 'm::n')]


def test_a_model_of_another_name_and_place_is_compared():
    old = model_file(A + B)
    new = model_file('<pose>0 0 3 0 0 0</pose>' + A + B.replace('0 0 1', '0 0 2')).replace(
        'name="m"', 'name="n"')
    assert [(each.change.value, each.name, each.moved_with)
            for each in differences_of_scenes(load_text(old), load_text(new))] == [
        ('renamed', 'n', ''), ('moved', 'n', ''), ('moved', 'n::a', 'n'), ('moved', 'n::b', '')]


F = '<frame name="f"/>'
PAIR = '<frame name="{}"/><frame name="{}"/>'
IN_TWO = '<model name="n"><link name="k"/>{}</model><model name="o"><link name="k"/>{}</model>'


@pytest.mark.parametrize(('old', 'new', 'changes'), [
    (F, F.replace('frame', 'link'), ['removed frame m::f m::f', 'added link m::f ']),
    (F, '<link name="g"/>', ['removed frame m::f m::f', 'added link m::g ']),
    (F, posed('frame', 'g', '0 1 0 0 0 0'), ['removed frame m::f m::f', 'added frame m::g ']),
    (IN_TWO.format(F, ''), IN_TWO.format('', F),
     ['removed frame m::n::f m::n::f', 'added frame m::o::f ']),
    # Of two in one place, none is renamed for certain.
    (PAIR.format('b', 'c'), F,
     ['removed frame m::b m::b', 'removed frame m::c m::c', 'added frame m::f ']),
    (F, PAIR.format('b', 'c'),
     ['removed frame m::f m::f', 'added frame m::b ', 'added frame m::c ']),
])
def test_what_is_added_or_removed_is_not_renamed(old, new, changes):
    scenes = (load_text(model_file(A + each)) for each in (old, new))
    assert [f'{each.change.value} {each.kind.label} {each.name} {each.old_name}'
            for each in differences_of_scenes(*scenes)] == changes


def test_worlds_are_told_apart_by_their_order():
    # TF has the first one, and its name is in no frame id.
    first, second = (f'<world name="{name}"><frame name="f"><pose>0 0 {z} 0 0 0</pose></frame>'
                     '</world>' for name, z in (('v', 1), ('w', 2)))
    sdf = '<sdf version="1.6">{}</sdf>'.format
    old = load_text(sdf(first + second))
    assert differences_of_scenes(old, load_text(sdf(first.replace('"v"', '"u"') + second))) == []
    assert [each.change.value for each in differences_of_scenes(
        old, load_text(sdf(second + first)))] == ['moved', 'moved']
    assert [each.change.value for each in differences_of_scenes(
        old, load_text(sdf(first)))] == ['removed']


def test_a_model_in_a_world_has_other_frame_ids():
    model = '<model name="m"><link name="l"/></model>'
    scenes = load_text(f'<sdf version="1.6">{model}</sdf>'), load_text(world_file(model))
    assert {each.change for each in differences_of_scenes(*scenes)} == {
        Change.ADDED, Change.REMOVED}


def test_an_unknown_frame_is_refused():
    with pytest.raises(UnknownFrameError, match='did you mean "m::a"'):
        differences(A, A, relative_to='m::aa')


# What else TF depends on

AXIS = '<axis><xyz>0 0 1</xyz><limit><lower>-1</lower><upper>2</upper></limit>{}</axis>'
JOINT = '<parent>a</parent><child>b</child>' + AXIS
LEADER = joint('<parent>b</parent><child>c</child><axis><xyz>0 0 1</xyz></axis>', 'i', 'revolute')
MIMIC = '<mimic joint="i"><multiplier>2</multiplier><offset>1</offset></mimic>'
ARM = TWO_LINKS + '<link name="c"/>' + LEADER + joint(JOINT.format(MIMIC), 'j', 'revolute')
CAMERA = '<link name="l"><sensor name="s" type="camera"><camera/></sensor></link>'
UNIVERSAL = TWO_LINKS + joint(
    JOINT.format('') + '<axis2><xyz>1 0 0</xyz></axis2>', 'j', 'universal')
ONE_CHANGE = [
    ('parent', ARM + '<frame name="f" attached_to="a"/>', 'to="a"', 'to="b"',
     'm::f', 'm::a', 'm::b'),
    ('parent', TWO_LINKS + joint('<parent>a</parent><child>b</child>'), 't>a', 't>world',
     'm::b', 'm::a', 'world'),
    ('type', ARM, 'name="j" type="revolute"', 'name="j" type="prismatic"',
     'm::j', 'revolute', 'prismatic'),
    ('type', TWO_LINKS + joint('<parent>a</parent><child>b</child><screw_thread_pitch>0.5'
                               '</screw_thread_pitch><axis/>', 'j', 'screw'), '0.5', '-0.5',
     'm::j', 'screw 0.5 m', 'screw -0.5 m'),
    ('type', '<model name="n"><link name="k"/></model>' + LINK, '"n">', '"n"><static>1</static>',
     'm::n', 'not static', 'static'),
    ('axis', ARM, '0 0 1</xyz><limit>', '0 0 -1</xyz><limit>', 'm::j', '0 0 1', '0 0 -1'),
    ('axis', UNIVERSAL, '1 0 0', '-1 0 0', 'm::j', 'axis2 1 0 0', 'axis2 -1 0 0'),
    ('limits', ARM, '<upper>2', '<upper>3', 'm::j', '-1 to 2', '-1 to 3'),
    ('mimic', ARM, '>2</mul', '>-2</mul', 'm::j', '2 * m::i + 1', '-2 * m::i + 1'),
    ('mimic', ARM, MIMIC, '', 'm::j', '2 * m::i + 1', 'none'),
    ('frame id', CAMERA, '<camera/>', '<camera/><gz_frame_id>f</gz_frame_id>', 'm::l::s',
     'by its name and _optical', 'f and _optical'),
    ('frame id', CAMERA, '<camera/>', '<camera/><frame_id>f</frame_id>', 'm::l::s',
     'by its name and _optical', 'f in Harmonic by its name and _optical'),
    ('frame id', CAMERA, '<camera/>', '<camera><optical_frame_id>o</optical_frame_id></camera>',
     'm::l::s', 'by its name and _optical', 'by its name o'),
    ('frame id', CAMERA, '<sensor name="s" type="camera"><camera/>',
     '<sensor name="s" type="imu">', 'm::l::s', 'by its name and _optical', 'by its name'),
]


@pytest.mark.parametrize(
    ('change', 'text', 'old', 'new', 'name', 'was', 'now'), ONE_CHANGE,
    ids=[f'{each[0]} {each[-1]}' for each in ONE_CHANGE])
def test_one_change_is_one_difference(change, text, old, new, name, was, now):
    text = model_file(text, version='1.11')
    assert old in text
    (found,) = differences_of_scenes(load_text(text), load_text(text.replace(old, new)))
    assert (found.change.value, found.name, found.old, found.new) == (change, name, was, now)


def test_each_change_is_shown():
    shown = {*(each[0] for each in ONE_CHANGE), 'added', 'removed', 'renamed', 'moved'}
    assert shown == {change.value for change in Change}


@pytest.mark.parametrize(('old', 'new'), [
    ('<sphere><radius>1', '<sphere><radius>2'), ('<mass>1', '<mass>2'),
    ('<friction>1', '<friction>2'),
    ('<reference>0</reference><offset>1', '<reference>1</reference><offset>3'),
    ('name="i"', 'name="h"'), ('"i"', '"h"')])
def test_what_tf_does_not_depend_on_is_no_difference_but_for_names(old, new):
    text = model_file(ARM.replace('<link name="c"/>', (
        '<link name="c"><inertial><mass>1</mass></inertial><visual name="v"><geometry><sphere>'
        '<radius>1</radius></sphere></geometry></visual></link>')).replace(
            '</limit>', '</limit><dynamics><friction>1</friction></dynamics>').replace(
            '<offset>', '<reference>0</reference><offset>'), version='1.11')
    changed = text.replace(old, new).replace('joint="i"', 'joint="h"' if new[-2:] == 'h"' else (
        'joint="i"'))
    assert changed != text
    assert [each.change.value for each in differences_of_scenes(
        load_text(text), load_text(changed))] == ['renamed'] * (new[-2:] == 'h"')


def test_an_exchange_of_parent_and_child_is_a_difference():
    # The pose and the axis of the joint stay, and the other way is positive.
    text = model_file(TWO_LINKS + joint(JOINT.format(''), 'j', 'revolute'))
    exchanged = text.replace('t>a</p', 't>b</p').replace('d>b</c', 'd>a</c')
    assert [(each.change.value, each.name) for each in differences_of_scenes(
        load_text(text), load_text(exchanged))] == [('parent', 'm::j')]


def test_of_two_joints_between_the_same_links_the_first_one_counts():
    joints = [joint('<parent>a</parent><child>b</child><axis/>', name, each)
              for name, each in (('i', 'revolute'), ('j', 'fixed'))]
    texts = (model_file(''.join((TWO_LINKS, *order))) for order in (joints, reversed(joints)))
    (found,) = differences_of_scenes(*map(load_text, texts))
    assert (found.name, found.old, found.new) == (
        'm::i', 'revolute', 'revolute that moves nothing')


URDF = (
    '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="revolute">'
    '<parent link="a"/><child link="b"/><axis xyz="1 0 0"/><limit lower="-1" upper="2" effort="1" '
    'velocity="1"/></joint>'
    '</robot>')


def test_the_name_of_a_urdf_is_in_no_frame_id():
    assert differences_of_scenes(
        load_text(URDF), load_text(URDF.replace('"r"', '"s"'))) == []
    (moved, *others) = differences_of_scenes(load_text(URDF), load_text(
        URDF.replace('"r"', '"s"').replace('<axis', '<origin xyz="0 0 1"/><axis')))
    assert (moved.change, moved.name, moved.distance_m) == (Change.MOVED, 's::j', 1.0)
    assert [(each.name, each.moved_with) for each in others] == [('s::b', 's::j')]


def test_another_model_in_sdformat_is_a_frame_that_a_urdf_does_not_have():
    sdf = model_file(TWO_LINKS + joint(
        JOINT.format('').replace('0 0 1', '1 0 0'), 'j', 'revolute'))
    assert [(each.change.value, each.name) for each in differences_of_scenes(
        load_text(URDF), load_text(sdf))] == [('added', 'm')]


# A template of arms, with values of which most pairs are different.
TEMPLATE = (
    '{static}<link name="a"/><link name="b"><pose>{pose}</pose></link><link name="c"/>'
    '<joint name="i" type="{type}"><pose>{turn}</pose><parent>{parent}</parent><child>b</child>'
    '<axis><xyz>{axis}</xyz><limit><lower>{lower}</lower><upper>0</upper></limit></axis></joint>'
    '<joint name="j" type="prismatic"><parent>{ends[0]}</parent><child>{ends[1]}</child>'
    '<axis><xyz>0 1 0</xyz>{mimic}</axis></joint><frame name="f" attached_to="{link}"/>')
VALUES = {
    'static': ['', '<static>1</static>'], 'pose': ['0 0 0 0 0 0', '0 0 1 0 0 0'],
    'type': ['revolute', 'fixed', 'screw'], 'turn': ['0 0 0 0 0 0', '0 0 0 0 0 1'],
    'parent': ['a', 'f'], 'axis': ['0 0 1', '1 0 0'], 'lower': ['-1', '0'],
    'ends': ['bc', 'cb', 'ac'], 'link': ['a', 'c'],
    'mimic': ['', '<mimic joint="i"/>']}


def transforms_at_positions(text):
    """Return the parent and the transform of each frame, at three positions of each joint."""
    scene = load_text(text)
    tree = tf_tree_from_scene(scene, TfOptions(use_joint_states=True))
    positions = JointPositions(scene, tree.moving.motion)
    found = []
    for value in (0.0, 0.5, -0.5):
        # Joints follow others, so each moves alone.
        for name in ('i', 'j'):
            if not positions.unknown([name]):
                positions.update(positions.selection([name]), np.array([value]))
            transforms = tree.transforms.copy()
            transforms[tree.moving.indices] = tree.moving.transforms(positions.values)
            found.append(transforms)
    return tree.parent_ids, np.round(found, 6).tolist()


def test_no_difference_means_the_same_transforms_at_all_positions():
    hypothesis = pytest.importorskip('hypothesis', reason='needs hypothesis')
    values = hypothesis.strategies.fixed_dictionaries({
        name: hypothesis.strategies.sampled_from(choices) for name, choices in VALUES.items()})
    same = hypothesis.strategies.just({})
    one = hypothesis.strategies.sampled_from(
        [{name: choice} for name, choices in VALUES.items() for choice in choices])

    @hypothesis.given(values, one | same)
    def check(drawn, change):
        old, new = (model_file(TEMPLATE.format(**each), version='1.11')
                    for each in (drawn, drawn | change))
        try:
            scenes = load_text(old), load_text(new)
        except SdfError:
            return
        if not differences_of_scenes(*scenes):
            assert transforms_at_positions(old) == transforms_at_positions(new)

    check()
