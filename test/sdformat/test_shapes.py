# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Shapes of visuals and collisions, as a load on request gives them, and surfaces."""

import math

import numpy as np
import pytest
from sdf_texts import codes_of, errors_of_file, link_with, model_file, world_file, write_files

from sdf_pose_bridge import load_text
from sdf_pose_bridge.sdformat.shapes import Shape

BOX = '<geometry><box><size>1 2 3</size></box></geometry>'


def shape_of(content, tag='visual'):
    """Return the shape of a visual that holds something; None without one."""
    scene = load_text(link_with(f'<{tag} name="v">{content}</{tag}>'), shapes=True)
    return next(iter(scene.shapes.values()), None)


def shape_in(geometry):
    return shape_of(f'<geometry>{geometry}</geometry>')


def test_shapes_are_not_read_unless_they_are_asked_for():
    assert load_text(link_with(f'<visual name="v">{BOX}</visual>')).shapes == {}


def test_shape_belongs_to_its_visual():
    scene = load_text(
        link_with(f'<visual name="a"><geometry><empty/></geometry></visual>'
                  f'<visual name="b">{BOX}</visual>'), shapes=True)
    (element,) = scene.shapes
    assert scene.names[element].endswith('::b')


def test_collision_has_a_shape():
    assert shape_of(BOX, 'collision').type == 'box'


@pytest.mark.parametrize('geometry', ['', '<empty/>'])
def test_geometry_without_a_shape(geometry):
    assert shape_in(geometry) is None


@pytest.mark.parametrize(('geometry', 'kind', 'sizes_m'), [
    ('<box><size>1 2 3</size></box>', 'box', (1, 2, 3)),
    ('<capsule><radius>2</radius><length>3</length></capsule>', 'capsule', (2, 3)),
    ('<cone><radius>2</radius><length>3</length></cone>', 'cone', (2, 3)),
    ('<cylinder><radius>2</radius><length>3</length></cylinder>', 'cylinder', (2, 3)),
    ('<ellipsoid><radii>1 2 3</radii></ellipsoid>', 'ellipsoid', (1, 2, 3)),
    ('<sphere><radius>2</radius></sphere>', 'sphere', (2,)),
    ('<plane><normal>1 0 0</normal><size>4 5</size></plane>', 'plane', (4, 5)),
    ('<heightmap><uri>h.png</uri></heightmap>', 'heightmap', ()),
])
def test_shape_has_sizes(geometry, kind, sizes_m):
    shape = shape_in(geometry)
    assert (shape.type, shape.sizes_m) == (kind, sizes_m)


def test_mesh_has_a_uri_a_part_and_a_scale():
    shape = shape_in('<mesh><uri> model://arm/a b.dae </uri><scale>1 2 -3</scale>'
                     '<submesh><name>hand</name></submesh></mesh>')
    assert shape[:3] == ('mesh', (), (0, 0, 1))
    assert shape[3:6] == ('model://arm/a b.dae', 'hand', (1, 2, -3))


@pytest.mark.parametrize(('center', 'is_centered'), [
    ('', False), ('<center>true</center>', True), ('<center>0</center>', False)])
def test_part_of_a_mesh_may_be_centered(center, is_centered):
    shape = shape_in(
        f'<mesh><uri>a.dae</uri><submesh><name>hand</name>{center}</submesh></mesh>')
    assert shape.is_centered is is_centered


@pytest.mark.parametrize(('material', 'rgba'), [
    ('', None),
    ('<material/>', None),
    ('<material><diffuse>nan 0 0 1</diffuse></material>', None),
    ('<material><ambient>.1 .2 .3 1</ambient></material>', (0.1, 0.2, 0.3, 1)),
    ('<material><ambient>0 0 0 1</ambient><diffuse>.1 .2 .3 .4</diffuse></material>',
     (0.1, 0.2, 0.3, 0.4)),
    ('<material><diffuse>.1 .2 .3</diffuse></material>', (0.1, 0.2, 0.3, 1)),
])
def test_color_is_that_of_the_material(material, rgba):
    assert shape_of(f'{BOX}{material}').rgba == rgba


@pytest.mark.parametrize(('transparency', 'opacity', 'is_visible'), [
    ('', 1, True), ('.75', 0.25, True), ('1', 0, False), ('7', 1, True), ('-1', 1, True),
])
def test_transparency_counts_with_and_without_a_material(transparency, opacity, is_visible):
    element = f'{BOX}<transparency>{transparency}</transparency>' if transparency else BOX
    material = '<material><diffuse>1 0 0 .5</diffuse></material>'
    for shape in (shape_of(element), shape_of(f'{element}{material}')):
        assert (shape.opacity, shape.is_visible) == (opacity, is_visible)
    assert shape_of(element).rgba_or((0, 0, 1, 1)) == (0, 0, 1, opacity)
    assert shape_of(f'{element}{material}').rgba_or((0, 0, 1, 1)) == (1, 0, 0, 0.5 * opacity)


