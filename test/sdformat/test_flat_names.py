# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Names such as kid::link of old worlds become nested models."""

import pytest
from sdf_texts import codes_of

import sdf_pose_bridge


def world(content, version='1.7'):
    return (f'<sdf version="{version}"><world name="w"><model name="m">{content}</model></world>'
            '</sdf>')


KID = """
  <frame name="kid::__model__" attached_to="kid::b"><pose>0 0 1 0 0 0</pose></frame>
  <link name="kid::a"><pose relative_to="kid::__model__">1 0 0 0 0 0</pose></link>
  <link name="kid::b"/>
"""


@pytest.mark.parametrize('joint', [
    '<parent>base</parent><child>kid::a</child>', '<parent>kid::a</parent><child>base</child>',
])
def test_a_joint_that_would_reach_outside_is_refused(joint):
    text = world(f'<link name="base"/>{KID}<joint name="kid::j" type="fixed">{joint}</joint>')
    assert codes_of(text) == ['CONVERSION_ERROR']


def test_newer_files_may_not_hold_such_names():
    assert set(codes_of(world(KID, '1.8'))) == {'RESERVED_NAME'}


def test_elements_move_into_a_nested_model():
    scene = sdf_pose_bridge.load_text(world('<link name="base"/>' + KID))
    assert scene.names == ('world', 'm', 'm::base', 'm::kid', 'm::kid::a', 'm::kid::b')
    assert scene.pose('m::kid::a')[:3] == (1.0, 0.0, 1.0)
    kid, canonical = scene.index('m::kid'), scene.index('m::kid::b')
    assert scene.canonical_links[kid] == canonical


def test_a_name_that_only_begins_alike_stays():
    scene = sdf_pose_bridge.load_text(world('<link name="b::l"/><link name="base"/>'))
    assert scene.names == ('world', 'm', 'm::base', 'm::b', 'm::b::l')


def test_models_are_nested_as_deep_as_their_names():
    scene = sdf_pose_bridge.load_text(world('<link name="base"/><link name="a::b::c"/>'))
    assert scene.names[3:] == ('m::a', 'm::a::b', 'm::a::b::c')


def test_the_world_stays_a_parent():
    scene = sdf_pose_bridge.load_text(world(
        '<link name="kid::l"/>'
        '<joint name="kid::j" type="fixed"><parent>world</parent><child>kid::l</child></joint>'))
    assert scene.joints[0].parent == 0
