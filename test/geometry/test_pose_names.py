# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""One pose in all texts with names, lists of poses, and numbers that are missing."""

import math

import pytest

from sdf_pose_bridge.geometry import pose_names
from sdf_pose_bridge.geometry.formats import converted_poses, PoseFormatError
from sdf_pose_bridge.geometry.pose_texts import FORMATS, TextDivider, typed_poses_from_text

YAW = math.degrees(2 * math.atan2(0.6, 0.8))
POSE = '{position: {x: 1, y: 2, z: 3}, orientation: {x: 0, y: 0, z: 0.6, w: 0.8}}'
SCALARS = 'x: 1\ny: 2\nz: 3\nroll: 0\npitch: 0\nyaw: 1.287002218\n'
ROWS = '[0.28, -0.96, 0, 1], [0.96, 0.28, 0, 2], [0, 0, 1, 3]'
FLAT = '0.28, -0.96, 0, 1, 0.96, 0.28, 0, 2, 0, 0, 1, 3'
LINES_IN_ONE = (
    'header: stamp: sec: 5 nanosec: 7 frame_id: a pose: pose: position: x: 1 y: 2 z: 3'
    ' orientation: x: 0 y: 0 z: 0.6 w: 0.8 covariance: - 0.0 - 0.0 twist: twist: linear: x: 0')
GAZEBO = """pose {
  name: "a"
  id: 8
  position {
    x: 1
    y: 2
    z: 3
  }
  orientation {
    z: 0.6
    w: 0.8
  }
}
"""
FANUC = """P[1]{
   GP1:
    UF : 0, UT : 1,  CONFIG : 'N U T, 0, 0, 0',
    X =  1000.000  mm,  Y =  2000.000  mm,  Z =  3000.000  mm,
    W =  0.000 deg,  P =  0.000 deg,  R =  73.739795 deg
};
"""
LAUNCH = """<launch>
  <!-- a lidar -->
  <arg name="rate" default="10"/>

  <node type="static_transform_publisher" name="p" args="1 2 3 1.287002218 0 0 a_1 b_2 100"/>
</launch>
"""
PYTHON_LAUNCH = """Node(executable='static_transform_publisher',
     arguments=['--x', '1', '--y', '2', '--z', '3',
                '--yaw', '1.287002218', '--frame-id', 'a'])
"""
MUJOCO = """<mujoco><compiler angle="radian" eulerseq="XYZ"/>
  <body pos="1 2 3" euler="0 0 1.287002218"/></mujoco>
"""


@pytest.mark.parametrize('text', [
    SCALARS, LINES_IN_ONE, GAZEBO, FANUC, LAUNCH, PYTHON_LAUNCH, MUJOCO, POSE,
    'sensor:\n  ' + SCALARS.replace('\n', '\n  '), SCALARS.replace('\n', ', '),
    'xyz: [1, 2, 3]\nrpy: [0, 0, 1.287002218]\n', 'xyz="1 2 3" rpy="0 0 1.287002218"',
    f'a: {POSE} # the end', f'{{"a": {POSE}, "b": {{"x": 5}}}}', f'"{POSE}"',
    POSE.replace('x: 0, y: 0, ', ''), f'header: {{stamp: {{sec: 5}}}}\npose:\n  pose: {POSE}\n',
    'rotation: w: 0.8 x: 0 y: 0 z: 0.6 translation: x: 1 y: 2 z: 3',
    'rotation: {x: 0, y: 0, z: 0.6, w: 0.8}\ntranslation: {z: 3, y: 2, x: 1}',
    'cam:\n  intrinsics: [9, 9, 4, 4]\n  T_a_b:\n  - ' + ROWS.replace('], ', ']\n  - ') + '\n',
    f'T: !!opencv-matrix\n  rows: 3\n  cols: 4\n  dt: d\n  data: [{FLAT}]\n',
    f'm = np.array([{ROWS}])', f'T_a_b: (a to b):\n[{ROWS}]',
    'static_transform_publisher 1 2 3 1.287002218 0 0 a_1 b_2',
    'rosrun tf static_transform_publisher 1 2 3 0 0 0.6 0.8 a b 100',
    f'<body pos="1 2 3" euler="0 0 {YAW}"/>', '<geom pos="1 2 3" quat="0.8 0 0 0.6" size="1"/>',
    '<joint name="j"><origin rpy="0 0 1.287002218" xyz="1 2 3"/><axis xyz="0 0 1"/></joint>',
    'p [1, 2, 3, 0, 0, 1.287002218]', 'posx(1000, 2000, 3000, 0, 0, 73.739795)',
    'TRANS(1000, 2000, 3000, 0, 0, 73.739795)',
    'pose: {quat_wxyz: [0.8, 0, 0, 0.6], position: [1, 2, 3]}',
    'R: [[0.28, -0.96, 0], [0.96, 0.28, 0], [0, 0, 1]]\nt: [1, 2, 3]',
    'a: xyz: [1, 2, 3]; rpy: [0, 0, 1.287002218]',
    'a:\n  x: 1 y: 2 z: 3 rpy: [0, 0, 1.287002218]',
    '- x: 1, y: 2, z: 3, rpy: [0, 0, 1.287002218]',
    'a:\n  name: "[b"\n  xyz: [1, 2, 3]\n  rpy: [0, 0, 1.287002218]\nb:\n  scale: 2'])
