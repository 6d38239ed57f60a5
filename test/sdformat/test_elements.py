# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The table of elements: the places of errors, and positions that may be in millimetres."""

import pytest
from sdf_texts import model_file, only_error, world_file

from sdf_pose_bridge import load_text


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
