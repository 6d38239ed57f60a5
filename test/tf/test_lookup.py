# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Look-ups of poses by the names of SDF and of TF."""

from matrices import assert_same_pose, matrix_from_degrees, OPTICAL
import numpy as np
import pytest
from sdf_texts import joint, model_file, world_file

from sdf_pose_bridge import Kind
from sdf_pose_bridge.errors import JointPositionError, UnknownFrameError
from sdf_pose_bridge.geometry.poses import pose_product
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.lookup import lookup_from_scene, PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

ROBOT = """\
<model name="robot">
  <pose degrees="true">1 2 0 0 0 90</pose>
  <link name="base">
    <visual name="shell">
      <pose>0 0 0.5 0 0 0</pose><geometry><sphere><radius>1</radius></sphere></geometry>
    </visual>
    <sensor name="eye" type="camera"><pose degrees="true">0.2 0 0.3 0 30 0</pose><camera/></sensor>
  </link>
  <frame name="grip"><pose>0 0 1 0 0 0</pose></frame>
</model>
"""
BASE = matrix_from_degrees(1, 2, 0, 0, 0, 90)
EYE = BASE @ matrix_from_degrees(0.2, 0, 0.3, 0, 30, 0)
GRIP = BASE @ matrix_from_degrees(0, 0, 1)
SHELL = BASE @ matrix_from_degrees(0, 0, 0.5)


def lookup_in(text, **options):
    scene = load_text(text, 'file.sdf')
    return PoseLookup(scene, tf_tree_from_scene(scene, TfOptions(**options)))


ARM = world_file(
    '<model name="m"><link name="base"/><link name="upper"><sensor name="eye" type="camera"/>'
    '</link><link name="hand"/><frame name="tool" attached_to="hand"/>'
    + joint('<parent>base</parent><child>upper</child>', 'elbow', 'revolute')
    + joint('<parent>upper</parent><child>hand</child>', 'wrist', 'revolute') + '</model>')


@pytest.mark.parametrize(('frame', 'relative_to', 'reported', 'missing'), [
    ('m/upper', 'm', [], 'joint "m/elbow"'), ('m/upper', 'm/tool', ['elbow'], 'joint "m/wrist"'),
    ('m/tool', 'm/base', ['wrist'], 'joint "m/elbow"'), ('m/tool', 'm/hand', [], ''),
    ('m/base', 'm/upper', [], 'joint "m/elbow"'), ('m/base', 'm', [], ''),
    ('m/upper/eye_optical', 'm', [], 'joint "m/elbow"'),
    ('m::hand', 'm::upper', ['wrist'], ''), ('m/tool', 'm', ['elbow', 'wrist'], ''),
    ('m', '', ['elbow'], 'the pose of model "m"'), ('world', 'm', [], 'the pose of model "m"')])
def test_a_pose_behind_a_joint_or_of_a_model_needs_its_position(
        frame, relative_to, reported, missing):
    scene = load_text(ARM)
    tree = tf_tree_from_scene(scene, TfOptions(use_joint_states=True, follows_models=True))
    joints = JointPositions(scene, tree.moving.motion)
    joints.update(joints.selection(reported), np.zeros(len(reported)))
    lookup = PoseLookup(scene, tree, joints)
    if missing:
        with pytest.raises(JointPositionError, match=f'on {missing}, which has not been'):
            lookup.pose(frame, relative_to)
    else:
        assert lookup.pose(frame, relative_to).pose == (0, 0, 0, 0, 0, 0, 1)
    joints.update(joints.selection_of_models([2]), np.array([[4.0, *[0.0] * 5, 1.0]]))
    assert lookup.pose('world', 'm').pose.x == -4.0
    assert [lookup.first_dof(each) for each in ('m/tool', 'world', 'floor')] == [2, -1, -1]


@pytest.fixture(name='lookup')
def make_lookup():
    return lookup_in(world_file(ROBOT), root_frame='map', frame_prefix='left/')


@pytest.mark.parametrize(('frame', 'relative_to', 'expected', 'frame_id'), [
    ('robot::grip', '', GRIP, 'map'),
    ('left/robot/grip', '', GRIP, 'map'),
    ('robot::base::shell', '', SHELL, 'map'),
    ('left/robot/base/eye_optical', '', EYE @ OPTICAL, 'map'),
    ('robot::grip', 'robot::base::eye', np.linalg.inv(EYE) @ GRIP, 'left/robot/base/eye'),
    ('left/robot/grip', 'robot::base::shell', np.linalg.inv(SHELL) @ GRIP, 'robot::base::shell'),
    ('robot', 'map', BASE, 'map'),
    ('robot', 'world', BASE, 'map'),
    ('map', 'robot', np.linalg.inv(BASE), 'left/robot'),
    ('world', 'left/robot', np.linalg.inv(BASE), 'left/robot'),
    ('map', '', np.eye(4), 'map'),
])
def test_poses_by_the_names_of_sdf_and_of_tf(lookup, frame, relative_to, expected, frame_id):
    found = lookup.pose(frame, relative_to)
    assert_same_pose(found.pose, expected, name=frame)
    assert found.pose.qw >= 0.0
    assert found.frame_id == frame_id
    assert lookup.knows(frame)
    assert lookup.is_frame_id(frame) is frame.startswith('left/')
    if frame != 'map':
        element, in_element = lookup.element(frame)
        pose = pose_product(lookup.pose_of_element(element, relative_to), in_element)
        assert_same_pose(pose, expected, name=frame)


