# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Values that no pose depends on, but that libsdformat refuses."""

import pytest
from sdf_texts import codes_of
from sdf_texts import model_file

import sdf_pose_bridge


def link(content):
    return model_file(f'<link name="l">{content}</link>')


def visual(content):
    return link(f'<visual name="v">{content}</visual>')


def material(content):
    return visual(f'<material>{content}</material>')


def axis(content):
    return model_file(
        '<link name="a"/><link name="b"/><joint name="j" type="revolute"><parent>a</parent>'
        f'<child>b</child><axis>{content}</axis></joint>')


def ode(content):
    return link('<collision name="c"><surface><friction><ode>'
                f'{content}</ode></friction></surface></collision>')


@pytest.mark.parametrize(('text', 'code'), [
    (link('<inertial><mass>heavy</mass></inertial>'), 'ELEMENT_INVALID'),
    (link('<gravity>maybe</gravity>'), 'ELEMENT_INVALID'),
    (visual('<geometry><box><size>1 1</size></box></geometry>'), 'ELEMENT_INVALID'),
    (visual('<geometry><box><size>1 x 1 1</size></box></geometry>'), 'ELEMENT_INVALID'),
    (visual('<transparency>,</transparency>'), 'ELEMENT_INVALID'),
    (visual('<visibility_flags>x1</visibility_flags>'), 'ELEMENT_INVALID'),
    (visual('<visibility_flags>.5</visibility_flags>'), 'ELEMENT_INVALID'),
    (visual('<transparency>\u0661</transparency>'), 'ELEMENT_INVALID'),
    (visual('<geometry><box><size>1 1 \u0661</size></box></geometry>'), 'ELEMENT_INVALID'),
    (material('<ambient>1 1</ambient>'), 'ELEMENT_INVALID'),
    (material('<ambient>1 1 2 1</ambient>'), 'ELEMENT_INVALID'),
    (material('<ambient>1 1 5e-0_1</ambient>'), 'ELEMENT_INVALID'),
    (material('<ambient>1 1 1 1 1</ambient>'), 'ELEMENT_INVALID'),
    (material('<ambient>1 1 1 red</ambient>'), 'ELEMENT_INVALID'),
    (material('<ambient>1 1 nan</ambient>'), 'ELEMENT_INVALID'),
    (material('<script><name>n</name></script>'), 'ELEMENT_INVALID'),
    (material('<script><uri>u</uri></script>'), 'ELEMENT_MISSING'),
    (material('<shader type="round"/>'), 'ELEMENT_INVALID'),
    (material('<shader type="normal_map_object_space"/>'), 'ELEMENT_MISSING'),
    (axis('<xyz>0 0 0</xyz>'), 'ELEMENT_INVALID'),
    (axis('<xyz>0 1</xyz>'), 'ELEMENT_INVALID'),
    (axis('<xyz>0 0 1</xyz><limit><lower>low</lower></limit>'), 'ELEMENT_INVALID'),
    (ode('<mu>-1</mu>'), 'ELEMENT_INVALID'),
    (link('<light name="x"/>'), 'ATTRIBUTE_MISSING'),
    (link('<sensor name="x"/>'), 'ATTRIBUTE_MISSING'),
    (model_file('<link name="l"/><plugin name="p"/>'), 'ATTRIBUTE_MISSING'),
    (link('<audio_source><pose>1 2</pose></audio_source>'), 'ELEMENT_INVALID'),
])
def test_bad_values_are_refused(text, code):
    assert codes_of(text) == [code]


@pytest.mark.parametrize('text', [
    link('<inertial><mass> 1.5kg </mass></inertial>'),
    link('<inertial><mass/></inertial>'),
    link('<inertial><mass>true</mass></inertial>'),
    link('<gravity>1</gravity>'),
    visual('<geometry><box><size>1 1 1 1</size></box></geometry>'),
    visual('<visibility_flags>0x0F</visibility_flags>'),
    visual('<transparency>-.5</transparency>'),
    material('<ambient>1 1 0.5</ambient>'),
    material('<ambient>1 1_0 0.5x</ambient>'),
    axis('<xyz>0 0 1e-3</xyz>'),
    ode('<mu>1e9</mu>'),
    link('<unknown><mass>heavy</mass></unknown>'),
    model_file('<link name="l"/><plugin name="p" filename="f"><inertial><mass>x</mass></inertial>'
               '<plugin/></plugin>'),
])
def test_what_libsdformat_takes_is_taken(text):
    assert sdf_pose_bridge.load_text(text).names