def test_one_pose_in_all_texts_with_names(text):
    for each in (text, f'%YAML:1.0\n# a pose\n{text}\n'):
        (pose,) = typed_poses_from_text(each)
        assert converted_poses(pose.numbers, pose.format, 'sdf_rpy_degrees') == pytest.approx(
            (1, 2, 3, 0, 0, YAW), abs=1e-6)
        ((_, divided),) = TextDivider(None).divided(each.splitlines(True), is_end=True)
        assert typed_poses_from_text(divided)[0].numbers == pose.numbers


@pytest.mark.parametrize(('text', 'names'), [
    (f'poses:\n- {POSE}\n- {POSE}', ['', '']), (f'[{POSE}, {POSE}]', ['', '']),
    (f'a: {POSE}\nb: {POSE}', ['a', 'b']), (f'k:\n  a: {POSE}\n\n  b: {POSE}', ['a', 'b']),
    (GAZEBO + GAZEBO.replace('"a"', '"b"'), ['a', 'b']),
    (''.join(f'- child_frame_id: {name}\n  transform: {POSE}\n' for name in 'ab'), ['a', 'b'])])
def test_a_list_of_poses_has_their_names(text, names):
    ((_, divided),) = TextDivider(None).divided(text.splitlines(True), is_end=True)
    assert [pose.name for pose in typed_poses_from_text(divided)] == names


@pytest.mark.parametrize(('text', 'numbers'), [
    ('{pose: {position: {x: 1}}}', [1, 0, 0, 0, 0, 0]), ('<pose relative_to="a 2"/>', 6 * [0]),
    ('position {\n}\norientation {\n  z: 1\n}', [0, 0, 0, 0, 0, 1, 0]), ('<origin/>', 6 * [0]),
    ('<origin xyz="1 0 0"/>', [1, 0, 0, 0, 0, 0]), ('--yaw 1', [0, 0, 0, 0, 0, 1])])
def test_gaps_are_filled_by_the_defaults_of_their_texts(text, numbers):
    assert typed_poses_from_text(text)[0].numbers == numbers


@pytest.mark.parametrize(('text', 'source', 'name'), [
    ('pose: [1, 2, 3, 0, 0, 1]', 'sdf_rpy', 'sdf_rpy'),
    ('[[1,0,3],[0.8,0,0,0.6]]', 'abb', 'abb'), ('t := [TRUE,[[1,0,3],[1,0,0,0]]]', 'abb', 'abb'),
    ('O_T_EE: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1]', '', 'franka_matrix'),
    ('T: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1]', 'franka_matrix', 'franka_matrix')])
def test_numbers_of_one_name_are_in_the_requested_format(text, source, name):
    (pose,) = typed_poses_from_text(text, FORMATS.get(source))
    assert pose.format.name == name
    assert converted_poses(pose.numbers, pose.format, 'sdf_rpy')[2] in (3, 0.003)


@pytest.mark.parametrize('text', [FLAT, f'T: [{FLAT}]'])
def test_rows_of_a_matrix_are_no_columns(text):
    with pytest.raises(PoseFormatError, match='franka_matrix has 16'):
        typed_poses_from_text(text, FORMATS['franka_matrix'])


def test_the_tables_name_formats_that_exist():
    named = {each.format for each in (*pose_names.ROTATIONS, *pose_names.QUATERNION)}
    named = named.union(pose_names.TEXTS, *(formats for _, *formats in pose_names.CALLS.values()))
    assert named - pose_names.FORMATS.keys() == {'euler'}  # of which <compiler> has the sequence
