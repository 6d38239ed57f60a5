# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What messages of joint states put on ``/tf``: which frames, with which stamp, and how often."""

from itertools import count
import math
import time

import numpy as np
import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from builtin_interfaces.msg import Time
from geometry_msgs.msg import TransformStamped
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

from sdf_pose_bridge import load_text
from sdf_pose_bridge.ros.joint_states import JointStates, SUBSCRIPTIONS_AT_ONCE, TOPICS_PERIOD_S
from sdf_pose_bridge.ros.published_frames import PublishedFrames
from sdf_pose_bridge.ros.publishers import Publishers
from sdf_pose_bridge.ros.topic_names import JointStateTopics
from sdf_pose_bridge.tf.joint_positions import JointPositions, UnreportedJoints
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

ARM = """<sdf version="1.11"><model name="arm">
<link name="base"/><link name="upper"/><link name="slide"/><link name="finger"/>
<joint name="turn" type="revolute"><parent>base</parent><child>upper</child>
  <axis><xyz>0 0 1</xyz></axis></joint>
<joint name="lift" type="prismatic"><parent>upper</parent><child>slide</child>
  <axis><xyz>0 0 1</xyz></axis></joint>
<joint name="grip" type="prismatic"><parent>base</parent><child>finger</child>
  <axis><xyz>1 0 0</xyz></axis></joint>
</model></sdf>"""
JOINTS = ('turn', 'lift', 'grip')
TOPICS = JointStateTopics({'joint_states': ''})
LATCHED = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
NOW = 10**9
"""Seconds of a time that the clock has passed."""


def joint_state(sec, positions):
    return JointState(
        header=Header(stamp=Time(sec=sec)), name=list(positions),
        position=list(positions.values()))


def frames_by_stamp(message):
    """Return the seconds of each stamp in a message for ``/tf``, and the frames that have it."""
    frames = {}
    for each in message.transforms:
        frames.setdefault(each.header.stamp.sec, set()).add(each.child_frame_id)
    return sorted(frames.items())


def topic_of(states, name='joint_states'):
    (topic,) = (each for key, each in states._topics.items() if key[0] == name)
    return topic


def update(states, data, name='joint_states'):
    """Have a serialized message taken, as an executor does."""
    states._receive(topic_of(states, name), data, {'source_timestamp': 0})


@pytest.fixture(name='moving_frames')
def make_moving_frames(make_node):
    """Makes frames that move; ``moving_frames(text)`` returns the node and the frames."""
    node = make_node('bridge')
    publishers = Publishers(node)

    def moving_frames(text, unreported=UnreportedJoints.ZERO):
        scene = load_text(text)
        tree = tf_tree_from_scene(scene, TfOptions(use_joint_states=True))
        positions = JointPositions(scene, tree.moving.dofs, unreported=unreported)
        frames = PublishedFrames(publishers, tree, positions, {})
        publishers.opened(frames.moving.transforms_topic)
        return node, frames.moving

    return moving_frames


@pytest.fixture(name='states')
def joint_states(moving_frames):
    return JointStates(*moving_frames(ARM), TOPICS, (0.0, False))


@pytest.fixture
def listener(make_node):
    return make_node('listener')


@pytest.fixture(name='wait_until')
def make_wait_until(listener, states, make_executor):
    """Runs both nodes until a condition is true; ``wait_until(condition, collection)``."""
    executor = make_executor(listener, states._node)

    def wait_until(condition, collection):
        deadline = time.monotonic() + 20.0
        while not condition():
            assert time.monotonic() < deadline, collection
            executor.spin_once(timeout_sec=0.1)

    return wait_until


@pytest.fixture(name='published')
def make_published(listener, wait_until, states):
    """
    Returns what messages put on ``/tf``; ``published(*messages)``.

    The last message must be published. The result has the stamp and the frames of each.
    """
    found = []

    def add(message):
        found.extend(frames_by_stamp(message))

    listener.create_subscription(TFMessage, '/tf', add, 100)
    wait_until(lambda: found, found)  # what is published before the first message

    def published(*messages):
        for message in messages:
            update(states, serialize_message(message))
        wait_until(lambda: found[-1][0] == messages[-1].header.stamp.sec, found)
        return [each for each in found if each[0] < NOW]

    return published


