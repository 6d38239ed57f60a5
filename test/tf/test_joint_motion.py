# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Poses of elements at positions of joints, against matrix exponentials; frames that move."""

import math

from joint_trees import link_matrices, model_text, pose_text, POSES, POSITIONS, random_joints
from matrices import assert_close, assert_same_pose, matrix_from_degrees, matrix_from_pose
import numpy as np
import pytest
from random_scenes import random_scenes
from sdf_texts import joint, model_file, world_file

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st

from sdf_pose_bridge import Kind
from sdf_pose_bridge.geometry.poses import pose_products
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.tf.anchors import AnchorModels
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.joint_motion import JointMotion
from sdf_pose_bridge.tf.joint_positions import JointPositions, UnreportedJoints
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.parents import NO_PARENT, ROOT_IS_PARENT, tf_parents_from_scene
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions


def motion_of(text):
    scene = load_text(text)
    return scene, JointMotion(scene, tf_parents_from_scene(scene))


def poses_at(text, positions):
    """Return the pose of each element, by its name, at positions of joints by their names."""
    scene, motion = motion_of(text)
    state = JointPositions(scene, motion)
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


@pytest.mark.parametrize(('text', 'names'), [
    (two_links('fixed'), []),
    (two_links('revolute').replace('<link', '<static>true</static><link', 1), []),
    (model_file("""
        <link name="a"/>
        <link name="b"/>
        <joint name="x" type="revolute"><parent>a</parent><child>b</child></joint>
        <joint name="y" type="revolute"><parent>a</parent><child>b</child></joint>"""), ['x'])])
def test_joints_that_move(text, names):
    assert [dof.name for dof in motion_of(text)[1].dofs] == names


SLIDING = '<parent>{}</parent><child>{}</child><axis><xyz>1 0 0</xyz></axis>'


@pytest.mark.parametrize(('text', 'name', 'x'), [
    (model_file('<link name="a"/><link name="b"/><frame name="f" attached_to="b"/>' + joint(
        SLIDING.format('f', 'a'), 'j', 'prismatic')), 'm::b', -2.0),
    (world_file('<model name="m"><link name="l"/></model>' + joint(
        SLIDING.format('world', 'm'), 'j', 'prismatic')), 'm', 2.0),
], ids=['the link of its parent frame backwards', 'a model'])
def test_a_joint_moves(text, name, x):
    assert_same_pose(poses_at(text, {'j': 2.0})[name], matrix_from_degrees(x, 0, 0))


@given(st.data(), st.integers(2, 7))
def test_random_trees_move_as_products_of_matrix_exponentials(data, count):
    joints = data.draw(random_joints(count))
    link_poses = [data.draw(POSES) for _ in range(count)]
    positions = {
        name: data.draw(POSITIONS) for joint in joints for name in joint.position_names}
    pose = pose_text(data.draw(POSES))
    links_of_frames = {'f': 1, 'g': 0 if joints[0].is_reversed else 1, 'h': 1}
    text = model_text(
        link_poses, joints, f'<frame name="f" attached_to="l1">{pose}</frame>'
        f'<frame name="g" attached_to="j1">{pose}</frame>'
        '<frame name="h" attached_to="f"><pose relative_to="l0">1 2 3 0 0 1</pose></frame>')
    scene, poses = load_text(text), poses_at(text, positions)
    for number, matrix in enumerate(link_matrices(link_poses, joints, positions)):
        link = f'm::l{number}'
        assert_same_pose(poses[link], matrix, name=link)
        for name in [f'm::{each}' for each, body in links_of_frames.items() if body == number]:
            in_link = matrix_from_pose(scene.pose(name, link))
            assert_same_pose(poses[name], matrix @ in_link, name=name)


# Frames

CAMERA = '<sensor name="s" type="camera"><pose>1 0 0 0 0 0</pose></sensor>'
ARM = """
    <link name="a"/>
    <link name="b"><sensor name="s" type="camera"><pose>1 0 0 0 0 0</pose></sensor></link>
    <link name="c"><pose>0 1 0 0 0 0</pose></link>
    <joint name="j" type="revolute"><parent>a</parent><child>b</child></joint>
    <joint name="k" type="revolute"><parent>b</parent><child>c</child></joint>"""


