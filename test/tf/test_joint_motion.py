# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Poses of elements at positions of joints, against matrix exponentials."""

from joint_trees import link_matrices, model_text, pose_text, POSES, POSITIONS, random_joints
from matrices import assert_same_pose, matrix_from_degrees, matrix_from_pose
import numpy as np
import pytest
from sdf_texts import model_file, world_file

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st

from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.tf.joint_motion import JointMotion
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.parents import tf_parents_from_scene


def motion_of(text):
    scene = load_text(text)
    return scene, JointMotion(scene, tf_parents_from_scene(scene))


def poses_at(text, positions):
    """Return the pose of each element, by its name, at positions of joints by their names."""
    scene, motion = motion_of(text)
    state = JointPositions(scene, motion.dofs)
    selection = state.selection(list(positions))
    assert not state.unknown(positions)
    state.update(selection, np.array(list(positions.values()), float))
    elements = np.arange(len(scene.names), dtype=np.int32)
    moved = motion.moved_poses(scene.poses, elements, state.values)
    return dict(zip(scene.names, moved, strict=True))


def two_links(joint_type, content='', joint_pose=''):
    return model_file(
        '<link name="a"/><link name="b"><pose>1 0 0 0 0 0</pose></link>'
        f'<joint name="j" type="{joint_type}">{joint_pose}<parent>a</parent><child>b</child>'
        f'{content}</joint>', version='1.11')


def test_a_fixed_joint_has_no_degree_of_freedom():
    assert not motion_of(two_links('fixed'))[1].dofs


def test_a_static_model_does_not_move():
    text = two_links('revolute').replace('<link', '<static>true</static><link', 1)
    assert not motion_of(text)[1].dofs


def test_a_joint_of_the_world_moves_a_model():
    text = world_file(
        '<model name="m"><link name="l"/></model><joint name="j" type="prismatic">'
        '<parent>world</parent><child>m</child><axis><xyz>1 0 0</xyz></axis></joint>')
    assert_same_pose(poses_at(text, {'j': 2.0})['m'], matrix_from_degrees(2, 0, 0))


def test_the_last_joint_of_a_loop_moves_nothing():
    joints = ''.join(
        f'<joint name="{name}" type="revolute"><parent>{parent}</parent><child>{child}</child>'
        '</joint>' for name, parent, child in ('xab', 'ybc', 'zac'))
    links = ''.join(f'<link name="{name}"/>' for name in 'abc')
    scene, motion = motion_of(model_file(links + joints))
    assert [scene.names[each.joint.element] for each in motion.dofs] == ['m::x', 'm::y']


@given(st.data())
def test_what_is_attached_to_a_moved_link_moves_with_it(data):
    joints = data.draw(random_joints(2, types=('revolute', 'screw')))
    link_poses = [data.draw(POSES) for _ in range(2)]
    pose = data.draw(POSES)
    position = data.draw(POSITIONS)
    extra = (
        f'<frame name="f" attached_to="l1">{pose_text(pose)}</frame>'
        f'<frame name="g" attached_to="j1">{pose_text(pose)}</frame>'
        '<frame name="h" attached_to="f"><pose relative_to="l0">1 2 3 0 0 1</pose></frame>')
    text = model_text(link_poses, joints, extra)
    poses = poses_at(text, {'j1': position})
    before = {name: load_text(text).pose(f'm::{name}') for name in 'fgh'}
    link = matrix_from_degrees(*link_poses[1])
    motion = link_matrices(link_poses, joints, {'j1': position})[1] @ np.linalg.inv(link)
    is_child = not joints[0].is_reversed
    for name in 'fgh':
        moves = name != 'g' or is_child
        expected = matrix_from_pose(before[name])
        assert_same_pose(poses[f'm::{name}'], motion @ expected if moves else expected, name=name)


@given(st.data(), st.integers(2, 7))
def test_random_trees_move_as_products_of_matrix_exponentials(data, count):
    joints = data.draw(random_joints(count))
    link_poses = [data.draw(POSES) for _ in range(count)]
    positions = {
        name: data.draw(POSITIONS) for joint in joints for name in joint.position_names}
    poses = poses_at(model_text(link_poses, joints), positions)
    expected = link_matrices(link_poses, joints, positions)
    for number, matrix in enumerate(expected):
        assert_same_pose(poses[f'm::l{number}'], matrix, name=f'l{number}')
