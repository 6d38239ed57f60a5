# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A measured pose goes into the file: client, bridge, joints and a listener are apart."""

from math import pi

from changes import BRIDGE, call, listen_to_tf, reason_for_refusal, wait_for_x
from geometry_msgs.msg import PoseStamped
from listener import JointPublisher
import pytest
import urdf_texts

from sdf_pose_bridge import load
from sdf_pose_bridge_interfaces.srv import LookupPose, SetPose

ARM = """<sdf version="1.11"><world name="w"><model name="arm"><static>false</static>
<link name="base"/><link name="tool"><pose>1 0 0 0 0 0</pose></link>
<joint name="turn" type="revolute"><pose relative_to="base"/><parent>base</parent>
  <child>tool</child><axis><xyz>0 0 1</xyz></axis></joint></model>
<frame name="fixture"><pose>5 0 0 0 0 0</pose></frame>
<include><uri>gauge.sdf</uri></include><include><uri>rig.urdf</uri></include></world></sdf>"""
GAUGE = """<sdf version="1.11"><model name="gauge"><static>true</static><link name="body"/>
<frame name="zero"><pose>0 0 0 0 0 0</pose></frame></model></sdf>"""

RIG = urdf_texts.robot(
    urdf_texts.link('post') + urdf_texts.link('camera')
    + urdf_texts.joint('mount', 'post', 'camera'))


@pytest.fixture
def path(tmp_path):
    (tmp_path / 'rig.urdf').write_text(RIG)
    (tmp_path / 'gauge.sdf').write_text(GAUGE)
    path = tmp_path / 'cell.sdf'
    path.write_text(ARM)
    return path


def ask(listener, frame, x, frame_id='', *, dry_run=False):
    pose = PoseStamped()
    pose.header.frame_id = frame_id
    pose.pose.position.x = x
    return call(listener, SetPose, frame=frame, pose=pose, dry_run=dry_run)


def test_measured_poses_go_into_the_files(
        start_bridge, start_listener, ros_domain, path):
    bridge = start_bridge(sdf_file=path, allow_set_pose=True, use_joint_states=True)
    bridge.wait_until_started()
    client, observer = start_listener(), start_listener()
    listen_to_tf(observer)
    wait_for_x(observer, 5.0, 'fixture')
    joints = JointPublisher(observer)

    def tool_y():
        # The first messages are lost, until the bridge has discovered the publisher.
        joints.send({'turn': pi / 2})
        return call(client, LookupPose, frame='arm/tool').pose.pose.position.y

    client.wait(lambda: abs(tool_y() - 1.0) < 1e-9, 'the tool at y = 1')
    answer = ask(client, 'fixture', 0.5, 'arm/tool')
    assert (answer.success, answer.message) == (True, '')
    assert (answer.file, answer.line) == (str(path), 5)
    bridge.wait_for_line(f'wrote the pose of "fixture" to {path}:5')
    assert path.read_text() == ARM.replace(
        '5 0 0 0 0 0', '0 1.5 0 0 0 1.570796327')
    wait_for_x(observer, 0.0, 'fixture')
    assert load(path).pose('fixture')[:3] == (0.0, 1.5, 0.0)
    # One of an included model.
    assert '+<frame name="zero"><pose>0.25' in ask(client, 'gauge/zero', 0.25, dry_run=True).diff
    answer = ask(client, 'gauge/zero', 0.25)
    assert (answer.success, answer.file) == (True, str(path.with_name('gauge.sdf')))
    wait_for_x(observer, 0.25, 'gauge/zero')
    # One of an included URDF.
    answer = ask(client, 'r/camera', 0.125, 'r/post')
    rig = path.with_name('rig.urdf')
    assert (answer.success, answer.file) == (True, str(rig))
    assert rig.read_text() == RIG.replace('type="fixed">', (
        'type="fixed"><origin xyz="0.125 0 0" rpy="0 0 0"/>'))
    refused = ask(client, 'arm/tol', 0.0)
    assert not refused.success
    assert 'did you mean "arm/tool"' in refused.message


def test_nobody_can_switch_it_on_while_the_node_runs(bridge, start_listener):
    client = start_listener()
    assert 'allow_set_pose' in reason_for_refusal(client, allow_set_pose=True)

    def services():
        return {name for name, _ in client.node.get_service_names_and_types()}

    client.wait(lambda: f'{BRIDGE}/lookup_pose' in services(), services)
    assert f'{BRIDGE}/set_pose' not in services()
