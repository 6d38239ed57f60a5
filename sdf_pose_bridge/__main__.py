# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
# PYTHON_ARGCOMPLETE_OK
"""Run the command line: as ``sdf_pose``, or as ``python -m sdf_pose_bridge``."""

import signal
import sys


def main() -> int:
    """Run a command, which signals end at once, also while it imports what is slow."""
    # An exception of Python's would be printed, or caught, where it interrupts. A command in the
    # background of a script ignores the signal.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    # The installed executable has blocked them in its first line.
    signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT, signal.SIGTERM])
    from sdf_pose_bridge.cli.main import main
    return main()


if __name__ == '__main__':
    sys.exit(main())
