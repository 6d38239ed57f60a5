# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Masses and moments of inertia, and automatic ones with the centers of mass of collisions."""

import math

import numpy as np
import pytest
from sdf_texts import codes_of, link_with, model_file

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st

from sdf_pose_bridge import load_text
from sdf_pose_bridge.sdformat.inertials import Inertial, matrix_from_moments, moments_from_matrix

AUTO = '<inertial auto="true"/>'
UNIT_BOX = '<box><size>1 1 1</size></box>'


def collision(name, x, shape, density=''):
    density = f'<density>{density}</density>' if density else ''
    return (f'<collision name="{name}"><pose>{x} 0 0 0 0 0</pose>{density}'
            f'<geometry>{shape}</geometry></collision>')


def center_of(content):
    return load_text(link_with(content)).pose('m::l::inertial')


def inertial_of(content):
    scene = load_text(link_with(content), shapes=True)
    return scene.inertials[scene.index('m::l::inertial')]


def inertia(*moments, mass='2'):
    values = zip(('ixx', 'iyy', 'izz', 'ixy', 'ixz', 'iyz'), moments, strict=True)
    content = ''.join(f'<{tag}>{value}</{tag}>' for tag, value in values)
    return f'<inertial><mass>{mass}</mass><inertia>{content}</inertia></inertial>'


# What libsdformat refuses, although no pose depends on it

@pytest.mark.parametrize('content', [
    inertia(1, 1, 1, 0, 0, 0, mass=-1),
    inertia(1, 1, 3, 0, 0, 0),
    inertia(-1, 1, 1, 0, 0, 0),
    inertia(1, 1, 1, 0.9, 0, 0),
    inertia('nan', 1, 1, 0, 0, 0),
    inertia('inf', 1, 1, 0, 0, 0),
    inertia(1, 1, 1, '1e200', 0, 0),
    # As libsdformat rounds, a minor and a determinant are below zero.
    inertia(289, 2819.609999999999, 3108.609999999999, 902.6999999999999, 0, 0),
    inertia(8.5, 11.7, 4, -1.2, 5.4, 1.8),
])
def test_moments_that_no_body_can_have_are_a_warning(content):
    scene = load_text(link_with(f'\n{content}'), 'm.sdf', shapes=True)
    (warning,) = scene.warnings
    assert (warning.code, warning.place.line) == ('LINK_INERTIA_INVALID', 2)
    assert 'moments of inertia of link "l"' in warning.message


@pytest.mark.parametrize('content', [
    inertia(1, 1, 2, 0, 0, 0),  # a plate
    inertia(0, 0, 0, 0, 0, 0),  # a point
    inertia(0, 0, 0, 0, 0, 0, mass=0),
    inertia(0.1, 0.2, 0.1 + 0.2, 0, 0, 0),
    inertia(2, 2, 2, 0.1, -0.1, 0.1),
])
def test_moments_of_bodies_give_no_warning(content):
    assert load_text(link_with(content), shapes=True).warnings == ()


# Rounding of the determinant grows with the cube of the moments, and gz-math's tolerance does not.
@given(st.lists(st.tuples(*[st.floats(-0.4, 0.4)] * 3), min_size=1, max_size=2))
def test_moments_of_points_are_valid(points):
    points = np.array(points)
    matrix = np.eye(3) * (points ** 2).sum() - points.T @ points
    assert Inertial(1.0, moments_from_matrix(matrix)).is_valid


@given(st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6))
def test_validity_is_that_of_the_principal_moments(moments):
    smallest, middle, largest = np.linalg.eigvalsh(matrix_from_moments(moments))
    margin = min(smallest, smallest + middle - largest)
    if abs(margin) > 1e-9:
        assert Inertial(1.0, tuple(moments)).is_valid is bool(margin > 0.0)


# What is written

