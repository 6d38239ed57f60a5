# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The text of URDF: links with masses and shapes, limits of joints, and what is left out."""

from lxml import etree
import pytest
from sdf_texts import link_with, model_file, write_files

import sdf_pose_bridge
from sdf_pose_bridge import load, load_text, urdf_from_scene
from sdf_pose_bridge.sdformat.shape_types import SHAPE_TYPES

BOX = '<box><size>1 2 3</size></box>'
TWO_LINKS = '<link name="a"/><link name="b"/>'


def urdf_of(text, name='robot.sdf', **options):
    return urdf_from_scene(load_text(text, name, shapes=True), **options)


def xml_of(text, **options):
    """Return the robot; nothing may be left out of it."""
    urdf = urdf_of(text, **options)
    assert urdf.warnings == ()
    return etree.fromstring(urdf.text.encode())


def part(tag, geometry, extra=''):
    return f'<{tag} name="v">{extra}<geometry>{geometry}</geometry></{tag}>'


def described(xml):
    """Return the tags and attributes in an element."""
    return [(each.tag, dict(each.attrib)) for each in xml.iterdescendants()]


def joint_of(content, joint_type='revolute'):
    joint = (f'<joint name="j" type="{joint_type}"><parent>a</parent><child>b</child>'
             f'<axis><xyz>0 0 1</xyz>{content}</axis></joint>')
    xml = xml_of(model_file(TWO_LINKS + joint, version='1.11')).find('joint[@name="j"]')
    return {each.tag: dict(each.attrib) for each in xml}


# What is refused or left out

def test_a_path_that_is_not_unicode_is_escaped():
    assert r'from \udcff.sdf.' in urdf_of(model_file(TWO_LINKS), '\udcff.sdf').text


def test_scene_without_shapes_is_refused():
    with pytest.raises(ValueError, match='shapes=True'):
        urdf_from_scene(load_text(link_with('')))


@pytest.mark.parametrize(('content', 'reason'), [
    (part('visual', '<mesh><uri>none.stl</uri></mesh>'),
     'the visual "m::l::v" is left out: the mesh "none.stl" is not found'),
    (part('collision', '<cone/>'), 'the collision "m::l::v" is left out: URDF has no cone'),
    (part('visual', '<plane/>'), 'the visual "m::l::v" is left out: URDF has no plane'),
    (part('visual', '<ellipsoid><radii>1 1 2</radii></ellipsoid>'),
     'the visual "m::l::v" is left out: URDF has no ellipsoid'),
    (part('visual', '<sphere><radius>0</radius></sphere>'),
     'the visual "m::l::v" is left out: its sizes are not positive'),
    (part('visual', '<polyline><point>0 0</point><height>1</height></polyline>'),
     'the visual "m::l::v" is left out: a polyline is not supported'),
    ('<inertial><mass>-1</mass></inertial>',
     'the inertial "m::l::inertial" is left out: no body can have its moments'),
])
def test_what_cannot_be_said_is_left_out_with_a_warning(content, reason):
    urdf = urdf_of(link_with(f'\n{content}'))
    (warning,) = urdf.warnings
    assert str(warning) == f'robot.sdf:2: WARNING: {reason}'
    assert '<link name="l"/>' in urdf.text


@pytest.mark.parametrize('name', sorted(SHAPE_TYPES))
def test_every_type_of_shape_is_written_or_warned_of(name):
    urdf = urdf_of(link_with(part('visual', f'<{name}/>')))
    assert ('<geometry>' in urdf.text) is not bool(urdf.warnings)


def test_part_of_a_mesh_cannot_be_named(tmp_path):
    (tmp_path / 'a.dae').touch()
    mesh = '<mesh><uri>a.dae</uri><submesh><name>hand</name></submesh></mesh>'
    urdf = urdf_of(link_with(part('visual', mesh)), str(tmp_path / 'robot.sdf'))
    assert 'all of the mesh "a.dae" is meant in URDF instead of its part "hand"' in str(
        urdf.warnings[0])
    assert f'filename="file://{tmp_path}/a.dae"' in urdf.text


# Links

