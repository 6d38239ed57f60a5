# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Links and joints of URDF: their names, types and places, and what cannot be one tree."""

import math

import numpy as np
import pytest
from sdf_texts import LINK, model_file, world_file

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import assume, given
from hypothesis import strategies as st
from joint_trees import model_text, pose_text, POSES, POSITIONS, random_joints
from matrices import assert_close, matrix_from_pose
from random_scenes import random_scenes

from sdf_pose_bridge import Kind, load_text, scene_at_positions, SdfError
from sdf_pose_bridge.errors import UrdfNotMadeError
from sdf_pose_bridge.export.urdf_robot import robot_from_scene
from sdf_pose_bridge.export.urdf_text import urdf_from_scene
from sdf_pose_bridge.sdformat.limits import DEFAULT_LIMITS
from sdf_pose_bridge.tf.anchors import AnchorModels
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.joint_positions import JointPositions, UnreportedJoints
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

MODEL = f'<model name="{{}}">{LINK}</model>'
TWO_LINKS = '<link name="a"/><link name="b"><pose>1 0 0 0 0 0</pose></link>'


def robot_of(text, limits=DEFAULT_LIMITS, **options):
    return robot_from_scene(load_text(text, shapes=True, limits=limits), TfOptions(**options))


def joint(joint_type, content='', name='j', parent='a', child='b', pose=''):
    pose = f'<pose>{pose}</pose>' if pose else ''
    return (f'<joint name="{name}" type="{joint_type}">{pose}<parent>{parent}</parent>'
            f'<child>{child}</child>{content}</joint>')


def axis(content='', tag='axis', xyz='0 0 1'):
    return f'<{tag}><xyz>{xyz}</xyz>{content}</{tag}>'


def joints_of(text, **options):
    """Return all joints of a robot by their names."""
    links = robot_of(text, **options).links
    return {link.joint.name: link.joint for link in links if link.joint is not None}


def mimic_of(joint):
    """Return the name of the joint that a joint follows, multiplier and offset; or None."""
    mimic = joint.axis and joint.axis.mimic
    assert mimic is None or mimic.reference == 0.0
    return mimic and (mimic.leader.name, mimic.multiplier, mimic.offset)


def tree_of(text, **options):
    """Return the parent of each link, with the joint between them."""
    return {
        link.name: link.joint and (link.joint.parent, link.joint.name)
        for link in robot_of(text, **options).links}


# What is refused

@pytest.mark.parametrize(('text', 'model', 'reason'), [
    (world_file(''), '', 'URDF_NOT_MADE: .* the file has no model'),
    (world_file(MODEL.format('a') + MODEL.format('b')), '', 'the models "a", "b"; choose one'),
    (world_file(MODEL.format('a')), 'c', 'UNKNOWN_FRAME: there is no model "c"'),
    (model_file(f'<link name="a/b"/><model name="a"><link name="b"/>{LINK}</model>'), '',
     'DUPLICATE_NAME'),
    ('<robot name="r"><link name="l"/></robot>', '', 'URDF_NOT_MADE: the file is URDF already')])
def test_what_has_no_urdf_is_refused(text, model, reason):
    with pytest.raises(SdfError, match=reason):
        robot_of(text, model=model)


def test_names_that_would_fill_the_memory_are_refused():
    links = ''.join(f'<link name="{i}"/>' for i in range(450))
    text = model_file(links).replace('"m"', f'"{"m" * 30_000}"')
    limits = DEFAULT_LIMITS._replace(characters=20_000_000)
    robot_of(text, limits)
    with pytest.raises(UrdfNotMadeError, match='characters together'):
        robot_of(text, limits, frame_names=FrameNames.SCOPED)


# One tree

