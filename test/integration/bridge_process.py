# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The installed executable in a process of its own, as ``ros2 run`` would start it."""

import contextlib
import itertools
import os
from pathlib import Path
import signal
import subprocess
import sys
import threading
import time

from deadline import DEADLINE_S, wait_until

STARTED = ': publishing '
"""In the line that the node logs when it has published and offers its services."""


class LoggedProcess:
    """
    A running process; what it writes is kept line by line.

    :param command: the executable and what follows it on the command line.
    :param with_children: whether signals go to the processes that it starts too, as those do that
        come from a terminal.
    """

    def __init__(self, command, *, with_children=False):
        # Imported here, as processes that tests start import this module without that folder.
        from processes import started
        from ros_domain import claims
        self._with_children = with_children
        self._process = started(
            list(map(str, command)), stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            start_new_session=with_children, pass_fds=claims())
        self.pid = self._process.pid
        self.lines = []
        self._has_changed = threading.Condition()
        self._has_ended = False
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self._process.stdout:
            # Fast DDS takes another port where a file of another user is in its place.
            if 'Failed init_port' in line:
                continue
            with self._has_changed:
                self.lines.append(line.rstrip('\n'))
                self._has_changed.notify_all()
        with self._has_changed:
            self._has_ended = True
            self._has_changed.notify_all()

    def wait_for_line(self, text, number=1):
        """Wait until so many lines with a text are written, and return the last of these."""
        def found():
            lines = [line for line in self.lines if text in line]
            return lines[number - 1] if len(lines) >= number else None

        with self._has_changed:
            self._has_changed.wait_for(lambda: found() or self._has_ended, DEADLINE_S)
            line = found()
        assert line is not None, f'no line with "{text}" but:\n' + '\n'.join(self.lines)
        return line

    def count_of(self, text):
        """Return the number of lines with a text so far."""
        return sum(text in line for line in self.lines)

    def wait_until_sleeping(self):
        """Wait until the process waits for something itself."""
        def is_sleeping():
            assert self._process.poll() is None, '\n'.join(self.lines)
            status = Path(f'/proc/{self.pid}/status').read_text(encoding='ascii')
            return 'State:\tS' in status

        wait_until(is_sleeping, lambda: time.sleep(0.001), 'sleep')

    def children(self):
        """Return the ids of the processes that it has started."""
        pids = []
        for task in Path(f'/proc/{self.pid}/task').glob('*/children'):
            # A thread may end meanwhile.
            with contextlib.suppress(FileNotFoundError, ProcessLookupError):
                pids += map(int, task.read_text(encoding='ascii').split())
        return pids

    @property
    def is_running(self):
        """Whether it has not ended."""
        return self._process.poll() is None

    def send(self, number):
        if self._with_children and self._process.poll() is None:
            os.killpg(self.pid, number)
        else:
            self._process.send_signal(number)

    def wait_for_end(self):
        """Wait until the process has ended, and return its exit code."""
        code = self._process.wait(DEADLINE_S)
        self._reader.join(DEADLINE_S)
        return code

    def end(self):
        """Make sure that it has ended."""
        if self._process.poll() is None:
            self.send(signal.SIGINT)
            try:
                self._process.wait(DEADLINE_S)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        self._reader.join(DEADLINE_S)
        self._process.stdout.close()


class BridgeProcess(LoggedProcess):
    """
    A running bridge.

    :param arguments: what follows the executable on the command line.
    :param program: the name of the executable, or a text in Python that runs the bridge.
    :param parameters: their values by their names; they follow the arguments.
    """

    def __init__(self, *arguments, program='bridge', with_children=False, **parameters):
        from command_line import executable_of_workspace
        command = [sys.executable, '-c', program] if '\n' in program else [
            executable_of_workspace(program)]
        words = (('-p', f'{name}:={value}') for name, value in parameters.items())
        super().__init__(
            [*command, *arguments, '--ros-args', *itertools.chain(*words)],
            with_children=with_children)

    def wait_until_started(self):
        self.wait_for_line(STARTED)
        return self
