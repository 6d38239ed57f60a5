# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Look-ups of poses by the names of SDF and of TF."""

from matrices import assert_same_pose, matrix_from_degrees
import numpy as np
import pytest
from sdf_texts import joint, model_file, world_file

from sdf_pose_bridge import Kind
from sdf_pose_bridge.errors import JointPositionError, UnknownFrameError
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.lookup import PoseLookup
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
OPTICAL = np.array([[0.0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


def lookup_in(text, **options):
    scene = load_text(text, 'file.sdf')
    return PoseLookup(scene, tf_tree_from_scene(scene, TfOptions(**options)))


ARM = model_file(
    '<link name="base"/><link name="upper"/><link name="hand"/><frame name="tool" '
    'attached_to="hand"/>'
    + joint('<parent>base</parent><child>upper</child>', 'elbow', 'revolute')
    + joint('<parent>upper</parent><child>hand</child>', 'wrist', 'revolute'))


@pytest.mark.parametrize(('frame', 'relative_to', 'reported', 'missing'), [
    ('upper', '', [], 'elbow'), ('upper', 'tool', ['elbow'], 'wrist'),
    ('tool', 'base', ['wrist'], 'elbow'), ('tool', 'hand', [], ''), ('base', '', [], ''),
    ('m::hand', 'm::upper', ['wrist'], ''), ('tool', 'm', ['elbow', 'wrist'], ''),
    ('base', 'upper', [], 'elbow')])
def test_a_pose_behind_a_joint_needs_its_position(frame, relative_to, reported, missing):
    scene = load_text(ARM)
    tree = tf_tree_from_scene(scene, TfOptions(use_joint_states=True))
    joints = JointPositions(scene, tree.moving.motion)
    joints.update(joints.selection(reported), np.zeros(len(reported)))
    lookup = PoseLookup(scene, tree, joints)
    if missing:
        with pytest.raises(JointPositionError, match=f'on joint "{missing}", which has not been'):
            lookup.pose(frame, relative_to)
    else:
        assert lookup.pose(frame, relative_to).pose == (0, 0, 0, 0, 0, 0, 1)


FREE = ROBOT.replace('</model>', '<link name="arm"/>' + joint(
    '<parent>base</parent><child>arm</child>', 'elbow', 'revolute') + '</model>')


@pytest.mark.parametrize(('frame', 'relative_to', 'unreported'), [
    ('robot', '', 'the pose of model "robot"'), ('', 'robot', 'the pose of model "robot"'),
    ('robot/arm', 'robot/grip', 'joint "robot/elbow"'),
    ('robot/grip', 'robot/arm', 'joint "robot/elbow"')])
def test_poses_follow_a_model_and_need_its_pose(frame, relative_to, unreported):
    scene = load_text(world_file(FREE))
    tree = tf_tree_from_scene(scene, TfOptions(use_joint_states=True, follows_models=True))
    positions = JointPositions(scene, tree.moving.motion)
    lookup = PoseLookup(scene, tree, positions)
    with pytest.raises(JointPositionError, match=f'depends on {unreported}, which'):
        lookup.pose(frame or 'world', relative_to)
    positions.update(positions.selection_of_models([1]), np.array([[4.0, *[0] * 5, 1]]))
    place = matrix_from_degrees(4, 0, 0)
    eye = place @ np.linalg.inv(BASE) @ EYE @ OPTICAL
    assert_same_pose(lookup.pose('robot/base/eye_optical').pose, eye, name='eye')
    assert_same_pose(lookup.pose('world', 'robot').pose, np.linalg.inv(place), name='world')
    firsts = [lookup.first_dof(each) for each in ('robot/arm', 'robot', 'world', 'floor')]
    assert firsts == [1, 1, -1, -1]


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


@pytest.mark.parametrize(('frame', 'element', 'in_element'), [
    ('robot::grip', 'robot::grip', np.eye(4)), ('left/robot', 'robot', np.eye(4)),
    ('left/robot/base/eye_optical', 'robot::base::eye', OPTICAL)])
def test_the_element_that_places_a_frame(lookup, frame, element, in_element):
    index, pose = lookup.element(frame)
    assert_same_pose(pose, in_element, name=frame)
    assert lookup.pose_of_element(index, 'map') == lookup.pose(element).pose
    assert lookup.pose_of_element(index) == lookup.pose(element).pose


def test_an_optical_frame_whose_camera_has_no_frame_has_no_element():
    lookup = lookup_in(world_file(ROBOT.replace('<camera/>', '<camera/><frame_id>robot</frame_id>')
                                  ), kinds=frozenset({Kind.SENSOR, Kind.MODEL}))
    with pytest.raises(UnknownFrameError, match='a camera without a frame of its own'):
        lookup.element('robot_optical')


@pytest.mark.parametrize(('name', 'is_known'), [
    ('map', True), ('left/robot', True), ('robot::base::shell', True), ('left/floor', False)])
def test_which_names_are_known(lookup, name, is_known):
    assert lookup.knows(name) is is_known
    assert lookup.is_frame_id(name) is name.startswith('left/robot')


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


def test_where_a_text_is_both_the_name_of_sdf_is_meant():
    lookup = lookup_in(
        world_file('<model name="a"><link name="b"><pose>1 0 0 0 0 0</pose></link></model>'
                   '<model name="m"><model name="a"><link name="b"/></model></model>'),
        frame_names=FrameNames.RELATIVE, frame_separator='::', kinds=frozenset({Kind.LINK}))
    assert lookup.pose('a::b').pose.x == 1.0
    assert lookup.pose('m::a::b', 'a::b').pose.x == -1.0
    assert lookup.pose_of_element(lookup.element('a::b')[0]).x == 1.0


def test_a_model_file_is_looked_up_from_its_root():
    found = lookup_in(model_file('<link name="a"><pose>1 0 0 0 0 0</pose></link>')).pose('m::a')
    assert (found.pose.x, found.frame_id) == (1.0, 'world')


def test_only_the_world_that_is_published_is_looked_up():
    text = ('<sdf version="1.10"><world name="v"><frame name="f"><pose>1 0 0 0 0 0</pose></frame>'
            '</world><world name="w"><frame name="f"/><frame name="g"/></world></sdf>')
    lookup = lookup_in(text)
    assert lookup.pose('f').pose.x == 1.0
    assert lookup.pose('world').frame_id == 'world'
    with pytest.raises(UnknownFrameError, match='"g"'):
        lookup.pose('g')


@pytest.mark.parametrize('text', [
    '{model}<world name="w"><frame name="f"/></world>',
    '<world name="w"><frame name="f"/></world>{model}',
])
def test_a_model_beside_a_world_has_nothing_in_common_with_it(text):
    model = '<model name="m"><link name="l"/></model>'
    lookup = lookup_in(f'<sdf version="1.10">{text.format(model=model)}</sdf>')
    with pytest.raises(UnknownFrameError):
        lookup.pose('m::l', 'f')