def test_messages_with_another_number_of_positions_are_ignored(published, capfd):
    wrong = joint_state(5, {'turn': 1.0})
    wrong.name.append('lift')
    assert [sec for sec, _ in published(wrong, wrong, joint_state(6, {'turn': 0.0}))] == [6]
    assert capfd.readouterr().err.count('has 2 names and 1 positions') == 1, 'not at a high rate'


@pytest.mark.parametrize('frequency', [0.0, 20.0])
def test_publishers_that_are_best_effort_are_heard(states, frequency):
    node = states._node
    states.destroy()
    JointStates(node, states._frames, TOPICS, (frequency, False))
    subscription, = node.subscriptions
    assert node.resolve_topic_name('joint_states') == subscription.topic_name
    assert subscription.qos_profile.reliability is ReliabilityPolicy.BEST_EFFORT


def test_a_second_message_with_one_stamp_is_not_published(published):
    messages = [joint_state(sec, {'turn': 0.5}) for sec in (5, 5, 6)]
    assert [sec for sec, _ in published(*messages)] == [5, 6]


def test_joints_that_no_message_has_named_are_published_too(published):
    assert published(joint_state(5, {'lift': 0.5})) == [(5, {'upper', 'slide', 'finger'})]


@pytest.fixture
def published_when_reported(published, states, moving_frames):
    """Does what ``published`` does, with joints that have no position before a message."""
    published(joint_state(1, dict.fromkeys(JOINTS, 0.0)))
    _, frames = moving_frames(ARM, UnreportedJoints.NONE)
    states.replace(frames, TOPICS)

    def published_since(*messages):
        return [each for each in published(*messages) if each[0] > 1]
    return published_since


def test_a_joint_that_no_message_has_named_moves_nothing(published_when_reported):
    assert published_when_reported(
        joint_state(5, {'lift': 0.5}), joint_state(6, {'turn': 0.5}),
        joint_state(7, {'lift': 0.5}),
    ) == [(5, {'slide'}), (6, {'upper'}), (7, {'slide'})]


def test_a_value_that_is_no_position_reports_no_joint(published_when_reported):
    assert published_when_reported(
        joint_state(5, {'lift': math.nan, 'turn': 0.5}),
        joint_state(6, {'lift': 1.0, 'turn': 0.5}),
    ) == [(5, {'upper'}), (6, {'upper', 'slide'})]


def test_joints_that_stay_unreported_are_named_once_and_then_that_none_is(
        states, moving_frames, wait_until, capfd):
    states.replace(moving_frames(ARM, UnreportedJoints.NONE)[1], TOPICS)
    update(states, serialize_message(joint_state(5, {'lift': 0.5})))
    assert states.unreported.names == ()
    wait_until(lambda: states.unreported.names, 'two seconds')
    assert states.unreported == (('turn', 'grip'), ('/joint_states',))
    for sec in (6, 7):
        update(states, serialize_message(joint_state(sec, dict.fromkeys(JOINTS, 0.0))))
    log = capfd.readouterr().err
    assert log.count('2 joints have not been reported yet, for example "turn"') == 1
    assert log.count('all joints have been reported now') == 1


def test_of_joints_that_are_known_those_that_move_are_published(published):
    found = published(
        joint_state(5, {'turn': 0.5}), joint_state(6, {'lift': 0.5, 'grip': 0.5}),
        joint_state(7, {'turn': 0.25}))
    assert found[-1] == (7, {'upper'})


def test_a_message_without_a_stamp_gets_the_time_of_the_node(published, states):
    published(joint_state(0, {'turn': 0.5}), joint_state(6, {'turn': 0.25}))
    update(states, serialize_message(joint_state(0, {'turn': 0.5})))
    assert (states._frames.positions.stamps_ns > NOW * NOW).all()


