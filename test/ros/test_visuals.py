# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""When ``~/visuals`` is made and published."""

import math

from deadline import spin_until
from rclpy.qos import DurabilityPolicy, QoSProfile
from visualization_msgs.msg import Marker, MarkerArray

from sdf_pose_bridge.ros.visuals import VisualPublisher
from sdf_pose_bridge.tf.loaded_scene import LoadRequest
from sdf_pose_bridge.tf.loading import loaded_scene_from_request

SDF = """<sdf version="1.10"><model name="m"><link name="l">
<visual name="v"><geometry><{shape}/></geometry></visual></link></model></sdf>"""


def test_shapes_of_the_scene_before_are_no_longer_read_and_not_shown(
        make_node, make_executor, reader, tmp_path):
    node, listener = make_node('bridge'), make_node('listener')
    scenes = []
    for shape in ('box', 'sphere'):
        path = tmp_path / f'{shape}.sdf'
        path.write_text(SDF.format(shape=shape))
        scenes.append(loaded_scene_from_request(LoadRequest(str(path), '')))
    old, new = scenes
    visuals = VisualPublisher(node, reader, old)
    visuals.switch(on=True)
    executor, found = make_executor(listener), []

    def listen():
        return listener.create_subscription(
            MarkerArray, '/bridge/visuals', found.append,
            QoSProfile(depth=9, durability=DurabilityPolicy.TRANSIENT_LOCAL))

    subscription = listen()
    spin_until(executor, lambda: visuals.go_on() < math.inf)
    listener.destroy_subscription(subscription)
    spin_until(executor, lambda: not node.count_subscribers('/bridge/visuals'))
    visuals.replace(new)
    assert visuals.go_on() == math.inf, 'nobody listens'
    listen()
    spin_until(executor, lambda: visuals.go_on() == math.inf and found)
    assert [each.markers[1].type for each in found] == [Marker.SPHERE]
