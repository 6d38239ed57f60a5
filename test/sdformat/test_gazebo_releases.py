# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Warnings of elements that releases of Gazebo read in different ways."""

import pytest
from sdf_texts import link_with, model_file, write_files

from sdf_pose_bridge import load, load_text

SENSOR = '<sensor name="s" type="camera">{}</sensor>'
PLUGIN = '<plugin filename="libignition-gazebo-imu-system.so" name=""/>'


def doubts_of(text):
    return [each.message for each in load_text(text).warnings if each.is_for_gazebo]


@pytest.mark.parametrize(('text', 'message'), [
    (model_file('<link name="l"/>', version='1.12'), 'Gazebo Harmonic refuses version 1.12'),
    (model_file(f'<link name="l"/>{PLUGIN}'), 'Gazebo from Ionic on does not find a library'),
    (link_with(SENSOR.format('<camera><pose>1 0 0 0 0 0</pose></camera>')),
     'Gazebo does not read a <pose> in <camera>'),
    (link_with(SENSOR.format('<gz_frame_id>a</gz_frame_id><frame_id>b{}</frame_id>')),
     'Gazebo Harmonic sends data of the sensor with the frame id "a", later releases with "b{}"'),
    (f'<robot name="r"><link name="l"/><gazebo>{PLUGIN}</gazebo></robot>', 'Gazebo from Ionic on'),
])
def test_what_a_release_does_not_read_is_told_for_gazebo_alone(text, message):
    assert [each.startswith(message) for each in doubts_of(text)].count(True) == 1


@pytest.mark.parametrize('content', [
    '<gz_frame_id>a</gz_frame_id><frame_id> a </frame_id>', '<frame_id>b</frame_id>',
    '<gz_frame_id>a</gz_frame_id>', '<gz_frame_id/><frame_id>a</frame_id>',
    f'<camera/><plugin filename="ignition-gazebo-imu-system" name="n">{PLUGIN}</plugin>'])
def test_what_all_releases_read_is_not_told(content):
    assert doubts_of(link_with(SENSOR.format(content))) == []


def test_an_included_file_is_told_once(tmp_path):
    include = '<include><uri>b.sdf</uri><name>{}</name></include>'
    write_files(tmp_path, b=model_file('<link name="l"/>', version='1.12'), a=model_file(
        include.format('x') + include.format('y')))
    (warning,) = load(tmp_path / 'a.sdf').warnings
    assert warning.place.file.endswith('b.sdf')
