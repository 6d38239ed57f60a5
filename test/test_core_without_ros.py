# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The core and the command line run in a process where there is no ROS."""

import importlib.util
import json
from pathlib import Path
import re
import sys

from command_line import completed
from folders import ROOT
import pytest

PACKAGE = ROOT / 'sdf_pose_bridge'
CORE = sorted(
    '.'.join(path.relative_to(PACKAGE).with_suffix('').parts) for path in PACKAGE.rglob('*.py')
    if path.relative_to(PACKAGE).parts[0] != 'ros' and not path.stem.startswith('__')
    and path.parent.name != 'viewer')
"""The modules of all rooms but that of the node, and that of the viewer, which needs viser."""

ROS_NAME = re.compile(
    r'(rclpy|rcl|rosidl|rpyutils|ament|launch|tf2|builtin_interfaces|action_msgs)(_\w+)?'
    r'|\w+_(msgs|srvs|interfaces)')
FOUND_ROS = """
import importlib.util, sys
found = [name for name in sys.modules if re.fullmatch(pattern, name.partition('.')[0])]
found += [name for name in ('rclpy', 'tf2_msgs', 'ament_index_python')
          if importlib.util.find_spec(name)]
"""


@pytest.fixture(scope='module')
def bare_folders(tmp_path_factory):
    """Folders to import from that hold the package, numpy and lxml, and nothing else."""
    folder = tmp_path_factory.mktemp('bare')
    (folder / 'sdf_pose_bridge').symlink_to(PACKAGE)
    for name in ('numpy', 'lxml'):
        package = Path(importlib.util.find_spec(name).origin).parent
        for path in (package, package.with_name(f'{name}.libs')):
            if path.is_dir():
                (folder / path.name).symlink_to(path)
    return [str(folder)]


def run_bare(folders, program):
    """Run a program in an interpreter that finds the standard library and some folders only."""
    start = f'import re, sys\nsys.path[:0] = {folders!r}\npattern = {ROS_NAME.pattern!r}\n'
    done = completed([sys.executable, '-I', '-S', '-B', '-c', start + program], env={})
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_every_module_of_the_core_is_imported_without_ros(bare_folders):
    out = run_bare(bare_folders, f"""
import importlib
for module in {CORE!r}:
    importlib.import_module('sdf_pose_bridge.' + module)
{FOUND_ROS}
print(found)
""")
    assert out.strip() == '[]'


def test_the_command_line_runs_without_ros(bare_folders):
    out = run_bare(bare_folders, f"""
import runpy
sys.argv = ['sdf_pose', 'poses', '--json', {str(ROOT / 'examples' / 'mobile_robot.sdf')!r}]
try:
    runpy.run_module('sdf_pose_bridge', run_name='__main__')
except SystemExit as end:
    assert not end.code, end.code
{FOUND_ROS}
assert not found, found
""")
    answer = json.loads(out)
    assert answer['ok']
    assert any(element['name'] == 'mobile_robot::chassis' for element in answer['elements'])
