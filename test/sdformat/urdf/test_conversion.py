# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Converted robots: names, poses and joints as libsdformat 14.9 has them in an include.

Where that differs from what ROS makes of a robot there are tests of both.
"""

import math

import pytest
from sdf_texts import codes_of, errors_of_file, names_of, only_error, posed, world_file
from urdf_texts import gazebo, joint, link, origin, robot, shape

from sdf_pose_bridge import load, load_text
from sdf_pose_bridge.geometry.rotations import quaternion_from_rpy
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.source_formats import SourceFormat
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.urdf.conversion import sdf_from_urdf
from sdf_pose_bridge.sdformat.xml_file import xml_from_bytes

FIXED = joint('j', 'a', 'b', 'fixed', origin('1 0 0', f'0 0 {math.pi / 2}'))
TWO = link('a') + link('b')
TWO_FIXED = TWO + FIXED
SENSOR = '<sensor name="s" type="imu">{}</sensor>'


def joined(content=''):
    """Return two links with a continuous joint."""
    return TWO + joint('j', 'a', 'b', 'continuous', content)


def write(folder, text):
    (folder / 'r.urdf').write_text(robot(text))
    include = '<include><uri>r.urdf</uri><name>n</name><pose>5 0 0 0 0 0</pose></include>'
    (folder / 'w.sdf').write_text(world_file(include))
    return folder / 'w.sdf'


def for_ros(text):
    """Load a robot as ROS reads it."""
    return load_text(robot(text))


@pytest.fixture
def included(tmp_path):
    """Loads a world that includes a robot: ``included(text)``."""
    return lambda text, **options: load(write(tmp_path, text), **options)


@pytest.fixture
def errors_in(tmp_path):
    """Returns the errors of a world that includes a robot: ``errors_in(text)``."""
    return lambda text: errors_of_file(write(tmp_path, text))


def model_from(text, *, is_included=True):
    """Return the ``model`` that a robot becomes."""
    sources = Sources()
    sources.add_path('f')
    file = xml_from_bytes(text.encode(), 'f')
    sources.add_tree('f', file.root, file.lines)
    converted, _ = sdf_from_urdf(file.root, sources, is_included=is_included)
    return converted.find('model')


def kinds_of(scene):
    """Return the kinds of named elements."""
    return {name: Kind(kind).label for name, kind in zip(scene.names, scene.kinds, strict=True)}


# Links and joints

def test_frame_of_a_link_is_that_of_its_joint():
    scene = for_ros(joined(origin('0.30000000000000004 2 3')))
    assert names_of(scene) == ['r', 'r::a', 'r::a::inertial', 'r::j', 'r::b', 'r::b::inertial']
    assert scene.pose('r::b') == scene.pose('r::j')
    assert scene.pose('r::b')[:3] == (0.30000000000000004, 2.0, 3.0)


def test_children_are_in_the_order_of_their_joints():
    scene = for_ros(
        TWO + link('c') + joint('k', 'a', 'b', 'continuous') + joint('j', 'a', 'c', 'continuous'))
    links = [name for name in scene.names if name in ('r::a', 'r::b', 'r::c')]
    assert links == ['r::a', 'r::c', 'r::b']


@pytest.mark.parametrize(('joint_type', 'expected'), [
    ('continuous', 'revolute'), ('revolute', 'revolute'), ('prismatic', 'prismatic'),
])
def test_type_of_a_joint(joint_type, expected):
    limit = '<limit effort="1" velocity="1"/>'
    assert model_from(robot(TWO + joint('j', 'a', 'b', joint_type, limit))).find(
        'joint').get('type') == expected


@pytest.mark.parametrize('joint_type', ['floating', 'planar'])
def test_joint_that_sdformat_does_not_have_is_refused_in_an_include(errors_in, joint_type):
    (error,) = errors_in(TWO + '\n' + joint('j', 'a', 'b', joint_type))
    assert (error.code, error.line) == ('POSE_RELATIVE_TO_INVALID', 2)


@pytest.mark.parametrize(('joint_type', 'types', 'message'), [
    ('planar', ['fixed'], 'joint "j" is planar, which SDFormat does not have; it is fixed here'),
    ('floating', [], 'joint "j" is floating; somebody else has to publish where link "b" is')])
def test_for_ros_a_planar_joint_is_fixed_and_a_floating_one_left_to_others(
        joint_type, types, message):
    scene = for_ros(TWO + joint('j', 'a', 'b', joint_type, origin('1 0 0')))
    assert scene.pose('r::b').x == 1.0
    assert [each.type for each in scene.joints] == types
    (warning,) = scene.warnings
    assert warning.message == message


def test_axis_limits_dynamics_and_mimic_are_converted():
    content = ('<axis xyz="0 1 0"/><limit lower="2" upper="-1" effort="3" velocity="4"/>'
               '<dynamics damping="6" friction="7"/><mimic joint="k" multiplier="5"/>')
    axis = model_from(robot(TWO + joint('j', 'a', 'b', 'revolute', content))).find('joint/axis')
    texts = {child.tag: child.text for child in axis.iter() if len(child) == 0}
    assert texts == {'xyz': '0 1 0', 'lower': '-1', 'upper': '2', 'effort': '3', 'velocity': '4',
                     'damping': '6', 'friction': '7', 'multiplier': '5', 'offset': '0'}
    assert axis.find('mimic').get('joint') == 'k'


def test_swapped_limits_are_as_written_for_ros_and_in_order_in_an_include(included):
    swapped = '<limit lower="2" upper="-1" effort="3" velocity="4"/>'
    text = TWO + joint('j', 'a', 'b', 'revolute', swapped)
    for scene, limits, told in (
            (for_ros(text), (2.0, -1.0), 'the lower limit 2 is above the upper one, -1'),
            (included(text), (-1.0, 2.0), 'Gazebo swaps the lower and the upper')):
        axis = scene.joints[0].axes[0]
        assert (axis.lower, axis.upper) == limits
        (warning,) = scene.warnings
        assert warning.message.startswith(told)
    equal = text.replace('"2"', '"-1"')
    assert included(equal).warnings == ()


def test_preserved_fixed_joint_can_be_mimicked(included):
    mimic = joint('k', 'b', 'c', 'continuous', '<mimic joint="j"/>')
    preserved = gazebo('<preserveFixedJoint>true</preserveFixedJoint>', 'j')
    scene = included(TWO + link('c') + FIXED + preserved + mimic)
    leader, follower = scene.joints
    assert (leader.type, follower.axes[0].mimic.joint) == ('fixed', leader.element)


def test_mimic_of_a_joint_that_does_not_exist_is_left_out_for_ros():
    scene = for_ros(joined('<mimic joint="k"/>'))
    assert scene.joints[0].axes[0].mimic is None
    assert 'there is no joint "k"' in scene.warnings[0].message


def test_continuous_joint_has_no_range_and_by_default_the_axis_x():
    limit = '<limit lower="-1" upper="1" effort="3" velocity="4"/>'
    model = model_from(robot(joined(limit)))
    assert [child.tag for child in model.find('joint/axis/limit')] == ['effort', 'velocity']
    assert model.find('joint/axis/xyz').text == '1 0 0'


def test_link_world_is_the_world():
    scene = for_ros(
        '<link name="world"/>' + link('b') + joint('j', 'world', 'b', 'fixed', origin('1 0 0')))
    assert names_of(scene) == ['r', 'r::j', 'r::b', 'r::b::inertial']
    assert scene.pose('r::b').x == 1.0
    assert len(scene.joints) == 1
    assert scene.urdf_root == 'world'
    assert names_of(for_ros('<link name="world"/>')) == ['r']
    assert 'RESERVED_NAME' in codes_of(robot(link('a') + link('world') + joint('j', 'a', 'world')))


def test_link_fixed_to_the_world_stays_a_link_in_an_include(included):
    text = '<link name="world"/>' + link('b') + joint('j', 'world', 'b', 'fixed', origin('1 0 0'))
    scene = included(text)
    assert kinds_of(scene)['n::b'] == 'link'
    assert scene.pose('n::b', 'n').x == 1.0


MASSLESS = (TWO + '<link name="c"/>' + link('d') + joint('j', 'a', 'b', 'continuous')
            + joint('k', 'b', 'c', 'continuous', origin('1 0 0'))
            + joint('l', 'c', 'd', 'continuous', origin('0 1 0')))


def test_link_without_mass_is_left_out_with_what_is_below_it_in_an_include(included):
    scene = included(MASSLESS)
    assert 'n::b' in scene.names
    assert not {'n::c', 'n::d', 'n::k', 'n::l'} & set(scene.names)
    (warning,) = scene.warnings
    assert warning.code == 'LINK_INERTIA_INVALID'
    assert warning.place.element == '/robot[@name="r"]/link[@name="c"]'


def test_link_without_mass_at_a_fixed_joint_is_a_frame_in_an_include(included):
    scene = included(link('a') + '<link name="b"/>' + FIXED)
    assert kinds_of(scene)['n::b'] == 'frame'
    assert scene.warnings == ()


@pytest.mark.parametrize('massless', ['<link name="c"/>', link('c', mass=0.0)])
def test_link_without_mass_stays_for_ros_with_a_warning(massless):
    scene = for_ros(MASSLESS.replace('<link name="c"/>', massless))
    assert scene.pose('r::d')[:3] == (1.0, 1.0, 0.0)
    assert 'r::c::inertial' not in scene.names
    (warning,) = scene.warnings
    assert (warning.code, warning.place.element) == (
        'LINK_INERTIA_INVALID', '/robot[@name="r"]/link[@name="c"]')
    assert warning.message.startswith('link "c" has no mass, so Gazebo leaves it out')
    assert warning.is_for_gazebo


@pytest.mark.parametrize('text', [
    '<link name="a"/><link name="b"/>' + FIXED,
    link('a', mass=0.0) + link('b', mass=0.0) + FIXED,
    '<link name="world"/><link name="b"/>' + joint('j', 'world', 'b', 'fixed', origin('1 0 0')),
])
def test_robot_without_any_mass_is_read_for_ros(text):
    assert for_ros(text).pose('r::b')[:3] == (1.0, 0.0, 0.0)


def test_links_without_mass_below_others_are_lumped_as_if_they_were_not_there_for_ros():
    text = (link('a', mass=0.0) + link('b', mass=0.0) + link('c')
            + joint('k', 'a', 'b') + joint('j', 'a', 'c'))
    assert for_ros(text).warnings == ()


# Fixed joints

def test_joint_with_the_name_of_a_link_is_refused_in_an_include(errors_in):
    codes = {error.code for error in errors_in(TWO + joint('b', 'a', 'b', 'continuous'))}
    assert 'DUPLICATE_NAME' in codes


def test_fixed_joint_leaves_two_frames_in_an_include(included):
    scene = included(TWO_FIXED + gazebo('<preserveFixedJoint>no</preserveFixedJoint>', 'j'))
    kinds = kinds_of(scene)
    assert (kinds['n::j'], kinds['n::b']) == ('frame', 'frame')
    assert scene.pose('n::b')[:3] == (6.0, 0.0, 0.0)
    assert scene.joints == ()
    assert (scene.source_format, scene.urdf_root) == (SourceFormat.SDFORMAT, '')


def test_fixed_joint_stays_for_ros_with_all_that_its_link_has():
    text = SENSOR.format('<pose degrees="true">0.123456789 0 0 0 0 90</pose>')
    scene = for_ros(
        link('a', mass=1.0)
        + link('b', shape('visual') + shape('collision'), mass=3.0, center='1 0 0') + FIXED
        + gazebo(text, 'b'))
    assert [each.type for each in scene.joints] == ['fixed']
    assert names_of(scene) == [
        'r', 'r::a', 'r::a::inertial', 'r::j', 'r::b', 'r::b::inertial',
        'r::b::b_collision', 'r::b::b_visual', 'r::b::s']
    assert scene.pose('r::a::inertial')[:3] == (0.0, 0.0, 0.0)
    assert scene.pose('r::b::inertial', 'r::b')[:3] == (1.0, 0.0, 0.0)
    assert scene.pose('r::b::s', 'r::b').x == pytest.approx(0.123456789, abs=1e-15)
    assert scene.urdf_root == 'a'
    assert scene.warnings == ()


@pytest.mark.parametrize(('option', 'expected'), [
    ('<preserveFixedJoint>true</preserveFixedJoint>', 'fixed'),
    ('<preserveFixedJoint value="YES"/>', 'fixed'),
    ('<disableFixedJointLumping>1</disableFixedJointLumping>', 'revolute'),
    ('<disableFixedJointLumping>1</disableFixedJointLumping><preserveFixedJoint value="1"/>',
     'fixed'),
    ('<preserveFixedJoint value="1"/><disableFixedJointLumping value="1"/>', 'fixed'),
])
def test_fixed_joint_is_kept_on_demand(option, expected):
    text = robot(TWO_FIXED + gazebo(option, 'j'))
    assert model_from(text).find('joint').get('type') == expected
    assert model_from(text, is_included=False).find('joint').get('type') == 'fixed'


def test_revolute_joint_in_place_of_a_fixed_one_has_the_axis_of_sdformat():
    option = '<disableFixedJointLumping>1</disableFixedJointLumping>'
    joint_xml = model_from(robot(TWO_FIXED + gazebo(option, 'j'))).find('joint')
    assert joint_xml.findtext('axis/xyz') == '0 0 1'
    assert joint_xml.findtext('axis/limit/upper') == '0'


@pytest.mark.parametrize(('tag', 'expected'), [
    ('visual', ['a_visual', 'a_fixed_joint_lump__b_visual_1', 'a_fixed_joint_lump__v_visual_2',
                'ab_visual_3']),
    ('collision', ['a_collision', 'a_fixed_joint_lump__b_collision_1',
                   'a_fixed_joint_lump__v_collision_2', 'ab_collision_3']),
])
def test_shapes_of_a_lumped_link_move_to_its_parent(included, tag, expected):
    pose = origin('1 0 0')
    scene = included(
        link('a', shape(tag)) + link('b', shape(tag, pose) + shape(tag, pose, 'v')) + FIXED
        + joint('k', 'b', 'ab') + link('ab', shape(tag)))
    names = [name.removeprefix('n::a::') for name in scene.names if tag in name]
    assert names == expected
    assert scene.pose(f'n::a::{names[1]}', 'n')[:3] == pytest.approx((1.0, 1.0, 0.0))


@pytest.mark.parametrize('is_included', [True, False])
def test_mesh_of_a_package_stays_one(is_included):
    mesh = '<visual><geometry><mesh filename="package://p/a.dae"/></geometry></visual>'
    model = model_from(robot(link('a', mesh)), is_included=is_included)
    assert model.find('link/visual/geometry/mesh/uri').text == 'package://p/a.dae'


def test_poses_of_two_fixed_joints_in_a_row_are_multiplied_from_the_first(included):
    text = (TWO + link('c', shape('visual'), mass=3.0, center='1 0 0') + FIXED
            + joint('k', 'b', 'c', 'fixed', origin('0 1.0000004 0', '0.5 0 0'))
            + link('d') + joint('l', 'c', 'd', 'continuous', origin('0 0 3'))
            + gazebo(SENSOR.format('') + posed('particle_emitter', 'p', '0 0 5 0 0 0'), 'c'))
    in_include, in_ros = included(text), for_ros(text)
    expected = pytest.approx(
        (0.0, 0.0, 0.0, *quaternion_from_rpy((0.5, 0.0, math.pi / 2))), abs=1e-5)
    for name in ('a::a_fixed_joint_lump__c_visual', 'c', 'a::s'):
        assert in_include.pose(f'n::{name}', 'n') == expected, name
    assert in_include.pose('n::a::s', 'n').x == pytest.approx(0.0, abs=1e-9), 'six digits'
    assert in_include.pose('n::a::p', 'n')[:3] == (0.0, 0.0, 5.0), 'not moved'
    assert in_include.pose('n::a::inertial', 'n') == pytest.approx(
        (0.2, 0.6, 0.0, 0.0, 0.0, 0.0, 1.0), abs=1e-5)
    assert in_include.names[in_include.joints[0].parent] == 'n::a'
    assert in_ros.pose('r::c', 'r') == expected
    assert in_include.pose('n::d', 'n') == pytest.approx(in_ros.pose('r::d', 'r'))


def test_link_without_mass_gets_that_of_a_lumped_link(included):
    text = '<link name="a"/>' + link('b') + FIXED
    scene = included(text)
    assert scene.pose('n::a::inertial', 'n')[:3] == (1.0, 0.0, 0.0)
    assert for_ros(text).warnings == (), 'Gazebo leaves nothing out'


def test_pitch_near_a_right_angle_is_rounded_as_by_libsdformat_in_an_include(included):
    pitch = '<origin rpy="0 1.57 0"/>'
    robot_file = (link('a', shape('visual', pitch)) + link('b', center='1 0 0')
                  + joint('j', 'a', 'b', 'fixed', pitch))
    right_angle = (0.0, math.sqrt(0.5), 0.0, math.sqrt(0.5))
    in_include, in_ros = included(robot_file), for_ros(robot_file)
    assert in_include.pose('n::a::a_visual')[3:] == pytest.approx(right_angle)
    assert in_include.pose('n::a::inertial', 'n')[:3] == pytest.approx((0.0, 0.0, -0.5), abs=1e-9)
    assert in_ros.pose('r::a::a_visual').qy == pytest.approx(math.sin(0.785), abs=1e-15)


# What <gazebo> elements hold

def test_sensor_of_a_link():
    text = SENSOR.format('<pose>1 2 3 0 0 0</pose>')
    scene = for_ros(link('a') + gazebo('<mu1>0.2</mu1>' + text, 'a'))
    assert scene.pose('r::a::s')[:3] == (1.0, 2.0, 3.0)
    assert scene.warnings == ()


@pytest.mark.parametrize(('pose', 'y'), [
    ('<pose>0.123456789 0 0 0 0 0</pose>', 0.123457),
    ('<pose>1 0 0 0 0 0 9</pose>', 1.0),
    ('<pose relative_to="a">1 3 0 0 0 0</pose>', 3.0),
])
def test_pose_of_a_sensor_on_a_lumped_link_has_six_digits_and_its_reference(included, pose, y):
    scene = included(TWO_FIXED + gazebo(SENSOR.format(pose), 'b'))
    assert scene.pose('n::a::s')[:3] == pytest.approx((6.0, y, 0.0), abs=1e-9)


def test_degrees_are_ignored_with_a_warning_where_a_fixed_joint_is_removed(included):
    text = SENSOR.format('<pose degrees="true">0 0 0 1 0 0</pose>')
    scene = included(TWO + joint('j', 'a', 'b') + gazebo(text, 'b'))
    assert scene.pose('n::a::s').qx == pytest.approx(math.sin(0.5))
    assert 'attributes of this <pose> are ignored' in scene.warnings[0].message


@pytest.mark.parametrize('number', ['x', 'inf', '1e999'])
def test_pose_that_is_not_one_is_refused_in_an_include(errors_in, number):
    text = SENSOR.format(f'<pose>{number} 0 0 0 0 0</pose>')
    (error,) = errors_in(TWO_FIXED + gazebo(text, 'b'))
    assert error.code == 'ELEMENT_INVALID'
    assert number in error.message


@pytest.mark.parametrize('end', ['\n', ''])
def test_only_what_is_wrong_in_gazebo_elements_is_left_out(end):
    other = SENSOR.format('').replace('"s"', '"t"')
    sensors = end.join([SENSOR.format(''), SENSOR.format(''), other])
    text = robot(TWO_FIXED + gazebo(sensors, 'b') + end + gazebo(other, 'a'))
    scene = load_text(text)
    assert [name for name in scene.names if name.endswith(('::s', '::t'))] == [
        'r::a::t', 'r::b::s', 'r::b::t']
    (warning,) = scene.warnings
    assert warning.code == 'DUPLICATE_NAME'
    assert warning.message.endswith('so this part of <gazebo> elements is left out')


def test_all_of_gazebo_elements_is_left_out_where_that_is_not_enough():
    wrong = SENSOR.format('\n<pose relative_to="q"/>')
    double = wrong.replace('imu', 'nose')
    scene = for_ros(TWO_FIXED + gazebo(double + '\n' + double, 'a'))
    assert not [name for name in scene.names if name.endswith('::s')]


def test_all_of_gazebo_elements_is_left_out_where_one_was_needed_by_another():
    frames = '<frame name="f"><pose>1</pose></frame>\n' + posed('frame', 'g', '', 'f')
    scene = for_ros(TWO_FIXED + gazebo(frames) + '\n' + gazebo(SENSOR.format(''), 'a'))
    assert [warning.code for warning in scene.warnings] == [
        'ELEMENT_INVALID', 'POSE_RELATIVE_TO_INVALID']
    assert scene.warnings[-1].message.endswith('so all of <gazebo> elements is left out')
    assert not [name for name in scene.names if name.endswith(('::f', '::g', '::s'))]


def test_an_error_outside_gazebo_elements_is_reported_once():
    text = robot(joined('<axis/>') + gazebo(SENSOR.format('')))
    assert only_error(text).code == 'ELEMENT_INVALID'


def test_sensor_of_a_joint():
    text = SENSOR.format('').replace('imu', 'force_torque')
    scene = for_ros(joined() + gazebo(text, 'j'))
    assert 'r::j::s' in scene.names


@pytest.mark.parametrize(('reference', 'reason'), [
    ('j', 'it removes the fixed joint "j"; <preserveFixedJoint>true</preserveFixedJoint>'),
    ('c', 'no link or joint of that name')])
def test_what_belongs_to_nothing_is_left_out_with_a_warning(included, reference, reason):
    text = TWO_FIXED + gazebo('<mu1>1</mu1>' + SENSOR.format(''), reference)
    scene = included(text)
    assert not any(name.endswith('::s') for name in scene.names)
    in_ros = for_ros(text)
    assert ('r::j::s' in in_ros.names) == (reference == 'j')
    for each, is_for_gazebo in ((scene, False), (in_ros, True)):
        (warning,) = each.warnings
        assert reason in warning.message
        assert warning.is_for_gazebo == is_for_gazebo


@pytest.mark.parametrize('text', [
    FIXED.replace('"j"', '"b"') + gazebo(SENSOR.format(''), 'b'),
    FIXED + gazebo('<preserveFixedJoint>1</preserveFixedJoint>' + SENSOR.format(''), 'j'),
])
def test_sensor_that_gazebo_keeps_causes_no_warning_about_its_joint(text):
    assert not any('removes' in each.message for each in for_ros(TWO + text).warnings)
    sources = model_from(robot(TWO + text))
    assert sources.find('.//sensor') is not None


BALL = '<joint name="k" type="ball"><parent>world</parent><child>b</child></joint>'


def test_joint_in_a_gazebo_element_joins_the_link_that_remains(included):
    scene = included(TWO_FIXED + gazebo(BALL))
    assert scene.names[scene.joints[0].child] == 'n::a'


@pytest.mark.parametrize('content', [
    BALL, '<link name="l"/>', '<model name="x"><link name="l"/></model>',
    '<include><uri>model://x</uri></include>'])
def test_gazebo_elements_change_no_tree_for_ros(content):
    scene = for_ros(TWO_FIXED + gazebo(content))
    assert names_of(scene) == names_of(for_ros(TWO_FIXED))
    (warning,) = scene.warnings
    assert 'is for Gazebo alone' in warning.message
    assert warning.is_for_gazebo


@pytest.mark.parametrize(('content', 'x'), [
    (origin('1 0 0'), 1.0),
    (gazebo('<pose>2 0 0 0 0 0</pose>'), 2.0),
    (origin('1 0 0') + gazebo('<pose>2 0 0 0 0 0</pose>'), 1.0),
    (origin('x 0 0'), 0.0), (origin('2m 0 0'), 2.0),
])
def test_pose_of_the_robot(content, x):
    assert for_ros(link('a') + content).pose('r').x == x


def test_robot_is_static_in_an_include_alone(included):
    text = link('a') + gazebo('<static>yes</static>') + gazebo('<static>no</static>', 'a')
    assert len(included(text).static_models) == 1
    assert not for_ros(text).static_models, 'in ROS its joints move'


def test_what_sdformat_does_not_define_is_reported_only_in_gazebo_elements():
    scene = for_ros(
        '<transmission name="t"/>' + link('a', '<self_collision_checking/>')
        + gazebo('<sensr name="s"/>', 'a'))
    (warning,) = scene.warnings
    assert 'did you mean <sensor>?' in warning.message
    assert warning.is_for_gazebo


# Hostile files

def test_deep_chain_is_converted():
    count = 1500
    links = ''.join(link(f'l{i}') for i in range(count + 1))
    joints = ''.join(
        joint(f'j{i}', f'l{i}', f'l{i + 1}', 'fixed', origin('1 0 0')) for i in range(count))
    assert for_ros(links + joints).pose(f'r::l{count}').x == count


# Files

def test_robot_is_merged(tmp_path):
    path = write(tmp_path, TWO_FIXED)
    path.write_text('<sdf version="1.9"><model name="m"><include merge="true"><uri>r.urdf</uri>'
                    '</include></model></sdf>')
    assert load(path).pose('m::b').x == 1.0


# Moments of inertia, which an included robot has, and which nobody needs of others

def moments_in(model):
    return [float(each.text) for each in model.iterfind('link/inertial/inertia/*')]


def test_moments_of_links():
    assert moments_in(model_from(robot(link('a')))) == [1, 1, 1, 0, 0, 0]
    assert moments_in(model_from(robot(link('a')), is_included=False)) == []


IMPOSSIBLE = link('a') + link('b').replace('izz="1"', 'izz="3"') + joint('j', 'a', 'b', '{}')


def test_impossible_moments_cause_the_same_warning_with_and_without_an_include(included):
    text = IMPOSSIBLE.format('continuous')
    (of_include,) = included(text, shapes=True).warnings
    (warning,) = for_ros(text).warnings
    assert (warning.code, warning.message) == (of_include.code, of_include.message)
    assert (warning.is_for_gazebo, of_include.is_for_gazebo) == (True, False)


def test_impossible_moments_that_possible_ones_are_added_to_cause_no_warning(included):
    text = IMPOSSIBLE.format('fixed')
    assert included(text, shapes=True).warnings == ()
    assert for_ros(text).warnings == ()


def test_moments_of_links_that_are_lumped():
    assert moments_in(model_from(robot(TWO_FIXED))) == pytest.approx(
        [2, 2.5, 2.5, 0, 0, 0], abs=1e-12)
