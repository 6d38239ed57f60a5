# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Poses in a text are changed, and nothing else is."""

import math

import pytest
from sdf_texts import model_file

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import example, given
from hypothesis import strategies as st

from sdf_pose_bridge import Pose
from sdf_pose_bridge.errors import PoseNotSetError
from sdf_pose_bridge.geometry.poses import canonical_relative_pose
from sdf_pose_bridge.geometry.rotations import canonical_quaternion, quaternion_from_rpy
from sdf_pose_bridge.sdformat.pose_writing import PoseText, shortest_decimal

HALF = 0.5 ** 0.5
NEW = Pose(1.5, -2.0, 0.25, 0.0, 0.0, HALF, HALF)


def changed(text):
    """Set the pose of the link, which comes third, behind sdf and model."""
    return PoseText(text.encode(), 'file.sdf').with_pose(3, NEW, 1e-9).new_text.decode()


@pytest.mark.parametrize(('old', 'new'), [
    ('<pose>0 0 0 0 0 0</pose>', '<pose>1.5 -2 0.25 0 0 1.570796327</pose>'),
    ('<pose>\n\t0  0\t0\r\n0 0 0 </pose>', '<pose>\n\t1.5  -2\t0.25\r\n0 0 1.570796327 </pose>'),
    ("<pose degrees='true' >0 0 0 0 0 0</pose >",
     "<pose degrees='true' >1.5 -2 0.25 0 0 90</pose >"),
    ('<pose rotation_format="quat_xyzw">0 0 0 0 0 0 1</pose>',
     '<pose rotation_format="quat_xyzw">1.5 -2 0.25 0 0 0.7071067812 0.7071067812</pose>'),
    ('<pose/>', '<pose>1.5 -2 0.25 0 0 1.570796327</pose>'),
    ('<pose relative_to="l" />', '<pose relative_to="l" >1.5 -2 0.25 0 0 1.570796327</pose>'),
    ('<pose></pose>', '<pose>1.5 -2 0.25 0 0 1.570796327</pose>'),
    ('<pose><!-- <pose> x y --> 0 0 0 0 0 0<!-- end --></pose>',
     '<pose><!-- <pose> x y --> 1.5 -2 0.25 0 0 1.570796327<!-- end --></pose>'),
    ('<pose>1.50 -2.0 2.5e-1 0.0 -0 0</pose>',
     '<pose>1.50 -2.0 2.5e-1 0.0 -0 1.570796327</pose>'),
    ('<pose>0, 0, 0, 0, 0, 0</pose>', '<pose>1.5 -2 0.25 0, 0, 1.570796327</pose>'),
    ('<pose>9 9 9 6.283185307179586 0 7.853981633974483</pose>',
     '<pose>1.5 -2 0.25 6.283185307179586 0 7.853981633974483</pose>'),
])
def test_only_the_numbers_change(old, new):
    text = model_file('<!-- <pose> é --><link name="l">{}</link ><frame name="f"/>\n')
    assert changed(text.replace('{}', old)) == text.replace('{}', new)


@pytest.mark.parametrize('encoding', [
    'utf-8', 'utf-8-sig', 'iso-8859-1', 'utf-16-le', 'utf-16-be'])
def test_encoding_stays(encoding):
    mark = '\ufeff' if encoding.startswith('utf-16') else ''
    declared = 'utf-8' if encoding == 'utf-8-sig' else encoding[:6] if mark else encoding
    text = f'{mark}<?xml version="1.0" encoding="{declared}"?>\r\n' + model_file(
        '<link name="é"><pose>0 0 0 0 0 0</pose></link>')
    pose_text = PoseText(text.encode(encoding), 'file.sdf')
    # The elements are sdf, model, link, pose.
    assert pose_text.with_pose(3, NEW, 1e-9).new_text == text.replace(
        '0 0 0 0 0 0', '1.5 -2 0.25 0 0 1.570796327').encode(encoding)


@pytest.mark.parametrize(('old', 'new'), [
    ('<link name="l"/>', '<link name="l">{}</link>'),
    ('<link name="l"></link>', '<link name="l">{}</link>'),
    ('<link name="l">\n    <visual name="v"/>\n  </link>',
     '<link name="l">\n    {}\n    <visual name="v"/>\n  </link>'),
    ('<link name="l">\r\n\r\n\t<!-- c -->\r\n</link>',
     '<link name="l">\r\n\t{}\r\n\r\n\t<!-- c -->\r\n</link>'),
    ('<link name="l">\n</link>', '<link name="l">\n  {}\n</link>'),
    ('\n    <link name="l">\n    </link>', '\n    <link name="l">\n      {}\n    </link>'),
    ('\r\n\t<link name="l">\r\n\t</link>', '\r\n\t<link name="l">\r\n\t\t{}\r\n\t</link>'),
])
def test_a_new_pose_is_indented_like_a_child(old, new):
    text, changed_text = (
        model_file(each).replace('<model', '\n  <model')
        for each in (old, new.format('<pose>1.5 -2 0.25 0 0 1.570796327</pose>')))
    change = PoseText(text.encode(), 'file.sdf').with_new_pose(2, NEW, 1e-9)
    assert change.new_text.decode() == changed_text


