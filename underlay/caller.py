# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What commands that install, build and release have of the caller's environment."""

from collections.abc import Mapping
import re

# Each would make them find another Python or another ROS, install elsewhere, or install modules
# that have to be compiled at every start. Proxies, certificates and compilers come in.
_FOREIGN = re.compile(
    r'MAKE.*|MFLAGS|VIRTUAL_ENV|PYTHON.*|PIP_(PREFIX|PYTHON|REQUIRE_VIRTUALENV|ROOT|TARGET|USER)'
    r'|(AMENT|CMAKE|COLCON|RMW|_?ROS)_.*')


def environment_of_caller(environment: Mapping[str, str]) -> dict[str, str]:
    """Return the caller's variables without those."""
    return {name: value for name, value in environment.items() if not _FOREIGN.fullmatch(name)}
