# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
End the process when the node cannot go on, so that a launch file can start it again.

After a MemoryError, rclpy would lose callbacks, and block their groups for ever.
"""

from __future__ import annotations

import os
import sys
import threading
import traceback
from typing import NoReturn

_NO_MEMORY = b'sdf_pose_bridge: there is not enough memory, so the node ends\n'


def end_without_memory() -> NoReturn:
    """End the process with a line and exit code 1; this needs no memory."""
    try:
        os.write(2, _NO_MEMORY)
    finally:
        os._exit(1)


def end_at_failures_of_threads() -> None:
    """
    End the process after an exception in any thread but the first one.

    A MemoryError ends it too where Python would only report it: in the first steps of a thread,
    and while an object is destroyed.
    """
    threading.excepthook = _end_after_exception
    sys.unraisablehook = _end_if_without_memory


def _end_after_exception(failure: threading.ExceptHookArgs) -> None:
    if failure.exc_type is MemoryError:
        end_without_memory()
    if failure.exc_type is SystemExit:
        return
    try:
        name = failure.thread.name if failure.thread else ''
        print(f'sdf_pose_bridge: thread "{name}" has failed, so the node ends', file=sys.stderr)
        traceback.print_exception(failure.exc_value, file=sys.stderr)
        sys.stderr.flush()
    finally:
        os._exit(1)


def _end_if_without_memory(failure: sys.UnraisableHookArgs) -> None:
    if failure.exc_type is MemoryError:
        end_without_memory()
    sys.__unraisablehook__(failure)
