# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Which messages of other nodes are reported, and until when."""

import time

from deadline import wait_until
from geometry_msgs.msg import TransformStamped
import pytest
from rclpy.qos import DurabilityPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

from sdf_pose_bridge import load_text
from sdf_pose_bridge.ros.following import other_publishers
from sdf_pose_bridge.ros.following.other_publishers import OtherPublishers
from sdf_pose_bridge.ros.publishing.published_frames import PublishedFrames
from sdf_pose_bridge.ros.publishing.publishers import Publishers
from sdf_pose_bridge.tf.tree import tf_tree_from_scene, TfOptions

ROBOT = (
    '<sdf version="1.11"><model name="m"><link name="base"/><frame name="tool"/>{}</model></sdf>')
IMU = (
    '<link name="l"><sensor name="s" type="imu"><gz_frame_id>imu_link</gz_frame_id>'
    '<frame_id>imu</frame_id></sensor></link>')
LATCHED = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
SAME_PARENT = 'frame "tool" is also published on /tf_static by "/other", with the parent "m",'


class Looking:
    """A node that looks, and another one that publishes."""

    def __init__(self, node, other, executor, beside):
        self.other, self._executor, self._beside = other, executor, beside
        self.found = OtherPublishers(node)
        self.node = node
        self._publishers = Publishers(node)
        self.frames = None
        self._senders = {}

    def publish(self, content='', **options):
        self._scene = load_text(ROBOT.format(content))
        tree = tf_tree_from_scene(self._scene, TfOptions(**options))
        self.frames = PublishedFrames(
            self._publishers, tree, None, {}, self.frames, has_transforms=False)
        self.frames.publish_tf_static()

    def send(self, child, parent, topic='/tf_static'):
        self.send_all({child: parent}, topic)

    def send_all(self, parents, topic='/tf_static'):
        if topic not in self._senders:
            self._senders[topic] = self.other.create_publisher(
                TFMessage, topic, LATCHED if topic == '/tf_static' else 10)
        message = TFMessage()
        for child, parent in parents.items():
            message.transforms.append(TransformStamped(child_frame_id=child))
            message.transforms[-1].header.frame_id = parent
        self._senders[topic].publish(message)

    def stop(self):
        for each in self._senders.values():
            self.other.destroy_publisher(each)

    def look_until(self, condition, between=lambda: None):
        def step():
            between()
            self.look()

        wait_until(condition, step, lambda: self.found.problems)

    def look(self):
        self._beside(self._executor, self.found.look, self.frames, self._scene)
        self._beside(self._executor, time.sleep, 0.1)

    @property
    def lines(self):
        return [*self.found.problems.values()]


@pytest.fixture
def looking(make_node, make_executor, beside):
    node, other = make_node('bridge'), make_node('other')
    found = Looking(node, other, make_executor(node, other), beside)
    found.publish()
    return found


@pytest.mark.parametrize(('parent', 'words'), [
    ('m', SAME_PARENT),
    ('/odom', 'frame "tool" is also published on /tf_static by "/other", with the parent "odom",'),
])
def test_a_frame_of_another_node_is_reported_once_and_until_that_node_is_gone(
        looking, capfd, parent, words):
    looking.send('tool', parent)
    looking.look_until(lambda: looking.lines)
    assert looking.lines[0].startswith(words)
    looking.send('tool', parent)
    looking.look()
    looking.stop()
    looking.look_until(lambda: not looking.lines)
    looking.look()
    assert capfd.readouterr().err.count(words) == 1
    assert not list(looking.node.subscriptions)


def test_a_frame_on_tf_is_reported_if_it_has_another_parent(looking):
    looking.look_until(
        lambda: looking.lines, between=lambda: looking.send('tool', 'map', '/tf'))
    assert looking.lines[0].startswith('frame "tool" is also published on /tf by "/other"')


def test_a_publisher_that_is_silent_at_first_is_reported(looking, monkeypatch):
    monkeypatch.setattr(other_publishers, 'TF_PERIOD_S', 0.3)
    looking.send('elsewhere', 'map', '/tf')
    looking.look_until(lambda: list(looking.node.subscriptions))
    looking.look_until(lambda: not list(looking.node.subscriptions))
    assert not looking.lines
    looking.look_until(
        lambda: looking.lines, between=lambda: looking.send('tool', 'map', '/tf'))


def test_all_frames_are_reported_in_one_line_and_those_that_gazebo_names_with_a_cure(
        looking, capfd):
    looking.publish(IMU)
    looking.send_all({'tool': 'odom', 'other': 'odom', 'imu_link': 'base_link'})
    looking.look_until(lambda: looking.lines)
    assert ', and so are "imu_link"; a frame must have one publisher' in looking.lines[0]
    assert '; for "imu_link", set <gz_frame_id> of the sensor' in looking.lines[0]
    looking.look()
    assert capfd.readouterr().err.count('is also published') == 1


def test_other_frames_and_the_own_ones_are_not_reported(looking):
    looking.send('base', 'odom')
    looking.send('tool_2', 'tool')
    for _ in range(8):
        looking.send('tool', 'm', '/tf')
        looking.frames.publish_fixed_again()
        looking.look()
    assert [each.topic_name for each in looking.node.subscriptions] == ['/tf_static']
    looking.send('tool', 'odom')
    looking.look_until(lambda: looking.lines)
    (line,) = looking.lines
    assert 'with the parent "odom"' in line


def test_few_bytes_are_read_at_once_but_each_message_to_its_end(looking, monkeypatch):
    sizes, take_message = [0], other_publishers.take_message

    def take(subscription):
        taken = take_message(subscription)
        sizes.append(len(taken[0]) if taken else 0)
        return taken

    monkeypatch.setattr(other_publishers, 'take_message', take)
    monkeypatch.setattr(other_publishers, '_MOST_BYTES_READ', 0)
    parents = {**dict.fromkeys(map(str, range(8000)), 'map'), 'tool': 'odom'}
    looking.send_all(parents)
    looking.look_until(lambda: max(sizes) > 100_000)
    assert not looking.lines
    # More than the message of the node itself.
    monkeypatch.setattr(other_publishers, '_MOST_BYTES_READ', 1000)
    looking.look_until(lambda: looking.lines, between=lambda: looking.send_all(parents))


def test_after_other_frames_are_published_latched_messages_are_read_again(looking):
    looking.send('p/tool', 'p/m')
    for _ in range(4):
        looking.look()
    assert not looking.lines
    looking.publish(frame_prefix='p/')
    looking.look_until(lambda: looking.lines)
    assert looking.lines[0].startswith('frame "p/tool"')


def test_nothing_is_subscribed_to_while_the_node_is_alone(looking):
    for _ in range(3):
        looking.look()
    assert not list(looking.node.subscriptions)
