# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A bridge that follows joint states, beside a process that publishes them and listens."""

import signal
import sys

from builtin_interfaces.msg import Time
from changes import (
    asked_to_reload,
    BRIDGE,
    call,
    listen_to_tf,
    Monitor,
    pose_of,
    reload,
    replace,
    set_parameters,
)
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseStamped, TransformStamped
from listener import latched
import pytest
from sensor_msgs.msg import JointState
from slow_file import SlowFile
from std_msgs.msg import Header

from sdf_pose_bridge_interfaces.srv import LookupPose

ARM = """<sdf version="1.11"><model name="arm">
<link name="base"/><link name="upper"><pose>0 0 1 0 0 0</pose></link>
<link name="slide"><pose>0 0 2 0 0 0</pose></link><link name="finger"/>
<frame name="tool" attached_to="slide"><pose>{tool} 0 0 0 0 0</pose></frame>
<joint name="turn" type="revolute"><parent>base</parent><child>upper</child>
  <axis><xyz>0 0 1</xyz></axis></joint>
<joint name="lift" type="prismatic"><parent>upper</parent><child>slide</child>
  <axis><xyz>0 0 1</xyz></axis></joint>
<joint name="grip" type="prismatic"><parent>base</parent><child>finger</child>
  <axis><xyz>1 0 0</xyz><mimic joint="lift"><multiplier>2</multiplier><offset>0</offset>
  <reference>0</reference></mimic></axis></joint>
</model></sdf>"""
FILE_TEXT = ARM.format(tool=1)
FLOODING = """
import time
import rclpy
from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

rclpy.init()
publisher = rclpy.create_node('flooding').create_publisher(JointState, 'joint_states', 10)
messages = [
    serialize_message(JointState(
        name=[f'{row}_{number}' for row in range(10_000)], position=[0.0] * 10_000))
    for number in range(30)]
while True:
    for message in messages:
        publisher.publish(message)
        time.sleep(0.002)
"""
"""A program whose messages all have other names, and come faster than they can be taken."""

MOVED = {'upper', 'slide', 'finger'}


@pytest.fixture
def follow(bridge, joints, tf):
    """Lets the bridge follow joints, and returns when it hears their publisher."""
    def follow(**parameters):
        set_parameters(tf.listener, use_joint_states=True, **parameters)
        stamps = set()

        def is_connected():
            # The first messages are lost, until the bridge has discovered the publisher.
            stamps.add(joints.send({'turn': 0.0, 'lift': 0.0}))
            return 'upper' in tf.last and tf.last['upper'].header.stamp.sec in stamps

        tf.listener.wait(is_connected, 'the first message')
        return bridge
    return follow


def test_before_the_first_message_all_joints_can_be_at_zero(bridge, file, tf):
    poses = listen_to_poses(tf, 'tool')
    set_parameters(tf.listener, use_joint_states=True, unreported_joints='zero')
    tf.wait_for_frames(*MOVED)
    assert tf.last['slide'].transform.translation.z == 1.0
    listen_to_tf(tf.listener)
    tf.listener.wait(lambda: tf.listener.tf_messages, '/tf_static')
    fixed = {each.child_frame_id for each in tf.listener.tf_messages[0].transforms}
    assert fixed == {'arm', 'tool'}, 'and nothing for base, whose parent is odometry'
    replace(file, ARM.format(tool=2))
    tf.listener.wait(lambda: poses and poses['tool'].pose.position.x == 2.0, poses)


def test_joints_that_no_message_has_named_are_nowhere_until_their_driver_is_up(
        start_bridge, file, joints, tf):
    bridge = start_bridge(sdf_file=file, use_joint_states=True, anchor_models='all')
    tf.listener.wait(lambda: joints.send({'turn': 0.0}) and tf.last, 'the first message')
    poses = listen_to_poses(tf, 'base', 'upper', 'slide', 'tool', 'finger')
    transforms = listen_to_transforms(tf)
    tf.listener.wait(
        lambda: 'upper' in transforms and poses.keys() >= {'base', 'upper'}, poses)
    # On a busy machine the first message may come after the line.
    bridge.wait_for_line('no message has named ')
    assert tf.last.keys() == {'upper'}
    assert not transforms.keys() & {'slide', 'finger'}
    assert poses.keys() == {'base', 'upper'}
    answer = call(tf.listener, LookupPose, frame='tool', relative_to='base')
    assert (answer.success, answer.message) == (
        False, 'the pose depends on joint "lift", which has not been reported yet')
    assert pose_of(tf, 'upper').z == 1.0
    tf.wait_for('slide', joints.send({'lift': 0.25}))
    bridge.wait_for_line('all joints have been reported now')
    tf.listener.wait(lambda: len(poses) == 5 and 'finger' in transforms, poses)
    assert tf.last['finger'].transform.translation.x == 0.5, 'the mimic follows its leader'
    assert (pose_of(tf, 'tool').z, poses['tool'].pose.position.z) == (2.25, 2.25)


def test_joints_that_do_not_follow_say_once_which_parameter_moves_them(start_bridge, file, tf):
    bridge = start_bridge(sdf_file=file).wait_until_started()
    assert reload(tf.listener).success
    bridge.wait_for_line(' publishing ', 2)
    lines = [line for line in bridge.lines if 'use_joint_states' in line]
    assert len(lines) == 1
    assert 'fixed as in the file: 2 joints that can move, for example "turn"' in lines[0]


def test_a_flood_of_messages_does_not_keep_callers_waiting(follow, tf, start_program):
    bridge = follow()
    flooding = start_program([sys.executable, '-c', FLOODING])
    bridge.wait_for_line('not the name of one moving joint')
    for _ in range(3):
        pose_of(tf, 'slide')
    flooding.send(signal.SIGKILL)


