# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The example of clients: it shows topics and poses, and calls every service."""

import sys

from command_line import completed
from folders import EXAMPLES
import pytest


@pytest.fixture(scope='module')
def ask(start_shared_bridge):
    """Asks a bridge; ``ask(*arguments)`` returns the ended process."""
    start_shared_bridge(sdf_file=EXAMPLES / 'work_cell.sdf').wait_until_started()

    def ask(*arguments):
        return completed([sys.executable, EXAMPLES / 'ask_bridge.py', *arguments])

    return ask


@pytest.mark.parametrize(('arguments', 'line'), [
    ('topics', '  /sdf_pose_bridge/reload [std_srvs/srv/Trigger]'),
    ('pose robot/tool0', 'robot/tool0 in world:'),
    ('lookup fixture table', 'fixture in table:'),
    ('rotation --degrees 0 0 -90', 'roll pitch yaw    0.0 0.0 -90.0'),
    ('convert sdf_rpy sdf_quat_xyzw 1 2 -3 0 0 0', '1.0 2.0 -3.0 0.0 0.0 0.0 1.0'),
    ('reload', f'publishing 49 frames of {EXAMPLES / "work_cell.sdf"}'),
])
def test_it_prints_what_the_bridge_answers(ask, arguments, line):
    done = ask(*arguments.split())
    assert done.returncode == 0, done.stderr
    assert line in done.stdout.splitlines()


@pytest.mark.parametrize(('arguments', 'reason'), [
    ('lookup robot/tol0', '"robot/tol0"'),
    ('pose nowhere', '"nowhere"'),
    ('--timeout 1 --bridge /other topics', 'no node /other within 1 s'),
])
def test_it_says_why_there_is_no_answer(ask, arguments, reason):
    done = ask(*arguments.split())
    assert done.returncode == 1
    assert reason in done.stderr
    assert len(done.stderr.splitlines()) == 1
