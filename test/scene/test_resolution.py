# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""From poses in their references to poses in the root: placements, depths, few and many."""

from matrices import assert_same_pose
from matrices import matrix_from_degrees
import numpy as np
import pytest
from sdf_texts import assert_at
from sdf_texts import errors_of
from sdf_texts import fixed_joint
from sdf_texts import model_file
from sdf_texts import posed
from sdf_texts import world_file

import sdf_pose_bridge


def scene_of(text):
    return sdf_pose_bridge.load_text(text)


def degrees(values):
    return f'<pose degrees="true">{" ".join(map(str, values))}</pose>'


def step(i, j):
    return (0.5, -0.25 * j, 1.0, 20 * i, -35 + j, 50)


@pytest.mark.parametrize('breadth', [1, 10, 40])
def test_chains_of_any_depth_and_breadth(breadth):
    # Few at one depth are resolved one by one, many at once.
    depth = 12
    frames = ''.join(
        f'<frame name="f{i}_{j}" attached_to="{"l" if i == 0 else f"f{i - 1}_{j}"}">'
        f'{degrees(step(i, j))}</frame>'
        for j in range(breadth) for i in range(depth))
    scene = scene_of(model_file('<link name="l"/>' + frames))
    for j in range(breadth):
        matrix = np.eye(4)
        for i in range(depth):
            matrix = matrix @ matrix_from_degrees(*step(i, j))
            assert_same_pose(scene.pose(f'm::f{i}_{j}'), matrix)


def test_orientations_stay_unit_over_long_chains():
    frames = ''.join(
        f'<frame name="f{i}" attached_to="{f"f{i - 1}" if i else "l"}">'
        f'{degrees(step(i, 1))}</frame>'
        for i in range(2000))
    scene = scene_of(model_file('<link name="l"/>' + frames))
    norms = np.linalg.norm(scene.poses[:, 3:], axis=1)
    np.testing.assert_allclose(norms, 1.0, rtol=0.0, atol=1e-15)
    assert (scene.poses[:, 6] >= 0.0).all()


def test_there_are_no_negative_zeros():
    scene = scene_of(model_file(
        posed('link', 'a', '-0 -0 -0 0 0 3.141592653589793')
        + posed('link', 'b', '-0 0 0 0 0 3.141592653589793', 'a')))
    assert not (np.signbit(scene.poses) & (scene.poses == 0.0)).any()


# Placement frames

PLACED = (
    '<pose>1 2 3 0 0 1.5707963267948966</pose>' + posed('link', 'l', '1 0 0 0 0 0')
    + posed('link', 'k', '0 0 4 0 0 0') + fixed_joint('j', 'l', 'k', '<pose>1 1 1 0 0 0</pose>')
    + '<frame name="f" attached_to="l"><pose>0 1 0 0 0 0</pose></frame>'
    '<model name="n"><pose>0 0 1 0 0 0</pose><link name="b"><pose>0 1 0 0 0 0</pose></link>'
    '</model>')


@pytest.mark.parametrize('frame', ['l', 'k', 'j', 'f', 'n', 'n::b', 'n::__model__'])
def test_the_pose_of_a_model_is_that_of_its_placement_frame(frame):
    scene = scene_of(model_file(PLACED, attributes=f'placement_frame="{frame}"'))
    name = f'm::{frame}'.removesuffix('::__model__')
    assert_at(scene, name, (1, 2, 3, 0, 0, 0.5 ** 0.5, 0.5 ** 0.5))


@pytest.mark.parametrize('frame', ['', ' ', '__model__'])
def test_the_placement_frame_may_be_the_model_frame(frame):
    scene = scene_of(model_file(PLACED, attributes=f'placement_frame="{frame}"'))
    assert_at(scene, 'm', (1, 2, 3))


@pytest.mark.parametrize('frame', ['l', 'j', 'n::b'])
def test_a_placement_frame_moves_the_model_as_a_whole(frame):
    plain = scene_of(model_file(PLACED))
    placed = scene_of(model_file(PLACED, attributes=f'placement_frame="{frame}"'))
    for name in plain.names[2:]:
        np.testing.assert_allclose(
            placed.pose(name, 'm'), plain.pose(name, 'm'), rtol=0.0, atol=1e-12)


def test_placement_frames_within_placement_frames():
    scene = scene_of(world_file(
        posed('frame', 'r', '0 0 10 0 0 1.5707963267948966')
        + '<model name="m" placement_frame="n::b"><pose relative_to="r">1 0 0 0 0 0</pose>'
        + posed('link', 'l', '0 0 1 0 0 0')
        + '<model name="n" placement_frame="b"><pose relative_to="l">5 0 0 0 0 0</pose>'
        + posed('link', 'b', '0 1 0 0 0 0.3') + '</model></model>'))
    assert_same_pose(scene.pose('m::n::b'), matrix_from_degrees(0, 1, 10, 0, 0, 90))
    np.testing.assert_allclose(scene.pose('m::n::b', 'm::l'), (5, 0, 0, 0, 0, 0, 1), atol=1e-12)


def test_others_follow_a_placed_model():
    scene = scene_of(world_file(
        '<model name="m" placement_frame="l"><pose>1 0 0 0 0 0</pose>'
        + posed('link', 'l', '0 0 1 0 0 0') + '</model>'
        + posed('frame', 'f', '0 1 0 0 0 0', 'm')))
    assert_at(scene, 'm', (1, 0, -1))
    assert_at(scene, 'f', (1, 1, -1))


def test_the_placement_frame_of_a_static_model():
    scene = scene_of(world_file(
        '<model name="m" placement_frame="f"><static>1</static><pose>1 0 0 0 0 0</pose>'
        + posed('frame', 'f', '0 1 0 0 0 0') + '</model>'))
    assert_at(scene, 'm', (1, -1, 0))


@pytest.mark.parametrize('frame', ['zzz', 'm', 'm::l', 'world', 'n::zzz', 'b'])
def test_a_placement_frame_is_unknown(frame):
    error = errors_of(model_file(PLACED, attributes=f'placement_frame="{frame}"'))[0]
    assert error.code == 'POSE_RELATIVE_TO_INVALID'
    assert f'placement_frame="{frame}"' in error.message


def test_a_placement_frame_out_of_reach():
    text = model_file(
        '<link name="l"/><model name="n" placement_frame="l"><link name="b"/></model>')
    assert errors_of(text)[0].code == 'POSE_RELATIVE_TO_INVALID'
