# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The table of elements: places, poses in several formats, and poses that are not valid."""

import numpy as np
import pytest
from sdf_texts import model_file, only_error, world_file

from sdf_pose_bridge import Kind, load_text
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.sdformat.elements import ElementsBuilder, NO_ELEMENT
from sdf_pose_bridge.sdformat.poses import PoseFormat


@pytest.fixture
def problems():
    return Problems(['a.sdf', 'b.sdf'])


@pytest.fixture
def builder():
    """Return a table with a root, a model in line 2, and a link in line 3 of another file."""
    builder = ElementsBuilder(['a.sdf', 'b.sdf'])
    root = builder.add(Kind.ROOT, '__root__', NO_ELEMENT, NO_ELEMENT, 0, 1)
    model = builder.add(Kind.MODEL, 'm', root, root, 0, 2)
    builder.add(Kind.LINK, 'l', model, model, 1, 3)
    return builder


# Poses

def test_pose_that_is_not_valid_is_the_identity(builder, problems):
    builder.set_pose(1, '1 2', PoseFormat(), 2)
    elements = builder.elements(problems)
    assert elements.poses[1].tolist() == [0, 0, 0, 0, 0, 0, 1]


def test_pose_that_is_not_valid_is_reported_with_its_place(builder, problems):
    builder.set_pose(1, '1 2 3 0 0 0', PoseFormat(), 2)
    builder.set_pose(2, '1 2', PoseFormat(), 4)
    builder.elements(problems)
    (error,) = problems.errors
    assert error.place == ('b.sdf', 4, '/sdf/model[@name="m"]/link[@name="l"]/pose')
    assert '"1 2" has 2' in error.message


def test_poses_of_different_formats(builder, problems):
    builder.set_pose(0, '1 0 0 0 0 0', PoseFormat(), 1)
    builder.set_pose(1, '2 0 0 0 0 180', PoseFormat(is_degrees=True), 2)
    builder.set_pose(2, '3 0 0 0 1 0 0', PoseFormat(is_quaternion=True), 4)
    elements = builder.elements(problems)
    np.testing.assert_allclose(elements.poses, [
        [1, 0, 0, 0, 0, 0, 1], [2, 0, 0, 0, 0, 1, 0], [3, 0, 0, 0, 1, 0, 0]], atol=1e-15)


@pytest.mark.parametrize(('text', 'pose_format', 'message'), [
    ('0 0 0 0 0 90', PoseFormat(), 'did you mean degrees="true"?'),
    ('0 0 0 0 0 0 2', PoseFormat(is_quaternion=True), 'is not of length 1'),
])
def test_pose_that_may_mean_another_is_a_warning(builder, problems, text, pose_format, message):
    builder.set_pose(1, text, pose_format, 7)
    builder.elements(problems)
    (warning,) = problems.warnings
    assert message in warning.message
    assert warning.place.line == 7


def test_element_without_a_pose_is_at_the_identity(builder, problems):
    elements = builder.elements(problems)
    assert elements.poses.tolist() == [[0, 0, 0, 0, 0, 0, 1]] * 3
    assert elements.pose_lines.tolist() == [0, 0, 0]


def test_table_has_the_columns_of_all_elements(builder, problems):
    elements = builder.elements(problems)
    assert elements.parents.tolist() == elements.scopes.tolist() == [-1, 0, 1]
    assert elements.lines.tolist() == [1, 2, 3]
    assert [elements.kind(index) for index in range(3)] == [Kind.ROOT, Kind.MODEL, Kind.LINK]


# Places

@pytest.mark.parametrize(('index', 'place'), [
    (1, ('a.sdf', 2, '/sdf/model[@name="m"]')),
    (2, ('b.sdf', 3, '/sdf/model[@name="m"]/link[@name="l"]')),
])
def test_place_of_an_element(builder, problems, index, place):
    assert builder.elements(problems).place(index) == place


def test_place_of_a_part_of_an_element(builder, problems):
    elements = builder.elements(problems)
    assert elements.place(2, 7, 'pose') == (
        'b.sdf', 7, '/sdf/model[@name="m"]/link[@name="l"]/pose')


@pytest.mark.parametrize(('text', 'element'), [
    (world_file('<model name="m"><link name="l"><visual name="v"><pose>1</pose></visual></link>'
                '</model>'),
     '/sdf/world[@name="w"]/model[@name="m"]/link[@name="l"]/visual[@name="v"]/pose'),
    (model_file('<link name="l"><inertial><pose>1</pose></inertial></link>'),
     '/sdf/model[@name="m"]/link[@name="l"]/inertial/pose'),
])
def test_error_has_the_path_of_its_element(text, element):
    assert only_error(text).element == element


# Positions that may be in millimetres

def test_positions_far_from_their_model_give_one_warning():
    scene = load_text(model_file(
        '<link name="a"><pose>0 350 0 0 0 0</pose></link>'
        '<frame name="f"><pose>0 0 -1200 0 0 0</pose></frame>'))
    (warning,) = scene.warnings
    assert warning.message == (
        'the position 0 350 0 of link "a" is in metres, and 1 more in this file are as far away; '
        'these look like millimetres')


@pytest.mark.parametrize('text', [
    world_file('<model name="m"><pose>500 0 0 0 0 0</pose><link name="l"/></model>'),
    model_file('<static>1</static><link name="l"><pose>0 0 -150 0 0 0</pose></link>'),
    model_file('<link name="l"><visual name="sea"><pose>0 0 -150 0 0 0</pose></visual></link>'),
    model_file('<link name="l"><pose>99 0 0 0 0 0</pose>'
               '<light name="k" type="point"><pose>0 0 300 0 0 0</pose></light></link>'),
])
def test_what_may_be_far_away_gives_no_warning(text):
    assert not load_text(text).warnings
