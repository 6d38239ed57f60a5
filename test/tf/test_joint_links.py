# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The frames at joints that URDF has links for; test_urdf_robot.py compares their poses."""

import pytest
from sdf_texts import joint, model_file, world_file

from sdf_pose_bridge import load_text
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

ENDS = '<parent>a</parent><child>b</child>'
AWAY = f'<pose>0 1 0 0 0 0</pose>{ENDS}'
AXES = '<axis><xyz>0 0 1</xyz></axis><axis2><xyz>0 1 0</xyz></axis2>'


def parents_of(content, joint_type, **options):
    """Return the parents of all frames but those of the file."""
    text = model_file(
        '<link name="a"/><link name="b"><pose>1 0 0 0 0 0</pose></link>'
        + joint(content, 'j', joint_type))
    tree = tf_tree_from_scene(load_text(text), TfOptions(has_joint_links=True, **options))
    parents = dict(zip(tree.frame_ids, tree.parent_ids, strict=True))
    return {name: parent for name, parent in parents.items() if name.endswith('frame')}


@pytest.mark.parametrize(('content', 'joint_type', 'parents'), [
    (ENDS, 'revolute', {}),
    (AWAY, 'fixed', {}),
    (AWAY, 'revolute', {'j_frame': 'a'}),
    (ENDS + AXES, 'universal', {'j_frame': 'a'}),
    (AWAY + AXES, 'universal', {'j_frame': 'a', 'j_axis2_frame': 'a'}),
    (ENDS, 'ball', {'j_yaw_frame': 'a', 'j_pitch_frame': 'a'}),
    (AWAY, 'screw', {'j_slide_frame': 'a'}),
])
def test_frames_at_joints(content, joint_type, parents):
    assert parents_of(content, joint_type) == parents


def test_frames_at_joints_have_the_prefix():
    assert parents_of(AWAY, 'revolute', frame_prefix='r/') == {'r/j_frame': 'r/a'}


def test_there_are_none_unless_they_are_asked_for():
    assert 'j_frame' not in tf_tree_from_scene(load_text(model_file(
        '<link name="a"/><link name="b"/>' + joint(AWAY, 'j', 'revolute')))).frame_ids


def test_a_joint_to_a_model_that_is_not_published_has_none():
    text = world_file(
        '<model name="base"><link name="l"/></model><model name="arm"><link name="l"/></model>'
        '<joint name="j" type="revolute"><pose>0 1 0 0 0 0</pose><parent>base</parent>'
        '<child>arm</child><axis><xyz>0 0 1</xyz></axis></joint>')
    options = TfOptions(has_joint_links=True)
    assert 'j_frame' in tf_tree_from_scene(load_text(text), options).frame_ids
    assert 'j_frame' not in tf_tree_from_scene(
        load_text(text), options._replace(model='arm')).frame_ids
