# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A world with models that move, and a publisher of their poses."""

import math

from geometry_msgs.msg import PoseStamped, TransformStamped
import pytest

WORLD = """<sdf version="1.11"><world name="shop">
<model name="cart"><pose>1 0 0 0 0 0</pose><link name="deck"><pose>0 0 {height} 0 0 0</pose></link>
<model name="crate"><link name="box"/></model></model>
<model name="arm"><link name="base"/><link name="hand"><pose>0 0 1 0 0 0</pose></link>
<joint name="lift" type="prismatic"><parent>base</parent><child>hand</child>
  <axis><xyz>0 0 1</xyz></axis></joint></model>
<model name="wall"><static>true</static><link name="bricks"/></model>
</world></sdf>"""
CART = '/tracker/cart/pose'


def stamped(message_type, sec, x, frame_id='', child=''):
    """Return a message with a pose that is turned by a quarter about z."""
    message = message_type()
    message.header.stamp.sec, message.header.frame_id = sec, frame_id
    if hasattr(message, 'child_frame_id'):
        message.child_frame_id = child
    if message_type is TransformStamped:
        translation, rotation = message.transform.translation, message.transform.rotation
    else:
        pose = message.pose if message_type is PoseStamped else message.pose.pose
        translation, rotation = pose.position, pose.orientation
    translation.x, rotation.z, rotation.w = float(x), math.sqrt(0.5), math.sqrt(0.5)
    return message


class Tracker:
    """Publishes poses beside a listener."""

    def __init__(self, tf):
        self._tf, self._publishers, self.sec = tf, {}, 1000

    def publish(self, message, topic=CART):
        if topic not in self._publishers:
            self._publishers[topic] = self._tf.listener.node.create_publisher(
                type(message), topic, 10)
        self._publishers[topic].publish(message)

    def stop(self, topic=CART):
        self._tf.listener.node.destroy_publisher(self._publishers.pop(topic))

    def move(self, x, frame='cart/deck', message_type=PoseStamped, topic=CART, seen_x=None,
             **fields):
        """
        Publish a pose with newer and newer stamps until it is on ``/tf``.

        :param seen_x: where it is there, if not at x.
        :return: the transform.
        """
        def is_there():
            self.sec += 1
            self.publish(stamped(message_type, self.sec, x, **fields), topic)
            return frame in self._tf.last and self._tf.last[frame].transform.translation.x == (
                pytest.approx(x if seen_x is None else seen_x))

        self._tf.listener.wait(is_there, lambda: f'{frame} at {x}, last were {self._tf.last}')
        return self._tf.last[frame]
