# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The meaning of names: which transforms they move, and how much of it is kept."""

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from sdf_texts import joint, model_file

from sdf_pose_bridge import load_text
from sdf_pose_bridge.ros.cdr import SerializedNames
from sdf_pose_bridge.ros.joint_names import Meanings, MOST_BYTES
from sdf_pose_bridge.ros.published_frames import PublishedFrames
from sdf_pose_bridge.ros.publishers import Publishers
from sdf_pose_bridge.tf.joint_positions import JointPositions, UnreportedJoints
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

LINKS = ''.join(f'<link name="{name}"/>' for name in 'abc')
TEXT = model_file(LINKS + ''.join(
    joint(f'<parent>a</parent><child>{child}</child><axis><xyz>0 0 1</xyz></axis>',
          f'j{child}', 'revolute') for child in 'bc'))


@pytest.fixture(name='meanings_of', params=list(UnreportedJoints))
def make_meanings(make_node, request):
    """Return the meanings of names, the positions, and how unreported joints are treated."""
    scene = load_text(TEXT)
    tree = tf_tree_from_scene(scene, TfOptions(use_joint_states=True))
    positions = JointPositions(scene, tree.moving.dofs, unreported=request.param)
    frames = PublishedFrames(Publishers(make_node('bridge')), tree, positions, {})
    return Meanings(frames.moving), positions, request.param


def names_of(*names):
    return SerializedNames(names, '\0'.join(names).encode())


def test_names_move_their_transforms_and_those_of_joints_at_zero(meanings_of):
    meanings, positions, unreported = meanings_of
    meaning, unknown = meanings.find(names_of('jb', 'x'), '/j', '')
    assert unknown == ['x']
    positions.update(meaning.selection, np.zeros(2), 5)
    at_zero = unreported is UnreportedJoints.ZERO
    assert meanings.rows(meaning).tolist() == ([0, 1] if at_zero else [0])
    other, _ = meanings.find(names_of('jc'), '/j', '')
    positions.update(other.selection, np.zeros(1), 5)
    assert meanings.rows(meaning).tolist() == [0]
    assert meanings.rows(other).tolist() == [1]


def test_unknown_names_move_nothing(meanings_of):
    meanings, _, _ = meanings_of
    meaning, _ = meanings.find(names_of('x'), '/j', '')
    assert not len(meanings.rows(meaning))


def test_a_meaning_is_kept_for_all_topics_of_a_model(meanings_of):
    meanings, _, _ = meanings_of
    first, _ = meanings.find(names_of('jb'), '/one', '')
    assert meanings.find(names_of('jb'), '/two', '') == (first, [])
    assert meanings.last('/one') is meanings.last('/two') is first


def test_all_names_together_take_a_limited_number_of_bytes(meanings_of):
    meanings, _, _ = meanings_of
    size = MOST_BYTES // 10
    for number in range(40):
        meanings.find(names_of(str(number) * size), f'/{number}', '')
    kept = sum(meanings.last(f'/{number}') is not None for number in range(40))
    assert 0 < kept * size <= MOST_BYTES
    assert meanings.last('/39') is not None
