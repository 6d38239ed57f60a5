# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A file on a disk that is slow: whoever opens it waits until the test lets it go on."""

import contextlib
import fcntl
import os
import signal

from deadline import wait_until


class SlowFile:
    """
    A file that others wait for, by a lease of Linux.

    :param path: its path.
    :param text: what it has at first; with a text, nobody waits before :meth:`hold`.
    """

    def __init__(self, path, text=''):
        self.path = path
        path.write_text(text)
        # The kernel tells the holder of a lease by this signal, which would end the process.
        signal.signal(signal.SIGIO, signal.SIG_IGN)
        if not text:
            self.hold()

    def hold(self):
        """Let everybody wait who opens it from now on."""
        self._descriptor = os.open(self.path, os.O_RDWR)
        self._lease(fcntl.F_WRLCK)

    @contextlib.contextmanager
    def opened(self):
        """Wait until another process opens it, and let that wait until the end of the block."""
        wait_until(
            lambda: fcntl.fcntl(self._descriptor, fcntl.F_GETLEASE) != fcntl.F_WRLCK,
            what=lambda: f'somebody to open {self.path}')
        yield self
        self._lease(fcntl.F_UNLCK)
        os.close(self._descriptor)

    def write(self, text):
        """Set what it holds."""
        os.ftruncate(self._descriptor, 0)
        os.pwrite(self._descriptor, text.encode(), 0)

    def _lease(self, lease):
        fcntl.fcntl(self._descriptor, fcntl.F_SETLEASE, lease)
