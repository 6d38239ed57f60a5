# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Processes of tests end with them, and what a machine may lack is asked in one place."""

import os
import re
import select
import signal
import subprocess
import sys

from deadline import DEADLINE_S
from folders import ROOT
from processes import started
import pytest

PARENT = """
import subprocess, sys, time
from processes import started
child = started([sys.executable, '-c', 'import signal; print(flush=True); signal.pause()'],
                stdout=subprocess.PIPE)
child.stdout.read(1)
print(child.pid, flush=True)
time.sleep(600)
"""
NOT_TESTS = ('differential', 'growth', 'fuzzing')


@pytest.mark.parametrize('number', [signal.SIGTERM, signal.SIGKILL])
def test_process_ends_with_the_one_that_has_started_it(number):
    with started([sys.executable, '-c', PARENT], stdout=subprocess.PIPE, text=True,
                 cwd=ROOT / 'test') as parent:
        child = os.pidfd_open(int(parent.stdout.readline()))
        parent.send_signal(number)
    assert select.select([child], [], [], DEADLINE_S)[0]
    os.close(child)


@pytest.mark.parametrize(('text', 'place'), [
    (r'\bPopen\(', 'processes.py'), (r'\bwhich\(|\[.(git|ip|mount|tc|dot|cmake)\b', 'needs.py')])
def test_there_is_one_place_for(text, place):
    files = [path for path in (ROOT / 'test').rglob('*.py')
             if path.parent.name not in NOT_TESTS and path.name != place]
    assert [path.name for path in files if re.search(text, path.read_text())] == []
