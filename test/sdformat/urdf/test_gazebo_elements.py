# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Settings and SDFormat in ``<gazebo>`` elements."""

from lxml import etree
from urdf_texts import gazebo
from urdf_texts import robot

from sdf_pose_bridge.sdformat.urdf.gazebo_elements import Settings
from sdf_pose_bridge.sdformat.urdf.gazebo_elements import settings_and_extensions_from_robot


def read(content):
    return settings_and_extensions_from_robot(etree.fromstring(robot(content)))


def test_without_any_there_are_no_settings():
    assert read('') == (Settings(None, frozenset(), frozenset()), {})


def test_what_is_not_a_setting_is_an_extension_of_what_it_refers_to():
    _, extensions = read(
        gazebo('<sensor/><mu1>1</mu1>', 'a') + gazebo('<plugin/>') + gazebo('<light/>', 'a'))
    assert {name: [each.tag for each in found] for name, found in extensions.items()} == {
        'a': ['sensor', 'light'], '': ['plugin']}


def test_a_joint_that_is_preserved_does_not_become_revolute():
    settings, _ = read(
        gazebo('<preserveFixedJoint>true</preserveFixedJoint>', 'j')
        + gazebo('<disableFixedJointLumping>true</disableFixedJointLumping>', 'j')
        + gazebo('<disableFixedJointLumping>true</disableFixedJointLumping>', 'k')
        + gazebo('<preserveFixedJoint>false</preserveFixedJoint>', 'l'))
    assert settings == Settings(None, frozenset('jk'), frozenset('k'))


def test_only_the_model_is_static():
    assert read(gazebo('<static>yes</static>'))[0].static == 'true'
    assert read(gazebo('<static>yes</static>', 'a'))[0].static is None
