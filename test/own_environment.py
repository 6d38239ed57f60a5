# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The environment variables of tests, and of the processes that they start."""

import os
import re

_COME_IN = re.compile('|'.join((
    'PATH|TMPDIR',
    # What the Makefile and underlay/setup.bash set, or the setup.bash of ROS.
    'ROS|VERSIONS|RCLPY|RMW|RMW_FOLDER|RMW_IMPLEMENTATION|LD_PRELOAD|LD_LIBRARY_PATH',
    'ROS_DISTRO|ROS_VERSION|ROS_PYTHON_VERSION|_ROS_WHEELS_BOOTSTRAP_COMPLETE',
    '(AMENT|CMAKE|COLCON)_PREFIX_PATH|PKG_CONFIG_PATH|PYTHONPATH|PYTHONNOUSERSITE|VIRTUAL_ENV',
    # What says how tests run. In CI, pytest does not cut its last lines.
    'LONG|PYTEST_.*|COVERAGE_.*|CI|BUILD_NUMBER')))
_OWN = {
    'COLUMNS': '80', 'LC_ALL': 'C.UTF-8', 'PIP_CONFIG_FILE': os.devnull,
    'GIT_CONFIG_GLOBAL': os.devnull, 'GIT_CONFIG_NOSYSTEM': '1'}


def environment_of_tests(environment, home):
    """Return what tests have of the caller's environment, and what is their own."""
    return {**{name: value for name, value in environment.items() if _COME_IN.fullmatch(name)},
            **_OWN, 'HOME': home}