def moving_tree(text, **options):
    return tf_tree_from_scene(load_text(text), TfOptions(use_joint_states=True, **options))


def known_positions(scene, tree, values):
    joints = JointPositions(scene, tree.moving.motion, unreported=UnreportedJoints.ZERO)
    joints.values[:] = values
    return joints


def moving_ids(tree):
    return [tree.frame_ids[index] for index in tree.moving.indices]


def test_only_links_behind_joints_move_in_their_parents():
    tree = moving_tree(model_file(ARM), frame_names=FrameNames.SCOPED)
    assert tree.moving.motion.names == ('m/j', 'm/k')
    assert moving_ids(tree) == ['m/b', 'm/c']
    assert [tree.frame_ids[index] for index in tree.moving.posed_indices] == [
        'm/b', 'm/b/s', 'm/c', 'm/b/s_optical']


def test_a_frame_moves_by_all_joints_up_to_the_next_published_frame():
    text = model_file(ARM.replace(CAMERA, '') + '<frame name="f" attached_to="c"/>')
    tree = moving_tree(text, kinds=frozenset({Kind.FRAME}), anchor_models=AnchorModels.ALL)
    transform, = tree.moving.transforms(np.array([np.pi / 2, np.pi / 2]))
    assert_close(transform, [-1, 0, 0, 0, 0, 1, 0], 1e-15)


def test_a_model_that_is_not_anchored_has_no_transform_to_move():
    text = model_file('<link name="a"/>' + joint(
        '<parent>world</parent><child>a</child>', 'j', 'revolute'))
    assert moving_ids(moving_tree(text)) == ['a']
    assert not moving_ids(moving_tree(text, anchor_models=AnchorModels.NONE))


@pytest.mark.parametrize('kinds', [frozenset(Kind), frozenset({Kind.SENSOR, Kind.FRAME})])
@pytest.mark.parametrize('pose_frame', ['f', 'b/s'])
def test_poses_in_the_pose_frame_are_those_that_a_lookup_finds(pose_frame, kinds):
    scene = load_text(model_file(ARM + '<frame name="f"/>'))
    tree = tf_tree_from_scene(
        scene, TfOptions(use_joint_states=True, pose_frame=pose_frame, kinds=kinds))
    assert tree.frame_ids.index(pose_frame) not in tree.moving.posed_indices
    for positions in (np.zeros(2), np.array([4.0, -4.0])):
        assert (tree.moving.transforms(positions)[:, 6] >= 0.0).all()
        poses = tree.poses_in_pose_frame.copy()
        poses[tree.moving.posed_indices] = tree.moving.poses(positions)
        lookup = PoseLookup(scene, tree, known_positions(scene, tree, positions))
        expected = [lookup.pose(frame_id, pose_frame).pose for frame_id in tree.frame_ids]
        assert_close(poses, expected, 1e-15)


def test_transforms_depend_on_what_they_cross():
    moving = moving_tree(
        model_file(ARM + '<frame name="f" attached_to="c"/>'),
        kinds=frozenset({Kind.FRAME, Kind.SENSOR}), anchor_models=AnchorModels.ALL).moving
    # The sensor is behind the first joint, the frame behind both.
    for chosen, expected in (
            ([True, True], [True, True]), ([False, True], [False, True]),
            ([True, False], [True, True]), ([False, False], [False, False])):
        assert moving.depends_on(np.array(chosen)).tolist() == expected
    moving = moving_tree(model_file(ARM)).moving
    assert moving.depends_on(np.array([True, False])).tolist() == [True, False]


@given(st.data(), st.integers(2, 7))
def test_poses_need_the_positions_between_them_and_the_pose_frame(data, count):
    joints = data.draw(random_joints(count))
    text = model_text([data.draw(POSES) for _ in range(count)], joints)
    ids = tf_tree_from_scene(load_text(text)).frame_ids
    moving = moving_tree(text, pose_frame=data.draw(st.sampled_from(['', *ids]))).moving
    is_known = np.array([data.draw(st.booleans()) for _ in moving.motion.dofs], np.bool_)

    def unknown_before(dof):
        found = set()
        while dof >= 0:
            found.update({dof} - set(np.flatnonzero(is_known)))
            dof = moving.motion.previous[dof]
        return found

    reference = unknown_before(moving.last_dof_of_pose_frame)
    assert moving.has_pose(is_known).tolist() == [
        unknown_before(dof) == reference for dof in moving.posed_last_dofs]