@pytest.mark.parametrize(('geometry', 'elements'), [
    (BOX, [('box', {'size': '1 2 3'})]),
    ('<sphere><radius>2</radius></sphere>', [('sphere', {'radius': '2'})]),
    ('<ellipsoid><radii>2 2 2</radii></ellipsoid>', [('sphere', {'radius': '2'})]),
    ('<cylinder><radius>2</radius><length>5</length></cylinder>',
     [('cylinder', {'radius': '2', 'length': '5'})]),
    ('<capsule><radius>2</radius><length>5</length></capsule>', [
        ('cylinder', {'radius': '2', 'length': '5'}),
        ('sphere', {'radius': '2'}), ('sphere', {'radius': '2'})]),
    ('<mesh><uri>package://p/a.stl</uri></mesh>', [('mesh', {'filename': 'package://p/a.stl'})]),
    ('<mesh><uri>package://p/a.stl</uri><scale>1 2 -3</scale></mesh>',
     [('mesh', {'filename': 'package://p/a.stl', 'scale': '1 2 -3'})]),
])
def test_shapes(geometry, elements):
    xml = xml_of(link_with(part('collision', geometry)))
    assert [described(each)[0] for each in xml.iter('geometry')] == elements


def test_ends_of_a_capsule_are_in_its_axes():
    capsule = '<capsule><radius>1</radius><length>4</length></capsule>'
    turned = '<pose>5 0 0 0 1.5707963267948966 0</pose>'
    xml = xml_of(link_with(part('collision', capsule, turned)))
    assert [each.get('name') for each in xml.iter('collision')] == ['v', 'v_1', 'v_2']
    places = [[float(word) for word in each.get('xyz').split()] for each in xml.iter('origin')]
    assert places == [pytest.approx(place, abs=1e-15) for place in (
        (5, 0, 0), (3, 0, 0), (7, 0, 0))]


def test_capsule_of_urdf_1_2():
    capsule = '<capsule><radius>1</radius><length>4</length></capsule>'
    xml = xml_of(link_with(part('collision', capsule)), has_capsules=True)
    assert xml.get('version') == '1.2'
    assert described(xml.find('.//geometry')) == [('capsule', {'radius': '1', 'length': '4'})]


@pytest.mark.parametrize(('material', 'rgba'), [
    ('<material><diffuse>1 .5 0 1</diffuse></material>', '1 0.5 0 1'),
    ('<material><diffuse>1 .5 0 1</diffuse></material><transparency>.75</transparency>',
     '1 0.5 0 0.25'),
    ('', '0.7 0.7 0.7 1'),
])
def test_visual_has_a_color(material, rgba):
    xml = xml_of(link_with(part('visual', BOX, material)))
    assert described(xml.find('.//material')) == [('color', {'rgba': rgba})]


def test_mesh_has_its_own_materials():
    xml = xml_of(link_with(part('visual', '<mesh><uri>package://p/a.dae</uri></mesh>')))
    assert xml.find('.//material') is None


def test_inertial():
    xml = xml_of(link_with(
        '<inertial><pose>1 2 3 0 0 0</pose><mass>4</mass><inertia><ixx>1.1</ixx><ixy>.1</ixy>'
        '<ixz>.2</ixz><iyy>1.2</iyy><iyz>.3</iyz><izz>1.3</izz></inertia></inertial>'))
    assert described(xml.find('.//inertial')) == [
        ('origin', {'xyz': '1 2 3', 'rpy': '0 0 0'}), ('mass', {'value': '4'}),
        ('inertia', {'ixx': '1.1', 'ixy': '0.1', 'ixz': '0.2', 'iyy': '1.2', 'iyz': '0.3',
                     'izz': '1.3'})]


def test_link_without_an_inertial_has_none():
    assert xml_of(link_with(part('collision', BOX))).find('.//inertial') is None


def test_automatic_inertial():
    density = '<density>2</density>'
    xml = xml_of(link_with(f'<inertial auto="true"/>{part("collision", BOX, density)}'))
    assert xml.find('.//mass').get('value') == '12'


# Joints

