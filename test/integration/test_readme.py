# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What the README shows is what is printed, as far as that is the same on every machine."""

import re
import sys

from command_line import completed
from folders import ROOT
import pytest

from sdf_pose_bridge.cli.main import main
from sdf_pose_bridge_interfaces.srv import ConvertRotation

README = (ROOT / 'README.md').read_text()
ROS_INTERFACE = (ROOT / 'docs/ros_interface.md').read_text()
COMMAND_LINE = (ROOT / 'docs/command_line.md').read_text()
ERRORS = (ROOT / 'docs/errors.md').read_text()
INSTALLATION = (ROOT / 'docs/installation.md').read_text()
BROKEN = """\
<sdf version="1.10">
  <model name="gripper">
    <link name="base"/>
    <frame name="finger_mount"/>
    <frame name="tip">
      <pose relative_to="finger_mout">0 0 0.1 0 0 0</pose>
    </frame>
  </model>
</sdf>
"""
MISSPELT = """\
<sdf version="1.10">
  <model name="cell">
    <link name="table"/>
    <lnk name="shelf"/>
    <frame name="camera_mount" attached_to="table">
      <pose relativ_to="table">0 0 1 0 0 90</pose>
    </frame>
  </model>
</sdf>
"""


def shown_after(command, page=README):
    """Return the lines of the sample of a page that a line begins, without the indent."""
    (sample,) = re.findall(rf'^    {re.escape(command)}.*\n((?:(?:    .*)?\n)*)', page, re.M)
    return [line.removeprefix('    ') for line in sample.splitlines()]


@pytest.fixture(scope='module')
def bridge(start_shared_bridge):
    with pytest.MonkeyPatch.context() as monkeypatch:
        monkeypatch.chdir(ROOT)
        bridge = start_shared_bridge(sdf_file='examples/work_cell.sdf')
        return bridge.wait_until_started()


@pytest.fixture(scope='module')
def listener(bridge, start_shared_listener):
    return start_shared_listener()


def test_the_demonstration():
    done = completed([sys.executable, ROOT / 'examples/demo.py'])
    assert done.returncode == 0, done.stderr
    first = (
        '49 transforms on /tf_static, 49 on /sdf_pose_bridge/transforms, '
        '49 poses on /sdf_pose_bridge/poses/...')
    printed = iter(line.strip() for line in done.stdout.splitlines())
    for line in (first, *shown_after(first, INSTALLATION)):
        if line.strip() not in ('', '...'):
            assert any(each == line.strip() for each in printed), line


def test_the_first_line_of_the_node(bridge):
    shown = shown_after(
        '$ ros2 run sdf_pose_bridge bridge --ros-args -p sdf_file:=src/', ROS_INTERFACE)[0]
    same = re.compile(r'publishing .* frames|with .* transforms, root frame "world"')
    assert same.findall(shown) == same.findall(bridge.lines[0])


def test_a_pose(listener):
    topic = '/sdf_pose_bridge/poses/robot/tool0'
    listener.listen_to_poses([topic])
    listener.wait_for_keys(listener.poses, [topic])
    pose = listener.poses[topic].pose
    shown = [line.split(': ') for line in shown_after(
        f'$ ros2 topic echo --once {topic}', ROS_INTERFACE)
             if re.match(r' +[xyzw]: ', line)]
    assert [name.strip() for name, _ in shown] == list('xyzxyzw')
    # The last digits depend on the mathematical functions of the machine.
    assert [float(number) for _, number in shown] == pytest.approx([
        *(getattr(pose.position, name) for name in 'xyz'),
        *(getattr(pose.orientation, name) for name in 'xyzw')], rel=0, abs=1e-14)


def test_a_service(listener):
    request = ConvertRotation.Request()
    request.rpy.z = 1.5708
    response = listener.call(
        ConvertRotation, '/sdf_pose_bridge/convert_rotation', request)
    shown = shown_after('$ ros2 service call /sdf_pose_bridge/convert_rotation', ROS_INTERFACE)
    assert f'requester: making request: {request!r}' in shown
    assert repr(response) in shown


def test_errors(start_bridge, tmp_path, monkeypatch, capsys):
    (tmp_path / 'broken.sdf').write_text(BROKEN)
    monkeypatch.chdir(tmp_path)
    main(['check', 'broken.sdf'])
    (line,) = capsys.readouterr().out.splitlines()
    assert shown_after('$ sdf_pose check broken.sdf', ERRORS)[0] == line
    bridge = start_bridge(sdf_file='broken.sdf')
    assert bridge.wait_for_end() == 1
    assert bridge.lines[0].endswith(f'/{line}')
    (fatal, _) = shown_after(
        '$ ros2 run sdf_pose_bridge bridge --ros-args -p sdf_file:=broken.sdf', ROS_INTERFACE)[:2]
    assert fatal.startswith('[FATAL]')
    assert fatal.endswith(f': /home/me/ws/{line}')
    assert shown_after(
        '$ ros2 param set /sdf_pose_bridge sdf_file', ROS_INTERFACE)[0].endswith(
            f': /home/me/ws/{line}')


def test_the_first_file(tmp_path, monkeypatch, capsys):
    sdf = README[README.index('    <sdf '):README.index('    </sdf>')] + '    </sdf>\n'
    (tmp_path / 'cell.sdf').write_text(sdf)
    monkeypatch.chdir(tmp_path)
    assert main(['tree', 'cell.sdf']) == 0
    printed = capsys.readouterr().out.splitlines()
    assert shown_after('$ sdf_pose tree cell.sdf')[:len(printed)] == printed
    (tmp_path / 'cell.sdf').write_text(sdf.replace('"table::corner', '"table::cornor'))
    assert main(['check', 'cell.sdf']) == 1
    assert shown_after('$ sdf_pose check cell.sdf')[:1] == capsys.readouterr().out.splitlines()


def test_warnings(tmp_path, monkeypatch, capsys):
    (tmp_path / 'cell.sdf').write_text(MISSPELT)
    monkeypatch.chdir(tmp_path)
    assert main(['check', '--strict', 'cell.sdf']) == 1
    printed = capsys.readouterr().out.splitlines()
    shown = shown_after('$ sdf_pose check --strict cell.sdf', COMMAND_LINE)
    assert shown[:len(printed)] == printed
