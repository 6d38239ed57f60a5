# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A bridge that follows the joint states of several robots of a world, each on its own topic."""

from math import cos, isclose, sin

from changes import BRIDGE, pose_of, reason_for_refusal, reload, replace, set_parameters
import pytest

ROBOT = """<sdf version="1.11"><model name="robot">
<link name="base"/><link name="arm"><pose>1 0 0 0 0 0</pose></link>
<joint name="turn" type="revolute"><parent>base</parent><child>arm</child>
  <axis><xyz>0 0 1</xyz></axis></joint>
<joint name="lift" type="prismatic"><parent>arm</parent>
  <child>hand</child><axis><xyz>0 0 1</xyz></axis></joint>
<link name="hand"><pose>2 0 0 0 0 0</pose></link>
</model></sdf>"""
INCLUDE = (
    '<include><uri>robot.sdf</uri><name>{name}</name><pose>{x} 0 0 0 0 0</pose></include>')
FENCE = '<model name="fence"><static>true</static><link name="post"/></model>'


def fleet(**robots):
    """Write a world with robots at some x, and with a model that does not move."""
    includes = ''.join(INCLUDE.format(name=name, x=x) for name, x in robots.items())
    return f'<sdf version="1.11"><world name="shop">{includes}{FENCE}</world></sdf>'


@pytest.fixture
def file(tmp_path):
    (tmp_path / 'robot.sdf').write_text(ROBOT)
    path = tmp_path / 'shop.sdf'
    path.write_text(fleet(r1=10, r2=20, r3=30))
    return path


def joint_topics(tf):
    """Return the topics of joint states that the bridge follows."""
    subscribed = tf.listener.names_and_types('subscriber', BRIDGE)
    return {
        name for name, types in subscribed.items() if types == ['sensor_msgs/msg/JointState']}


def wait_for_topics(tf, *topics):
    tf.listener.wait(lambda: joint_topics(tf) == set(topics), lambda: joint_topics(tf))


def move(joints, tf, topic, robot, turn, lift):
    """Send positions until the frames of a robot have the stamp of the message."""
    stamps = set()

    def has_moved():
        # The first messages are lost, until the bridge has discovered the publisher.
        stamps.add(joints.send({'turn': turn, 'lift': lift}, topic=topic))
        found = [tf.last.get(f'{robot}/{link}') for link in ('arm', 'hand')]
        return all(each is not None and each.header.stamp.sec in stamps for each in found)

    tf.listener.wait(has_moved, tf.last)


def check_poses(tf, **robots):
    """Compare poses in the world with x of the base and the positions of the joints."""
    for robot, (x, turn, lift) in robots.items():
        hand = pose_of(tf, f'{robot}::hand')
        wanted = (x + 1 + cos(turn), sin(turn), lift)
        assert all(map(isclose, (hand.x, hand.y, hand.z), wanted)), (robot, hand)
        arm = tf.last[f'{robot}/arm'].transform
        assert isclose(arm.rotation.z, sin(turn / 2))
        assert tf.last[f'{robot}/hand'].transform.translation.z == lift


def test_each_robot_follows_its_own_topic_also_after_a_reload(bridge, file, joints, tf):
    set_parameters(tf.listener, use_joint_states=True, publish_frequency=20.0)
    wait_for_topics(
        tf, '/joint_states', '/r1/joint_states', '/r2/joint_states', '/r3/joint_states')
    for number in (1, 2, 3):
        move(joints, tf, f'r{number}/joint_states', f'r{number}', 0.1 * number, 0.5 * number)
    check_poses(tf, r1=(10, 0.1, 0.5), r2=(20, 0.2, 1.0), r3=(30, 0.3, 1.5))
    replace(file, fleet(r1=10, r3=30, r4=40, r5=50))
    wait_for_topics(
        tf, '/joint_states', '/r1/joint_states', '/r3/joint_states', '/r4/joint_states',
        '/r5/joint_states')
    move(joints, tf, 'r4/joint_states', 'r4', 0.4, 2.0)
    move(joints, tf, 'r5/joint_states', 'r5', 0.5, 2.5)
    move(joints, tf, 'r1/joint_states', 'r1', 0.6, 3.0)
    check_poses(
        tf, r1=(10, 0.6, 3.0), r3=(30, 0.3, 1.5), r4=(40, 0.4, 2.0), r5=(50, 0.5, 2.5))


def test_topics_of_gazebo_can_be_followed_and_changed(bridge, joints, tf):
    set_parameters(
        tf.listener, use_joint_states=True, model='r2',
        joint_states_topics=['/world/{world}/model/{model}/joint_state'])
    wait_for_topics(tf, '/world/shop/model/r2/joint_state')
    move(joints, tf, '/world/shop/model/r2/joint_state', 'r2', 0.5, 0.25)
    check_poses(tf, r2=(20, 0.5, 0.25))
    set_parameters(tf.listener, joint_states_topics=['{model}/j', 'j'])
    wait_for_topics(tf, '/j', '/r2/j')
    move(joints, tf, 'r2/j', 'r2', 0.75, 0.25)


def test_robot_state_publisher_has_the_one_topic_in_a_world_too(
        start_bridge, file, tf):
    start_bridge(
        '--ros-args', '-r', f'__node:={BRIDGE[1:]}', program='robot_state_publisher', sdf_file=file
    ).wait_until_started()
    wait_for_topics(tf, '/joint_states')


def test_topics_that_become_one_are_reported_and_lose_nothing(start_bridge, file, joints, tf):
    bridge = start_bridge(
        '--ros-args', '-r', 'r1/joint_states:=/both', '-r', 'r2/joint_states:=/both',
        sdf_file=file, use_joint_states=True).wait_until_started()
    wait_for_topics(tf, '/joint_states', '/both', '/r3/joint_states')
    bridge.wait_for_line(
        'joint_states_topics has /both for "r1", "r2", so messages on it can be about all '
        'models')
    stamps = set()

    def have_moved():
        stamps.add(joints.send({'r1/turn': 0.5, 'r2/turn': 0.25}, topic='both'))
        return {'r1/arm', 'r2/arm'} <= tf.last.keys()

    tf.listener.wait(have_moved, tf.last)
    move(joints, tf, 'r3/joint_states', 'r3', 0.5, 0.5)


def test_too_many_topics_are_rejected_in_a_setting_and_in_a_file(bridge, file, tf):
    set_parameters(tf.listener, use_joint_states=True, watch=False)
    patterns = [f'{{model}}/j{number}' for number in range(400)]
    assert reason_for_refusal(tf.listener, joint_states_topics=patterns).startswith(
        'joint_states_topics names 1200 topics with 3 models')
    # To subscribe to hundreds of topics takes long on a busy machine.
    replace(file, fleet())
    assert reload(tf.listener).success
    set_parameters(tf.listener, joint_states_topics=patterns)
    replace(file, fleet(r1=10, r2=20, r3=30))
    answer = reload(tf.listener)
    assert not answer.success
    assert answer.message.startswith('joint_states_topics names 1200 topics with 3 models')
    assert pose_of(tf, 'fence').x == 0


def test_too_many_topics_prevent_the_start(start_bridge, file):
    patterns = [f'{{model}}/j{number}' for number in range(400)]
    bridge = start_bridge(sdf_file=file, use_joint_states=True, joint_states_topics=patterns)
    assert bridge.wait_for_end() == 1
    # A busy machine, or the middleware, may have more to say.
    (line,) = [each for each in bridge.lines if each.startswith('[FATAL]')]
    assert bridge.count_of('Traceback') == 0
    assert 'joint_states_topics names 1200 topics with 3 models' in line
