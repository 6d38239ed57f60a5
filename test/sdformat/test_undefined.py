# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Warnings of elements and attributes that SDFormat or URDF does not define."""

import pytest
from sdf_texts import LINK, link_with, model_file, TWO_LINKS, world_file, write_files
from urdf_texts import joint, link, robot

from sdf_pose_bridge import load, load_text


def robot_with(in_joint, in_robot=''):
    return robot(f'{link("a")}{link("b")}{joint("j", "a", "b", "fixed", in_joint)}{in_robot}')


def messages_of(text):
    return [warning.message for warning in load_text(text).warnings]


@pytest.mark.parametrize(('text', 'message'), [
    (model_file(LINK + '<lnk name="k"/>'),
     '<lnk> in <model> is not defined in SDFormat; did you mean <link>?'),
    (model_file(LINK + '<Link name="k"/>'),
     '<Link> in <model> is not defined in SDFormat; did you mean <link>?'),
    (model_file(LINK + '<qqqq/>'), '<qqqq> in <model> is not defined in SDFormat'),
    (link_with('<static>true</static>'),
     '<static> in <link> is not defined in SDFormat; it can stand in <model>'),
    (link_with('<mass>1</mass>'),
     '<mass> in <link> is not defined in SDFormat; it can stand in <inertial>'),
    (link_with('<visual name="v"><uri>u</uri><geometry/></visual>'),
     ('<uri> in <visual> is not defined in SDFormat; it can stand in <script> of <material> '
      'or <heightmap> or <image> or <mesh>')),
    (link_with('<mu>1</mu>'),
     '<mu> in <link> is not defined in SDFormat; it can stand in <ode> of <friction>'),
    (link_with('<sensor name="s" type="camera"><optical_frame_id>o</optical_frame_id></sensor>'),
     '<optical_frame_id> in <sensor> is not defined in SDFormat; it can stand in <camera>'),
    (link_with('<pose>1 2 3 0 0 0<relative_to>world</relative_to></pose>'),
     ('<relative_to> in <pose> is not defined in SDFormat; it is an attribute: '
     'relative_to="..."')),
    (link_with('<sensor name="s" type="imu"><ignition_frame_id>f</ignition_frame_id></sensor>'),
     ('<ignition_frame_id> in <sensor> is not defined in SDFormat; no supported release of '
      'Gazebo reads it; write <gz_frame_id>, in version 1.12 <frame_id>')),
    (link_with('<gz_frame_id>f</gz_frame_id>'),
     '<gz_frame_id> in <link> is not defined in SDFormat; Gazebo looks for it in <sensor>'),
    (model_file(LINK + '<sensor name="s" type="imu"/>'),
     '<sensor> in <model> is not defined in SDFormat; it can stand in <link> or <joint>'),
    (link_with('<inertial><mas>1</mas></inertial>'),
     '<mas> in <inertial> is not defined in SDFormat; did you mean <mass>?'),
    (link_with('<collision name="c"><surface><friction><ode><kp>1</kp></ode></friction></surface>'
               '<geometry/></collision>'),
     '<kp> in <ode> of <friction> is not defined in SDFormat'),
    (world_file('<state world_name="w"><model name="m"><static>1</static></model></state>'),
     '<static> in <model> of <state> is not defined in SDFormat'),
    (world_file('<modle name="m"/>'),
     '<modle> in <world> is not defined in SDFormat; did you mean <model>?'),
    (f'<sdf version="1.9"><modell/><model name="m">{LINK}</model></sdf>',
     '<modell> in <sdf> is not defined in SDFormat; did you mean <model>?'),
    (link_with('<visual name="v"><origin xyz="1 2 3"/><geometry/></visual>'),
     ('<origin> in <visual> is not defined in SDFormat; it is from URDF; SDFormat has <pose>x y z '
     'roll pitch yaw</pose>')),
    (link_with('<pose relativ_to="x">1 2 3 0 0 0</pose>'),
     'relativ_to="x" of <pose> is not defined in SDFormat; did you mean relative_to?'),
    (link_with('<pose degree="true">0 0 0 0 0 1</pose>'),
     'degree="true" of <pose> is not defined in SDFormat; did you mean degrees?'),
    (model_file(LINK + '<frame name="f" attach_to="l"/>'),
     'attach_to="l" of <frame> is not defined in SDFormat; did you mean attached_to?'),
    (model_file(LINK, attributes='static="true"'),
     'static="true" of <model> is not defined in SDFormat; it is an element: <static>'),
    (link_with('<pose frame="l"/>'),
     'frame="l" of <pose> is not defined in SDFormat; since version 1.7 it is relative_to'),
    (world_file('<actor name="a"><skin><filename>f</filename></skin><script><trajectory id="0" '
                'type="t"><waypoint><time>0</time><pose frame="x">0 0 0 0 0 0</pose></waypoint>'
                '</trajectory></script></actor>', version='1.6'),
     'frame="x" of <pose> is not defined in SDFormat'),
    (model_file(TWO_LINKS + '<joint name="j" type="revolute"><parent>a</parent><child>b</child>'
                '<axis><use_parent_model_frame>1</use_parent_model_frame></axis></joint>'),
     ('<use_parent_model_frame> in <axis> is not defined in SDFormat; since version 1.7, true is '
      '<xyz expressed_in="__model__">')),
    (link_with('<inertial><pose relative_to="l"/></inertial>'),
     'relative_to="l" of <pose> is not defined in SDFormat; an inertial is placed in its link'),
    (model_file(LINK + '<plugin name="p" filename="f" file="g"/>'),
     'file="g" of <plugin> is not defined in SDFormat; did you mean filename?'),
    (robot_with('<orgin xyz="1 0 0"/>'),
     '<orgin> in <joint> is not defined in URDF; did you mean <origin>?'),
    (robot_with('<mimick joint="k"/>'),
     '<mimick> in <joint> is not defined in URDF; did you mean <mimic>?'),
    (robot_with('<mass value="1"/>'), '<mass> in <joint> is not defined in URDF'),
    (robot_with('<origin><xyz>1 0 0</xyz></origin>'),
     '<xyz> in <origin> is not defined in URDF; it is an attribute: xyz="..."'),
    (robot_with('<origin xyx="1 0 0"/>'),
     'xyx="1 0 0" of <origin> is not defined in URDF; did you mean xyz?'),
    (robot_with('<origin ypr="1 0 0"/>'),
     'ypr="1 0 0" of <origin> is not defined in URDF; it can have xyz, rpy, quat_xyzw'),
    (robot_with('', '<frame name="f"/>'), '<frame> in <robot> is not defined in URDF'),
    (robot_with('', '<inertial/>'),
     '<inertial> in <robot> is not defined in URDF; it can stand in <link>'),
])
def test_what_is_not_defined_is_a_warning(text, message):
    assert messages_of(text) == [message]


