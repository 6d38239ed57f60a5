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
from types import TracebackType
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
    # Python calls this one if it has no memory for the arguments of the first one.
    sys.excepthook = _end_at_failure_of_hook


def _end_after_exception(failure: threading.ExceptHookArgs) -> None:
    if failure.exc_type is MemoryError:
        end_without_memory()
    if failure.exc_type is SystemExit:
        return
    try:
        name = failure.thread.name if failure.thread else ''
        _print_exception(f'thread "{name}" has failed, so the node ends', failure.exc_value)
    finally:
        os._exit(1)


def _end_at_failure_of_hook(
    error_type: type[BaseException], error: BaseException, place: TracebackType | None,
) -> None:
    if error_type is MemoryError:
        end_without_memory()
    sys.__excepthook__(error_type, error, place)


def _end_if_without_memory(failure: sys.UnraisableHookArgs) -> None:
    if failure.exc_type is MemoryError:
        end_without_memory()
    # While the interpreter ends, nothing can be imported, and nothing depends on the object.
    if not sys.is_finalizing():
        what = failure.err_msg or 'exception ignored in'
        _print_exception(f'{what} {failure.object!r}', failure.exc_value)


def _print_exception(sentence: str, error: BaseException | None) -> None:
    # Imported here because the executables need this module before their other imports.
    from sdf_pose_bridge.ros.log_lines import line_from_text, lines_from_traceback
    lines = [f'sdf_pose_bridge: {line_from_text(sentence)}', *lines_from_traceback(error)]
    print(*lines, sep='\n', file=sys.stderr, flush=True)
