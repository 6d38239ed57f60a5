# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Run the command line as ``python -m sdf_pose_bridge``."""

import sys

from sdf_pose_bridge.cli.main import main

if __name__ == '__main__':
    sys.exit(main())
