# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Run the node in the foreground, found through the ament index as `ros2 run` finds it.

At a terminal the node gets Ctrl-C alone, so that what started this (make, for one) does not end
with an error when the node has ended well.
"""

import argparse
import os
from pathlib import Path
import re
import shutil
import signal
import subprocess
import sys
from types import FrameType

from ament_index_python.packages import get_package_prefix, PackageNotFoundError

PACKAGE = 'sdf_pose_bridge'
EXECUTABLE = 'bridge'
ROOT = Path(__file__).resolve().parents[1]


def path_from_caller(file: str, caller: str) -> str:
    """
    Resolve a relative path as whoever gave it would.

    :param file: a path or a URI.
    :param caller: the folder that the path is relative to; this one where no such file is there.
    :return: the URI as it is, or an absolute path.
    """
    if re.match(r'[A-Za-z][A-Za-z0-9+.-]*:', file):
        return file
    choices = [Path(folder, Path(file).expanduser()) for folder in (caller, Path.cwd())]
    return str(next((choice for choice in choices if choice.exists()), choices[0]))


def hint_for_second_shell() -> str:
    """
    Tell how to look at the running node.

    :return: what to type in another shell; with the ros2 command line where it is installed.
    """
    look = 'ros2 topic list' if shutil.which('ros2') else (
        f'python {ROOT}/examples/ask_bridge.py topics   # or: pose, lookup, rotation, convert, '
        'reload')
    return f'To look at the node, type in another shell:\n  . {ROOT}/underlay/setup.bash\n  {look}'


def run_in_terminal(arguments: 'list[str]') -> int:
    """
    Run a command as the only one that the terminal's Ctrl-C reaches.

    :param arguments: the command and its arguments.
    :return: its exit code.
    """
    terminal = sys.stdin.fileno()
    # Taking the terminal back from the background would stop this process otherwise.
    signal.signal(signal.SIGTTOU, signal.SIG_IGN)
    with subprocess.Popen(arguments, process_group=0) if sys.version_info >= (3, 11) else (
        subprocess.Popen(arguments, preexec_fn=os.setpgrp)
    ) as process:
        def pass_on(number: int, _: 'FrameType | None') -> None:
            process.send_signal(number)

        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, pass_on)
        os.tcsetpgrp(terminal, process.pid)
        try:
            return process.wait()
        finally:
            os.tcsetpgrp(terminal, os.getpgrp())


def main() -> int:
    """
    Find the node, and run it on the given file.

    :return: the node's exit code, or 1 after one sentence on stderr.
    """
    parser = argparse.ArgumentParser()
    parser.add_argument('caller')
    parser.add_argument('file')
    arguments, rest = parser.parse_known_args()
    try:
        executable = Path(get_package_prefix(PACKAGE), 'lib', PACKAGE, EXECUTABLE)
    except PackageNotFoundError:
        print(f'{PACKAGE} is not built; run `make setup` first.', file=sys.stderr)
        return 1
    file = path_from_caller(arguments.file, arguments.caller)
    command = [str(executable), '--ros-args', '-p', f'sdf_file:={file}', *rest]
    print(hint_for_second_shell(), file=sys.stderr, flush=True)
    if not sys.stdin.isatty():
        os.execv(command[0], command)
    return run_in_terminal(command)


if __name__ == '__main__':
    sys.exit(main())
