# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The text of URDF: links with masses and shapes, limits of joints, and what is left out."""

import re

from lxml import etree
import pytest
from sdf_texts import fixed_joint, link_with, model_file, world_file, write_files

from sdf_pose_bridge import Kind, load, load_text, urdf_from_scene
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


LOOP = (f'</link><link name="k"/>{fixed_joint("i", "l", "k")}{fixed_joint("j", "l", "k")}'
        '<link name="o">')


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
    (LOOP, ('joint "m::j" closes a loop between "m::l" and "m::k"; TF is a tree, so it moves '
            'nothing there')),
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
    assert f'filename="{(tmp_path / "a.dae").as_uri()}"' in urdf.text


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
    assert [described(each) for tag in ('material', 'inertial') for each in xml.iter(tag)] == []


def test_ends_of_a_capsule_are_in_its_axes():
    capsule = '<capsule><radius>1</radius><length>4</length></capsule>'
    turned = '<pose>5 0 0 0 1.5707963267948966 0</pose>'
    xml = xml_of(link_with(part('collision', capsule, turned)))
    assert [each.get('name') for each in xml.iter('collision')] == ['v', 'v_1', 'v_2']
    places = [[float(word) for word in each.get('xyz').split()] for each in xml.iter('origin')]
    assert places == [pytest.approx(place, abs=1e-15) for place in (
        (5, 0, 0), (3, 0, 0), (7, 0, 0))]


@pytest.mark.parametrize(('length', 'element'), [
    (4, ('capsule', {'radius': '1', 'length': '4'})), (0, ('sphere', {'radius': '1'}))])
def test_capsule_of_urdf_1_2(length, element):
    capsule = f'<capsule><radius>1</radius><length>{length}</length></capsule>'
    xml = xml_of(link_with(part('collision', capsule)), has_capsules=True)
    assert xml.get('version') == '1.2'
    assert described(xml.find('.//geometry')) == [element]


@pytest.mark.parametrize(('material', 'rgba'), [
    ('<material><diffuse>1 .5 0 1</diffuse></material>', '1 0.5 0 1'),
    ('<material><diffuse>1 .5 0 1</diffuse></material><transparency>.75</transparency>',
     '1 0.5 0 0.25'),
    ('', '0.7 0.7 0.7 1'),
])
def test_visual_has_a_color_unless_its_mesh_has_materials(material, rgba):
    mesh = part('visual', '<mesh><uri>package://p/a.dae</uri></mesh>')
    xml = xml_of(link_with(part('visual', BOX, material) + mesh.replace('"v"', '"w"')))
    assert [described(each) for each in xml.iter('material')] == [[('color', {'rgba': rgba})]]


def test_inertial():
    xml = xml_of(link_with(
        '<inertial><pose>1 2 3 0 0 0</pose><mass>4</mass><inertia><ixx>1.1</ixx><ixy>.1</ixy>'
        '<ixz>.2</ixz><iyy>1.2</iyy><iyz>.3</iyz><izz>1.3</izz></inertia></inertial>'))
    assert described(xml.find('.//inertial')) == [
        ('origin', {'xyz': '1 2 3', 'rpy': '0 0 0'}), ('mass', {'value': '4'}),
        ('inertia', {'ixx': '1.1', 'ixy': '0.1', 'ixz': '0.2', 'iyy': '1.2', 'iyz': '0.3',
                     'izz': '1.3'})]
    assert [*xml.find('.//inertia').attrib] == ['ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz']


# Joints

@pytest.mark.parametrize(('joint_type', 'content', 'limit'), [
    ('revolute', '', None),
    ('revolute', '<limit><effort>3</effort></limit>', {'effort': '3', 'velocity': '1e+16'}),
    ('revolute', '<limit><velocity>3</velocity></limit>', {'effort': '1e+16', 'velocity': '3'}),
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


@pytest.mark.parametrize('dynamics', [
    {'damping': '0.1', 'friction': '0'}, {'damping': '0', 'friction': '0.1'}])
def test_dynamics(dynamics):
    content = ''.join(f'<{tag}>{value}</{tag}>' for tag, value in dynamics.items())
    assert joint_of(f'<dynamics>{content}</dynamics>')['dynamics'] == dynamics
    assert joint_of('').keys() == {'parent', 'child', 'axis'}


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
        '<link name="b"><pose relative_to="a">0.2 0 0 0 0 -1e-17</pose></link>')
    assert 'xyz="0.2 0 0" rpy="0 0 0"' in str(urdf_of(text))


def test_names_are_escaped():
    urdf = urdf_of('<sdf version="1.9"><model name="&lt;m&quot;"><link name="a&amp;b"/></model>'
                   '</sdf>', 'a--b-.sdf')
    xml = etree.fromstring(urdf.text.encode())
    assert (xml.get('name'), xml.find('link').get('name')) == ('<m"', 'a&b')
    assert 'from a- -b-.sdf' in xml[0].text


def test_elements_of_urdf_are_passed_on():
    control = '<ros2_control name="c">\n  <hardware> a\nb </hardware>\n</ros2_control>'
    nested = '<model name="n"><link name="l"/><gazebo reference="l"/></model>'
    urdf = urdf_of(world_file(
        f'<model name="m">{TWO_LINKS}{control}{nested}</model><model name="o">{nested}</model>'),
        model='m')
    assert f'\n{control}\n<gazebo reference="l"/>\n</robot>\n' in urdf.text


def test_files_that_links_come_from_are_named(tmp_path):
    write_files(tmp_path, outer=model_file(
        f'<include><uri>inner-</uri><name>n</name></include>{TWO_LINKS}'))
    (tmp_path / 'inner-').write_text(model_file('<link name="l"/><link name="k"/>'))
    scene = load(tmp_path / 'outer.sdf', shapes=True)
    text = urdf_from_scene(scene).text
    assert f'sdf_pose urdf from {tmp_path}/outer.sdf' in text.splitlines()[2]
    assert re.findall('<!-- From (.*) -->\n  <link name="(.*)"/>', text) == [
        (f'{tmp_path}/inner-', 'n/l'), (f'{tmp_path}/outer.sdf', 'b')]


def test_links_have_the_names_and_kinds_of_the_options():
    text = model_file('<static>1</static><link name="l"><sensor name="s" type="camera"/></link>')
    assert 'link name="l/s_optical"' in urdf_of(text).text
    xml = xml_of(text, kinds={Kind.SENSOR}, frame_names='scoped', frame_separator='.',
                 optical_frames=False, root_frame='map')
    assert [each.get('name') for each in xml.iter('link')] == ['map', 'm.l', 'm.l.s']