TWO_MODELS = world_file(MODEL.format('a') + MODEL.format('b'))
MOVING = TWO_LINKS + joint('revolute', pose='1 0 0 0 0 0')
TREES = {
    'the first link is the canonical link': (
        model_file(TWO_LINKS), {}, {'a': None, 'm': ('a', 'm_fixed'), 'b': ('a', 'b_fixed')}),
    'a static model is fixed to the world': (
        model_file(f'<static>1</static>{TWO_LINKS}{joint("revolute")}'), {'root_frame': 'map'},
        {'map': None, 'a': ('map', 'a_fixed'), 'm': ('a', 'm_fixed'), 'b': ('a', 'j')}),
    'a joint to the world begins at the world': (
        model_file(LINK + joint('prismatic', parent='world', child='l', pose='1 0 0 0 0 0')),
        {'root_frame': 'j_frame'}, {'j_frame': None, 'j_frame_1': ('j_frame', 'j'),
                                    'l': ('j_frame_1', 'l_fixed'), 'm': ('l', 'm_fixed')}),
    'one of the models of a world': (
        TWO_MODELS, {'model': 'b'}, {'b/l': None, 'b': ('b/l', 'b_fixed')}),
    'the only model of a world need not be named': (
        world_file(MODEL.format('a')), {}, {'a/l': None, 'a': ('a/l', 'a_fixed')}),
    'a nested model begins at its own canonical link': (
        model_file(f'{LINK}{joint("revolute", parent="l", child="n::l")}{MODEL.format("n")}'),
        {'model': 'm::n'}, {'n/l': None, 'n': ('n/l', 'n_fixed')}),
    'a joint to a link around the model does not move': (
        model_file(LINK + joint('revolute', parent='l', child='n::b', pose='1 0 0 0 0 0')
                   + f'<model name="n">{TWO_LINKS}</model>'),
        {'model': 'm::n'}, {'world': None, 'n/a': ('world', 'n/a_fixed'),
                            'n': ('n/a', 'n_fixed'), 'n/b': ('world', 'j')}),
    'links are there whatever the kinds are': (
        model_file(TWO_LINKS), {'kinds': frozenset({Kind.FRAME})},
        {'a': None, 'b': ('a', 'b_fixed')}),
    'names are those of TF and of joint states': (
        model_file(f'<model name="n">{MOVING}</model>'),
        {'frame_separator': '_', 'kinds': frozenset({Kind.LINK})},
        {'n_a': None, 'n/j_frame': ('n_a', 'n/j'), 'n_b': ('n/j_frame', 'n_b_fixed')}),
    'what only the node does is left out': (
        model_file(TWO_LINKS + joint('revolute', pose='0 1 0 0 0 0')),
        {'frame_prefix': 'r/', 'pose_frame': 'x', 'anchor_models': AnchorModels.NONE,
         'use_joint_states': True, 'follows_models': True, 'has_joint_links': True,
         'others': ('x',)},
        {'a': None, 'm': ('a', 'm_fixed'), 'j_frame': ('a', 'j'), 'b': ('j_frame', 'b_fixed')}),
    'a joint that is a frame is a link too': (
        model_file(MOVING), {'kinds': frozenset({Kind.LINK, Kind.JOINT})},
        {'a': None, 'j_frame': ('a', 'j'), 'b': ('j_frame', 'b_fixed'), 'j': ('b', 'j_fixed')}),
}
"""Files and options, with the parent of each link and the joint between them."""


@pytest.mark.parametrize(('text', 'options', 'tree'), TREES.values(), ids=TREES)
def test_tree(text, options, tree):
    assert tree_of(text, **options) == tree
    robot = robot_of(text, **options)
    assert '::' not in robot.name
    elements = [link.element for link in robot.links if link.element >= 0]
    assert len({*elements}) == len(elements)


def test_links_stand_before_all_that_are_not_below_them():
    text = model_file(
        '<link name="a"/><frame name="f"/><link name="b"/><frame name="g" attached_to="b"/>')
    assert list(tree_of(text)) == ['a', 'm', 'f', 'b', 'g']


def test_second_tree_is_fixed_to_the_world_with_a_warning():
    robot = robot_of(model_file(f'{TWO_LINKS}{joint("revolute", parent="world")}'))
    (warning,) = robot.warnings
    assert '"a" is fixed to "world" in URDF' in warning.message
    assert robot.links[0] == ('world', -1, None)
    assert {link.name: link.joint.type for link in robot.links[1:]
            if link.joint.parent == 'world'} == {'a': 'fixed', 'b': 'continuous'}


def test_loop_is_cut_with_a_warning():
    robot = robot_of(model_file(
        TWO_LINKS + joint('revolute') + joint('revolute', name='k')))
    assert 'closes a loop' in robot.warnings[0].message
    assert [link.joint.name for link in robot.links if link.joint] == ['m_fixed', 'j']


