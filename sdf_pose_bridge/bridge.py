# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The executable ``bridge``: runs the node from its start to a clean end."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Iterator
from collections.abc import Sequence
from contextlib import contextmanager
import os
import signal
import sys
from types import FrameType

BUILD_COMMAND = 'colcon build --base-paths src src/<repo>/sdf_pose_bridge_interfaces'
"""Builds both packages in a workspace, where plain ``colcon build`` finds only one of them."""

MISSING_INTERFACES = (
    'sdf_pose_bridge_interfaces is not built or not in this environment; in the workspace type '
    f'"{BUILD_COMMAND}" (<repo> is the folder of the repository) and then '
    '". install/setup.bash"')
"""What to do if the interfaces are missing."""

MISSING_MODULE = (
    'the Python module {module} is missing; the node needs a shell with ROS 2 Jazzy, as after '
    '". /opt/ros/jazzy/setup.bash", and what "rosdep install --from-paths src --ignore-src" '
    'installs')
"""What to do if anything else is missing that the node imports."""

USAGE = """\
Publish every frame of an SDFormat file on TF and on topics.

usage: ros2 run sdf_pose_bridge bridge --ros-args -p sdf_file:=cell.sdf [-p name:=value ...]

"ros2 param describe /sdf_pose_bridge <name>" explains each parameter of the running node."""

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class StopRequest:
    """
    Takes note of SIGINT and SIGTERM from the moment it is made; both mean a good end.

    Until there is something to clean up, the first of them ends the process.
    """

    def __init__(self) -> None:
        self._is_made = False
        self._reaction: Callable[[], None] = _exit_at_once
        for number in SIGNALS:
            signal.signal(number, self._take)

    def is_made(self) -> bool:
        """Tell whether a signal has come."""
        return self._is_made

    def defer(self) -> None:
        """Only take note from now on, since there is something to clean up."""
        self._reaction = _do_nothing

    @contextmanager
    def interrupting(self) -> Iterator[None]:
        """
        Let a signal interrupt what is done meanwhile, which must be able to bear it.

        :raises KeyboardInterrupt: if a signal comes, or came before.
        """
        self._reaction = _interrupt
        try:
            if self._is_made:
                _interrupt()
            yield
        finally:
            self._reaction = _do_nothing

    def ignore_further(self) -> None:
        """Take no more notice, so that an end that has begun goes on in peace."""
        for number in SIGNALS:
            signal.signal(number, signal.SIG_IGN)

    def _take(self, _number: int, _frame: FrameType | None) -> None:
        self._is_made = True
        self._reaction()


def _do_nothing() -> None:
    pass


def _interrupt() -> None:
    raise KeyboardInterrupt


def _exit_at_once() -> None:
    # An exception instead could be caught or reported by whatever import it comes out of.
    os._exit(0)


def main(args: Sequence[str] | None = None) -> int:
    """
    Run the node until it is told to stop.

    :param args: the command line with the program's name first; that of the process if None.
    :return: exit code: 0 after SIGINT or SIGTERM, 1 if the node could not start.
    """
    stop = StopRequest()
    try:
        from sdf_pose_bridge.running import run
    except ImportError as error:
        print(f'sdf_pose_bridge: {sentence_from_import_error(error)}', file=sys.stderr)
        return 1
    try:
        return run(list(sys.argv if args is None else args), stop)
    finally:
        stop.ignore_further()


def sentence_from_import_error(error: ImportError) -> str:
    """
    Tell what to do about a failed import.

    :param error: what the import raised.
    :return: one sentence.
    """
    module = (error.name or '').partition('.')[0]
    if module == 'sdf_pose_bridge_interfaces':
        return MISSING_INTERFACES
    if isinstance(error, ModuleNotFoundError) and module != 'sdf_pose_bridge':
        return MISSING_MODULE.format(module=module)
    first_line = str(error).partition('\n')[0]
    return f'a module that the node needs cannot be loaded: {first_line}'