@pytest.mark.parametrize(('old', 'new'), [
    ('<origin xyz="0 0 0" rpy="0 0 0"/>', '<origin xyz="1.5 -2 0.25" rpy="0 0 1.570796327"/>'),
    ("<origin\n rpy = '0 0 -1.0' a='>'\txyz='0  0 9 ' ></origin >",
     "<origin\n rpy = '0 0 1.570796327' a='>'\txyz='1.5  -2 0.25 ' ></origin >"),
    ('<origin xyz="1.50 0 0"/><origin xyz="9 9 9"/>',
     '<origin rpy="0 0 1.570796327" xyz="1.50 -2 0.25"/><origin xyz="9 9 9"/>'),
    ('<origin rpy="6.283185307179586 0 7.853981633974483"/>',
     '<origin xyz="1.5 -2 0.25" rpy="6.283185307179586 0 7.853981633974483"/>'),
    ('<origin/>', '<origin xyz="1.5 -2 0.25" rpy="0 0 1.570796327"/>'),
])
def test_only_the_numbers_of_an_origin_change(old, new):
    text = ('<!-- é --><robot name="r"><joint name="j"><axis xyz="0 0 1"/>{}<!-- <origin/> --> '
            '</joint>\r\n</robot>')
    change = PoseText(text.replace('{}', old).encode(), 'file.urdf').with_origin(3, NEW, 1e-9)
    assert change.new_text.decode() == text.replace('{}', new)


def test_a_new_origin_is_indented_like_a_child():
    text = '<robot name="r">\n  <joint name="j">\n    <!-- <origin/> -->\n  </joint>\n</robot>'
    change = PoseText(text.encode(), 'file.urdf').with_origin(1, NEW, 1e-9)
    assert change.new_text.decode() == text.replace(
        '    <!--', '    <origin xyz="1.5 -2 0.25" rpy="0 0 1.570796327"/>\n    <!--')


@pytest.mark.parametrize(('text', 'reason'), [
    (model_file('<link name="l"><pose><![CDATA[0 0 0 0 0 0]]></pose></link>'), 'plain text'),
    (model_file('<link name="l"><pose>&#48; 0 0 0 0 0</pose></link>'), 'plain text'),
    (model_file('<link name="l"><pose>0 0 0</pose></link>'), 'a pose has 6 values'),
    (model_file('<link name="l"><pose degrees="true" rotation_format="quat_xyzw"/></link>'),
     'cannot be combined'),
    (model_file('<link name="l"><inertial/></link>'), 'is not written as <pose>, but in'),
    (model_file('<link name="R&D"><pose>0 0 0 0 0 0</pose></link>'), 'not well-formed'),
])
def test_other_texts_are_refused(text, reason):
    with pytest.raises(PoseNotSetError, match=reason):
        PoseText(text.encode(), 'file.sdf').with_pose(3, NEW, 1e-9)


def test_each_tag_has_a_line():
    text = PoseText(model_file('<link name="a"/><link name="b"\n/>').encode(), 'file.sdf')
    assert [text.element_at_line(line) for line in (1, 2, 3, 4)] == [0, 1, 2, 3]
    for line in (0, 5):
        with pytest.raises(PoseNotSetError):
            text.element_at_line(line)
    assert text.line(3) == 1


@pytest.mark.parametrize(('number', 'tolerance', 'text'), [
    (-1e-12, 1e-9, '0'), (2.5, 0.5, '2')])
def test_shortest_decimal(number, tolerance, text):
    assert shortest_decimal(number, tolerance) == text


NUMBERS = st.floats(-1e6, 1e6)
LAST_DIGIT = 0.1234567809, 0.2234567809, 0.3234567809


@example(
    (899462.4420425005, 1.4364914845209569, 0.0),
    (-0.30711506386201737, -1.0, -0.30711506386201737, -0.5), '')
@example(LAST_DIGIT, quaternion_from_rpy(LAST_DIGIT), '')
@given(st.tuples(NUMBERS, NUMBERS, NUMBERS), st.tuples(*[st.floats(-1, 1)] * 4).filter(
    lambda quat_xyzw: max(map(abs, quat_xyzw)) > 1e-3), st.sampled_from([
        '', 'degrees="true"', 'rotation_format="quat_xyzw"']))
def test_what_is_written_is_right_to_the_tolerance(xyz, quat_xyzw, attributes):
    pose = Pose(*xyz, *canonical_quaternion(quat_xyzw))
    text = model_file(f'<link name="l"><pose {attributes}/></link>').encode()
    written = PoseText(PoseText(text, '').with_pose(3, pose, 1e-9).new_text, '').pose(3)
    # Far from the origin, a relative pose is rounded more than what is written.
    assert math.dist(pose[:3], written[:3]) <= 1e-9
    between = canonical_relative_pose(pose, written)
    assert 2.0 * sum(part ** 2 for part in between[3:6]) ** 0.5 <= 1e-9
