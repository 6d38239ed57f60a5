# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Frames of odometry in a file."""

import pytest
from sdf_texts import model_file, world_file

from sdf_pose_bridge import load_text
from sdf_pose_bridge.geometry.poses import Pose, pose_inverse, pose_product
from sdf_pose_bridge.tf.odometry import Odometry
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

START = Pose(1.0, 2.0, 0.5)
CART = '<model name="cart"><pose>1 2 0.5 0 0 0</pose><link name="deck"/>{}</model>'
HALF_TURN = Pose(0.5, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


def plugin(system, parameters=''):
    return f'<plugin filename="f" name="gz::sim::systems::{system}">{parameters}</plugin>'


def odometry_in(content, text=None, model_name=''):
    text = world_file(CART.format(content)) if text is None else text
    scene = load_text(text, plugins=True).with_model_name(model_name)
    return tf_tree_from_scene(scene, TfOptions(follows_models=True)).odometry


@pytest.mark.parametrize('system', [
    'DiffDrive', 'AckermannSteering', 'MecanumDrive', 'TrackedVehicle'])
def test_odometry_of_wheels_counts_from_the_pose_in_the_file(system):
    assert odometry_in(plugin(system)) == {
        (0, 'cart/odom'): Odometry(START, Pose(), is_of_wheels=True)}


def test_odometry_of_a_spawned_model_counts_from_the_root():
    text = model_file(f'<pose>1 2 3 0 0 0</pose><link name="l"/>{plugin("DiffDrive")}')
    assert odometry_in('', text, 'cart_2') == {
        (0, 'cart_2/odom'): Odometry(Pose(), Pose(), is_of_wheels=True)}


@pytest.mark.parametrize(('content', 'frame_id'), [
    (plugin('DiffDrive', '<frame_id>a::odom</frame_id>'), 'a/odom'),
    (plugin('DiffDrive', '<frame_id>first</frame_id><frame_id>second</frame_id>'), 'first'),
    (plugin('OdometryPublisher', '<odom_frame>map</odom_frame>'), 'map'),
    (plugin('OdometryPublisher', '<frame_id>map</frame_id>'), 'cart/odom'),
    (plugin('AckermannSteering', '<steering_only>true</steering_only>'), None),
    (plugin('PosePublisher'), None),
])
def test_frame_id_of_odometry(content, frame_id):
    assert [each for _, each in odometry_in(content)] == [frame_id] * (frame_id is not None)


@pytest.mark.parametrize(('parameters', 'offset', 'start'), [
    ('', Pose(), Pose()),
    ('<xyz_offset>0.5 0 0</xyz_offset><rpy_offset>0 0 3.141592653589793</rpy_offset>',
     HALF_TURN, Pose()),
    ('<xyz_global_offset>0 0 2</xyz_global_offset>', Pose(), Pose(0.0, 0.0, 2.0)),
    ('<xyz_offset>a b c</xyz_offset>', Pose(), Pose()),
])
def test_offsets_of_odometry_publisher_are_taken_back(parameters, offset, start):
    (odometry,) = odometry_in(plugin('OdometryPublisher', parameters)).values()
    actual = Pose(3.0, 4.0, 5.0, 0.0, 0.0, 0.6, 0.8)
    sent = pose_product(pose_inverse(start), pose_product(actual, offset))
    found = pose_product(odometry.pose, pose_product(sent, odometry.model))
    assert found == pytest.approx(actual)
