# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Bridges whose frames another process publishes, too."""

from changes import asked_to_reload, Monitor, world
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import TransformStamped
from listener import latched
from slow_file import SlowFile
from tf2_msgs.msg import TFMessage


def test_two_bridges_of_one_name_report_each_other(start_bridge, file):
    bridges = [start_bridge(sdf_file=file) for _ in range(2)]
    for bridge in bridges:
        line = bridge.wait_for_line('is also published on /tf_static')
        assert 'by "/sdf_pose_bridge", with the parent ' in line


def test_a_bridge_listens_to_others_while_it_reads_a_file(
        start_bridge, tmp_path, start_listener):
    slow = SlowFile(tmp_path / 'slow.sdf', world(1))
    bridge = start_bridge(sdf_file=slow.path).wait_until_started()
    listener = start_listener()
    slow.hold()
    answer = asked_to_reload(listener)
    with slow.opened():
        transform = TransformStamped(child_frame_id='crate/body')
        transform.header.frame_id = 'odom'
        publisher = listener.node.create_publisher(TFMessage, '/tf_static', latched(1))
        publisher.publish(TFMessage(transforms=[transform]))
        bridge.wait_for_line('is also published on /tf_static by "/test_listener"')
    assert listener.response(answer).success


def test_another_parent_on_tf_is_in_the_log_and_in_diagnostics_until_its_node_is_gone(
        start_bridge, file, start_listener):
    bridge = start_bridge(sdf_file=file).wait_until_started()
    listener, sender = start_listener(), start_listener()
    listener.listen_to_frames()
    listener.wait(lambda: listener.tf_messages, '/tf_static')
    monitor = Monitor(listener)
    monitor.wait_for(DiagnosticStatus.OK)
    transform = TransformStamped(
        child_frame_id=listener.tf_messages[0].transforms[0].child_frame_id)
    transform.header.frame_id = 'odom'
    publisher = sender.node.create_publisher(TFMessage, '/tf', 10)

    def is_warned():
        publisher.publish(TFMessage(transforms=[transform]))
        return monitor.status.level == DiagnosticStatus.WARN

    listener.wait(is_warned, lambda: monitor.status)
    words = 'is also published on /tf by "/test_listener", with the parent "odom"'
    assert words in monitor.status.message
    bridge.wait_for_line(words)
    sender.node.destroy_publisher(publisher)
    monitor.wait_for(DiagnosticStatus.OK)
