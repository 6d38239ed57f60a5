# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Robots whose joints have names of links: allowed in URDF, not in SDFormat."""

import numpy as np
import pytest
from urdf_texts import joint
from urdf_texts import link
from urdf_texts import origin
from urdf_texts import robot

from sdf_pose_bridge import load_text
from sdf_pose_bridge import scene_at_positions
from sdf_pose_bridge.tf.tree import tf_tree_from_scene

TWO = link('a') + link('b')


def test_joint_gets_another_name_than_its_link_and_its_link_keeps_it():
    scene = load_text(robot(TWO + joint('b', 'a', 'b', 'continuous', origin('1 0 0'))))
    assert scene.names[scene.joints[0].element] == 'r::b_joint'
    assert scene.pose('r::b').x == 1.0
    (warning,) = scene.warnings
    assert 'has the name of link "b"; it is called "b_joint" here' in warning.message


def test_new_name_is_not_that_of_another_joint():
    scene = load_text(robot(
        TWO + link('c') + joint('b', 'a', 'b', 'continuous') + joint('b_joint', 'b', 'c')))
    assert {'r::b_joint', 'r::b_joint1'} <= set(scene.names)


@pytest.mark.parametrize('name', ['b', 'b_joint'])
def test_position_is_given_by_the_name_in_the_file_too(name):
    scene = load_text(robot(
        TWO + joint('b', 'a', 'b', 'continuous', '<axis xyz="0 0 1"/>')))
    assert scene_at_positions(scene, {name: np.pi}).pose('r::b').qz == pytest.approx(1.0)


def test_mimic_follows_a_joint_that_is_renamed():
    scene = load_text(robot(
        TWO + link('c') + joint('b', 'a', 'b', 'continuous', '<axis xyz="0 0 1"/>')
        + joint('k', 'a', 'c', 'continuous', '<axis xyz="0 0 1"/><mimic joint="b"/>')))
    assert scene_at_positions(scene, {'b': np.pi}).pose('r::c').qz == pytest.approx(1.0)


def test_fixed_joint_of_the_name_of_its_link_leaves_two_frames():
    scene = load_text(robot(TWO + joint('b', 'a', 'b', 'fixed', origin('1 0 0'))))
    assert scene.pose('r::b') == scene.pose('r::b_joint')


def test_robot_of_the_name_of_its_link_has_a_frame_beside_that_of_the_link():
    scene = load_text(robot(link('r')))
    assert sorted(tf_tree_from_scene(scene).frame_ids) == ['r', 'r_model']
