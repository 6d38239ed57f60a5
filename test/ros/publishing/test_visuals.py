# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""When ``~/visuals`` is made and published."""

import math

from deadline import spin_until
from rclpy.qos import DurabilityPolicy, QoSProfile
from sdf_texts import world_file, write_files
from visualization_msgs.msg import Marker, MarkerArray

from sdf_pose_bridge.export.published_scene import LoadRequest
from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.ros.publishing.visuals import VisualPublisher

SDF = """<sdf version="1.10"><model name="m"><link name="l">
<visual name="v"><geometry><{shape}/></geometry></visual></link></model></sdf>"""


def test_shapes_of_an_included_file_that_has_changed_are_not_shown(
        make_node, make_executor, reader, tmp_path, capfd):
    node, listener = make_node('bridge'), make_node('listener')
    write_files(tmp_path, part=SDF.format(shape='box'), m=world_file(
        '<include><uri>part.sdf</uri></include>'))
    visuals = VisualPublisher(node, reader, loaded_scene_from_request(
        LoadRequest(str(tmp_path / 'm.sdf'), '')))
    write_files(tmp_path, part=SDF.replace('"l"', '"k"').format(shape='box'))
    visuals.switch(on=True)
    listener.create_subscription(MarkerArray, '/bridge/visuals', print, 1)
    executor = make_executor(listener)
    spin_until(executor, lambda: visuals.go_on() < math.inf)
    spin_until(executor, lambda: visuals.go_on() == math.inf)
    assert capfd.readouterr().err.count(
        f'a file that {tmp_path}/m.sdf includes has changed since it was read') == 1


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
