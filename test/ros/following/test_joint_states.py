# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What messages of joint states put on ``/tf``: which frames, with which stamp, and how often."""

import concurrent.futures
import math
import threading

from builtin_interfaces.msg import Time
from deadline import DEADLINE_S, spin_until
from geometry_msgs.msg import TransformStamped
import pytest
from rcl_interfaces.msg import SetParametersResult
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

from sdf_pose_bridge import load_text
from sdf_pose_bridge.ros.following import joint_states, message_problems
from sdf_pose_bridge.ros.following.joint_states import JointStates
from sdf_pose_bridge.ros.following.state_topic import MOST_WAITING
from sdf_pose_bridge.ros.parameters.given import settings_from_values
from sdf_pose_bridge.ros.publishing.published_frames import PublishedFrames, TF
from sdf_pose_bridge.ros.publishing.publishers import Publishers
from sdf_pose_bridge.ros.publishing.topic_names import StateTopics
from sdf_pose_bridge.tf.joint_positions import JointPositions, UnreportedJoints
from sdf_pose_bridge.tf.lookup import PoseLookup
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
TOPICS = StateTopics({'joint_states': ''})
TWO_ARMS = '<sdf version="1.11"><world name="w">{}{}</world></sdf>'.format(*(
    ARM.partition('">')[2].replace('</sdf>', '').replace('"arm"', f'"{name}"') for name in 'ab'))
TWO_TOPICS = StateTopics({'a/j': 'a', 'b/j': 'b'})


def rule_of(frequency, *, ignore_timestamp=False):
    return settings_from_values({
        'robot_description': ARM, 'publish_frequency': frequency, 'use_joint_states': True,
        'ignore_timestamp': ignore_timestamp})


EACH = rule_of(0.0)
LATCHED = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
FIRST = 1000
"""Seconds of the first stamp of a test, after those of messages to connect."""

NOW = 10**9
"""Seconds of a time that the clock has passed."""


def frames_by_stamp(message):
    """Return the seconds of each stamp in a message for ``/tf``, and the frames that have it."""
    frames = {}
    for each in message.transforms:
        frames.setdefault(each.header.stamp.sec, set()).add(each.child_frame_id)
    return sorted(frames.items())


