# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Typed and pasted texts of poses: what is refused, and one pose in all forms."""

import pytest

from sdf_pose_bridge.geometry.formats import (
    converted_poses,
    converted_rotations,
    PoseFormatError,
)
from sdf_pose_bridge.geometry.pose_texts import (
    FORMATS,
    NoFormatError,
    number_from_text,
    texts_from_lines,
    typed_pose_from_text,
)

KUKA = '{X 100,Y -200,Z 300,A 90,B 0,C 0}'
ROBTARGET = '[[100,-200,300],[0.7,0,0,0.7],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]'
MESSAGE = """header:
  stamp: {sec: 5, nanosec: 7}
  frame_id: tool0
pose:
  position:
    x: 0.1
    y: -0.2
    z: 0.3
  orientation:
    x: 0.0
    y: 0.0
    z: 0.7071
    w: 0.7071
"""
TRANSFORM = """transforms:
- header:
    frame_id: map
  child_frame_id: base_2
  transform:
    translation: {x: 0.1, y: -0.2, z: 0.3}
    rotation: {x: 0.0, y: 0.0, z: 0.7071, w: 0.7071}
"""
ECHO = """At time 12.5
- Translation: [0.100, -0.200, 0.300]
- Rotation: in Quaternion (xyzw) [0.000, 0.000, 0.707, 0.707]
- Rotation: in RPY (degree) [0.000, -0.000, 90.000]
- Matrix:
  0.000 -1.000  0.000  0.100
"""
REPR = (
    'Pose(position=geometry_msgs.msg.Point(x=0.1, y=-0.2, z=0.3), '
    'orientation=geometry_msgs.msg.Quaternion(x=0.0, y=0.0, z=0.7, w=0.7))')
ROWS = ('0. -1. 0. 0.1', '1. 0. 0. -0.2', '0. 0. 1. 0.3', '0. 0. 0. 1.')
ARRAY = 'array([[' + '],\n       ['.join(row.replace(' ', ', ') for row in ROWS) + ']])'


@pytest.mark.parametrize(('text', 'source', 'message'), [
    ('0,1 -0,2 0,3 0 0 90', 'sdf_rpy', 'decimal commas'),
    ('0,5 1,25 0', 'rpy', 'decimal commas'), ('0,5; 1,25; 0', 'rpy', 'decimal commas'),
    ('0,5, 1,25, 0,3', 'sdf_rpy', 'decimal commas'), ('1, 2 3', 'rpy', 'decimal commas'),
    ('0,5,1,25,0,3', 'rpy', 'but 6 are given; decimals need points'),
    ('1/2 3 4', 'rpy', "'1/2' is not a number"), ('1 2 90deg', 'rpy', "'90deg'"),
    ('', 'rpy', 'but 0 are given'),
    (KUKA, 'yaskawa', r'the text is kuka_abc \({X ...} of KUKA\), not yaskawa'),
    ('<pose degrees="true">1 2 3 0 0 90</pose>', 'sdf_rpy', 'the text is sdf_rpy_degrees'),
    ('p[1, 2, 3]', None, r'has not the numbers of p\[...\] of Universal Robots'),
    ('{X 100,5,Y 2,Z 3,A 0,B 0,C 0}', None, 'has not the numbers of {X ...} of KUKA'),
    ('--x 1 --rol 2', None, 'has not the numbers of static_transform_publisher'),
    ('--x 1 --yaw 2 --qz 1', None, 'has not the numbers of static_transform_publisher'),
    ('position: {x: 1, y: 2, z: 3}', None, 'has not the numbers of a message of ROS'),
    (MESSAGE + MESSAGE, None, 'several poses'),
    ('0.5 0.5 0 0 1 0 0 0 1', 'matrix', 'not orthonormal'),
    ('0.71 0.71 0 0.71 -0.71 0 0 0 1', 'matrix', 'it mirrors'),
])
def test_a_text_that_is_no_pose_is_refused(text, source, message):
    with pytest.raises(PoseFormatError, match=message):
        converted_rotations(
            *typed_pose_from_text(text, FORMATS[source] if source else None)[:2], 'rpy')


