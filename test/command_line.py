# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The command line as its users start it."""

from functools import partial
from itertools import combinations
import os
from pathlib import Path
import subprocess
import sys

from deadline import DEADLINE_S
from folders import ROOT
from processes import end_with_parent

completed = partial(
    subprocess.run, capture_output=True, text=True, timeout=DEADLINE_S, check=False,
    preexec_fn=end_with_parent)
"""Runs a command to its end: ``completed(command, **options)`` returns what it has printed."""

AS_MODULE = [sys.executable, '-m', 'sdf_pose_bridge']


def executable_of_workspace(name):
    """Return the executable that ``ros2 run`` starts, or None where there is none."""
    try:
        from ament_index_python.packages import get_package_prefix
        prefix = get_package_prefix('sdf_pose_bridge')
    except (ImportError, LookupError):
        return None
    return Path(prefix, 'lib/sdf_pose_bridge', name)


def installed_command():
    """Return the command of the installed program; that of the source where none is installed."""
    programs = executable_of_workspace('sdf_pose'), Path(sys.executable).with_name('sdf_pose')
    return next(([str(path)] for path in programs if path and path.exists()), AS_MODULE)


COMMAND = installed_command()
ENVIRONMENT = {
    'PATH': os.defpath,
    'PYTHONPATH': str(ROOT) if COMMAND is AS_MODULE else os.environ.get('PYTHONPATH', '')}
"""Without what the user's shell may have set for the program."""

REDIRECTIONS = ('<&-', '>&-', '2>&-')
CLOSED = [each for count in (1, 2, 3) for each in combinations(REDIRECTIONS, count)]
"""The standard streams that a parent may close, as redirections of a shell."""


def with_closed_streams(redirections, *command):
    """Return a command that closes streams and ignores SIGCHLD before it runs another one."""
    return ['sh', '-c', f'trap "" CHLD; exec "$@" {" ".join(redirections)}', 'sh', *command]
