# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Launch files start real nodes, whose frames arrive in another process."""

from pathlib import Path
import signal
import sys

from bridge_process import STARTED
import pytest

pytest.importorskip('launch_ros', reason='needs launch_ros, which is not installed')
pytest.importorskip('launch_xml', reason='needs launch_xml, which is not installed')

FILE = """\
<sdf version="1.10">
  <model name="arm">
    <link name="base"/>
    <frame name="tool" attached_to="base"><pose>1 0 0 0 0 0</pose></frame>
  </model>
</sdf>
"""
URDF = """\
<robot name="arm">
  <link name="world"/>
  <link name="base"/>
  <link name="hand"/>
  <joint name="foot" type="fixed"><parent link="world"/><child link="base"/></joint>
  <joint name="wrist" type="fixed">
    <origin xyz="0 0 1"/><parent link="base"/><child link="hand"/>
  </joint>
</robot>
"""


@pytest.fixture
def sdf_file(tmp_path):
    path = tmp_path / 'arm.sdf'
    path.write_text(FILE)
    return path


@pytest.fixture
def installed():
    from ament_index_python.packages import get_package_share_directory
    return Path(get_package_share_directory('sdf_pose_bridge'))


@pytest.fixture
def launch(start_program, installed):
    """Launches an installed file; ``launch(name, argument=value)``."""
    def start(name, **arguments):
        words = [f'{key}:={value}' for key, value in arguments.items()]
        return start_program([
            sys.executable, Path(__file__).with_name('launch_process.py'),
            installed / 'launch' / name, *words], with_children=True)
    return start


@pytest.fixture
def listener(start_listener):
    return start_listener()


def wait_for_parents(listener, frame_ids):
    """Wait until the frames are on /tf_static; return the one parent of every frame there."""
    def parents():
        pairs = {
            (each.child_frame_id, each.header.frame_id)
            for message in listener.tf_messages for each in message.transforms}
        assert len(pairs) == len(dict(pairs)), 'a frame has two parents'
        return dict(pairs)

    listener.wait(
        lambda: parents().keys() >= set(frame_ids),
        lambda: sorted(set(frame_ids) - parents().keys()))
    return parents()


@pytest.mark.parametrize('name', ['bridge.launch.py', 'bridge.launch.xml'])
def test_arguments_reach_the_node(launch, listener, sdf_file, name):
    listener.listen_to_frames('/left/sdf_pose_bridge')
    # A root frame that YAML would take for a number.
    launch(name, sdf_file=sdf_file, namespace='left', frame_prefix='a/', root_frame='1',
        anchor_models='all')
    parents = wait_for_parents(listener, ['a/base', 'a/tool'])
    assert parents == {'a/arm': 'a/base', 'a/base': '1', 'a/tool': 'a/base'}
    listener.wait_for_keys(listener.transforms, parents)


@pytest.mark.parametrize('node', ['/**', 'sdf_pose_bridge', '/left/sdf_pose_bridge'])
def test_arguments_win_over_the_params_file_and_leave_it_the_rest(
        launch, listener, sdf_file, tmp_path, node):
    params_file = tmp_path / 'params.yaml'
    params_file.write_text(
        f'{node}:\n  ros__parameters:\n    sdf_file: {sdf_file}\n    root_frame: map\n'
        '    frame_prefix: from_file_\n    anchor_models: all\n')
    listener.listen_to_frames()
    namespace = '' if node == 'sdf_pose_bridge' else 'left'
    launch('bridge.launch.py', params_file=params_file, namespace=namespace, frame_prefix='a/')
    assert wait_for_parents(listener, ['a/base'])['a/base'] == 'map'


def test_a_file_that_is_not_valid_is_reported(launch, tmp_path):
    launched = launch('bridge.launch.py', sdf_file=tmp_path / 'missing.sdf')
    launched.wait_for_line('missing.sdf: FILE_READ: ')
    launched.wait_for_line('exit code 1')


def test_ctrl_c_ends_the_node_well(launch, sdf_file):
    launched = launch('bridge.launch.py', sdf_file=sdf_file)
    launched.wait_for_line(STARTED)
    launched.send(signal.SIGINT)
    launched.wait_for_line('process has finished cleanly')


def test_two_robots_have_frames_of_their_own_in_one_tree(launch, listener):
    listener.listen_to_frames()
    launch('two_robots.launch.py')
    parents = wait_for_parents(listener, [
        'left_start', 'right_start', 'left/base_link', 'right/base_link'])
    assert parents['left_start'] == parents['right_start'] == 'world'
    assert parents['left/chassis'] == 'left_start'
    assert parents['right/chassis'] == 'right_start'
    left, right = (
        {frame.removeprefix(robot) for frame in parents if frame.startswith(robot)}
        for robot in ('left/', 'right/'))
    assert left == right


def test_beside_robot_state_publisher_no_frame_has_two_parents(
        launch, listener, sdf_file, tmp_path):
    from ament_index_python.packages import get_package_prefix, PackageNotFoundError
    try:
        get_package_prefix('robot_state_publisher')
    except PackageNotFoundError:
        pytest.skip('needs robot_state_publisher, which is not installed')
    urdf_file = tmp_path / 'arm.urdf'
    urdf_file.write_text(URDF)
    listener.listen_to_frames()
    launch('beside_robot_state_publisher.launch.py', urdf_file=urdf_file, sdf_file=sdf_file)
    parents = wait_for_parents(listener, ['base', 'hand', 'cell/base', 'cell/tool'])
    assert parents['base'] == parents['cell/base'] == 'world'