@pytest.mark.parametrize('text', [
    model_file(LINK + '<plugin name="p" filename="f"><anything goes="here"/></plugin>'),
    ('<sdf version="1.9" xmlns:x="y"><model name="m"><link name="l" x:a="b"><x:b/></link></model>'
    '</sdf>'),
    model_file(LINK + '<my:tag/>'),
    robot_with('<my:tag/>', '<transmission><a b="c"/></transmission><ros2_control d="e"/>'),
    model_file(LINK + '<!-- <lnk/> -->'),
])
def test_what_belongs_to_others_gives_no_warning(text):
    assert [message for message in messages_of(text) if 'not defined' in message] == []


def test_element_that_is_not_defined_is_not_searched():
    assert len(messages_of(model_file(LINK + '<a><b c="d"/></a>'))) == 1


@pytest.mark.parametrize(('version', 'content'), [
    ('1.3', '<physics type="ode"><update_rate>1000</update_rate></physics>'),
    ('1.5', '<physics type="ode"><gravity>0 0 -9</gravity></physics>'),
    ('1.5', ('<model name="m"><link name="l"><sensor name="s" type="imu"><imu><noise>'
            '<type>gaussian</type></noise></imu></sensor></link></model>')),
    ('1.4', f'<model name="m">{LINK}<pose frame="">0 0 1 0 0 0</pose></model>'),
    ('1.7', ('<model name="m"><link name="l"><inertial><pose relative_to=""/></inertial></link>'
            '</model>')),
])
def test_element_of_an_old_version_gives_no_warning(version, content):
    text = world_file(content, version=version).replace(
        '<physics type="ode">', '<physics type="ode"><max_step_size>1</max_step_size>')
    assert messages_of(text) == []


def test_misspelt_element_of_an_include_is_a_warning_with_its_line(tmp_path):
    write_files(tmp_path, leaf=model_file(LINK), main=world_file(
        '\n<include>\n<uri>leaf.sdf</uri>\n<nmae>n</nmae>\n</include>'))
    (warning,) = load(tmp_path / 'main.sdf').warnings
    assert warning.message == (
        '<nmae> in <include> is not defined in SDFormat; did you mean <name>?')
    assert (warning.place.file, warning.place.line) == (str(tmp_path / 'main.sdf'), 4)


def test_include_where_none_is_read_has_a_warning_of_its_own():
    scene = load_text(model_file(LINK + '<pose><include><uri>u</uri></include></pose>'))
    assert [each.message for each in scene.warnings] == ['<include> in <pose> is not read']