class Following:
    """A node that follows joint states, and one that sends them and listens to ``/tf``."""

    def __init__(self, node, listener, executor, beside):
        self.node, self.listener, self._executor = node, listener, executor
        self._beside = beside
        self._publishers = Publishers(node)
        self._senders = {}
        self.states = self.frames = None
        self.found = []
        """What each message on ``/tf`` has, as :func:`frames_by_stamp` returns it."""
        self._tf = listener.create_subscription(
            TFMessage, '/tf', lambda message: self.found.append(frames_by_stamp(message)), 1000)
        self._clock = None

    def start(self, text=ARM, unreported=UnreportedJoints.NONE, topics=TOPICS, rule=EACH):
        self.frames = self.frames_of(text, unreported)
        self.states = self._beside(
            self._executor, JointStates, self.node, self.frames, self.lookup, topics, rule)

    def follow(self, frames, topics, rule):
        self._beside(self._executor, self.states.follow, frames, self.lookup, topics, rule)

    def frames_of(self, text=ARM, unreported=UnreportedJoints.NONE):
        scene = load_text(text)
        tree = tf_tree_from_scene(scene, TfOptions(use_joint_states=True))
        positions = JointPositions(scene, tree.moving.motion, unreported=unreported)
        self.lookup = PoseLookup(scene, tree, positions)
        frames = PublishedFrames(self._publishers, tree, positions, {}).moving
        self._publishers.opened(frames.transforms_topic)
        return frames

    def connect(self, topic='/joint_states', joints=('turn',)):
        """Send positions of joints, and wait until they are published."""
        sender = self._senders[topic] = self.listener.create_publisher(JointState, topic, 1000)
        subscription = next(
            each for each in self.node.subscriptions if each.topic_name == topic)
        tf = self._publishers.existing(TF)
        # The other side may not know an end that knows the other side.
        self.wait(lambda: all(each.get_subscription_count() for each in (sender, tf)) and all(
            each.get_publisher_count() for each in (subscription, self._tf)))
        self.send(1, dict.fromkeys(joints, 0.0), topic)
        self.wait(lambda: 1 in self.secs())
        # All frames are published once more.
        self.wait(lambda: self.states._publish_all not in self.states._due)
        self.found.clear()

    def set_time(self, sec):
        """Set the simulated time."""
        if self._clock is None:
            self.node.set_parameters([Parameter('use_sim_time', value=True)])
            self._clock = self.listener.create_publisher(Clock, '/clock', 1)

        def is_set():
            self._clock.publish(Clock(clock=Time(sec=sec)))
            return self.node.get_clock().now().nanoseconds == sec * NOW

        self.wait(is_set)

    def send(self, sec, positions, topic='/joint_states'):
        self._senders[topic].publish(JointState(
            header=Header(stamp=Time(sec=sec)), name=list(positions),
            position=list(positions.values())))

    def hold_with_a_message(self):
        """Have the thread wait while messages arrive; return what lets it go on."""
        begins, goes_on, arrived = threading.Event(), threading.Event(), []
        other = self.listener.create_subscription(JointState, '/joint_states', arrived.append, 10)
        self.wait(lambda: other.get_publisher_count())
        self.states._call(lambda: [begins.set(), goes_on.wait(DEADLINE_S)])
        self.wait(begins.is_set)

        def has_arrived():
            self.send(FIRST, {'turn': 0.5})
            return arrived

        self.wait(has_arrived)
        return goes_on.set

    def secs(self):
        """Return the seconds of all stamps on ``/tf``."""
        return [sec for message in self.found for sec, _ in message]

    def published(self, *messages):
        """Send messages, the last of which is published, and return what they put on ``/tf``."""
        for message in messages:
            self.send(*message)
        self.wait(lambda: messages[-1][0] in self.secs())
        # All frames may be published once more after those of the messages to connect.
        return [each for message in self.found for each in message if FIRST // 2 < each[0] < NOW]

    def wait(self, condition):
        """Run callbacks until a condition is true."""
        spin_until(self._executor, condition, self.found)

    def wait_until_taken(self, position):
        """Wait until the thread has taken the message that has a position."""
        self.wait(lambda: position in self.frames.positions.values)


@pytest.fixture
def following(make_node, make_executor, beside):
    node, listener = make_node('bridge'), make_node('listener')
    found = Following(node, listener, make_executor(node, listener), beside)
    yield found
    found.states.end()


@pytest.fixture
def arm(following):
    """Return an arm that is connected, all joints of which are known."""
    following.start(unreported=UnreportedJoints.ZERO)
    following.connect(joints=('turn', 'lift', 'grip'))
    return following


SLOW = rule_of(0.001)
"""A highest rate with periods of 1000 seconds."""

START = 10_000
"""Seconds of simulated time when the first of these periods begins."""


@pytest.fixture
def slow_arm(following):
    """Return an arm in the first of these periods of simulated time."""
    following.set_time(START)
    following.start(rule=SLOW)
    following.connect()
    return following


def test_a_transform_is_published_if_it_is_newer_than_the_last_one(arm):
    sent = [(FIRST + after, {'turn': 0.5}) for after in (0, 1, -100, 1, 2)]
    assert arm.published(*sent) == [
        (FIRST, {'upper'}), (FIRST + 1, {'upper'}), (FIRST + 2, {'upper'})]


def test_each_transform_has_its_own_last_stamp(arm):
    assert arm.published(
        (FIRST + 5, {'turn': 0.5}), (FIRST + 4, {'turn': 0.25, 'lift': 0.25}),
        (FIRST + 6, {'turn': 0.5}),
    ) == [(FIRST + 5, {'upper'}), (FIRST + 4, {'slide'}), (FIRST + 6, {'upper'})]


def test_each_message_can_be_published_whatever_its_stamp_is(following):
    following.start(rule=rule_of(20.0, ignore_timestamp=True))
    following.connect()
    sent = [(FIRST + after, {'turn': 0.5}) for after in (0, 0, -100, 2)]
    assert [sec - FIRST for sec, _ in following.published(*sent)] == [0, 0, -100, 2]


def test_after_simulated_time_has_jumped_back_older_stamps_are_published(following):
    following.set_time(5000)
    following.start()
    following.connect()
    following.published((FIRST + 4, {'turn': 0.5}))
    following.set_time(FIRST)
    following.found.clear()
    # The first one was sent before that, and waited.
    assert following.published((FIRST + 5, {'turn': 0.5}), (FIRST - 1, {'turn': 0.25})) == [
        (FIRST - 1, {'upper'})]


def test_joints_at_zero_are_published_with_each_message(following):
    following.start(unreported=UnreportedJoints.ZERO)
    following.connect()
    assert following.published((FIRST, {'lift': 0.5})) == [(FIRST, {'slide', 'finger'})]


def test_a_joint_that_no_message_has_named_moves_nothing(following):
    following.start()
    following.connect()
    assert following.published(
        (FIRST - 1, {'none': 0.5}), (FIRST, {'lift': math.nan, 'turn': 0.5}),
        (FIRST + 1, {'lift': 0.5}), (FIRST + 2, {'lift': 0.5, 'turn': 0.5}),
    ) == [(FIRST, {'upper'}), (FIRST + 1, {'slide'}), (FIRST + 2, {'upper', 'slide'})]
    assert not following.states.report().failures


def test_a_message_that_is_processed_ends_a_series_of_failures(arm):
    arm.states._failures._since = 0.0
    arm.send(FIRST, {'turn': 0.5})
    arm.wait(lambda: arm.states._failures._since == math.inf)


def test_joints_that_stay_unreported_are_counted_once_and_then_that_none_is(following, capfd):
    following.start()
    following.connect()
    following.wait(lambda: following.states.report().joints)
    assert following.states.report()[:3] == (['grip', 'lift'], [], ['/joint_states'])
    following.published((FIRST, {'lift': 0.0, 'grip': 0.0}), (FIRST + 1, {'turn': 0.0}))
    assert following.states.report().joints == []
    log = capfd.readouterr().err
    assert log.count('no message has named 2 joints yet, for example "grip"') == 1
    assert log.count('all joints have been reported now') == 1


def test_stamps_that_go_back_are_reported_once_and_until_a_joint_of_them_moves_again(arm, capfd):
    arm.published((FIRST + 100, {'turn': 0.5}))

    def is_late():
        # Messages with one of the names go on.
        nonlocal sec
        sec += 1
        arm.send(FIRST + 50, {'turn': 0.1, 'lift': 0.1})
        arm.send(sec, {'lift': 0.1})
        return arm.states.report().problems

    sec = FIRST + 100
    arm.wait(is_late)
    line = (
        'messages from /joint_states move nothing, for example "turn": their stamps are 50.000 s '
        'older than the last one;')
    arm.send(FIRST, {'turn': 0.1})
    arm.published((sec + 1, {'lift': 0.1}))
    assert arm.states.report().problems[0].startswith(line)
    sec += 1
    arm.published((sec + 1, {'turn': 0.5, 'grip': 0.5}))
    assert arm.states.report().problems == []
    assert capfd.readouterr().err.count(line) == 1


@pytest.mark.parametrize(('rule', 'newer', 'older'), [
    (EACH, 1, 0), (EACH, 0, 0), (rule_of(0.0, ignore_timestamp=True), 0, -5)],
    ids=['two publishers', 'a pause', 'ignored'])
def test_stamps_that_do_not_stop_a_frame_are_not_reported(
        following, monkeypatch, rule, newer, older):
    monkeypatch.setattr(message_problems, 'LATE_S', 0.0)
    following.start(rule=rule)
    following.connect()
    following.published((FIRST, {'turn': 0.5}))
    sec = FIRST
    for _ in range(9):
        sec += newer
        following.send(sec, {'turn': 0.5, 'lift': 0.5} if newer else {'turn': 0.5})
        following.send(sec - newer + older, {'turn': 0.5})
    following.published((sec, {'turn': 0.25}), (sec + 1, {'grip': 0.75}))
    assert not following.states.report().problems


def test_a_message_without_a_stamp_gets_the_time_of_the_node(arm):
    arm.send(0, {'turn': 0.5})
    arm.wait(lambda: any(sec > NOW for sec in arm.secs()))


def test_other_frames_continue_with_the_positions_and_one_nanosecond_later(arm):
    arm.published((FIRST, {'turn': 0.5, 'lift': 0.5, 'grip': 0.5}))
    frames = arm.frames_of(ARM.replace('type="revolute"', 'type="fixed"'))
    arm.found.clear()
    arm.follow(frames, TOPICS, EACH)
    assert dict(zip(frames.positions.names, frames.positions.values, strict=True)) == {
        'lift': 0.5, 'grip': 0.5}
    arm.wait(lambda: arm.found)
    assert arm.published((FIRST + 1, {'turn': 0.5, 'lift': 0.5})) == [
        (FIRST, {'slide', 'finger'}), (FIRST + 1, {'slide'})]


def test_a_look_up_sees_the_messages_that_came_before_it(arm):
    seen, go_on = [], arm.hold_with_a_message()
    future = arm.states.current_lookup()
    future.add_done_callback(lambda _: seen.extend(arm.frames.positions.values))
    assert not future.done()
    go_on()
    arm.wait(lambda: seen)
    assert 0.5 in seen


def test_a_message_that_waits_on_a_topic_that_is_followed_no_longer_moves_nothing(arm):
    go_on, wait = arm.hold_with_a_message(), arm.states.wait
    arm.states.wait = lambda: [go_on(), wait()]
    arm.follow(arm.frames, StateTopics({'other': ''}), EACH)
    assert 0.5 not in arm.frames.positions.values


def test_a_thread_that_does_not_answer_is_an_error(arm, monkeypatch):
    goes_on = threading.Event()
    arm.states._call(goes_on.wait)
    monkeypatch.setattr(joint_states, 'LONGEST_ANSWER_S', 0.0)
    with pytest.raises(concurrent.futures.TimeoutError):
        arm.states.wait()
    goes_on.set()


def test_nothing_of_the_frames_before_is_published_once_others_are_followed(arm):
    begins, goes_on, published, before = threading.Event(), threading.Event(), [], arm.frames
    wait = arm.states.wait

    def publish_slowly(rows):
        begins.set()
        goes_on.wait(DEADLINE_S)
        published.append(rows)

    def go_on_and_wait():
        goes_on.set()
        wait()

    before.publish_tf, arm.states.wait = publish_slowly, go_on_and_wait
    arm.send(FIRST, {'turn': 0.5})
    arm.wait(begins.is_set)
    arm.follow(arm.frames_of(), TOPICS, EACH)
    count = len(published)
    goes_on.set()
    arm.send(FIRST + 1, {'turn': 0.5})
    arm.wait(lambda: FIRST + 1 in arm.secs())
    assert len(published) == count == 1


def test_subscriptions_are_made_and_destroyed_by_the_executor(following):
    threads = set()

    def remember(_parameters):
        threads.add(threading.current_thread())
        return SetParametersResult(successful=True)

    following.node.add_on_set_parameters_callback(remember)
    following.start()
    assert threads == {threading.current_thread()}


def test_topics_have_few_of_many_messages_and_the_last_one_again_at_rest(arm, monkeypatch):
    secs = []
    arm.listener.create_subscription(
        TransformStamped, '/bridge/transforms',
        lambda each: each.child_frame_id == 'upper' and secs.append(each.header.stamp.sec),
        LATCHED)
    arm.wait(lambda: secs)
    for name in ('TOPICS_PERIOD_S', '_REST_S'):
        monkeypatch.setattr(joint_states, name, 1e9)
    arm.published(*((FIRST + number, {'turn': 0.5}) for number in range(200)))
    arm.wait(lambda: secs[-1] >= FIRST)
    monkeypatch.setattr(joint_states, '_REST_S', 0.0)
    arm.send(FIRST + 200, {'turn': 0.5})
    arm.wait(lambda: secs[-1] == FIRST + 200)
    # The first one, perhaps one for the rest before, and the last one.
    assert sum(each >= FIRST for each in secs) <= 3


def test_what_was_created_for_it_is_destroyed_with_it(following):
    following.start(rule=rule_of(20.0))
    following.states.end()
    assert not list(following.node.subscriptions)
    assert not following.states._thread.is_alive()


def test_it_ends_with_the_node(following):
    following.start()
    following.node.destroy_node()
    following.states._wait_set.wake()
    following.states._thread.join(DEADLINE_S)
    assert not following.states._thread.is_alive()


# A highest rate

def test_of_a_period_the_newest_stamp_counts(slow_arm):
    for after, position in ((1, 0.1), (2, 0.2), (4, 0.4), (3, 0.3)):
        slow_arm.send(FIRST + after, {'turn': position})
    slow_arm.send(FIRST + 2, {'grip': 0.5})
    slow_arm.wait_until_taken(0.5)
    assert not slow_arm.found
    slow_arm.set_time(START + 1001)
    slow_arm.wait(lambda: slow_arm.found)
    assert slow_arm.found == [[(FIRST + 2, {'finger'}), (FIRST + 4, {'upper'})]]
    assert sorted(slow_arm.frames.positions.values) == [0.0, 0.4, 0.5]


def test_what_waits_when_simulated_time_jumps_back_is_not_published(slow_arm):
    slow_arm.send(FIRST, {'turn': 0.5})
    slow_arm.wait_until_taken(0.5)
    slow_arm.set_time(FIRST - 1)
    slow_arm.states.wait()
    assert slow_arm.published((FIRST - 2, {'turn': 0.25})) == [(FIRST - 2, {'upper'})]


def test_what_waits_when_other_frames_are_followed_is_not_published(slow_arm, capfd):
    slow_arm.send(FIRST, {'turn': 0.5, 'lift': 0.5, 'grip': 0.5})
    slow_arm.wait_until_taken(0.5)
    fewer = slow_arm.frames_of(ARM.replace('prismatic', 'fixed'))
    slow_arm.follow(fewer, TOPICS, SLOW)
    assert not slow_arm.states.report().failures
    assert 'Traceback' not in capfd.readouterr().err


def test_a_message_after_a_period_without_any_is_published_at_once(slow_arm):
    for number in (1, 2):
        slow_arm.set_time(START + 1001 * number)
        assert slow_arm.published((FIRST + number, {'turn': 0.5}))


def test_positions_can_be_taken_before_the_end_of_a_period(following, finish, monkeypatch):
    monkeypatch.setattr(joint_states, '_LONGEST_SLEEP_S', DEADLINE_S)
    following.start(rule=SLOW)
    following.connect()
    following.send(FIRST, {'turn': 0.5})

    async def current_lookup():
        return await following.states.current_lookup()

    def is_taken():
        assert finish(following._executor, current_lookup) is following.lookup
        return 0.5 in following.frames.positions.values

    following.wait(is_taken)
    assert not following.found


def test_more_messages_than_a_subscription_holds_are_taken_in_a_long_period(slow_arm):
    slow_arm.send(FIRST, {'grip': 0.5})
    for number in range(1, 2 * MOST_WAITING):
        slow_arm.send(FIRST + number, {'turn': number / 1000})
        if number % (MOST_WAITING // 2) == 0:
            slow_arm.wait_until_taken(number / 1000)
    assert not slow_arm.found
    slow_arm.set_time(START + 1001)
    slow_arm.wait(lambda: FIRST in slow_arm.secs())


def test_simulated_time_that_has_not_begun_holds_nothing_up(following):
    following.node.set_parameters([Parameter('use_sim_time', value=True)])
    following.start(rule=SLOW)
    following.connect()
    assert following.published((FIRST, {'turn': 0.5}), (FIRST + 1, {'turn': 0.5}))


# Several topics

@pytest.fixture
def two_arms(following):
    """Return two arms, each with its topic, when no period of :data:`SLOW` has begun."""
    following.set_time(START)
    following.start(TWO_ARMS, topics=TWO_TOPICS)
    for topic in ('/a/j', '/b/j'):
        following.connect(topic)
    following.follow(following.frames, TWO_TOPICS, SLOW)
    return following


def test_a_bag_that_begins_again_without_a_clock_is_one_line_with_a_cure(following, capfd):
    following.node.set_parameters([Parameter('use_sim_time', value=True)])
    following.start(TWO_ARMS, topics=TWO_TOPICS)
    for topic in ('/a/j', '/b/j'):
        following.connect(topic)
        following.published((FIRST + 100, {'turn': 0.5}, topic))

    def is_late(*topics):
        for topic in topics:
            following.send(FIRST, {'turn': 0.1}, topic)
        return following.states.report().problems

    following.wait(lambda: is_late('/a/j', '/b/j'))
    following.published((FIRST + 200, {'turn': 0.5}, '/a/j'))
    following.wait(lambda: is_late('/b/j'))
    line, = following.states.report().problems
    assert 'play the bag with "ros2 bag play --clock"' in line
    assert capfd.readouterr().err.count('messages move nothing') == 1


def test_what_waits_at_the_end_of_a_period_is_one_message_with_the_stamp_of_each(two_arms):
    two_arms.published((FIRST, {'turn': 0.5}, '/a/j'))
    for number in range(1, 20):
        two_arms.send(FIRST + number, {'turn': 0.25 if number == 19 else 0.5}, '/a/j')
        two_arms.send(FIRST + 100 + number, {'turn': 0.75 if number == 19 else 0.5}, '/b/j')
    two_arms.wait_until_taken(0.25)
    two_arms.wait_until_taken(0.75)
    two_arms.set_time(START + 1001)
    two_arms.wait(lambda: len(two_arms.found) > 1)
    assert two_arms.found == [
        [(FIRST, {'a/upper'})], [(FIRST + 19, {'a/upper'}), (FIRST + 119, {'b/upper'})]]


def test_robots_that_start_together_share_a_message(two_arms):
    two_arms.published((FIRST, {'turn': 0.5}, '/a/j'))
    two_arms.send(FIRST, {'turn': 0.75}, '/b/j')
    two_arms.wait_until_taken(0.75)
    assert two_arms.found == [[(FIRST, {'a/upper'})]]
    two_arms.set_time(START + 1001)
    two_arms.wait(lambda: len(two_arms.found) == 2)


def test_the_first_message_of_a_robot_after_a_silence_does_not_wait(two_arms):
    two_arms.published((FIRST, {'turn': 0.5}, '/a/j'))
    # A topic is silent after two periods without a message.
    for number in (1, 2):
        two_arms.send(FIRST + number, {'turn': number / 10}, '/a/j')
        two_arms.wait_until_taken(number / 10)
        two_arms.set_time(START + 1001 * number)
        two_arms.wait(lambda number=number: FIRST + number in two_arms.secs())
    two_arms.send(FIRST + 3, {'turn': 0.4}, '/a/j')
    two_arms.send(FIRST, {'turn': 0.5}, '/b/j')
    two_arms.wait(lambda: [(FIRST, {'b/upper'})] in two_arms.found)
    assert FIRST + 3 not in two_arms.secs()


def test_with_short_periods_a_robot_is_silent_after_more_than_a_second(two_arms):
    def send_and_wait(number, *topics):
        for topic in topics:
            two_arms.send(FIRST + number, {'turn': number / 10}, topic)
        two_arms.wait(lambda: two_arms.frames.positions.values.tolist().count(number / 10) == len(
            topics))

    two_arms.follow(two_arms.frames, TWO_TOPICS, rule_of(1000.0))
    two_arms.published((FIRST, {'turn': 0.5}, '/a/j'))
    for number, sec, topics in ((1, 1, ['/a/j']), (2, 2, ['/a/j', '/b/j']), (3, 4, ['/a/j'])):
        send_and_wait(number, *topics)
        two_arms.set_time(START + sec)
        two_arms.wait(lambda number=number: FIRST + number in two_arms.secs())
    two_arms.send(FIRST + 4, {'turn': 0.4}, '/b/j')
    two_arms.wait(lambda: FIRST + 4 in two_arms.secs())
    assert two_arms.found == [
        [(FIRST, {'a/upper'})], [(FIRST + 1, {'a/upper'})], [(FIRST + 2, {'a/upper', 'b/upper'})],
        [(FIRST + 3, {'a/upper'})], [(FIRST + 4, {'b/upper'})]]


def test_too_many_messages_of_one_robot_leave_time_for_another(two_arms):
    topic = next(each for each in two_arms.states.sources.sources if each.model == 'a')
    take = topic.take
    # As if messages came faster than they are taken.
    topic.take = lambda *arguments: take(*arguments) or True
    two_arms.send(FIRST, {'turn': 0.5}, '/a/j')
    two_arms.send(FIRST, {'turn': 0.75}, '/b/j')
    two_arms.wait_until_taken(0.75)


def test_an_unreported_joint_is_named_with_the_topics_that_can_name_it(following):
    following.start(TWO_ARMS, topics=TWO_TOPICS)
    following.wait(lambda: following.states.report().joints)
    report = following.states.report()
    assert (len(report.joints), report.joints[0], report.topics) == (6, 'a/turn', ['/a/j'])


def test_topics_come_and_go_with_the_frames(following):
    following.start(TWO_ARMS, topics=StateTopics({'joint_states': '', 'a/j': 'a'}))

    def subscriptions():
        return {each.topic_name: each for each in following.node.subscriptions}

    def subscribed(topics):
        following.follow(following.frames, StateTopics(topics), EACH)
        following.wait(lambda: len(subscriptions()) == len(topics))
        return subscriptions()

    before = subscribed({'joint_states': '', 'a/j': 'a'})
    after = subscribed({'joint_states': '', 'a/j': 'a', 'b/j': 'b'})
    assert after.keys() == {'/joint_states', '/a/j', '/b/j'}
    assert after.items() > before.items()
    assert subscribed({'b/j': 'b'}).keys() == {'/b/j'}
    following.connect('/b/j')


@pytest.mark.parametrize(('topics', 'line'), [
    (['joint_states'], 'following /joint_states\n'),
    (['joint_states', 'a/j', 'b/j'],
     'following 3 sources; the first message is on /joint_states\n'),
])
def test_topics_that_are_followed_have_one_line(following, capfd, topics, line):
    following.start(ARM, topics=StateTopics(dict.fromkeys(topics, '')))
    following.connect()
    log = capfd.readouterr().err
    assert line in log
    assert log.count('following') == 1


def test_a_topic_that_cannot_be_made_is_reported_and_the_others_are_made(following, capfd):
    topics = StateTopics({'{nowhere}/j': 'a', 'b/j': 'b'}, warnings=('a warning',))
    following.start(TWO_ARMS, topics=topics)
    following.follow(following.frames, topics, EACH)
    assert [each.topic_name for each in following.node.subscriptions] == ['/b/j']
    log = capfd.readouterr().err
    assert 'no messages from {nowhere}/j: ' in log
    assert log.count('a warning') == 1