def test_two_publishers_of_a_joint_are_in_the_log_and_in_diagnostics_until_one_is_gone(
        follow, joints, tf, start_listener):
    bridge = follow()
    monitor = Monitor(tf.listener)
    monitor.wait_for(DiagnosticStatus.OK)
    other = start_listener()
    others = [other.node.create_publisher(JointState, 'joint_states', 10)]

    def is_at(level):
        sec = joints.send({'turn': 0.0, 'lift': 0.0})
        for each in others:
            each.publish(JointState(
                header=Header(stamp=Time(sec=sec)), name=['turn', 'lift'], position=[1.0, 0.0]))
        return monitor.status.level == level

    tf.listener.wait(lambda: is_at(DiagnosticStatus.WARN), lambda: monitor.status)
    words = 'about joint "turn" come from several publishers at once on /joint_states, among "/'
    assert words in monitor.status.message
    other.node.destroy_publisher(others.pop())
    tf.listener.wait(lambda: is_at(DiagnosticStatus.OK), lambda: monitor.status)
    assert bridge.count_of(words) == 1


def test_later_listeners_get_the_last_positions(follow, joints, tf):
    follow()
    tf.wait_for('slide', joints.send({'turn': 0.0, 'lift': 0.5}))
    transforms, poses = listen_to_transforms(tf), listen_to_poses(tf, 'tool')

    def heights():
        return (transforms['slide'].transform.translation.z, poses['tool'].pose.position.z)

    # The message of an earlier position may come first.
    tf.listener.wait(
        lambda: len(transforms) == 5 and poses and heights() == (1.5, 2.5),
        (transforms, poses))


def listen_to_transforms(tf):
    transforms = {}
    tf.listener.node.create_subscription(
        TransformStamped, f'{BRIDGE}/transforms',
        lambda message: transforms.update({message.child_frame_id: message}), latched(100))
    return transforms


def listen_to_poses(tf, *frames):
    poses = {}
    for frame in frames:
        tf.listener.node.create_subscription(
            PoseStamped, f'{BRIDGE}/poses/{frame}',
            lambda message, frame=frame: poses.update({frame: message}), latched(1))
    return poses


def wait_for_z(tf, poses, pose_frame, **expected):
    def heights():
        return {
            frame: pose.pose.position.z for frame, pose in poses.items()
            if pose.header.frame_id == pose_frame}
    tf.listener.wait(lambda: heights() == expected, heights)


def test_the_frame_of_poses_can_be_set_while_joints_move(follow, joints, tf):
    follow()
    poses = listen_to_poses(tf, 'base', 'tool')
    tf.wait_for('slide', joints.send({'turn': 0.0, 'lift': 0.25}))
    wait_for_z(tf, poses, 'world', base=0.0, tool=2.25)
    set_parameters(tf.listener, pose_frame='slide')
    wait_for_z(tf, poses, 'slide', base=-2.25, tool=0.0)
    tf.wait_for('slide', joints.send({'lift': 0.5}))
    wait_for_z(tf, poses, 'slide', base=-2.5, tool=0.0)
    set_parameters(tf.listener, pose_frame='upper')
    wait_for_z(tf, poses, 'upper', base=-1.0, tool=1.5)


def test_joints_move_while_the_file_is_read_again(follow, file, joints, tf):
    follow(watch=False)
    slow = SlowFile(file, ARM.format(tool=1))
    tf.wait_for('slide', joints.send({'lift': 0.1}))
    slow.hold()
    reloading = asked_to_reload(tf.listener)
    with slow.opened():
        sec = joints.send({'lift': 0.25})
        assert tf.wait_for('slide', sec).translation.z == 1.25
        assert pose_of(tf, 'tool').x == 1.0
        slow.write(ARM.format(tool=3))
    assert tf.listener.response(reloading).success
    assert (pose_of(tf, 'tool').x, pose_of(tf, 'tool').z) == (3.0, 2.25)
    assert tf.wait_for('slide', joints.send({'lift': 0.5})).translation.z == 1.5


def test_the_rate_can_be_set_while_joints_move(follow, joints, tf):
    follow(publish_rate=0.1)
    tf.wait_for('slide', joints.send({'lift': 0.1}))
    for rate in (20.0, 0.0):
        set_parameters(tf.listener, publish_frequency=rate)
        # The first messages may come before the publisher knows the new subscription.
        tf.listener.wait(
            lambda rate=rate: joints.send({'lift': rate / 100})
            and tf.last['slide'].transform.translation.z == 1 + rate / 100,
            tf.last)


def test_following_can_be_switched_off_and_on(follow, joints, tf):
    follow()
    tf.wait_for('slide', joints.send({'lift': 0.1}))
    listen_to_tf(tf.listener)
    set_parameters(tf.listener, use_joint_states=False)
    tf.listener.wait(
        lambda: tf.listener.tf_messages and {
            each.child_frame_id for each in tf.listener.tf_messages[-1].transforms} >= MOVED,
        'all frames on /tf_static')
    tf.listener.wait(
        lambda: not tf.listener.node.count_subscribers('/joint_states'), 'its end')
    set_parameters(tf.listener, use_joint_states=True)
    late = listen_to_poses(tf, 'base', 'slide')
    tf.listener.wait(lambda: 'base' in late, lambda: late)
    assert 'slide' not in late, 'it was fixed when it had this pose'
    assert tf.wait_for('slide', joints.send({'lift': 0.7})).translation.z == 1.7
