# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The node in this process: when a failure is reported. The rest is tested as a whole program."""

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')


from sdf_pose_bridge.ros.given_parameters import settings_from_node
from sdf_pose_bridge.ros.node import SdfPoseBridge
from sdf_pose_bridge.ros.published_frames import PublishedFrames
from sdf_pose_bridge.ros.publishers import Publishers
from sdf_pose_bridge.tf.loaded_scene import loaded_scene_from_request

GOOD = '<sdf version="1.10"><model name="m"><link name="l"/></model></sdf>'
HALF, LONGER_HALF = GOOD[:40], '\n' + GOOD[:50]


@pytest.fixture(name='file')
def write_file(tmp_path):
    path = tmp_path / 'scene.sdf'
    path.write_text(GOOD, encoding='utf-8')
    return path


@pytest.fixture(name='check_files')
def make_check_files(make_node, make_executor, finish, file):
    """Checks the files once, as the node does in each period; ``check_files()``."""
    # It does not watch them, so that nothing else has them checked.
    node = make_node('bridge', '-p', f'sdf_file:={file}', '-p', 'watch:=false')
    executor = make_executor(node)
    settings = settings_from_node(node)
    loaded = loaded_scene_from_request(settings.load_request)
    frames = PublishedFrames(Publishers(node), loaded.tree, loaded.joint_positions, {})
    bridge = SdfPoseBridge(node, frames, settings, loaded)
    return lambda: finish(executor, bridge._check_files)


def test_a_failure_is_reported_when_the_file_has_rested(check_files, file, capfd):
    def reported():
        check_files()
        return [line for line in capfd.readouterr().err.splitlines() if 'FILE_READ' in line]

    file.write_text(HALF, encoding='utf-8')
    assert not reported()
    file.write_text(LONGER_HALF, encoding='utf-8')
    assert not reported(), 'as it has changed again'
    (line,) = reported()
    assert f'{file}:2: ' in line
    assert not reported(), 'as it was'
    file.write_text(HALF, encoding='utf-8')
    assert not reported()
    file.write_text(GOOD, encoding='utf-8')
    assert not reported()
