# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Run the long steps: each command's output into a log, progress for whoever waits."""

from collections.abc import Callable, Mapping, Sequence
import os
from pathlib import Path
import signal
import subprocess
import sys
import time


class RefusalError(Exception):
    """What is missing and what to do about it, in one sentence."""


class CommandError(Exception):
    """
    A command of a step ended with an error.

    :param output: the last part of what it printed.
    """

    def __init__(self, output: str) -> None:
        super().__init__(output)
        self.output = output


class Steps:
    """
    The steps of one run, which are counted, timed and logged.

    :param total: how many steps this run has.
    :param log: file that takes everything the commands print.
    :param lock: file descriptor that each command inherits, so that what outlives a killed run
        still keeps the next one waiting.
    """

    def __init__(self, total: int, log: Path, lock: int) -> None:
        self._total = total
        self._done = 0
        self._log = log
        self._lock = lock
        self._terminal = sys.stdout.isatty()
        self._label = ''
        self._started = 0.0

    def run(self, title: str, typical_s: int, work: Callable[[], None]) -> None:
        """
        Do one step and show it.

        :param title: what is being done, as in "installing the tools".
        :param typical_s: how long this usually takes, in seconds.
        :param work: does the step; its commands go through :meth:`command`.
        """
        self._done += 1
        self._started = time.monotonic()
        self._label = f'[{self._done}/{self._total}] {title} (about {typical_s} s) ...'
        print(self._label, end='' if self._terminal else '\n', flush=True)
        try:
            work()
        except BaseException:
            if self._terminal:
                print(flush=True)
            raise
        done = f'done in {time.monotonic() - self._started:.0f} s'
        print(
            f'\r\x1b[K{self._label} {done}' if self._terminal
            else f'[{self._done}/{self._total}] {done}',
            flush=True,
        )

    def command(self, arguments: Sequence[str], env: Mapping[str, str], cwd: Path) -> None:
        """
        Run a command to its end, or end it when this run is interrupted.

        :param arguments: the command and its arguments.
        :param env: its whole environment.
        :param cwd: where it runs.
        :raises CommandError: if it ends with another code than 0.
        """
        self._log.parent.mkdir(parents=True, exist_ok=True)
        with self._log.open('ab') as log:
            log.write(f'\n$ {" ".join(arguments)}\n'.encode())
            log.flush()
            start = log.tell()
            with subprocess.Popen(
                arguments, env=env, cwd=cwd, stdin=subprocess.DEVNULL, stdout=log,
                stderr=subprocess.STDOUT, pass_fds=(self._lock,), start_new_session=True,
            ) as process:
                try:
                    self._wait(process)
                except BaseException:
                    _end_group(process)
                    raise
        if process.returncode != 0:
            with self._log.open('rb') as log:
                log.seek(start)
                output = log.read().decode(errors='replace')
            raise CommandError(output)

    def _wait(self, process: 'subprocess.Popen[bytes]') -> None:
        if not self._terminal:
            process.wait()
            return
        while True:
            try:
                process.wait(timeout=1.0)
            except subprocess.TimeoutExpired:
                elapsed = time.monotonic() - self._started
                print(f'\r\x1b[K{self._label} {elapsed:.0f} s', end='', flush=True)
            else:
                return


def _end_group(process: 'subprocess.Popen[bytes]') -> None:
    """End a command and everything that it started."""
    for number in (signal.SIGTERM, signal.SIGKILL):
        try:
            os.killpg(process.pid, number)
            process.wait(timeout=5.0)
        except (ProcessLookupError, subprocess.TimeoutExpired):
            continue
