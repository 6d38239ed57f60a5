# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""How much tests do that could do much more: less by ``make test`` than ``make test_long``."""

import os


def size(short, long):
    """Return the second number where ``LONG`` is set in the environment, else the first."""
    return long if os.environ.get('LONG') else short
