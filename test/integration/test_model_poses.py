# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A bridge that follows poses of models, beside a process that publishes them and listens."""

import math
import sys

from changes import call, listen_to_tf, pose_of, reload, replace, set_parameters
from folders import EXAMPLES
from geometry_msgs.msg import (
    PoseStamped,
    PoseWithCovarianceStamped,
    TransformStamped,
)
from nav_msgs.msg import Odometry
import pytest
from rclpy.qos import DurabilityPolicy, QoSProfile
from tf2_msgs.msg import TFMessage
from tracker import CART, stamped, Tracker, WORLD

from sdf_pose_bridge_interfaces.srv import LookupPose

TOPIC = '/tracker/{model}/pose'
FILE_TEXT = WORLD.format(height=0.5)


@pytest.fixture
def tracker(tf):
    return Tracker(tf)


@pytest.fixture
def follow(bridge, tf):
    """Lets the bridge follow poses of models."""
    def follow(*topics, **parameters):
        set_parameters(tf.listener, model_pose_topics=list(topics or [TOPIC]), **parameters)
        return bridge
    return follow


@pytest.mark.parametrize('message_type', [
    PoseStamped, PoseWithCovarianceStamped, TransformStamped, Odometry])
def test_a_pose_of_each_type_moves_its_model(follow, tf, tracker, message_type):
    follow(frame_prefix='p/')
    found = tracker.move(3.0, 'p/cart/deck', message_type)
    assert found.header.frame_id == 'world'
    assert (found.transform.translation.z, found.transform.rotation.z) == (
        0.5, pytest.approx(math.sqrt(0.5)))
    assert pose_of(tf, 'p/cart').x == 3.0


