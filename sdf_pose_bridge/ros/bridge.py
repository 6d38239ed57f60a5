# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The executable ``bridge``: runs the node from its start to a clean end."""

from __future__ import annotations

from collections.abc import Sequence
import gc
import os
import sys

from sdf_pose_bridge.ros.stop_request import StopRequest

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


def main(args: Sequence[str] | None = None) -> int:
    """
    Run the node until it is told to stop.

    :param args: the command line with the program's name first; that of the process if None.
    :return: exit code: 0 after SIGINT or SIGTERM, 1 if the node could not start.
    """
    stop = StopRequest()
    # Nothing that a start leaves behind is garbage; to look for some would take a tenth of it.
    gc.disable()
    # numpy's threads for large matrices, which there are none of here, would spin for a while.
    os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
    # Functions of ROS's libraries are looked up when they are called, as in programs in C++; most
    # never are.
    if sys.platform != 'win32':
        sys.setdlopenflags(os.RTLD_LAZY)
    try:
        from sdf_pose_bridge.ros.process import run
        return run(list(sys.argv if args is None else args), stop)
    except ImportError as error:
        print(f'sdf_pose_bridge: {sentence_from_import_error(error)}', file=sys.stderr)
        return 1
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
