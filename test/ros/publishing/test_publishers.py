# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Publishers of a real node: which are made, shared, kept and destroyed."""

from deadline import spin_until, wait_until
from geometry_msgs.msg import PoseStamped
import pytest
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

from sdf_pose_bridge.ros.publishing import publishers as publishers_module
from sdf_pose_bridge.ros.publishing.publishers import Publishers, SwitchedPublisher, Topic


@pytest.fixture(name='publishers')
def publishers_of_node(node):
    return Publishers(node)


def found_publishers(node, topic, count):
    """Wait until so many are discovered, which may be after they were made, and return them."""
    wait_until(lambda: node.count_publishers(topic) == count)
    return node.get_publishers_info_by_topic(topic)


def test_equal_topics_share_a_publisher(publishers):
    publisher = publishers.opened(Topic('~/a', PoseStamped))
    assert publishers.opened(Topic('~/a', PoseStamped)) is publisher
    assert publishers.existing(Topic('~/a', PoseStamped)) is publisher


@pytest.mark.parametrize('other', [
    Topic('~/b', PoseStamped), Topic('~/a', PoseStamped, depth=2),
    Topic('~/a', PoseStamped, is_latched=False), Topic('~/a', PoseStamped, part='b')])
def test_topics_that_differ_have_publishers_of_their_own(publishers, other):
    publisher = publishers.opened(Topic('~/a', PoseStamped))
    assert publishers.existing(other) is None
    assert publishers.opened(other) is not publisher


def test_messages_are_kept_as_the_topic_says(node, publishers):
    publishers.opened(Topic('~/a', PoseStamped, depth=7))
    publishers.opened(Topic('~/b', PoseStamped, is_latched=False))
    found = {
        name: found_publishers(node, f'/bridge/{name}', 1)[0].qos_profile for name in 'ab'}
    assert found['a'].durability is DurabilityPolicy.TRANSIENT_LOCAL
    assert found['b'].durability is DurabilityPolicy.VOLATILE


def test_a_publisher_tells_the_executor_nothing(publishers):
    assert not publishers.opened(Topic('~/a', PoseStamped)).event_handlers


def test_other_topics_are_destroyed(node, publishers):
    a, b, c = (Topic(f'~/{name}', PoseStamped) for name in 'abc')
    kept = publishers.opened(b)
    publishers.opened(a)
    publishers.opened(c)
    publishers.destroy_others([b, c])
    topics = {publisher.topic_name for publisher in node.publishers}
    assert topics - {'/rosout', '/parameter_events'} == {'/bridge/b', '/bridge/c'}
    assert publishers.existing(a) is None
    assert publishers.existing(b) is kept


def test_more_publishers_than_were_measured_cause_one_warning(
        publishers, monkeypatch, capfd):
    def replace(*topics):
        for topic in topics:
            publishers.opened(topic)
        publishers.destroy_others(topics)

    monkeypatch.setattr(publishers_module, 'MOST_PUBLISHERS', 2)
    a, b, c, d = (Topic(f'~/{name}', PoseStamped) for name in 'abcd')
    replace(a, b)
    assert 'publishers are more than' not in capfd.readouterr().err
    replace(a, b, c)
    replace(a, b, d)
    assert capfd.readouterr().err.count('3 publishers are more than 2') == 1


def test_a_publisher_that_is_switched_off_leaves_no_message(node):
    quality = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    received, sent = [], []
    node.create_subscription(
        String, 'text', lambda message: received.append(message.data), quality)
    publisher = SwitchedPublisher(node, Topic('text', String))
    for text in ('a', 'b', '', 'c'):
        publisher.switch(on=bool(text))
        publisher.publish(String(data=text))
        found_publishers(node, '/text', int(bool(text)))
        if text:
            sent.append(text)
            spin_until(
                node.executor,
                lambda: len(received) == len(sent) and publisher.has_listeners())
    assert received == sent