def test_the_same_names_can_move_other_frames_later(published, states, moving_frames):
    positions = {'turn': 0.5, 'lift': 0.5, 'grip': 0.5}
    published(joint_state(5, positions))
    _, frames = moving_frames(ARM.replace('type="revolute"', 'type="fixed"'))
    states.replace(frames, TOPICS)
    assert published(joint_state(6, positions))[-1] == (6, {'slide', 'finger'})


def test_bytes_that_align_names_mean_nothing(published, states):
    for sec, padding in (5, b'\0\0'), (6, b'ab'), (7, b'cd'):
        data = serialize_message(joint_state(sec, {'slide': 0.5, 'lift': 0.5}))
        begin = data.index(b'slide\0') + 6
        update(states, data[:begin] + padding + data[begin + 2:])
    assert len(topic_of(states)._plans) == 1, 'as each takes time'
    assert published(joint_state(8, {'lift': 0.5}))[-1] == (8, {'slide', 'upper', 'finger'})


def test_a_message_that_is_not_one_is_ignored(published, states):
    update(states, b'')
    update(states, serialize_message(joint_state(5, {'turn': 0.5}))[:30])
    assert [sec for sec, _ in published(joint_state(6, {'turn': 0.5}))] == [6]


def test_topics_have_few_of_many_messages_and_the_last_one_again_at_rest(
        listener, wait_until, states):
    stamps = []
    listener.create_subscription(
        TransformStamped, '/bridge/transforms',
        lambda each: each.child_frame_id == 'upper' and stamps.append(each.header.stamp.sec),
        LATCHED)
    # At rest, before the first message, they have the time of the node.
    wait_until(lambda: stamps, stamps)
    begin = time.monotonic()
    for sec in range(1, 201):
        update(states, serialize_message(joint_state(sec, {'turn': 0.5})))
    seconds = time.monotonic() - begin
    wait_until(lambda: stamps[-2:] == [200, 200], stamps)
    assert stamps[1] == 1
    assert len(stamps) <= 5 + seconds / TOPICS_PERIOD_S


def test_after_a_message_frames_have_its_time_alone(listener, wait_until, states):
    on_tf, on_transforms = [], []
    listener.create_subscription(
        TFMessage, '/tf', lambda each: on_tf.append(each.transforms[0].header.stamp.sec), 100)
    listener.create_subscription(
        TransformStamped, '/bridge/transforms',
        lambda each: on_transforms.append(each.header.stamp.sec), LATCHED)
    wait_until(lambda: on_tf, on_tf)
    update(states, serialize_message(joint_state(5, {'turn': 0.5})))
    # At once, and again at rest, for three frames.
    wait_until(lambda: 5 in on_tf and on_transforms.count(5) == 6, on_transforms)
    assert on_tf[on_tf.index(5):] == [5]


@pytest.mark.parametrize('frequency', [0.0, 20.0])
def test_what_was_created_for_it_is_destroyed_with_it(states, frequency):
    node = states._node
    states.destroy()
    JointStates(node, states._frames, TOPICS, (frequency, False)).destroy()
    assert [*node.timers, *node.subscriptions] == []


@pytest.fixture(name='slow_states', params=['in the subscription', 'here'])
def make_slow_states(request, monkeypatch, states, listener, wait_until):
    """
    Follows messages with a highest rate; ``slow_states(frequency)``.

    Returns it, a publisher of messages, and a list that gets the stamp and the frames of each
    message on ``/tf``. Messages wait in the subscription, or, as with a release of rclpy that has
    no such function to take them from there, where they are followed.
    """
    if request.param == 'here':
        monkeypatch.setattr(
            'sdf_pose_bridge.ros.joint_state_topic._take_message_from_subscription',
            lambda subscription: None)

    def start(frequency):
        states.destroy()
        slow, found = JointStates(
            states._node, states._frames, TOPICS, (frequency, False)), []
        publisher = listener.create_publisher(JointState, 'joint_states', 100)

        def add(message):
            found.extend(each for each in frames_by_stamp(message) if each[0] < NOW)

        listener.create_subscription(TFMessage, '/tf', add, 100)
        # The first ones are lost until both have discovered each other.
        sent = []
        wait_until(
            lambda: found or publisher.publish(
                sent.append(1) or joint_state(len(sent), dict.fromkeys(JOINTS, 0.0))), found)
        found.clear()
        return slow, publisher, found
    return start