# Names

def test_names_that_are_made_are_not_those_of_others():
    links = tree_of(model_file(
        TWO_LINKS + joint('revolute', pose='1 0 0 0 0 0') + '<frame name="j_frame"/>'
        + joint('fixed', name='m_fixed', child='c') + '<link name="c"/>'))
    assert links['b'] == ('j_frame_1', 'b_fixed')
    assert {links['c'][1], links['m'][1]} == {'m_fixed', 'm_fixed_1'}


# Joints

@pytest.mark.parametrize(('joint_type', 'content', 'types'), [
    ('fixed', '', {'j': 'fixed'}),
    ('revolute', axis(), {'j': 'continuous'}),
    ('continuous', axis(), {'j': 'continuous'}),
    ('revolute', axis('<limit><lower>-1e16</lower><upper>1e16</upper></limit>'),
     {'j': 'continuous'}),
    ('revolute', axis('<limit><lower>-1</lower></limit>'), {'j': 'revolute'}),
    ('revolute', axis('<limit><lower>-1</lower><upper>1</upper></limit>'), {'j': 'revolute'}),
    ('gearbox', axis(), {'j': 'continuous'}),
    ('prismatic', axis(), {'j': 'prismatic'}),
    ('universal', axis() + axis(tag='axis2'), {'j': 'continuous', 'j_axis2': 'continuous'}),
    ('revolute2', axis() + axis('<limit><upper>1</upper></limit>', 'axis2'),
     {'j': 'continuous', 'j_axis2': 'revolute'}),
    ('ball', '', {'j_yaw': 'continuous', 'j_pitch': 'continuous', 'j_roll': 'continuous'}),
    ('screw', axis() + '<screw_thread_pitch>2</screw_thread_pitch>',
     {'j': 'continuous', 'j_slide': 'prismatic'}),
])
def test_types_of_joints(joint_type, content, types):
    joints = joints_of(model_file(TWO_LINKS + joint(joint_type, content), version='1.11'))
    del joints['m_fixed']
    assert {name: each.type for name, each in joints.items()} == types


def test_link_away_from_its_joint_is_fixed_to_a_link_at_the_joint():
    joints = joints_of(model_file(TWO_LINKS + joint('revolute', axis(), pose='0 2 0 0 0 0')))
    assert joints['j'][2:4] == ('a', (1, 2, 0, 0, 0, 0, 1))
    assert joints['b_fixed'][1:4] == ('fixed', 'j_frame', (0, -2, 0, 0, 0, 0, 1))


def test_thread_follows_what_turns():
    text = model_file(TWO_LINKS + joint(
        'screw', axis('<limit><lower>-9</lower></limit>')
        + '<screw_thread_pitch>2</screw_thread_pitch>'), version='1.11')
    joints = joints_of(text)
    assert mimic_of(joints['j_slide']) == ('j', pytest.approx(1 / math.pi), 0)
    assert (joints['j'].axis.lower, joints['j_slide'].axis.lower) == (-9, -math.inf)


def followers(*mimics, extra=''):
    """Write joints j0, j1, ... in a row, each with a mimic or none."""
    links = ''.join(f'<link name="l{number}"/>' for number in range(len(mimics) + 1))
    return model_file(links + extra + ''.join(
        joint('revolute', axis(mimic), f'j{number}', f'l{number}', f'l{number + 1}')
        for number, mimic in enumerate(mimics)), version='1.11')


def mimic(leader, multiplier, offset=0, reference=0):
    return (f'<mimic joint="{leader}"><multiplier>{multiplier}</multiplier>'
            f'<offset>{offset}</offset><reference>{reference}</reference></mimic>')


@pytest.mark.parametrize(('mimics', 'expected'), [
    ([mimic('j0', 2, 5, 1), mimic('j1', 10, 1)], [('j0', 2, 3), ('j0', 20, 31)]),
    ([mimic('j2', 10, 1), mimic('j0', 2, 5, 1)], [('j0', 20, 31), ('j0', 2, 3)])])
def test_mimic_has_no_reference_and_names_the_first_leader(mimics, expected):
    joints = joints_of(followers('', *mimics))
    assert [mimic_of(joints[name]) for name in ('j1', 'j2')] == expected


