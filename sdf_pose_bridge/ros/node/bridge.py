# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The executables of the node; they handle signals before the slow import of ROS."""

from __future__ import annotations

from collections.abc import Sequence
import gc
import os
import signal
import sys

from sdf_pose_bridge.printed_text import printable
from sdf_pose_bridge.ros.node.ending import end_without_memory

LINK_COMMAND = 'ln -s sdf_pose_bridge/sdf_pose_bridge_interfaces .'
"""Shows colcon the second package, in the folder ``src`` of a workspace."""

MISSING_INTERFACES = (
    'sdf_pose_bridge_interfaces is not built or not in this environment; in the folder src of the '
    f'workspace type "{LINK_COMMAND}" if this link is missing, and in the workspace '
    '"colcon build" and ". install/setup.bash"')
"""Message if the interfaces are missing."""

MISSING_MODULE = (
    'the Python module {module} is missing; the node needs a shell with ROS 2, as after '
    '". /opt/ros/jazzy/setup.bash", and the packages that "rosdep install --from-paths src '
    '--ignore-src" installs')
"""Message if another module is missing that the node imports."""


def robot_state_publisher() -> int:
    """Run the node with the name and the defaults of robot_state_publisher."""
    return main(program='robot_state_publisher')


def main(args: Sequence[str] | None = None, program: str = 'bridge') -> int:
    """
    Run the node until a signal ends it.

    :param args: the command line with the program's name first; by default ``sys.argv``.
    :param program: the name of the executable.
    :return: exit code: 0 after SIGINT or SIGTERM, 1 if the node could not start.
    """
    for number in (signal.SIGINT, signal.SIGTERM):
        # No exception, which the interrupted import could catch or report.
        signal.signal(number, lambda _number, _frame: os._exit(0))
    # The installed executable has blocked them in its first line.
    signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT, signal.SIGTERM])
    # Garbage collection would delay the start, and there is no garbage.
    gc.disable()
    # Threads of numpy for large matrices, which the node does not have, would spin at first.
    os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
    # Resolve functions of ROS's libraries at their first call, as programs in C++ do.
    sys.setdlopenflags(os.RTLD_LAZY)
    try:
        from sdf_pose_bridge.ros.file_process import FileProcess
        # It forks a process, so it comes before ROS, which starts threads when it is imported.
        reader = FileProcess()
        from sdf_pose_bridge.ros.node.process import run
        return run(list(sys.argv if args is None else args), program, reader)
    except ImportError as error:
        print(f'sdf_pose_bridge: {printable(sentence_from_import_error(error))}', file=sys.stderr)
        return 1
    except MemoryError:
        end_without_memory()
    except OSError as error:  # such as too many open files
        print(f'sdf_pose_bridge: the node cannot start: {printable(str(error))}', file=sys.stderr)
        return 1


def sentence_from_import_error(error: ImportError) -> str:
    """Return a message with a remedy for a failed import."""
    module = (error.name or '').partition('.')[0]
    if module == 'sdf_pose_bridge_interfaces':
        return MISSING_INTERFACES
    if isinstance(error, ModuleNotFoundError) and module != 'sdf_pose_bridge':
        return MISSING_MODULE.format(module=module)
    first_line = str(error).partition('\n')[0]
    return f'a module that the node needs cannot be loaded: {first_line}'