def test_a_pose_that_was_latched_before_the_node_starts_counts(
        start_bridge, file, tf, tracker):
    latched = tf.listener.node.create_publisher(PoseWithCovarianceStamped, CART, QoSProfile(
        depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
    latched.publish(stamped(PoseWithCovarianceStamped, 7, 3.0))
    start_bridge(sdf_file=file, model_pose_topics=[TOPIC]).wait_until_started()
    tf.wait_for_frames('cart/deck')
    assert tf.last['cart/deck'].transform.translation.x == 3.0
    # A volatile publisher beside it is followed too.
    tracker.move(4.0, message_type=PoseWithCovarianceStamped)


def test_transforms_name_the_models_that_they_move(follow, tf, tracker):
    bridge = follow('/poses', model_pose_frames=['*/odom'])

    def are_there():
        tracker.sec += 1
        tracker.publish(TFMessage(transforms=[
            stamped(TransformStamped, tracker.sec, x, frame_id, child)
            for x, frame_id, child in (
                (4, 'shop', 'cart'), (5, 'cart/odom', 'cart::crate'), (6, '', 'arm'),
                (7, '', 'wall'), (8, 'elsewhere', 'arm'))]), '/poses')
        return tf.last.keys() >= {'cart/deck', 'cart/crate/box', 'arm/base'}

    tf.listener.wait(are_there, tf.last)
    assert [tf.last[each].transform.translation.x for each in (
        'cart/deck', 'cart/crate/box', 'arm/base')] == [4.0, 5.0, 6.0]
    bridge.wait_for_line('/poses has poses of "wall", which are ignored')
    bridge.wait_for_line('/poses has poses in "elsewhere", which are ignored')
    assert bridge.count_of('which are ignored') == 2


def test_a_tracker_may_come_late_stop_and_come_back_with_another_type(follow, tf, tracker):
    bridge = follow()
    bridge.wait_for_line('no pose has come yet for 3 models, for example "cart"')
    answer = call(tf.listener, LookupPose, frame='cart/deck')
    assert 'depends on the pose of model "cart", which has not been reported' in answer.message
    tracker.move(3.0)
    tracker.stop()
    tf.listener.wait(lambda: not tf.listener.node.count_publishers(CART), 'its end')
    assert pose_of(tf, 'cart').x == 3.0
    tracker.move(4.0, message_type=Odometry)


def test_many_poses_of_hostile_names_delay_no_look_up(follow, tf, tracker):
    bridge = follow('/hostile', TOPIC)
    tracker.move(3.0)
    for number in range(30):
        hostile = [f'\n\x1b[31m{{}}%s"{number}/{row}' for row in range(300)]
        tracker.publish(TFMessage(transforms=[
            stamped(TransformStamped, number, math.nan, *names)
            for each in hostile for names in ((each, 'cart'), ('', each))]), '/hostile')
        assert pose_of(tf, 'cart/deck').x == 3.0
    tracker.move(4.0)
    assert not bridge.count_of('internal error')


def test_poses_in_a_frame_that_moves_follow_it(follow, tf, tracker, joints):
    follow(use_joint_states=True)
    tracker.move(5.0, 'arm/base', topic='/tracker/arm/pose')
    tf.listener.wait(
        lambda: joints.send({'lift': 0.25}) and 'arm/hand' in tf.last, 'the hand')
    tf.wait_for('arm/hand', joints.send({'lift': 0.5}))
    # The base of the arm is turned by a quarter.
    found = tracker.move(1.0, seen_x=5.0, frame_id='arm/hand').transform
    assert (found.translation.y, found.translation.z) == pytest.approx((1.0, 2.0))


CART_WITH_WHEELS = """<sdf version="1.11"><world name="shop">
<frame name="mocap"><pose degrees="true">0 0 0 90 0 0</pose></frame>
<model name="cart"><pose>1 2 0.5 0 0 0</pose><link name="deck"/>
<frame name="markers"><pose>0 0 0.25 0 0 0</pose></frame>
<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"/></model>
</world></sdf>"""


def test_the_odometry_of_wheels_begins_where_the_file_puts_the_model(follow, file, tracker):
    replace(file, CART_WITH_WHEELS)
    bridge = follow('/model/{model}/odometry', model_pose_frames=['*/odom'])
    found = tracker.move(
        3.0, 'cart/deck', Odometry, '/model/cart/odometry', seen_x=4.0, frame_id='cart/odom',
        child='cart/deck').transform.translation
    assert (found.y, found.z) == (2.0, 0.5)
    bridge.wait_for_line('model_pose_frames has no effect on "cart/odom"')


def test_two_odometries_in_one_frame_and_a_plugin_in_a_nested_model(follow, file, tracker):
    diff_drive = 'plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"'
    replace(file, f"""<sdf version="1.11"><world name="shop">
<model name="cart"><pose>3 2 0.1 0 0 0</pose><link name="deck"/>
<{diff_drive}><odom_topic>wheels</odom_topic></plugin>
<plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher"/>
</model><model name="trolley"><model name="bot"><pose>0 1 0 0 0 0</pose><link name="base"/>
<{diff_drive}/></model></model></world></sdf>""")
    follow('/{model}/odometry_1', '/{model}/odometry', '/{model}/bot/odometry')
    for topic, seen_x, y in (('/cart/odometry_1', 5.0, 0.0), ('/cart/odometry', 8.0, 2.0)):
        assert tracker.move(
            5.0, 'cart/deck', Odometry, topic, seen_x=seen_x, frame_id='cart/odom',
            child='cart/base_footprint').transform.translation.y == y
    found = tracker.move(
        5.0, 'trolley/bot/base', Odometry, '/trolley/bot/odometry', frame_id='bot/odom',
        child='bot/base')
    assert found.transform.translation.y == pytest.approx(1.0)


def test_a_tracker_with_another_axis_up_gives_poses_of_its_markers(follow, file, tracker):
    replace(file, CART_WITH_WHEELS)
    follow(model_pose_placement='markers')
    # The tracker turns the markers about its z axis, which is -y of the world.
    found = tracker.move(3.0, 'cart/deck', seen_x=3.0, frame_id='mocap').transform
    assert (found.translation.y, found.translation.z) == pytest.approx((0.25, 0.0))


def test_models_keep_their_poses_when_the_file_is_read_again(follow, file, tf, tracker):
    follow(watch=False)
    tracker.move(3.0)
    replace(file, WORLD.format(height=0.75))
    assert reload(tf.listener).success
    tf.listener.wait(
        lambda: tf.last['cart/deck'].transform.translation.z == 0.75, tf.last)
    assert (pose_of(tf, 'cart/deck').x, pose_of(tf, 'cart/deck').z) == (3.0, 0.75)
    tracker.move(4.0)


def test_models_can_be_where_the_file_puts_them_at_first(bridge, follow, tf):
    follow(unreported_joints='zero')
    tf.wait_for_frames('cart/deck')
    assert tf.last['cart/deck'].transform.translation.x == 1.0
    listen_to_tf(tf.listener)
    tf.listener.wait(lambda: tf.listener.tf_messages, '/tf_static')
    fixed = {each.child_frame_id for each in tf.listener.tf_messages[-1].transforms}
    assert 'arm/hand' in fixed, 'as joints do not move'
    assert fixed.isdisjoint({'cart/deck', 'arm/base', 'cart/crate/box'})


def test_the_example_moves_the_part_of_the_work_cell(start_bridge, start_program, tf):
    start_bridge(
        sdf_file=EXAMPLES / 'work_cell.sdf', model_pose_topics=[TOPIC]).wait_until_started()
    start_program([
        sys.executable, EXAMPLES / 'track_part.py', '--ros-args', '-p', 'frame:=robot/tool0'])
    tf.wait_for_frames('gear_housing/body')
    answer = call(tf.listener, LookupPose, frame='gear_housing', relative_to='robot/tool0')
    position = answer.pose.pose.position
    assert math.hypot(position.x, position.y) == pytest.approx(0.1)
    assert position.z == pytest.approx(0.2)