def test_messages_wait_for_the_end_of_a_period(slow_states, wait_until):
    _, publisher, found = slow_states(2.0)
    for sec in range(NOW - 20, NOW):
        publisher.publish(joint_state(sec, {'turn': 0.5}))
    wait_until(lambda: (NOW - 1, {'upper'}) in found, found)
    assert len(found) < 10


def test_each_waiting_message_keeps_its_stamp(slow_states, wait_until):
    _, publisher, found = slow_states(2.0)
    publisher.publish(joint_state(NOW - 2, {'turn': 0.5}))
    publisher.publish(joint_state(NOW - 1, {'grip': 0.5}))
    wait_until(lambda: (NOW - 1, {'finger'}) in found, found)
    assert (NOW - 2, {'upper'}) in found


def test_a_message_after_a_period_without_any_is_published_at_once(slow_states, wait_until):
    slow, publisher, found = slow_states(50.0)
    for sec in (NOW - 2, NOW - 1):
        wait_until(lambda: topic_of(slow).is_open, 'the end of a period')
        publisher.publish(joint_state(sec, {'turn': 0.5}))
        wait_until(lambda sec=sec: found[-1:] == [(sec, {'upper'})], found)


def test_positions_can_be_taken_before_the_end_of_a_period(slow_states, wait_until):
    slow, publisher, found = slow_states(0.001)
    publisher.publish(joint_state(NOW - 1, {'turn': 0.5}))
    positions = slow._frames.positions

    def is_taken():
        slow.take_waiting()
        return 0.5 in positions.values

    wait_until(is_taken, positions.values)
    assert not found


def test_simulated_time_that_has_not_begun_holds_nothing_up(slow_states, states, wait_until):
    states._node.set_parameters([Parameter('use_sim_time', value=True)])
    _, publisher, found = slow_states(0.001)
    publisher.publish(joint_state(NOW - 1, {'turn': 0.5}))
    wait_until(lambda: (NOW - 1, {'upper'}) in found, found)


def test_a_period_is_one_of_simulated_time(slow_states, states, listener, wait_until):
    states._node.set_parameters([Parameter('use_sim_time', value=True)])
    clock = listener.create_publisher(Clock, '/clock', 1)

    def is_at(sec):
        clock.publish(Clock(clock=Time(sec=sec)))
        return states._node.get_clock().now().nanoseconds == sec * NOW

    wait_until(lambda: is_at(1000), 'the clock')
    # A period of 1000 seconds.
    slow, _, _ = slow_states(0.001)
    seconds = count(3000, 2000)
    assert not topic_of(slow).is_open

    def is_over():
        is_at(next(seconds))
        return topic_of(slow).is_open

    wait_until(is_over, 'the end of the period')


# Several topics

TWO_ARMS = '<sdf version="1.11"><world name="w">{}{}</world></sdf>'.format(*(
    ARM.partition('">')[2].replace('</sdf>', '').replace('"arm"', f'"{name}"') for name in 'ab'))
TWO_TOPICS = JointStateTopics({'a/joint_states': 'a', 'b/joint_states': 'b'})


