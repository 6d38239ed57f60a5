# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What only models, frames, sensors and materials have."""

import math

import pytest
from sdf_texts import codes_of
from sdf_texts import errors_of
from sdf_texts import fixed_joint
from sdf_texts import LINK
from sdf_texts import link_with
from sdf_texts import model_file
from sdf_texts import only_error
from sdf_texts import posed
from sdf_texts import world_file

from sdf_pose_bridge import load_text

# The implicit root cannot be named

@pytest.mark.parametrize(('text', 'code'), [
    (model_file(posed('link', 'l', '', '__root__')), 'ATTRIBUTE_INVALID'),
    (model_file(LINK + '<frame name="f" attached_to="__root__"/>'), 'ATTRIBUTE_INVALID'),
    (model_file(LINK, attributes='canonical_link="__root__"'), 'ATTRIBUTE_INVALID'),
    (model_file(LINK, attributes='placement_frame="__root__"'), 'ATTRIBUTE_INVALID'),
    (model_file(LINK + fixed_joint('j', '__root__', 'l')), 'RESERVED_NAME'),
    (model_file(LINK + fixed_joint('j', 'l', '__root__')), 'RESERVED_NAME'),
])
def test_reference_to_the_implicit_root_is_refused(text, code):
    error = errors_of(text)[0]
    assert error.code == code
    assert '"__root__"' in error.message


# Models

@pytest.mark.parametrize('value', ['maybe', '2', 'yes', '-1'])
def test_wrong_static_is_refused(value):
    error = only_error(model_file(f'<static>{value}</static>' + LINK))
    assert error.code == 'ELEMENT_INVALID'
    assert f'"{value}"' in error.message


@pytest.mark.parametrize(('value', 'is_static'), [
    ('true', True), (' 1 ', True), ('TRUE', True), ('false', False), ('0', False), ('', False),
])
def test_model_is_static(value, is_static):
    scene = load_text(model_file(f'<static>{value}</static>' + LINK))
    assert (scene.index('m') in scene.static_models) == is_static


def test_model_is_not_static_by_default():
    assert not load_text(model_file(LINK)).static_models


def test_nested_model_of_a_static_model_is_not_static():
    scene = load_text(model_file('<static>true</static><model name="n"><link name="l"/></model>'))
    assert scene.static_models == {scene.index('m')}


# Sensors

def sensor_with(content, sensor_type='custom'):
    scene = load_text(link_with(f'<sensor name="s" type="{sensor_type}">{content}</sensor>'))
    return scene.sensors[scene.index('m::l::s')]


def test_sensor_has_a_type():
    assert sensor_with('', ' imu ').type == 'imu'


@pytest.mark.parametrize(('content', 'frame_id'), [
    ('', ''),
    ('<gz_frame_id/>', ''),
    ('<gz_frame_id>a/b</gz_frame_id>', 'a/b'),
    ('<ignition_frame_id> a </ignition_frame_id>', 'a'),
    ('<ignition_frame_id>old</ignition_frame_id><gz_frame_id>new</gz_frame_id>', 'new'),
    ('<ignition_frame_id>old</ignition_frame_id><gz_frame_id/>', 'old'),
])
def test_sensor_has_a_frame_id(content, frame_id):
    assert sensor_with(content).frame_id == frame_id


@pytest.mark.parametrize(('content', 'is_camera', 'optical_frame_id'), [
    ('', False, ''),
    ('<optical_frame_id>eye</optical_frame_id>', False, ''),
    ('<camera/>', True, ''),
    ('<camera><optical_frame_id>eye</optical_frame_id></camera>', True, 'eye'),
])
def test_sensor_with_a_camera(content, is_camera, optical_frame_id):
    details = sensor_with(content)
    assert (details.is_camera, details.optical_frame_id) == (is_camera, optical_frame_id)


@pytest.mark.parametrize(('sensor_type', 'is_camera'), [
    ('camera', True), ('rgbd_camera', True), ('gpu_lidar', False)])
def test_sensor_of_the_type_of_a_camera(sensor_type, is_camera):
    assert sensor_with('', sensor_type).is_camera == is_camera


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


@pytest.mark.parametrize('content', [
    '<script><uri>u</uri><name>n</name></script>',
    '<shader type="pixel"/>',
    '<shader type="normal_map_object_space"><normal_map>m</normal_map></shader>',
])
def test_material_is_accepted(content):
    load_text(link_with(f'<visual name="v"><material>{content}</material></visual>'))


AUTO = '<inertial auto="true"/>'
UNIT_BOX = '<box><size>1 1 1</size></box>'


def collision(name, x, shape, density=''):
    density = f'<density>{density}</density>' if density else ''
    return (f'<collision name="{name}"><pose>{x} 0 0 0 0 0</pose>{density}'
            f'<geometry>{shape}</geometry></collision>')


def center_of(content):
    return load_text(link_with(content)).pose('m::l::inertial')


# What cannot be computed

@pytest.mark.parametrize('shape', [
    '<plane/>', '<empty/>', '', '<heightmap><uri>a</uri></heightmap>',
    '<box><size>1 0 1</size></box>', '<sphere><radius>-1</radius></sphere>',
    '<cylinder><radius>1</radius><length>-1</length></cylinder>',
    '<capsule><radius>0</radius><length>1</length></capsule>',
])
def test_collision_without_a_volume_is_refused(shape):
    assert codes_of(link_with(AUTO + collision('c', 1, shape))) == ['LINK_INERTIA_INVALID']


