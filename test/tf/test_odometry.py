# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Frames of odometry in a file."""

import pytest
from sdf_texts import joint, model_file, plugin, world_file, write_files

from sdf_pose_bridge import load, load_text
from sdf_pose_bridge.geometry.poses import Pose, pose_inverse, pose_product
from sdf_pose_bridge.tf.odometry import Odometry
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

START = Pose(1.0, 2.0, 0.5)
CART = '<model name="cart"><pose>1 2 0.5 0 0 0</pose><link name="deck"/>{}</model>'
HALF_TURN = Pose(0.5, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


def tree_of(content, text=None, model_name=''):
    text = world_file(CART.format(content)) if text is None else text
    scene = load_text(text, plugins=True).with_model_name(model_name)
    return tf_tree_from_scene(scene, TfOptions(follows_models=True))


def odometry_in(*arguments):
    """Return the odometry of each model in each frame, on any topic."""
    odometry = tree_of(*arguments).odometry
    return {key[:2]: each for key, each in odometry.items() if not key[2]}


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


def model(name, content, pose='0 0 0 0 0 0'):
    return f'<model name="{name}"><pose>{pose}</pose>{content}</model>'


LINK = '<link name="l"/>'
BOT = model('bot', LINK + plugin('DiffDrive'), '0 0 0.5 0 0 0')
FIXED = joint('<parent>l</parent><child>bot::l</child>', joint_type='fixed')


@pytest.mark.parametrize(('content', 'nested'), [
    (BOT, 'cart::bot'),
    (model('inner', BOT), 'cart::inner::bot'),
    (LINK + BOT + FIXED, 'cart::bot'),
    # It moves by itself, and is no part of the model around it.
    (LINK + BOT, ''),
])
def test_a_plugin_in_a_nested_model(content, nested):
    text = world_file(model('cart', content, '1 2 0 0 0 0'))
    key = (int(nested == ''), 'bot/odom')
    assert odometry_in('', text) == {key: Odometry(
        START, Pose(), is_of_wheels=True, nested_model=nested)}


def test_a_nested_model_of_a_spawned_one_counts_from_its_place_in_it():
    text = model_file(f'<pose>1 2 3 0 0 0</pose>{BOT}')
    assert odometry_in('', text, 'cart_2') == {(0, 'bot/odom'): Odometry(
        Pose(0.0, 0.0, 0.5), Pose(), is_of_wheels=True, nested_model='cart_2::bot')}


def test_a_wrapper_that_places_a_frame_of_what_it_includes(tmp_path):
    write_files(
        tmp_path, bot=model_file(f'{LINK}<frame name="f"><pose>0 0 0.25 0 0 0</pose></frame>'
                                 + plugin('DiffDrive')),
        cart=model_file('<include><uri>bot.sdf</uri><name>bot</name><pose>0 1 0 0 0 0</pose>'
                        '<placement_frame>f</placement_frame></include>'),
        world=world_file('<include><uri>cart.sdf</uri><name>cart</name><pose>1 1 0.75 0 0 0</pose>'
                         '<placement_frame>bot::l</placement_frame></include>'))
    scene = load(tmp_path / 'world.sdf', plugins=True)
    odometry = tf_tree_from_scene(scene, TfOptions(follows_models=True)).odometry
    assert odometry[0, 'bot/odom', '/cart/bot/odometry'] == Odometry(
        Pose(1.0, 1.0, 0.75), Pose(), is_of_wheels=True, nested_model='cart::bot')


def test_topics_have_the_names_of_the_bridge_and_of_gazebo():
    odometry = tree_of(
        plugin('DiffDrive', '<odom_topic>wheels</odom_topic>')
        + plugin('OdometryPublisher')).odometry
    assert {key: each.is_of_wheels for key, each in odometry.items()} == {
        (0, 'cart/odom', topic): is_of_wheels for topic, is_of_wheels in {
            '': True, '/cart/odometry': True, '/wheels': True, '/cart/odometry_1': False,
            '/model/cart/odometry': False, '/cart/odometry_with_covariance': False,
            '/model/cart/odometry_with_covariance': False}.items()}


def test_the_odometry_with_covariance_is_in_the_same_frame():
    odometry = tree_of(plugin('OdometryPublisher', '<odom_frame>map</odom_frame>')).odometry
    assert {frame_id for _, frame_id, _ in odometry} == {'map'}
    assert len(odometry) == 5


def test_odometries_on_one_topic_are_told_with_both_plugins_and_the_cure():
    (warning,) = tree_of(plugin('DiffDrive') + plugin('OdometryPublisher')).warnings
    assert warning.message == (
        'the topic /model/cart/odometry belongs to DiffDrive, OdometryPublisher of "cart", so it '
        'has messages of all; give each a topic of its own in the file, by <odom_topic>')
    assert not tree_of(plugin('DiffDrive')).warnings
    text = world_file(CART.format(plugin('DiffDrive') + plugin('OdometryPublisher')))
    scene = load_text(text, plugins=True)
    assert not tf_tree_from_scene(scene, TfOptions(use_joint_states=True)).warnings
