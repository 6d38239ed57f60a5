# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The command line as a process: wrong arguments, exit codes and closed pipes."""

import shlex
import subprocess

from command_line import COMMAND
from command_line import ENVIRONMENT


def test_a_command_is_required(sdf_pose):
    done = sdf_pose()
    assert done.returncode == 2
    assert 'COMMAND' in done.stderr


def test_an_unknown_command_is_an_error_that_lists_the_known_ones(sdf_pose):
    done = sdf_pose('chekc')
    assert done.returncode == 2
    assert all(name in done.stderr for name in ('check', 'poses', 'convert'))


def test_errors_of_a_file_are_printed_behind_what_was_printed_before(files):
    command = f'{shlex.join(COMMAND)} tree good.sdf bad.sdf 2>&1'
    done = subprocess.run(
        ['bash', '-c', command], cwd=files, env=ENVIRONMENT, capture_output=True, text=True,
        timeout=60, check=False)
    assert done.returncode == 1
    first, *_, before_last, last = done.stdout.splitlines()
    assert first == 'good.sdf'
    assert before_last.startswith('bad.sdf:3: ELEMENT_INVALID: ')
    assert last.startswith('bad.sdf:4: ')


def test_a_closed_pipe_prints_no_error(files):
    command = f'{shlex.join(COMMAND)} poses {"good.sdf " * 2000}| head -1'
    done = subprocess.run(
        ['bash', '-c', command], cwd=files, env=ENVIRONMENT, capture_output=True, text=True,
        timeout=60, check=False)
    assert done.stderr == ''
