# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A listener with a ROS context of its own, in another process than the bridge."""

import time

from deadline import wait_until
from geometry_msgs.msg import PoseStamped, TransformStamped
import rclpy
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, qos_profile_parameters, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

LOST_S = 5.0
"""Period in which the first request of a client is repeated; any answer to it counts."""


def latched(depth):
    return QoSProfile(
        depth=depth, reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Listener:
    """Collects what arrives; everything is keyed by frame id or topic."""

    def __init__(self, domain):
        self._context = Context()
        rclpy.init(args=[], context=self._context, domain_id=domain)
        self.node = rclpy.create_node('test_listener', context=self._context)
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self.node)
        self.tf_messages = []
        self.transforms = {}
        self.poses = {}
        self._clients = {}

    def listen_to_frames(self, bridge='/sdf_pose_bridge'):
        self.node.create_subscription(
            TFMessage, '/tf_static', self.tf_messages.append, latched(100))
        self.node.create_subscription(
            TransformStamped, f'{bridge}/transforms', self._take_transform, latched(1000))

    def listen_to_poses(self, topics):
        for topic in topics:
            self.node.create_subscription(
                PoseStamped, topic, lambda pose, topic=topic: self.poses.update({topic: pose}),
                latched(1))

    def _take_transform(self, message):
        assert message.child_frame_id not in self.transforms, 'sent twice'
        self.transforms[message.child_frame_id] = message

    def spin_once(self):
        """Handle a message if there is one."""
        self._executor.spin_once(timeout_sec=0.1)

    def wait(self, condition, what):
        """Handle messages until a condition is true."""
        wait_until(condition, self.spin_once, what)

    def wait_for_keys(self, collection, keys):
        self.wait(
            lambda: collection.keys() >= set(keys), lambda: sorted(set(keys) - set(collection)))

    def names_and_types(self, kind, node):
        """
        Return what a node has that is known here so far, as types by name.

        :param kind: ``'publisher'``, ``'subscriber'`` or ``'service'``.
        :param node: the full name of the node, in the root namespace.
        """
        get = getattr(self.node, f'get_{kind}_names_and_types_by_node')
        try:
            return dict(get(node.removeprefix('/'), '/'))
        except RuntimeError:  # The node is not known yet, even where a message of it has come.
            return {}

    def ask(self, service_type, name, request):
        """Send a request to a service, and return its :class:`Answer`."""
        # Kept, as programs do.
        is_new = name not in self._clients
        if is_new:
            # A client receives the answers to all clients, and by default keeps ten of them.
            self._clients[name] = self.node.create_client(
                service_type, name, qos_profile=qos_profile_parameters)
        client = self._clients[name]
        self.wait(client.service_is_ready, name)
        return Answer(client, request, may_be_lost=is_new)

    def call(self, service_type, name, request):
        """Return the response of a service to a request."""
        return self.response(self.ask(service_type, name, request))

    def response(self, answer):
        """Wait for an answer, and return the response."""
        self.wait(answer.done, f'an answer from {answer.service}')
        return answer.result()

    def end(self):
        self._executor.shutdown()
        self.node.destroy_node()
        self._context.shutdown()
        self._context.destroy()


class Answer:
    """
    The future answer to a request, which is sent again where the answer is lost.

    :param may_be_lost: whether it is the first request of a client: the middleware may lose the
        answer to a client that it has not discovered completely.
    """

    def __init__(self, client, request, *, may_be_lost=True):
        self.service = client.srv_name
        self._client = client
        self._request = request
        self._may_be_lost = may_be_lost
        self._futures = []
        self._send()

    def _send(self):
        self._futures.append(self._client.call_async(self._request))
        self._sent_at = time.monotonic()

    def done(self):
        if self._may_be_lost and time.monotonic() > self._sent_at + LOST_S:
            self._send()
        return any(future.done() for future in self._futures)

    def result(self):
        return next(future.result() for future in self._futures if future.done())


class TfListener:
    """Keeps the last message about each frame on /tf."""

    def __init__(self, listener):
        self.listener = listener
        self.last = {}
        self.count = 0
        listener.node.create_subscription(TFMessage, '/tf', self._take, 100)

    def _take(self, message):
        self.count += 1
        self.last.update({each.child_frame_id: each for each in message.transforms})

    def wait_for_frames(self, *frames):
        """Wait until there is a transform of each frame."""
        self.listener.wait_for_keys(self.last, frames)

    def wait_for(self, frame, sec):
        """Wait for a transform with a stamp; return its translation and rotation."""
        self.listener.wait(
            lambda: frame in self.last and self.last[frame].header.stamp.sec == sec,
            lambda: f'{frame} at {sec}, last were {self.last}')
        return self.last[frame].transform


class JointPublisher:
    """Publishes joint states, beside a listener."""

    def __init__(self, listener):
        self._listener = listener
        self._publishers = {}
        self._sec = 1000

    def send(self, positions, *, sec=None, nanosec=0, names=None, topic='joint_states'):
        """
        Publish one message when there is a subscription.

        :param positions: by the names of joints.
        :param sec: the stamp; the last one and 1 if there is none.
        :param nanosec: the nanoseconds of the stamp.
        :param names: other names than those of the positions.
        :param topic: the name of the topic.
        :return: the stamp.
        """
        self._sec = self._sec + 1 if sec is None else sec
        if topic not in self._publishers:
            self._publishers[topic] = self._listener.node.create_publisher(JointState, topic, 10)
        self._listener.wait(
            self._publishers[topic].get_subscription_count, f'a subscription to {topic}')
        message = JointState(
            name=names or list(positions), position=list(map(float, positions.values())))
        message.header.stamp.sec, message.header.stamp.nanosec = self._sec, nanosec
        self._publishers[topic].publish(message)
        return self._sec
