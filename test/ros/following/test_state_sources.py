# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The topics that a node subscribes to, and when."""

from deadline import wait_until
from geometry_msgs.msg import PointStamped, PoseStamped
from nav_msgs.msg import Odometry
import pytest
import rclpy
from rclpy.context import Context
from rclpy.qos import DurabilityPolicy, QoSProfile
from sdf_texts import world_file

from sdf_pose_bridge.export.published_scene import LoadRequest
from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.ros.following.state_sources import StateSources
from sdf_pose_bridge.ros.parameters.given import settings_from_values
from sdf_pose_bridge.ros.publishing.topic_names import StateTopics
from sdf_pose_bridge.tf.tree import TfOptions

SETTINGS = settings_from_values({'sdf_file': 'a.sdf'})
POSITIONS = loaded_scene_from_request(
    LoadRequest('', world_file(''), tf_options=TfOptions(follows_models=True))).joint_positions
TOPICS = StateTopics({'joint_states': ''}, {'a/pose': 'a', 'b/pose': 'b'})


class Sources:
    """The sources of a node, and a node that publishes."""

    def __init__(self, node, other, beside):
        self._node, self._other, self._beside = node, other, beside
        self.sources = StateSources(node, lambda topics: self.sources.close(topics), lambda: None)

    def follow(self, *arguments):
        """Call this method as the loader does."""
        return self._beside(self._node.executor, self.sources.follow, *arguments)

    def publish(self, message_type, topic='a/pose', qos=10):
        return self._other.create_publisher(message_type, topic, qos)

    def search(self):
        self.sources._find_publishers()
        self._node.executor.spin_once(timeout_sec=0.01)

    def types(self):
        return {
            each.name: each.subscription.msg_type.__name__ for each in self.sources.sources}

    def wait_for(self, **types):
        """Search until these are the types of the topics of poses."""
        expected = {'/joint_states': 'JointState', **{f'/{k}/pose': v for k, v in types.items()}}

        wait_until(lambda: self.types() == expected, self.search, self.types)


@pytest.fixture
def sources(node, make_node, beside):
    found = Sources(node, make_node('other'), beside)
    found.follow(TOPICS, SETTINGS, POSITIONS)
    yield found
    found.sources.end()


@pytest.fixture
def other_context(ros_domain):
    context = Context()
    rclpy.init(args=[], context=context, domain_id=ros_domain)
    yield context
    context.shutdown()


def test_topics_of_poses_have_the_types_of_their_publishers(sources):
    sources.wait_for()
    sources.publish(PoseStamped)
    sources.wait_for(a='PoseStamped')
    sources.publish(Odometry, 'b/pose')
    sources.wait_for(a='PoseStamped', b='Odometry')


def test_a_simulator_whose_name_is_too_long_in_the_namespace_is_told(
        make_node, make_executor, beside, capfd):
    node = make_node('bridge', '-r', f'__ns:=/{"s" * 30}')
    make_executor(node)
    sources, name = Sources(node, None, beside), 'x' * 220
    sources.follow(TOPICS, settings_from_values({
        'sdf_file': 'a.sdf', 'simulator': name, 'simulator_others': True}), POSITIONS)
    assert sources.sources.simulator is None
    assert f'no messages from {name}/get_entities_states: ' in capfd.readouterr().err
    sources.sources.end()


def test_a_latched_publisher_is_followed_by_two_subscriptions_until_there_is_a_message(
        sources, node):
    def durabilities():
        return sorted(
            each.qos_profile.durability.name for each in node.subscriptions
            if each.topic_name == '/a/pose')

    sources.publish(PoseStamped)
    sources.wait_for(a='PoseStamped')
    assert durabilities() == ['VOLATILE']
    sources.publish(PoseStamped, qos=QoSProfile(
        depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
    wait_until(lambda: durabilities() == ['TRANSIENT_LOCAL', 'VOLATILE'], sources.search)
    assert len([*sources.sources.sources]) == 3
    unwanted = sources.follow(StateTopics({'joint_states': ''}, {}), SETTINGS, POSITIONS)
    assert len(unwanted) == 2


def test_a_topic_that_changes_its_type_is_followed_anew(sources, node, other_context):
    # A process has one type for a topic.
    first, second = (rclpy.create_node(name, context=other_context) for name in 'pq')
    first.create_publisher(PoseStamped, '/a/pose', 10)
    sources.wait_for(a='PoseStamped')
    first.destroy_node()
    second.create_publisher(Odometry, '/a/pose', 10)
    sources.wait_for(a='Odometry')
    topics = [each.topic_name for each in node.subscriptions]
    assert sorted(topics) == ['/a/pose', '/joint_states']


@pytest.mark.parametrize(('types', 'words'), [
    ([PointStamped], '/a/pose has messages of "geometry_msgs/msg/PointStamped"; topics'),
    ([Odometry, PoseStamped], 'of "geometry_msgs/msg/PoseStamped", "nav_msgs/msg/Odometry"; top'),
])
def test_other_types_and_several_are_reported_once(
        sources, node, other_context, capfd, types, words):
    # A process has one type for a topic.
    sources.publish(types[0])
    third = rclpy.create_node('third', context=other_context)
    for each in types[1:]:
        third.create_publisher(each, '/a/pose', 10)
    wait_until(lambda: node.count_publishers('/a/pose') == len(types))
    sources.publish(PoseStamped, 'b/pose')
    sources.wait_for(b='PoseStamped')
    sources.sources._find_publishers()
    assert capfd.readouterr().err.count(words) == 1


def test_topics_that_are_no_longer_wanted_are_returned(sources, node):
    sources.publish(PoseStamped)
    sources.wait_for(a='PoseStamped')
    # The topic is for another model now, and then for none.
    for wanted, types in (({'a/pose': 'b'}, {'a': 'PoseStamped'}), ({}, {})):
        unwanted = sources.follow(StateTopics({'joint_states': ''}, wanted), SETTINGS, POSITIONS)
        assert [each.name for each in unwanted] == ['/a/pose']
        for each in unwanted:
            node.destroy_subscription(each.subscription)
        sources.wait_for(**types)


def test_another_simulator_replaces_the_one_before(sources, node):
    pytest.importorskip('simulation_interfaces', reason='needs simulation_interfaces')
    for name in ('one', 'two', ''):
        settings = settings_from_values({
            'sdf_file': 'a.sdf', 'simulator': name, 'simulator_others': bool(name)})
        sources.follow(StateTopics({}), settings, POSITIONS)
        names = [each.name for each in sources.sources.sources]
        assert names == [f'/{name}/get_entities_states'] * bool(name)
        assert len([*node.clients]) == 2 * len(names)


def test_warnings_are_repeated_only_if_they_change(sources, capfd):
    for warnings in (('one',), ('one',), ('two',)):
        sources.follow(TOPICS._replace(warnings=warnings), SETTINGS, POSITIONS)
    log = capfd.readouterr().err
    assert (log.count('one'), log.count('two')) == (1, 1)
