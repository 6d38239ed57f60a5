# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Publish joint states, in a process of its own, as lines of standard input say."""

import json
import subprocess
import sys

from bridge_process import SECONDS


class JointPublisher:
    """A process that publishes positions of joints."""

    def __init__(self):
        from ros_domain import claims
        self._process = subprocess.Popen(
            [sys.executable, __file__], stdin=subprocess.PIPE, text=True, pass_fds=claims())
        self._sec = 1000

    def send(self, positions, *, sec=None, nanosec=0, names=None, topic='joint_states'):
        """
        Publish one message.

        :param positions: by the names of joints.
        :param sec: the stamp; the last one and 1 if there is none.
        :param nanosec: the nanoseconds of the stamp.
        :param names: other names than those of the positions.
        :param topic: the name of the topic.
        :return: the stamp.
        """
        self._sec = self._sec + 1 if sec is None else sec
        self._process.stdin.write(json.dumps(
            [topic, names or list(positions), list(positions.values()), self._sec, nanosec])
            + '\n')
        self._process.stdin.flush()
        return self._sec

    def end(self):
        self._process.stdin.close()
        try:
            self._process.wait(SECONDS)
        except subprocess.TimeoutExpired:  # it waits for a bridge that has ended
            self._process.kill()
            self._process.wait()


def main():
    import rclpy
    from sensor_msgs.msg import JointState
    rclpy.init()
    node = rclpy.create_node('joints')
    publishers = {}
    for line in sys.stdin:
        topic, names, positions, sec, nanosec = json.loads(line)
        if topic not in publishers:
            publishers[topic] = node.create_publisher(JointState, topic, 10)
        # Until the bridge is there, nobody would get the message.
        while not publishers[topic].get_subscription_count():
            rclpy.spin_once(node, timeout_sec=0.1)
        message = JointState(name=names, position=list(map(float, positions)))
        message.header.stamp.sec, message.header.stamp.nanosec = sec, nanosec
        publishers[topic].publish(message)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