@pytest.mark.parametrize(('content', 'mass_kg', 'moments'), [
    ('<inertial/>', 1, (1, 1, 1, 0, 0, 0)),
    ('<inertial><mass>3</mass></inertial>', 3, (1, 1, 1, 0, 0, 0)),
    ('<inertial><inertia><iyy>1.5</iyy><ixz>.1</ixz></inertia></inertial>',
     1, (1, 1.5, 1, 0, 0.1, 0)),
    (inertia(1, 1.1, 1.2, 0.1, 0.2, 0.3), 2, (1, 1.1, 1.2, 0.1, 0.2, 0.3)),
    ('<inertial><mass/></inertial>', 1, (1, 1, 1, 0, 0, 0)),
    (inertia(1, '<!-- kg m2 -->1.5', 1, 0, 0, 0), 2, (1, 1.5, 1, 0, 0, 0)),
])
def test_inertial_has_mass_and_moments(content, mass_kg, moments):
    assert inertial_of(content) == (mass_kg, moments)


@pytest.mark.parametrize('mass', [
    '2</mass><mass>3', '2<!-- a comment -->', '2 kg', '2_0'])
def test_first_number_of_the_first_element_counts(mass):
    assert inertial_of(inertia(1, 1, 1, 0, 0, 0, mass=mass)).mass_kg == 2.0


def test_elements_of_other_places_are_not_read():
    other = '<inertia><mass>7</mass></inertia><user:mass>8</user:mass><ixx>9</ixx>'
    assert inertial_of(f'<inertial>{other}</inertial>') == (1, (1, 1, 1, 0, 0, 0))


# Automatic ones that cannot be computed

REFUSED = {
    'LINK_INERTIA_INVALID': [collision('c', 1, *each) for each in (
        # Shapes without a volume.
        ('<plane/>',), ('<empty/>',), ('',), ('<heightmap><uri>a</uri></heightmap>',),
        ('<box><size>1 0 1</size></box>',), ('<sphere><radius>-1</radius></sphere>',),
        ('<cylinder><radius>1</radius><length>-1</length></cylinder>',),
        ('<capsule><radius>0</radius><length>1</length></capsule>',),
        # Densities.
        (UNIT_BOX, '0'), ('<sphere/>', '0'), ('<cylinder/>', '0'), ('<cone/>', '0'),
        ('<ellipsoid/>', '-1'), ('<capsule/>', '-1'),
    )],
    'POSE_RELATIVE_TO_INVALID': [
        collision('c', 1, UNIT_BOX).replace('<pose>', '<pose relative_to="none">')],
    'ELEMENT_MISSING': [''],
}


@pytest.mark.parametrize(('code', 'content'), [
    (code, content) for code, contents in REFUSED.items() for content in contents])
def test_automatic_inertial_that_cannot_be_computed_is_refused(code, content):
    assert codes_of(link_with(AUTO + content)) == [code]


def test_automatic_inertial_in_an_actor_needs_no_collisions():
    actor = f'<actor name="a"><script/><link name="l">{AUTO}</link></actor>'
    load_text(f'<sdf version="1.9">{actor}</sdf>')


@pytest.mark.parametrize(('shape', 'x', 'words'), [
    (UNIT_BOX, 1.0, 'pose of an automatic inertial is ignored'),
    ('<mesh><uri>a</uri></mesh>', 3.0, 'automatic inertial of link "l" has its pose as written'),
])
def test_written_pose_is_ignored_unless_there_is_a_mesh(shape, x, words):
    scene = load_text(link_with(
        '<inertial auto="true"><pose>3 0 0 0 0 1</pose></inertial>' + collision('c', 1, shape)
        + collision('d', 1, UNIT_BOX)))
    pose = scene.pose('m::l::inertial')
    assert (pose.x, pose.qz > 0.0) == (x, 'mesh' in shape)
    assert words in scene.warnings[-1].message
    assert bool(scene.inertials) is ('mesh' not in shape)


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
    cone = collision('c', 0, '<cone><radius>1</radius><length>2</length></cone>')
    assert center_of(AUTO + cone.replace('0 0</pose>', '0.5 0</pose>'))[:3] == pytest.approx(
        (-0.5 * math.sin(0.5), 0.0, -0.5 * math.cos(0.5)))


