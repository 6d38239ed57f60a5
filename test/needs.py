# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What some tests need that a machine may lack; they are skipped without it."""

from importlib.util import find_spec
import os
import shutil

import pytest

from sdf_pose_bridge.cli.view import BROWSERS


def program(*names):
    """Return the path of the first of some programs that is installed."""
    path = next(filter(None, map(shutil.which, names)), None)
    if path is None:
        pytest.skip(f'needs {" or ".join(names)}')
    return path


def modules(*names):
    """Find modules for processes; setuptools cannot be imported into any process."""
    for name in names:
        if find_spec(name) is None:
            pytest.skip(f'needs {name}')


def browser():
    """Return the path of the browser that ``sdf_pose view`` starts, and can draw something in."""
    pytest.importorskip('viser', reason='needs viser')
    if 'LD_PRELOAD' in os.environ:
        pytest.skip('a browser does not start with the library of a middleware in its processes')
    return program(*BROWSERS)


def executables_in(folder):
    """Skip where files in a folder cannot be executed."""
    if os.statvfs(folder).f_flag & os.ST_NOEXEC:
        pytest.skip('needs a folder for temporary files that is not mounted with noexec')


def gazebo():
    """Skip without Gazebo Fortress and the programs of its transport, which ``.ci/run`` makes."""
    from gazebo import FOLDER, TOOL
    if not all(map(os.path.exists, (FOLDER / 'bin/gazebo_server', TOOL('service')))):
        pytest.skip('needs Gazebo')