@pytest.fixture(name='two_arms')
def make_two_arms(states, moving_frames, listener, wait_until):
    """
    Follows the topics of two arms with a highest rate; ``two_arms(frequency)``.

    Returns it, publishers of messages by the names of the arms, and a list that gets what each
    message on ``/tf`` has, as :func:`frames_by_stamp` returns it.
    """
    def start(frequency):
        states.destroy()
        both = JointStates(
            *moving_frames(TWO_ARMS, UnreportedJoints.NONE), TWO_TOPICS, (frequency, False))
        publishers = {
            name: listener.create_publisher(JointState, f'{name}/joint_states', 1000)
            for name in 'ab'}
        found = []
        listener.create_subscription(
            TFMessage, '/tf', lambda message: found.append(frames_by_stamp(message)), 100)

        sent = []

        def have_arrived(secs):
            both._end_period()
            return {frame for each in found for sec, frames in each if sec in secs
                    for frame in frames} >= {'a/upper', 'b/upper'}

        def are_connected():
            if have_arrived(range(NOW)):
                return True
            sent.append(1)
            for publisher in publishers.values():
                publisher.publish(joint_state(len(sent), {'turn': 0.0}))
            return False

        wait_until(are_connected, found)
        wait_until(lambda: have_arrived([len(sent)]), found)

        def are_silent():
            both._end_period()
            return all(
                each.silent_periods > both._silent_periods for each in both._topics.values())

        wait_until(are_silent, 'periods without messages')
        found.clear()
        return both, publishers, found
    return start


def test_what_waits_at_the_end_of_a_period_is_one_message_with_the_stamp_of_each(
        two_arms, wait_until):
    _, publishers, found = two_arms(2.0)
    for sec in range(NOW - 20, NOW):
        publishers['a'].publish(joint_state(sec, {'turn': 0.5}))
        publishers['b'].publish(joint_state(sec - 1000, {'turn': 0.5}))
    last = [(NOW - 1001, {'b/upper'}), (NOW - 1, {'a/upper'})]
    wait_until(lambda: last in found, found)
    assert len(found) < 10


def test_messages_of_one_robot_do_not_delay_those_of_another(two_arms, wait_until):
    _, publishers, found = two_arms(0.01)
    for robot in 'ab':
        publishers[robot].publish(joint_state(NOW - 1, {'turn': 0.5}))
        wait_until(lambda robot=robot: found[-1:] == [[(NOW - 1, {f'{robot}/upper'})]], found)


@pytest.fixture(name='sender')
def make_sender(two_arms, wait_until):
    """
    Follows two arms, in periods that do not end by themselves; ``sender(frequency)``.

    Returns what ``two_arms`` does, but for the publishers a function that sends a message of some
    robots and waits until they are processed; ``send(sec, robots)``.
    """
    def start(frequency):
        both, publishers, found = two_arms(frequency)
        both._period_timer.timer_period_ns = 1000 * NOW

        def send(sec, robots):
            for robot in robots:
                publishers[robot].publish(joint_state(sec, {'turn': 1.0 / sec}))
            values = both._frames.positions.values

            def are_processed():
                both.take_waiting()
                return np.count_nonzero(values == 1.0 / sec) == len(robots)

            wait_until(are_processed, values)
        return both, send, found
    return start


def test_robots_with_a_message_in_each_period_share_one_for_each(sender, wait_until):
    both, send, found = sender(20.0)
    for sec in range(10, 20):
        send(sec, 'ab')
        both._end_period()
    wait_until(lambda: found[-1:] == [[(19, {'a/upper', 'b/upper'})]], found)
    # A message at once begins a period, for each robot after the silence.
    assert len(found) <= 10 + 2


@pytest.mark.parametrize(('frequency', 'periods', 'waits'), [
    (20.0, 19, True), (20.0, 20, False), (0.1, 1, True), (0.1, 2, False)])
def test_a_message_waits_if_it_is_late_but_not_after_a_silence(sender, frequency, periods, waits):
    both, send, _ = sender(frequency)
    for sec in (10, 11):
        send(sec, 'ab')
        both._end_period()
    for sec in range(12, 12 + periods):
        send(sec, 'a')
        both._end_period()
    send(100, 'b')
    assert both._is_waiting.any() == waits


def test_robots_that_start_together_share_a_message(states, moving_frames):
    states.destroy()
    _, frames = moving_frames(TWO_ARMS, UnreportedJoints.NONE)
    both = JointStates(states._node, frames, TWO_TOPICS, (0.01, False))
    for robot in 'ab':
        update(both, serialize_message(joint_state(5, {'turn': 0.5})), f'{robot}/joint_states')
    assert both._is_waiting.sum() == 1