@pytest.mark.parametrize(('joint_type', 'content', 'limit'), [
    ('revolute', '', None),
    ('revolute', '<limit><effort>3</effort></limit>', {'effort': '3', 'velocity': '1e+16'}),
    ('revolute', '<limit><lower>-1</lower></limit>',
     {'lower': '-1', 'upper': '1e+16', 'effort': '1e+16', 'velocity': '1e+16'}),
    ('prismatic', '',
     {'lower': '-1e+16', 'upper': '1e+16', 'effort': '1e+16', 'velocity': '1e+16'}),
    ('prismatic', ('<limit><lower>-.1</lower><upper>.3</upper><effort>-1</effort>'
                   '<velocity>0</velocity></limit>'),
     {'lower': '-0.1', 'upper': '0.3', 'effort': '1e+16', 'velocity': '0'}),
])
def test_limits(joint_type, content, limit):
    assert joint_of(content, joint_type).get('limit') == limit


def test_dynamics():
    content = '<dynamics><damping>.1</damping></dynamics>'
    assert joint_of(content)['dynamics'] == {'damping': '0.1', 'friction': '0'}
    assert 'dynamics' not in joint_of('')


def test_mimic():
    xml = xml_of(model_file(
        TWO_LINKS + '<link name="c"/>'
        '<joint name="j" type="prismatic"><parent>a</parent><child>b</child><axis>'
        '<xyz>1 0 0</xyz></axis></joint>'
        '<joint name="k" type="prismatic"><parent>b</parent><child>c</child><axis>'
        '<xyz>1 0 0</xyz><mimic joint="j"><multiplier>-1</multiplier><offset>.5</offset></mimic>'
        '</axis></joint>', version='1.11'))
    assert dict(xml.find('.//mimic').attrib) == {
        'joint': 'j', 'multiplier': '-1', 'offset': '0.5'}


# The text

def test_numbers_have_no_more_digits_than_say_the_same():
    text = model_file(
        '<link name="a"><pose>0.1 -0.0 0 0 0 0</pose></link>'
        '<link name="b"><pose relative_to="a">0.2 0 0 0 0 1e-17</pose></link>')
    assert 'xyz="0.2 0 0" rpy="0 0 0"' in urdf_of(text).text


def test_text_is_the_same_each_time():
    text = model_file(TWO_LINKS + '<frame name="f"/><ros2_control name="c"/>')
    assert urdf_of(text) == urdf_of(text)
    assert str(urdf_of(text)) == urdf_of(text).text


def test_names_are_escaped():
    urdf = urdf_of('<sdf version="1.9"><model name="&lt;m&quot;"><link name="a&amp;b"/></model>'
                   '</sdf>', 'a--b-.sdf')
    xml = etree.fromstring(urdf.text.encode())
    assert (xml.get('name'), xml.find('link').get('name')) == ('<m"', 'a&b')
    assert 'from a- -b-.sdf' in xml[0].text


def test_elements_of_urdf_are_passed_on():
    control = '<ros2_control name="c">\n  <hardware> a\nb </hardware>\n</ros2_control>'
    urdf = urdf_of(model_file(
        f'{TWO_LINKS}{control}<model name="n"><link name="l"/><gazebo reference="l"/></model>'))
    assert f'\n{control}\n<gazebo reference="l"/>\n</robot>\n' in urdf.text


def test_files_that_links_come_from_are_named(tmp_path):
    write_files(tmp_path, outer=model_file(
        f'{TWO_LINKS}<include><uri>inner.sdf</uri><name>n</name></include>'),
        inner=model_file('<link name="l"/>'))
    scene = load(tmp_path / 'outer.sdf', shapes=True)
    lines = urdf_from_scene(scene).text.splitlines()
    assert f'sdf_pose urdf from {tmp_path}/outer.sdf' in lines[2]
    assert lines[lines.index('  <link name="n/l"/>') - 1] == (
        f'  <!-- From {tmp_path}/inner.sdf -->')


def test_camera_has_an_optical_frame():
    text = link_with('<sensor name="s" type="camera"/>')
    assert 'link name="l/s_optical"' in urdf_of(text).text
    assert 'optical' not in urdf_of(text, optical_frames=False).text


def test_function_is_in_the_package():
    assert sdf_pose_bridge.urdf_from_scene is urdf_from_scene
