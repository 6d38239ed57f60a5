# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Frames published by a real node: which topics there are, and which publishers stay."""

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from rclpy.executors import SingleThreadedExecutor
from tf_checks import tree_of

from sdf_pose_bridge.ros.published_frames import PublishedFrames
from sdf_pose_bridge.ros.publishers import Publishers

OTHERS = {'/tf_static', '/bridge/transforms'}
WORLD = '<sdf version="1.10"><world name="w">{}</world></sdf>'


def tree_of_frames(*names):
    return tree_of(WORLD.format(''.join(f'<frame name="{name}"/>' for name in names)))


@pytest.fixture(name='node')
def spinnable_node(make_node):
    node = make_node('bridge')
    executor = SingleThreadedExecutor(context=node.context)
    executor.add_node(node)
    yield node
    executor.shutdown()


@pytest.fixture(name='publish')
def make_publish(node):
    """Publishes frames and pose topics; ``publish(names, topics)``."""
    publishers = Publishers(node)

    def publish(names, topics=()):
        frames = PublishedFrames(
            publishers, tree_of_frames(*names), None, {name: f'topic_{name}' for name in topics})
        frames.publish_tf()
        task = node.executor.create_task(frames.publish_topics)
        node.executor.spin_until_future_complete(task, timeout_sec=20.0)
        assert task.done()
        task.result()

    return publish


def topics_of(node):
    topics = {publisher.topic_name for publisher in node.publishers}
    return topics - {'/rosout', '/parameter_events'}


def test_no_frames_can_be_published(publish, node):
    publish('')
    publish('a')
    publish('')
    assert topics_of(node) == OTHERS


def test_pose_topics_are_made_and_removed(publish, node):
    publish('abc', 'ab')
    assert topics_of(node) == OTHERS | {'/bridge/poses/topic_a', '/bridge/poses/topic_b'}
    publish('abc', 'bc')
    assert topics_of(node) == OTHERS | {'/bridge/poses/topic_b', '/bridge/poses/topic_c'}
    publish('abc')
    assert topics_of(node) == OTHERS


def test_publishers_of_topics_that_stay_are_kept(publish, node):
    publish('abc', 'ab')
    before = {id(publisher) for publisher in node.publishers}
    publish('abd', 'ab')
    assert {id(publisher) for publisher in node.publishers} == before
    publish('ab', 'ab')
    new, = (each for each in node.publishers if id(each) not in before)
    assert new.topic_name == '/bridge/transforms', 'which keeps another number of messages'


def test_another_tree_gets_another_stamp(node):
    publishers = Publishers(node)
    first = PublishedFrames(publishers, tree_of_frames('a'), None, {})
    same = PublishedFrames(publishers, first.tree, None, {}, first)
    other = PublishedFrames(publishers, tree_of_frames('a'), None, {}, first)
    assert first.stamp == same.stamp < other.stamp


def test_many_topics_are_made_between_other_callbacks(publish, node):
    calls = []
    node.create_timer(0.0, lambda: calls.append(len(topics_of(node))))
    names = [f'f{number}' for number in range(200)]
    publish(names, names)
    assert len(set(calls)) > 3
