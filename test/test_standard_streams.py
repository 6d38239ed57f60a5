# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Every program with standard streams closed and SIGCHLD ignored, as a parent may leave them."""

import subprocess
import sys

from command_line import CLOSED, COMMAND, completed, with_closed_streams
from commands import ARGUMENTS, COMMANDS
import pytest
from sdf_texts import link_with

LOAD = 'import sdf_pose_bridge, sys; sys.exit(len(sdf_pose_bridge.load("m.sdf").names) != 4)'


@pytest.fixture(scope='module', autouse=True)
def folder(tmp_path_factory):
    """The folder of a file that causes a warning."""
    found = tmp_path_factory.mktemp('streams')
    (found / 'm.sdf').write_text(
        link_with('<visual name="v"/><visual name="w"><pose relative_to="none"/></visual>'))
    return found


@pytest.mark.parametrize('name', COMMANDS)
def test_a_command_does_the_same_with_closed_streams(folder, name):
    if name == 'view':
        pytest.importorskip('viser', reason='needs viser')
    command = [*COMMAND, name, *ARGUMENTS[name]]
    usual = completed(command, cwd=folder, stdin=subprocess.DEVNULL)
    assert usual.returncode == 0, usual
    # To import the viewer takes long.
    for closed in CLOSED[3::2] if name == 'view' else CLOSED:
        done = completed(with_closed_streams(closed, *command), cwd=folder)
        has_lost_output = '>&-' in closed and usual.stdout != ''
        messages = usual.stderr + has_lost_output * (
            f'sdf_pose {name}: the output cannot be written: bad file descriptor\n')
        assert (done.returncode, done.stdout, done.stderr) == (
            int(has_lost_output), '' if '>&-' in closed else usual.stdout,
            '' if '2>&-' in closed else messages), closed


@pytest.mark.parametrize('closed', CLOSED, ids=' '.join)
def test_a_file_can_be_loaded_with_closed_streams(folder, closed):
    done = completed(with_closed_streams(closed, sys.executable, '-c', LOAD), cwd=folder)
    assert done.returncode == 0, done