def test_an_optical_frame_whose_camera_has_no_frame_has_no_element():
    lookup = lookup_in(world_file(ROBOT.replace('<camera/>', '<camera/><frame_id>robot</frame_id>')
                                  ), kinds=frozenset({Kind.SENSOR, Kind.MODEL}))
    with pytest.raises(UnknownFrameError, match='a camera without a frame of its own'):
        lookup.element('robot_optical')


@pytest.mark.parametrize(('frame', 'relative_to', 'sentence'), [
    ('robot::gripp', '',
     'no frame or element is called "robot::gripp"; did you mean "robot::grip"?'),
    ('left/robot/gripp', '', 'did you mean "left/robot/grip"?'),
    ('robot::grip', 'floor', 'no frame or element is called "floor"'),
    ('', '', 'no frame or element is called ""'),
    ('/left/robot', '', 'no frame or element is called "/left/robot"; did you mean "left/robot"?'),
])
def test_a_name_that_means_nothing_is_named(lookup, frame, relative_to, sentence):
    with pytest.raises(UnknownFrameError) as caught:
        lookup.pose(frame, relative_to)
    assert sentence in caught.value.message
    assert not lookup.knows(relative_to or frame)


def test_where_a_text_is_both_the_name_of_sdf_is_meant():
    lookup = lookup_in(
        world_file('<model name="a"><link name="b"><pose>1 0 0 0 0 0</pose></link></model>'
                   '<model name="m"><model name="a"><link name="b"/></model></model>'),
        frame_names=FrameNames.RELATIVE, frame_separator='::', kinds=frozenset({Kind.LINK}))
    assert lookup.pose('a::b').pose.x == 1.0
    assert lookup.pose('m::a::b', 'a::b').pose.x == -1.0
    assert lookup.pose_of_element(lookup.element('a::b')[0]).x == 1.0


def test_a_model_file_is_looked_up_from_its_root():
    text = model_file('<link name="a"><pose>1 0 0 0 0 0</pose></link>')
    lookup = lookup_in(text, root_frame='map')
    found = lookup.pose('m::a')
    assert (found.pose.x, found.frame_id) == (1.0, 'map')
    assert lookup.pose_of_element(lookup.element('m::a')[0]).x == 1.0
    scene = load_text('<robot name="r"><link name="world"/></robot>')
    tree = tf_tree_from_scene(scene, TfOptions(frame_prefix='r/'))
    assert tree.kind_labels(scene) == [Kind.ROOT.label]
    assert PoseLookup(scene, tree).element('r/world')[0] == 0


def test_only_the_world_that_is_published_is_looked_up():
    text = ('<sdf version="1.10"><world name="v"><frame name="f"><pose>1 0 0 0 0 0</pose></frame>'
            '</world><world name="w"><frame name="f"/><frame name="g"/></world></sdf>')
    lookup = lookup_in(text)
    assert lookup.pose('f').pose.x == 1.0
    assert lookup.pose('world').frame_id == 'world'
    with pytest.raises(UnknownFrameError, match='"g"'):
        lookup.pose('g')
    text = '<sdf version="1.10"><model name="m"><link name="l"/></model><world name="w"/></sdf>'
    assert lookup_in(text).pose('m::l').frame_id == 'world'


@pytest.mark.parametrize('text', [
    '{model}<world name="w"><frame name="f"/></world>',
    '<world name="w"><frame name="f"/></world>{model}',
])
def test_a_model_beside_a_world_has_nothing_in_common_with_it(text):
    model = '<model name="m"><link name="l"/></model>'
    lookup = lookup_in(f'<sdf version="1.10">{text.format(model=model)}</sdf>')
    with pytest.raises(UnknownFrameError):
        lookup.pose('m::l', 'f')


def test_a_lookup_without_options_is_at_positions_and_knows_names_that_share_an_id():
    text = model_file(
        '<link name="a/b"/><model name="a"><link name="b"/></model><link name="c"/>' + joint(
            '<parent>a/b</parent><child>c</child><axis><xyz>1 0 0</xyz></axis>', 'j', 'prismatic'))
    scene = load_text(text)
    assert lookup_from_scene(scene).pose('m::c', 'm::a::b').pose.x == 0.0
    assert lookup_from_scene(scene, {'j': 0.5}).pose('m::c', 'm::a::b').pose.x == 0.5
