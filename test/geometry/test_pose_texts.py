# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Typed and pasted texts of poses: what is refused, and one pose in all forms."""

import pytest

from sdf_pose_bridge.geometry.formats import (
    converted_poses,
    converted_rotations,
    format_from_name,
    PoseFormatError,
)
from sdf_pose_bridge.geometry.pose_texts import (
    FORMATS,
    NoFormatError,
    number_from_text,
    only_pose,
    TextDivider,
    typed_poses_from_text,
)


def typed_pose_from_text(*arguments, **options):
    """Read one pose."""
    return only_pose(typed_poses_from_text(*arguments, **options))


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
  1.000  0.000  0.000 -0.200
  0.000  0.000  1.000  0.300
  0.000  0.000  0.000  1.000
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
    ('p[1, 2, 3]', None, r'p\[...\] of Universal Robots has 6 numbers, and this one 3'),
    ('{X 100,5,Y 2,Z 3,A 0,B 0,C 0}', None, "\"X\" is '100 5', not a number"),
    ('--x 1 --rol 2', None, '"--rol" is left over'),
    ('--x 1 --yaw 2 --qz 1', None, '"--qz" is left over'),
    ('position: {x: 1, y: 2, z: 3}', None, 'x y z without a rotation'),
    (MESSAGE + MESSAGE, None, '"position.x" is given twice'),
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
    with pytest.raises(PoseFormatError, match='the text is no sdf_pose'):
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
    texts = TextDivider(FORMATS.get(source)).divided(text.splitlines(keepends=True), is_end=True)
    assert [each for _, each in texts] in ([text], [typed.numbers])


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
    lines = f'# a\n1 2 3\n\n{MESSAGE}---\n{MESSAGE}4 5 6\n{ECHO}{ECHO}7 8 9\n'.splitlines(True)
    texts = TextDivider(FORMATS['rpy']).divided(lines, is_end=True)
    assert [text for _, text in texts] == [
        [1, 2, 3], MESSAGE, MESSAGE, [4, 5, 6], ECHO, ECHO, [7, 8, 9]]
    assert [number for number, _ in texts[:3]] == [2, 4, 18]


@pytest.mark.parametrize(('lines', 'name', 'firsts'), [
    ('1 0 0 5\n0 1 0 0\n0 0 1 0\n0 0 0 1\n' * 2, 'matrix_row_major', [1, 5]),
    ('1 0 0\n0 1 0\n0 0 1\n\n1 0 0\n0 1 0\n0 0 1\n', 'matrix', [1, 5]),
    ('1 2 3\n0 0 0\n1 2 3 0 0 0\n', 'sdf_rpy', [1, 3]), ('1 2 3\n0 0 0 1\n', 'rpy', [1, 2]),
    ('1 2 3\n0 0 0\n' * 2, 'sdf_rpy', [1, 3]),
    ('1 2 3\n1 2 3 0 0 0\n', 'rzyz', [1, 2]), ('1, 2, 3\n(1\n2 3)\n1 2 3\n', 'rpy', [1, 2, 4]),
    ('x: [1\n\n0 0 0 0 0 1\n', 'sdf_rpy', [1, 3]), ('x: [1,\n2]\n0 0 1\n', 'rpy', [1, 3]),
    ('m:\n1 0 0\n0 1 0\n0 0 1\n# a\nm:\n1 0 0\n', None, [1, 6]),
    ('<?xml?>\n<!-- [ -->\n<a>\n\n<b/>\n</a>\n', None, [1]),
    (f'{MESSAGE}\n{KUKA}\n{KUKA}\np[1,\n2]\n', None, [1, 15, 16, 17]),
    ('--x 1 \\\n--y 2\n--x 1\n', None, [1, 3]), ('a: 1\n\nb: 2\n', None, [1]),
    ('x: 1 y: 2 z: 3 w: 4\n\nxyz: [1,2,3]\nrpy: [0,0,0]\n', None, [1, 3])])
def test_texts_end_where_others_begin(lines, name, firsts):
    source = format_from_name(name, FORMATS) if name else None
    texts = TextDivider(source).divided(lines.splitlines(True), is_end=True)
    assert [number for number, _ in texts] == firsts


def test_lines_that_come_later_continue_a_text():
    divider = TextDivider(FORMATS['matrix'])
    assert divider.divided(['1 0 0\n', '0 1 0\n']) == []
    assert divider.divided(['0 0 1\n', '1 0 0\n']) == [(1, '1 0 0\n0 1 0\n0 0 1\n')]
    assert divider.divided([], is_end=True) == [(4, '1 0 0\n')]


@pytest.mark.parametrize(('matrix', 'is_changed'), [
    ('0.7 -0.7 0 0.7 0.7 0 0 0 1', False), ('0.71 -0.71 0 0.71 0.71 0 0 0 1', True),
    ('0.707 -0.707 0.002 0.707 0.707 0 0 0 1', True),
    ('0.707 -0.707 0.003 0.707 0.707 0 0 0 1', False),
    ('0.7071 -0.7071 0.0003 0.7071 0.7071 0 0 0 1', False),
    ('0.71 -0.71 0.00003 0.71 0.71 0 0 0 1', True), ('2.01 0 0 0 1.01 0 0 0 1', False),
    ('0.70710678 -0.70710678 0 0.70710678 0.70710678 0 0 0 1', False)])
def test_only_few_digits_are_a_reason_to_change_a_matrix(matrix, is_changed):
    typed = typed_pose_from_text(matrix, FORMATS['matrix'])
    assert bool(typed.notes) is is_changed
    assert (typed.numbers == [*map(float, matrix.split())]) is not is_changed
    ((_, divided),) = TextDivider(FORMATS['matrix']).divided([matrix], is_end=True)
    assert isinstance(divided, str) is (is_changed or '0.70710678' not in matrix)


@pytest.mark.parametrize('text', ['', '-', '1/2', '1,5', '1 2', '1_0', '\u0663'])
def test_a_text_that_is_no_number_is_refused(text):
    with pytest.raises(PoseFormatError, match='is not a number'):
        number_from_text(text)


def test_a_minus_sign_is_a_minus():
    assert number_from_text(' \u221230 ') == -30.0