def test_collision_without_a_density_above_zero_is_refused():
    text = link_with(AUTO + collision('c', 1, UNIT_BOX, '0'))
    assert codes_of(text) == ['LINK_INERTIA_INVALID']


def test_collision_that_is_relative_to_no_frame_is_refused():
    text = link_with(
        f'{AUTO}<collision name="c"><pose relative_to="none"/><geometry>{UNIT_BOX}</geometry>'
        '</collision>')
    assert codes_of(text) == ['POSE_RELATIVE_TO_INVALID']


def test_link_without_collisions_is_refused():
    assert codes_of(link_with(AUTO)) == ['ELEMENT_MISSING']


def test_mesh_leaves_the_pose_as_written_with_a_warning():
    scene = load_text(link_with(
        '<inertial auto="true"><pose>3 0 0 0 0 0</pose></inertial>'
        + collision('c', 1, '<mesh><uri>a</uri></mesh>')))
    assert scene.pose('m::l::inertial').x == 3.0
    assert 'automatic inertial of link "l" has its pose as written' in scene.warnings[-1].message


def test_written_pose_is_ignored_with_a_warning():
    scene = load_text(link_with(
        '<inertial auto="true"><pose>3 0 0 0 0 0</pose></inertial>' + collision('c', 1, UNIT_BOX)))
    assert scene.pose('m::l::inertial').x == 1.0
    assert 'pose of an automatic inertial is ignored' in scene.warnings[0].message


# Centers of mass

@pytest.mark.parametrize(('shape', 'volume'), [
    ('<box><size>1 2 3</size></box>', 6.0),
    ('<box/>', 1.0),
    ('<capsule><radius>1</radius><length>3</length></capsule>', math.pi * (3.0 + 4.0 / 3.0)),
    ('<capsule><radius>1</radius><length>0</length></capsule>', math.pi * 4.0 / 3.0),
    ('<cylinder><radius>2</radius><length>3</length></cylinder>', 12.0 * math.pi),
    ('<ellipsoid><radii>1 2 3</radii></ellipsoid>', 8.0 * math.pi),
    ('<sphere><radius>2</radius></sphere>', 32.0 / 3.0 * math.pi),
    ('<cone><radius>2</radius><length>3</length></cone>', 4.0 * math.pi),
])
def test_mass_is_in_proportion_to_the_volume(shape, volume):
    x = center_of(AUTO + collision('a', 0, UNIT_BOX) + collision('b', 1, shape)).x
    assert x == pytest.approx(volume / (1.0 + volume), rel=1e-14)


def test_center_of_a_cone_is_a_quarter_below_its_middle():
    cone = '<cone><radius>1</radius><length>2</length></cone>'
    assert center_of(AUTO + collision('c', 0, cone)).z == -0.5


@pytest.mark.parametrize(('inertial', 'densities', 'x'), [
    (AUTO, ('', ''), 0.5),
    (AUTO, ('', '3000'), 0.75),
    ('<inertial auto="true"><density>3</density></inertial>', ('1', ''), 0.75),
    ('<inertial auto="true"><mass>7</mass></inertial>', ('', '3000'), 0.75),
])
def test_density_is_that_of_collision_inertial_or_water(inertial, densities, x):
    first, second = densities
    assert center_of(
        inertial + collision('a', 0, UNIT_BOX, first) + collision('b', 1, UNIT_BOX, second)
    ).x == pytest.approx(x)


def test_inertial_has_the_axes_of_its_link():
    scene = load_text(model_file(
        f'<link name="l"><pose degrees="true">0 0 0 0 0 90</pose>{AUTO}'
        '<collision name="c"><pose degrees="true">1 0 0 90 0 0</pose>'
        f'<geometry>{UNIT_BOX}</geometry></collision></link>'))
    pose = scene.pose('m::l::inertial', relative_to='m::l')
    assert pose == pytest.approx((1, 0, 0, 0, 0, 0, 1), abs=1e-15)


def test_collision_may_be_relative_to_another_frame():
    scene = load_text(model_file(
        '<frame name="f"><pose>0 5 0 0 0 0</pose></frame>'
        f'<link name="l">{AUTO}<collision name="c"><pose relative_to="f">1 0 0 0 0 0</pose>'
        f'<geometry>{UNIT_BOX}</geometry></collision></link>'))
    assert scene.pose('m::l::inertial')[:3] == (1, 5, 0)


def test_inertial_that_is_not_automatic_has_its_pose():
    assert center_of(
        '<inertial auto="false"><pose>3 0 0 0 0 0</pose></inertial>'
        + collision('c', 1, UNIT_BOX)).x == 3.0


# Types

@pytest.mark.parametrize('text', [
    link_with('<sensor name="s" type="eye"/>'),
    link_with('<sensor name="s" type="Camera"/>'),
    link_with('<light name="s" type="bulb"/>'),
    link_with('<particle_emitter name="s" type="sphere"/>'),
])
def test_unknown_type_is_refused(text):
    assert codes_of(text) == ['ATTRIBUTE_INVALID']


@pytest.mark.parametrize('content', [
    '<surface_model>MARS</surface_model>',
    '<world_frame_orientation>NED</world_frame_orientation>',
])
def test_unknown_spherical_coordinates_are_refused(content):
    text = world_file(f'<spherical_coordinates>{content}</spherical_coordinates>')
    assert codes_of(text) == ['ELEMENT_INVALID']