@given(st.data(), st.integers(2, 7))
def test_transforms_along_the_tree_give_the_poses(data, count):
    joints = data.draw(random_joints(count))
    text = model_text([data.draw(POSES) for _ in range(count)], joints)
    kinds = data.draw(st.sampled_from([
        {Kind.LINK}, {Kind.JOINT}, {Kind.MODEL, Kind.LINK, Kind.JOINT}]))
    tree = moving_tree(text, kinds=frozenset(kinds), anchor_models=AnchorModels.ALL)
    positions = np.array([data.draw(POSITIONS) for _ in tree.moving.motion.dofs])
    transforms = tree.transforms.copy()
    transforms[tree.moving.indices] = tree.moving.transforms(positions)
    poses = tree.poses.copy()
    poses[tree.moving.posed_indices] = tree.moving.poses(positions)
    for pose, parent, transform in zip(poses, tree.parents.tolist(), transforms, strict=True):
        assert parent != NO_PARENT
        if parent != ROOT_IS_PARENT:
            transform = pose_products(poses[[parent]], transform[np.newaxis])[0]
        sign = 1.0 if transform[3:] @ pose[3:] > 0.0 else -1.0
        assert_close([*transform[:3], *sign * transform[3:]], pose, 1e-12)


# Models that move freely

QUATERNIONS = st.tuples(*[st.floats(-1.0, 1.0)] * 4).filter(lambda quat: math.hypot(*quat) > 0.1)


@st.composite
def model_poses(draw):
    quat = np.array(draw(QUATERNIONS))
    return [*draw(st.tuples(*[st.floats(-50.0, 50.0)] * 3)), *quat / np.linalg.norm(quat)]


def composed_matrices(tree, transforms):
    """Return the pose of each frame in the root, composed as TF does it."""
    edges = [matrix_from_pose(each) for each in tree.transforms]
    for frame, transform in zip(tree.moving.indices.tolist(), transforms, strict=True):
        edges[frame] = matrix_from_pose(transform)
    matrices = {ROOT_IS_PARENT: np.eye(4)}

    def matrix(frame):
        if frame not in matrices:
            matrices[frame] = matrix(tree.parents.item(frame)) @ edges[frame]
        return matrices[frame]

    return [matrix(frame) for frame in range(len(edges))]


@given(random_scenes(is_world=True), st.data(), st.booleans())
def test_frames_move_with_their_models(drawn, data, use_joint_states):
    scene = load_text(drawn.text())
    options = TfOptions(
        follows_models=True, use_joint_states=use_joint_states, frame_prefix='p/',
        optical_frames=False)
    ids = tf_tree_from_scene(scene, options).frame_ids
    tree = tf_tree_from_scene(scene, options._replace(
        pose_frame=data.draw(st.sampled_from([options.root_frame, *ids]))))
    moving, motion = tree.moving, tree.moving.motion
    values = motion.initial_coordinates.copy()
    in_file = drawn.matrices()
    displacements = {-1: np.eye(4)}
    for dof in range(len(motion.dofs), len(motion.names)):
        pose = data.draw(model_poses())
        values[motion.coordinates(np.array([dof]))[0]] = pose
        before = in_file[scene.names[motion.elements[dof]]]
        displacements[dof] = matrix_from_pose(pose) @ np.linalg.inv(before)

    def displacement(element):
        dof = motion.last_dofs[element]
        while 0 <= dof < len(motion.dofs):
            dof = motion.previous[dof]
        return displacements[int(dof)]

    expected = [
        displacement(element) @ in_file[scene.names[element]] for element in tree.elements]
    found = composed_matrices(tree, moving.transforms(values))
    assert_close(found, expected, 1e-12)
    if tree.pose_frame != tree.root_frame:
        in_root = np.linalg.inv(expected[ids.index(tree.pose_frame)])
        expected = [in_root @ each for each in expected]
    for row, pose in zip(moving.posed_indices.tolist(), moving.poses(values), strict=True):
        assert_close(matrix_from_pose(pose), expected[row], 1e-12)
