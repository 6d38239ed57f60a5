# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The programs as their users install and start them."""

import os
from pathlib import Path
import shutil
import subprocess
import sys
import sysconfig

from command_line import completed, executable_of_workspace
from deadline import DEADLINE_S
from folders import ROOT
import mesh_texts
import needs
import pytest

MESH = """<sdf version="1.9"><model name="m"><link name="l"><visual name="v"><geometry>
  <mesh><uri>a.stl</uri></mesh></geometry></visual></link></model></sdf>"""
NOT_COPIED = shutil.ignore_patterns(
    '.*', 'build*', 'install*', 'log*', 'docs', 'test', 'underlay', '*.egg-info', '__pycache__')


@pytest.fixture(scope='session')
def prefix_of_wheel(tmp_path_factory):
    """A folder in which pip has installed the wheel."""
    needs.modules('pip', 'setuptools', 'wheel')
    folder = tmp_path_factory.mktemp('wheel')
    needs.executables_in(folder)
    shutil.copytree(ROOT, folder / 'source', ignore=NOT_COPIED)
    # Pip builds a wheel and installs it.
    subprocess.run(
        [sys.executable, '-m', 'pip', '--quiet', '--disable-pip-version-check', 'install',
         '--no-deps', '--no-index', '--no-build-isolation', '--no-compile', '--ignore-installed',
         '--prefix', folder / 'prefix', folder / 'source'], check=True, timeout=DEADLINE_S)
    return folder / 'prefix'


def program_of_workspace(name):
    executable = executable_of_workspace(name)
    if executable is None:
        pytest.skip('needs a ROS workspace')
    return [str(executable)], os.environ.get('PYTHONPATH', '')


@pytest.fixture(params=['executable', 'wheel'])
def started(request):
    """A way to start the command line, and the folder that it is imported from."""
    if request.param == 'executable':
        return program_of_workspace('sdf_pose')
    prefix = request.getfixturevalue('prefix_of_wheel')
    library = sysconfig.get_path('purelib', vars={'base': str(prefix)})
    return [str(prefix / 'bin/sdf_pose')], library


def test_meshes_are_read_however_the_program_is_started(started, tmp_path):
    for name in ('viser', 'trimesh'):
        pytest.importorskip(name, reason=f'needs {name}')
    (tmp_path / 'mesh.sdf').write_text(MESH)
    (tmp_path / 'a.stl').write_text(mesh_texts.stl())
    command, path = started
    done = completed(
        [*command, 'view', 'mesh.sdf', '-o', 'page.html'], cwd=tmp_path,
        env={**os.environ, 'PYTHONPATH': path})
    assert (done.returncode, done.stdout, done.stderr) == (0, '', '')


@pytest.mark.parametrize('name', ['bridge', 'sdf_pose'])
def test_executables_can_be_imported(name, tmp_path):
    (executable,), path = program_of_workspace(name)
    done = completed(
        [sys.executable, '-c', f'import runpy; runpy.run_path({executable!r}, run_name="other")'],
        env={**os.environ, 'PYTHONPATH': path}, cwd=tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, '', '')


def test_the_node_of_the_wheel_has_a_name_of_its_own(prefix_of_wheel):
    assert sorted(path.name for path in (prefix_of_wheel / 'bin').iterdir()) == [
        'sdf_pose', 'sdf_pose_bridge']


def test_the_environment_has_the_node_under_the_same_name():
    executable_of_workspace('bridge') or pytest.skip('needs a ROS workspace')
    program = needs.program('sdf_pose_bridge')
    assert Path(program).resolve() == executable_of_workspace('bridge').resolve()