def test_material_without_alpha_is_not_visible():
    shape = shape_of(f'{BOX}<material><diffuse>1 0 0 0</diffuse></material>')
    assert not shape.is_visible


@pytest.mark.parametrize(('sizes_m', 'has_extent'), [
    ((1.0, 1.0), True), ((1.0, 0.0), False), ((1.0, -1.0), False), ((math.nan, 1.0), False),
    ((math.inf, 1.0), False),
])
def test_shape_has_an_extent_if_its_sizes_are_positive(sizes_m, has_extent):
    shape = Shape('cylinder', sizes_m, (0, 0, 1), '', '', (1, 1, 1), None)
    assert shape.has_extent is has_extent
    assert shape._replace(normal=(0, 0, 0)).has_extent is False


# Materials

@pytest.mark.parametrize(('content', 'code'), [
    ('<script><name>n</name></script>', 'ELEMENT_INVALID'),
    ('<script><uri/><name>n</name></script>', 'ELEMENT_INVALID'),
    ('<script><uri>__default__</uri><name>n</name></script>', 'ELEMENT_INVALID'),
    ('<script><uri>u</uri></script>', 'ELEMENT_MISSING'),
    ('<shader type="round"/>', 'ELEMENT_INVALID'),
    ('<shader type="normal_map_object_space"/>', 'ELEMENT_MISSING'),
])
def test_wrong_material_is_refused(content, code):
    visual = f'<visual name="v"><material>{content}</material></visual>'
    assert codes_of(link_with(visual)) == [code]


# libsdformat reports all materials before all references of joints.
@pytest.mark.parametrize('order', [['ELEMENT_INVALID', 'JOINT_PARENT_LINK_INVALID'],
                                   ['JOINT_PARENT_LINK_INVALID', 'ELEMENT_INVALID']])
def test_errors_of_materials_and_joints_are_in_the_order_of_their_lines(order):
    parts = {
        'ELEMENT_INVALID': '<link name="l"><visual name="v"><material><script><name>n</name>'
                           '</script></material></visual></link>',
        'JOINT_PARENT_LINK_INVALID': '<joint name="j" type="fixed"><parent>none</parent>'
                                     '<child>l</child></joint>'}
    assert codes_of(model_file('\n'.join(parts[code] for code in order))) == order


def test_errors_of_an_included_file_follow_those_of_the_file(tmp_path):
    link = '<link name="l"><visual name="v"><material><script/></material></visual></link>'
    write_files(tmp_path, part=model_file('', version='1.99'), main=world_file(
        f'<include><uri>part.sdf</uri></include>\n<model name="m">{link}</model>'))
    assert [error.code for error in errors_of_file(tmp_path / 'main.sdf')] == [
        'ELEMENT_INVALID', 'ELEMENT_MISSING', 'CONVERSION_ERROR']


def test_submesh_without_a_name_is_refused():
    visual = '<visual name="v"><geometry><mesh><uri>u</uri>{}</mesh></geometry></visual>'
    assert codes_of(link_with(visual.format('<submesh/>'))) == ['ELEMENT_MISSING']
    load_text(link_with(visual.format('<submesh><name>n</name></submesh>')))


@pytest.mark.parametrize('place', [
    '<road name="r">{}</road>',
    '<population name="p">{}</population>',
    '<state world_name="w"><insertions>{}</insertions></state>',
])
def test_material_that_libsdformat_does_not_read_is_not_checked(place):
    material = '<material><script/><shader type="round"/></material>'
    model = f'<model name="m"><link name="l"><visual name="v">{material}</visual></link></model>'
    content = place.format(material if 'road' in place else model)
    load_text(f'<sdf version="1.9"><world name="w">{content}</world></sdf>')


@pytest.mark.parametrize('content', [
    '<script><uri>u</uri><name>n</name></script>',
    '<shader type="pixel"/>',
    '<shader type="normal_map_object_space"><normal_map>m</normal_map></shader>',
])
def test_material_is_accepted(content):
    load_text(link_with(f'<visual name="v"><material>{content}</material></visual>'))


# Surfaces

@pytest.mark.parametrize('normal', [(0, 0, 1), (0, 0, -2), (1, 0, 0), (1, -2, 3)])
def test_plane_has_its_normal(normal):
    shape = Shape('plane', (2.0, 4.0), normal, '', '', (1.0, 1.0, 1.0), None)
    points, faces = shape.surface
    first, second, third = np.moveaxis(points[faces], 1, 0)
    areas = 0.5 * np.cross(second - first, third - first)
    assert areas.sum(axis=0) == pytest.approx(8.0 * np.array(normal) / np.linalg.norm(normal))


@pytest.mark.parametrize(('tag', 'normal'), [('plane', (1, 0, 0)), ('box', (0, 0, 1))])
def test_only_a_plane_has_a_normal(tag, normal):
    assert shape_in(f'<{tag}><normal>1 0 0</normal></{tag}>').normal == normal
