# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What only sensors have."""


import pytest
from sdf_texts import link_with

from sdf_pose_bridge import load_text


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