def test_numbers_alone_name_no_format():
    with pytest.raises(NoFormatError):
        typed_pose_from_text('1 2 3')
    with pytest.raises(PoseFormatError, match='has not the numbers of sdf_pose'):
        typed_pose_from_text('1 2 3 0 0 0', form_name='sdf_pose')
    assert typed_pose_from_text('1 2 3', None, FORMATS['rpy']).format is FORMATS['rpy']


@pytest.mark.parametrize(('text', 'source'), [
    ('0.1, -0.2, 0.3, 0, 0, 1.5708', 'sdf_rpy'), ('100; \u2212200; 300; 0; 0; 90', 'denso'),
    ('[0.1, -0.2, 0.3, 0.0, 0.0, 0.7071, 0.7071]', 'sdf_quat_xyzw'),
    ('\n'.join(ROWS), 'matrix_row_major'), ('\n'.join(ROWS[:3]), 'matrix_row_major'),
    (ARRAY, 'matrix_row_major'), ('p[0.1, -0.2, 0.3, 0, 0, 1.5708]', ''), (KUKA, ''),
    ('{E6POS: X 100,Y -200,Z 300,A 90,B 0,C 0,S 2,T 35,E1 0.0}', ''), (ROBTARGET, ''),
    (f'CONST robtarget p10:={ROBTARGET};', ''),
    ('<frame name="f"><pose relative_to="a 2" degrees="1">0.1 -0.2 0.3 0 0 90</pose></frame>', ''),
    ('<pose rotation_format="quat_xyzw">0.1 -0.2 0.3 0 0 0.7 0.7</pose>', ''),
    ('<origin rpy="0 0 1.5708" xyz="0.1 -0.2 0.3"/>', ''),
    ('--x 0.1 --y -0.2 --z 0.3 --yaw 1.5708 --frame-id a', ''),
    ('--z 0.3 --y -0.2 --x 0.1 --qz 0.7 --qw 0.7', ''), (MESSAGE, ''), (TRANSFORM, ''), (ECHO, ''),
    (REPR, ''),
    ('transformation: {qw: 0.7, qx: 0.0, qy: 0.0, qz: 0.7, x: 0.1, y: -0.2, z: 0.3}', ''),
])
def test_one_pose_in_all_texts(text, source):
    typed = typed_pose_from_text(text, FORMATS.get(source))
    assert converted_poses(typed.numbers, typed.format, 'sdf_rpy_degrees') == pytest.approx(
        (0.1, -0.2, 0.3, 0, 0, 90), abs=1e-3)
    lines = [(1, text)] if text.startswith('At time') else [*texts_from_lines(
        text.splitlines(keepends=True), typed.format.row_length)]
    assert [each for _, each in lines] == [text]


def test_a_rotation_is_read():
    assert typed_pose_from_text('x: 0\ny: 0\nz: 1\nw: 0')[:2] == (
        [0, 0, 1, 0], FORMATS['quaternion'])


@pytest.mark.parametrize(('digits', 'note'), [(2, '2 digits'), (4, '4 digits'), (8, '')])
def test_a_matrix_with_few_digits_is_made_a_rotation(digits, note):
    row = converted_rotations((10, 20, 30), 'rpy_degrees', 'matrix').round(digits)
    typed = typed_pose_from_text(' '.join(map(str, row.tolist())), FORMATS['matrix'])
    assert ' '.join(typed.notes).count(note) == 1 or not (note or typed.notes)
    assert converted_rotations(typed.numbers, typed.format, 'rpy_degrees') == pytest.approx(
        (10, 20, 30), abs=100 * 10.0 ** -digits)


def test_lines_are_divided_into_texts():
    lines = f'# a\n1 2 3\n\n{MESSAGE}---\n{MESSAGE}4 5 6\n{ECHO}{ECHO}7 8\n'.splitlines(True)
    texts = [*texts_from_lines(lines, 3)]
    assert [text for _, text in texts] == [
        '1 2 3\n', MESSAGE, MESSAGE, '4 5 6\n', ECHO, ECHO, '7 8\n']
    assert [number for number, _ in texts[:3]] == [2, 4, 18]


@pytest.mark.parametrize('text', ['', '-', '1/2', '1,5', '1 2', '1_0', '\u0663'])
def test_a_text_that_is_no_number_is_refused(text):
    with pytest.raises(PoseFormatError, match='is not a number'):
        number_from_text(text)


def test_a_minus_sign_is_a_minus():
    assert number_from_text(' \u221230 ') == -30.0
