# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Old files mean now what they meant then."""

import pytest
from sdf_texts import codes_of

import sdf_pose_bridge


def file_of(version, content):
    return f'<sdf version="{version}">{content}</sdf>'


def model(content):
    return f'<model name="m">{content}</model>'


@pytest.mark.parametrize('version', [
    '', '1', '1.0', '1.1', '1.13', '2.0', '1.6.0', ' 1.9 ', '1.09', 'latest', '١.٩', '1.-9',
])
def test_versions_that_do_not_exist_are_refused(version):
    assert codes_of(file_of(version, model('<link name="l"/>'))) == ['CONVERSION_ERROR']


@pytest.mark.parametrize('version', [f'1.{minor}' for minor in range(2, 13)])
def test_all_versions_are_read(version):
    frame = '<frame name="f"><pose degrees="1" relative_to="l"/></frame>'
    scene = sdf_pose_bridge.load_text(file_of(version, model('<link name="l"/>' + frame)))
    assert 'm::f' in scene.names


def test_frame_of_a_pose_was_relative_to():
    text = file_of('1.6', model(
        '<link name="a"><pose>1 0 0 0 0 0</pose></link>'
        '<link name="b"><pose frame="a" relative_to="x">1 0 0 0 0 0</pose></link>'))
    assert sdf_pose_bridge.load_text(text).pose('m::b').x == 2.0


def test_frame_of_a_pose_means_nothing_since_1_7():
    scene = sdf_pose_bridge.load_text(file_of('1.7', model(
        '<link name="a"/><link name="b"><pose frame="a">1 0 0 0 0 0</pose></link>')))
    assert 'frame="a" has no meaning since 1.7' in scene.warnings[0].message


def test_in_plugins_nothing_is_converted():
    text = file_of('1.6', model(
        '<link name="a"/><plugin name="p" filename="f"><pose frame="nowhere"/></plugin>'))
    assert sdf_pose_bridge.load_text(text).warnings == ()


@pytest.mark.parametrize('flag', ['true', '1', 'TRUE'])
def test_old_axes_can_turn_with_the_model(flag):
    axis = f'<xyz>1 0 0</xyz><use_parent_model_frame>{flag}</use_parent_model_frame>'
    joint = ('<joint name="j" type="revolute"><parent>a</parent><child>b</child>'
             f'<axis>{axis}</axis></joint>')
    text = file_of('1.6', model(f'<link name="a"/><link name="b"/>{joint}'))
    assert 'm::j' in sdf_pose_bridge.load_text(text).names