def test_messages_that_are_published_at_once_do_not_put_off_the_end_of_the_period(
        two_arms, wait_until):
    both, publishers, found = two_arms(0.01)
    ends_in = []
    for robot in 'ab':
        publishers[robot].publish(joint_state(NOW - 1, {'turn': 0.5}))
        wait_until(lambda robot=robot: found[-1:] == [[(NOW - 1, {f'{robot}/upper'})]], found)
        ends_in.append(both._period_timer.time_until_next_call())
    assert ends_in[1] < ends_in[0]


def test_too_many_messages_of_one_robot_leave_time_for_another(two_arms, wait_until):
    both, publishers, _ = two_arms(0.001)

    class Flooded:
        """A topic whose messages come faster than they are taken."""

        def take_one(self):
            return True

    both._topics = {'flooded': Flooded(), **both._topics}
    for topic in list(both._topics.values())[1:]:
        topic.is_open = False
    publishers['b'].publish(joint_state(NOW, {'turn': 0.75}))

    def is_taken():
        both.take_waiting()
        return 0.75 in both._frames.positions.values

    wait_until(is_taken, both._frames.positions.values)
    del both._topics['flooded']


def test_an_unreported_joint_is_named_with_the_topics_that_can_name_it(two_arms, wait_until):
    both, _, _ = two_arms(2.0)
    wait_until(lambda: both.unreported.names, 'two seconds')
    assert both.unreported == (('a/grip', 'a/lift', 'b/grip', 'b/lift'), ('/a/joint_states',))


def test_topics_come_and_go_with_the_frames(states, moving_frames):
    _, frames = moving_frames(TWO_ARMS)

    def subscribed(topics):
        states.replace(frames, JointStateTopics(topics))
        return sorted(each.topic_name for each in states._node.subscriptions)

    assert subscribed({'joint_states': '', 'a/j': 'a'}) == ['/a/j', '/joint_states']
    before = {id(each) for each in states._node.subscriptions}
    assert subscribed({'joint_states': '', 'a/j': 'a', 'b/j': 'b'}) == [
        '/a/j', '/b/j', '/joint_states']
    assert before < {id(each) for each in states._node.subscriptions}
    assert subscribed({'b/j': 'b'}) == ['/b/j']


@pytest.mark.parametrize(('topics', 'line'), [
    ({'joint_states': ''}, 'following /joint_states\n'),
    ({'joint_states': '', 'a/j': 'a', 'b/j': 'b'},
     'following 3 topics of joint states; the first message is on /joint_states\n'),
])
def test_topics_that_are_followed_have_one_line(states, moving_frames, capfd, topics, line):
    _, frames = moving_frames(TWO_ARMS)
    states.replace(frames, JointStateTopics(topics))
    for name in topics:
        update(states, serialize_message(joint_state(5, {'a/turn': 0.5})), name)
    log = capfd.readouterr().err
    assert line in log
    assert log.count('following') == 1


def test_many_topics_are_made_between_other_callbacks(states, moving_frames, wait_until):
    _, frames = moving_frames(TWO_ARMS)
    states.replace(frames, JointStateTopics({f'a_{number}': 'a' for number in range(100)}))
    subscriptions = states._node._subscriptions
    assert len(subscriptions) == SUBSCRIPTIONS_AT_ONCE
    wait_until(lambda: len(subscriptions) == 100, subscriptions)


def test_a_topic_that_cannot_be_made_is_reported_and_the_others_are_made(
        states, moving_frames, capfd):
    _, frames = moving_frames(TWO_ARMS)
    topics = JointStateTopics({'{nowhere}/j': 'a', 'b/j': 'b'}, ('a warning',))
    for _ in range(2):
        states.replace(frames, topics)
    assert [each.topic_name for each in states._node.subscriptions] == ['/b/j']
    log = capfd.readouterr().err
    assert 'no subscription to {nowhere}/j: ' in log
    assert log.count('a warning') == 1