@pytest.mark.parametrize(('inertial', 'densities', 'x'), [
    (AUTO, ('', ''), 0.5),
    (AUTO, ('', '3000'), 0.75),
    ('<inertial auto="true"><density>3</density></inertial>', ('1', ''), 0.75),
    ('<inertial auto="true"><density>3000</density></inertial>', ('', ' '), 0.25),
    ('<inertial auto="true"><mass>7</mass></inertial>', ('', '3000'), 0.75),
    ('<inertial auto="false"><pose>3 0 0 0 0 0</pose></inertial>', ('', ''), 3.0),
])
def test_density_is_that_of_collision_inertial_or_water(inertial, densities, x):
    first, second = densities
    assert center_of(
        inertial + collision('a', 0, UNIT_BOX, first) + collision('b', 1, UNIT_BOX, second)
    ).x == pytest.approx(x)


@pytest.mark.parametrize('shape', ['<capsule/>', '<ellipsoid/>'])
def test_capsule_or_ellipsoid_may_have_the_density_zero(shape):
    massless = collision('c', 1, shape, '0')
    inertial = inertial_of(AUTO + massless)
    assert (inertial.mass_kg, inertial.moments_kg_m2) == (0.0, (0.0,) * 6)
    assert center_of(f'<inertial auto="true"><mass>2</mass></inertial>{massless}').x == 0.0
    assert center_of(AUTO + massless + collision('d', 5, UNIT_BOX)).x == 5.0


def test_collision_may_be_relative_to_another_frame():
    scene = load_text(model_file(
        '<frame name="f"><pose>0 5 0 0 0 0</pose></frame>'
        f'<link name="l">{AUTO}<collision name="c"><pose relative_to="f">1 0 0 0 0 0</pose>'
        f'<geometry>{UNIT_BOX}</geometry></collision></link>'))
    assert scene.pose('m::l::inertial')[:3] == (1, 5, 0)


# Moments of automatic ones

def test_boxes_side_by_side_are_one_box_in_the_axes_of_the_link():
    halves = ''.join(
        f'<collision name="{xy}"><pose degrees="true">{xy} 0 0 0 45</pose>'
        f'<density>12</density><geometry>{UNIT_BOX}</geometry></collision>'
        for xy in ('0.35355339059 1', '1.06066017178 0.29289321881'))
    scene = load_text(model_file(
        f'<link name="l"><pose degrees="true">0 0 0 10 20 30</pose>{AUTO}{halves}</link>'))
    (inertial,) = scene.inertials.values()
    # Those of a box of two cubes are 10, 4 and 10.
    assert inertial.moments_kg_m2 == pytest.approx((7, 7, 10, 3, 0, 0), abs=1e-9)
    pose = scene.pose('m::l::inertial', relative_to='m::l')
    assert pose[2:] == pytest.approx((0, 0, 0, 0, 1), abs=1e-15)


@pytest.mark.parametrize(('mass', 'mass_kg'), [
    ('', 12.0), ('<mass>24</mass>', 24.0), ('<mass/>', 1.0)])
def test_given_mass_scales_the_moments(mass, mass_kg):
    box = collision('c', 7, '<box><size>1 2 3</size></box>', '2')
    inertial = inertial_of(f'<inertial auto="true">{mass}</inertial>{box}')
    moments = pytest.approx([13.0, 10.0, 5.0, 0.0, 0.0, 0.0])
    assert inertial.mass_kg == pytest.approx(mass_kg)
    assert np.array(inertial.moments_kg_m2) * 12.0 / mass_kg == moments


def test_masses_are_read_on_request_only():
    scene = load_text(link_with(inertia(1, 1, 1, 0, 0, 0, mass=-1)))
    assert (scene.inertials, scene.warnings) == ({}, ())
