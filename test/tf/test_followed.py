# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The joints and models that topics of plugins are about follow messages, or all do."""

import pytest
from sdf_texts import joint, model, plugin, world_file

from sdf_pose_bridge import load_text
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

ARM = '<link name="k"/>' + joint('<parent>l</parent><child>k</child>', 'j', 'revolute')
TEXT = world_file(
    model('a', ARM + plugin('JointStatePublisher', '<topic>/j1</topic>') + plugin('DiffDrive'))
    + model('b', ARM) + model('still', f'<static>true</static>{ARM}'))
JOINTS, POSES = {'use_joint_states': True}, {'follows_models': True}


def tree_of(finds_at_rest=True, **options):
    return tf_tree_from_scene(
        load_text(TEXT, plugins=True), TfOptions(**options), finds_at_rest=finds_at_rest)


@pytest.mark.parametrize(('options', 'at_rest'), [
    ({}, (['a/j', 'b/j'], [])), ({'model': 'b'}, (['b/j'], [])),
    ({**JOINTS, 'joint_states_topics': ('/j1',)}, (['b/j'], [])),
    ({**JOINTS, 'joint_states_topics': ('/j1', '/others')}, ([], [])), (JOINTS, ([], [])),
    ({**POSES, 'model_pose_topics': ('/model/a/odometry',)}, (['a/j', 'b/j'], ['b'])),
    ({**POSES, 'model_pose_topics': ('/a/odometry', '/others')}, (['a/j', 'b/j'], [])),
    # A simulator has no topics.
    ({**JOINTS, **POSES}, ([], []))])
def test_others_than_those_of_the_topics_are_at_rest_if_all_topics_are_of_plugins(
        options, at_rest):
    tree = tree_of(**options)
    assert tree.at_rest == at_rest
    moving = set() if tree.moving is None else {*tree.moving.motion.names}
    assert moving.isdisjoint([*at_rest[0], *at_rest[1]])
    assert tree_of(finds_at_rest=False, **options).at_rest == ([], [])
