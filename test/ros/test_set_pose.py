# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What a request to set a pose does to the file."""

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from geometry_msgs.msg import PoseStamped
import numpy as np
from sdf_texts import joint
from sdf_texts import model_file
from sdf_texts import posed

from sdf_pose_bridge import load
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.ros.given_parameters import settings_from_node
from sdf_pose_bridge.ros.loaded_scene import loaded_scene_from_settings
from sdf_pose_bridge.ros.set_pose import set_pose
from sdf_pose_bridge_interfaces.srv import SetPose

ARM = model_file(
    '<link name="base"/>' + posed('link', 'tool', '1 0 0 0 0 0')
    + '<frame name="tip" attached_to="tool"><pose>0 0 1 0 0 0</pose></frame>'
    + posed('frame', 'mark', '2 0 0 0 0 0') + posed('frame', 'on_mark', '0 0 1 0 0 0', 'mark')
    + joint('<pose relative_to="base"/><parent>base</parent><child>tool</child>'
            '<axis><xyz>0 0 1</xyz></axis>', 'turn', 'revolute'))


@pytest.fixture(name='path')
def make_path(tmp_path):
    path = tmp_path / 'cell.sdf'
    path.write_text(ARM, encoding='utf-8')
    return path


@pytest.fixture(name='ask')
def make_ask(make_node, path):
    settings = settings_from_node(make_node(
        'bridge', '-p', f'sdf_file:={path}', '-p', 'use_joint_states:=true'))
    loaded = loaded_scene_from_settings(settings)
    positions = loaded.joint_positions
    positions.update(positions.selection(['turn']), np.array([np.pi / 2]))

    def ask(frame, xyz, quat_xyzw=(0.0, 0.0, 0.0, 1.0), frame_id='', *, dry_run=False):
        pose = PoseStamped()
        pose.header.frame_id = frame_id
        position, rotation = pose.pose.position, pose.pose.orientation
        position.x, position.y, position.z = xyz
        rotation.x, rotation.y, rotation.z, rotation.w = quat_xyzw
        return set_pose(
            SetPose.Request(frame=frame, pose=pose, dry_run=dry_run), loaded, settings)

    return ask


def test_the_answer_has_the_file_and_the_frames_that_move(ask, path):
    response = ask('mark', (3.0, 0.0, 0.0))
    assert (response.success, response.message) == (True, '')
    assert (response.file, response.line) == (str(path), 1)
    assert '+<sdf' in response.diff
    assert response.moved_frames == ['on_mark']
    assert path.read_text(encoding='utf-8') == ARM.replace('2 0 0 0 0 0', '3 0 0 0 0 0')


def test_a_pose_in_a_frame_that_has_moved_is_taken_where_that_frame_is(ask, path):
    # The tool has turned from x to y.
    ask('mark', (0.5, 0.0, 0.0), frame_id='tool')
    np.testing.assert_allclose(load(path).pose('m::mark')[:3], (0.0, 1.5, 0.0), atol=1e-9)


def test_a_frame_that_moves_is_set_where_it_is_now(ask, path):
    ask('tip', (0.0, 1.0, 3.0), (0.0, 0.0, 0.5 ** 0.5, 0.5 ** 0.5))
    np.testing.assert_allclose(
        load(path).pose('m::tip', 'm::tool')[:6], (0.0, 0.0, 3.0, 0.0, 0.0, 0.0), atol=1e-9)


def test_a_frame_that_a_joint_moves_away_is_refused(ask, path):
    with pytest.raises(SdfError, match='a joint has moved "m::tool" away from "m"'):
        ask('tool', (0.0, 1.0, 0.0))
    assert path.read_text(encoding='utf-8') == ARM


def test_a_dry_run_writes_nothing(ask, path):
    assert ask('mark', (3.0, 0.0, 0.0), dry_run=True).diff
    assert path.read_text(encoding='utf-8') == ARM


@pytest.mark.parametrize(('frame', 'xyz', 'quat_xyzw', 'frame_id', 'reason'), [
    ('marc', (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), '', 'did you mean "mark"'),
    ('mark', (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), 'tol', 'did you mean "tool"'),
    ('mark', (np.nan, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), '', 'must be a finite number'),
    ('mark', (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0), '', 'is zero, which is not a rotation'),
    ('mark', (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), 'on_mark', 'moves with it'),
])
def test_a_wrong_request_is_refused(ask, path, frame, xyz, quat_xyzw, frame_id, reason):
    with pytest.raises(SdfError, match=reason):
        ask(frame, xyz, quat_xyzw, frame_id)
    assert path.read_text(encoding='utf-8') == ARM


def test_a_text_that_is_no_file_is_refused(make_node):
    settings = settings_from_node(make_node('text', '-p', f'robot_description:={ARM}'))
    with pytest.raises(SdfError, match='in the parameter robot_description, not in a file'):
        set_pose(
            SetPose.Request(frame='mark'), loaded_scene_from_settings(settings), settings)