def test_joints_that_follow_one_another_follow_nothing():
    robot = robot_of(followers(mimic('j1', 1), mimic('j0', 1)))
    assert [mimic_of(link.joint) for link in robot.links if link.joint] == [None] * 3
    assert [warning.message for warning in robot.warnings] == [
        'joint "j0" mimics nothing in URDF: "m::j0" follows it in turn',
        'joint "j1" mimics nothing in URDF: "m::j0" follows it in turn']


def test_follower_of_a_joint_that_does_not_move_follows_nothing():
    text = followers('', mimic('f', 1), extra=(
        '<link name="x"/>' + joint('fixed', axis(), 'f', 'l0', 'x')))
    robot = robot_of(text)
    assert 'joint "j1" mimics nothing in URDF: "m::f" does not move' in str(robot.warnings[-1])


def test_second_axis_can_be_followed():
    follower = axis('<mimic joint="j" axis="axis2"><multiplier>3</multiplier></mimic>')
    text = model_file(
        '<link name="a"/><link name="b"/><link name="c"/>'
        + joint('universal', axis() + axis(tag='axis2'))
        + joint('revolute', follower, 'k', 'b', 'c'), version='1.11')
    assert mimic_of(joints_of(text)['k']) == ('j_axis2', 3, 0)


# Every link is where TF has the frame, at every position of the joints

def poses_of_joint_links(scene, positions, options):
    """Return the poses of the frames that TF has at joints for URDF."""
    tree = tf_tree_from_scene(scene, TfOptions(
        anchor_models=AnchorModels.ALL, use_joint_states=True, has_joint_links=True, **options))
    state = JointPositions(scene, tree.moving.motion, unreported=UnreportedJoints.ZERO)
    selection = state.selection(list(positions))
    state.update(selection, np.array(list(positions.values()), float))
    lookup = PoseLookup(scene, tree, state)
    return {
        frame_id: lookup.pose(frame_id).pose
        for frame_id in tree.frame_ids if frame_id.endswith('_frame')}


def assert_same_frames(text, positions, joints=(), **options):
    scene = load_text(text, shapes=True)
    robot = robot_from_scene(scene, TfOptions(**options))
    urdf = load_text(urdf_from_scene(scene, **options).text, 'robot.urdf')
    moved, moved_urdf = (scene_at_positions(each, positions) for each in (scene, urdf))
    tree = tf_tree_from_scene(moved, TfOptions(anchor_models=AnchorModels.ALL, **options))
    expected = dict(zip(tree.frame_ids, tree.poses.tolist(), strict=True))
    expected.update(poses_of_joint_links(scene, positions, options))
    places = {link.name: matrix_from_pose(moved_urdf.pose(f'{urdf.own_name(1)}::{link.name}'))
              for link in robot.links if link.name in expected}
    assert places.keys() == expected.keys()
    assert {link.name for link in robot.links} - places.keys() - {'world'} <= {
        f'{joint.name}_frame' for joint in joints if joint.type == 'screw'}
    first = robot.links[0].name
    to_root = np.eye(4)
    if first in expected:
        to_root = matrix_from_pose(expected[first]) @ np.linalg.inv(places[first])
    for name, matrix in places.items():
        assert_close(to_root @ matrix, matrix_from_pose(expected[name]), name=name)


@given(st.data(), st.integers(2, 5))
def test_frames_of_random_trees_of_joints(data, count):
    link_poses = data.draw(st.lists(POSES, min_size=count, max_size=count))
    joints = data.draw(random_joints(count))
    extra = f'<frame name="f" attached_to="l{count - 1}">{pose_text(data.draw(POSES))}</frame>'
    positions = {
        name: data.draw(POSITIONS) for each in joints for name in each.position_names}
    assert_same_frames(model_text(link_poses, joints, extra), positions, joints)


@given(random_scenes(), st.sets(st.sampled_from([Kind.FRAME, Kind.JOINT, Kind.SENSOR])))
def test_frames_of_random_scenes(drawn, kinds):
    text = drawn.text()
    model = drawn.models[0].scoped_name
    try:
        robot_of(text, model=model, kinds=frozenset({*kinds, Kind.LINK}))
    except SdfError:
        assume(False)
    assert_same_frames(text, {}, model=model, kinds=frozenset({*kinds, Kind.LINK}))
