# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Plugins of Gazebo: their classes and parameters, and the elements that have them."""

import pytest
from sdf_texts import model_file, world_file, write_files

from sdf_pose_bridge import load, load_text
from sdf_pose_bridge.sdformat.plugins import Plugin

LIBRARY = 'gz-sim-diff-drive-system'
CLASS = 'gz::sim::systems::DiffDrive'
PLUGIN = f'<plugin filename="{LIBRARY}" name="{CLASS}"><frame_id>odom</frame_id></plugin>'


def plugins_in(scene):
    return {
        scene.names[index]: [(each.system, each.parameters) for each in plugins]
        for index, plugins in scene.plugins.items()}


DRIVE = [('DiffDrive', (('frame_id', 'odom'),))]


@pytest.mark.parametrize(('filename', 'name', 'system'), [
    (LIBRARY, CLASS, 'DiffDrive'),
    ('any', CLASS, 'DiffDrive'),
    (LIBRARY, '', 'DiffDrive'),
    ('libignition-gazebo6-diff-drive-system.so', 'ignition::gazebo::systems::DiffDrive',
     'DiffDrive'),
    ('libignition-gazebo-odometry-publisher-system.so', '', 'OdometryPublisher'),
    ('gz-sim-tracked-vehicle-system', 'a name of our own', 'TrackedVehicle'),
    ('libgazebo_ros_diff_drive.so', 'diff_drive', ''),
    ('', '', ''),
])
def test_class_of_a_plugin(filename, name, system):
    assert Plugin(filename, name, ()).system == system


def test_plugins_of_worlds_models_and_sensors_are_read():
    scene = load_text(world_file(
        f'{PLUGIN}<model name="a"><link name="l"><sensor name="s" type="imu">{PLUGIN}</sensor>'
        f'</link><model name="b"><link name="l"/>{PLUGIN}{PLUGIN}</model></model>'), plugins=True)
    assert plugins_in(scene) == {'world': DRIVE, 'a::l::s': DRIVE, 'a::b': DRIVE * 2}


def test_plugins_and_topics_of_sensors_are_read_on_request_only():
    text = model_file(
        f'<link name="l"><sensor name="s" type="camera"><topic> a </topic><camera><triggered>1'
        f'</triggered></camera></sensor></link>{PLUGIN}')
    for requested in (True, False):
        scene = load_text(text, plugins=requested)
        assert bool(scene.plugins) is requested
        assert [each.topics for each in scene.sensors.values()] == [
            (('topic', 'a'), ('camera/triggered', '1')) if requested else ()]


def test_parameters_keep_their_order_and_repetitions():
    plugin, = load_text(model_file(
        '<link name="l"/><plugin filename="f"><!-- c --><joint_name> a  b </joint_name>'
        '<joint_name>c</joint_name><track><link>l</link></track></plugin>'),
        plugins=True).plugins[1]
    assert plugin.parameters == (('joint_name', 'a b'), ('joint_name', 'c'), ('track', ''))


@pytest.mark.parametrize(('content', 'owners'), [
    ('<include><uri>m.sdf</uri><name>n</name>{}</include>', {'n': DRIVE * 2}),
    ('<model name="n"><link name="k"/><include merge="true"><uri>m.sdf</uri></include></model>',
     {'n': DRIVE}),
], ids=['include', 'merge'])
def test_plugins_of_included_models(tmp_path, content, owners):
    write_files(
        tmp_path, m=model_file(f'<link name="l"/>{PLUGIN}'),
        w=world_file(content.format(PLUGIN)))
    assert plugins_in(load(tmp_path / 'w.sdf', plugins=True)) == owners


def test_plugin_of_a_gazebo_element_of_urdf():
    scene = load_text(
        f'<robot name="r"><link name="l"/><gazebo>{PLUGIN}</gazebo></robot>', plugins=True)
    assert plugins_in(scene) == {'r': DRIVE}
