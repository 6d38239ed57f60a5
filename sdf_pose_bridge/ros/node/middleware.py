# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Choose a profile of the middleware.

With the default settings of Fast DDS, the default middleware of ROS 2, the first message arrives
late in many starts, as the profiles of this package explain. Other middlewares need none.
"""

from __future__ import annotations

from collections.abc import MutableMapping
from pathlib import Path
from typing import NamedTuple

from ament_index_python.packages import get_package_share_directory


class Profile(NamedTuple):
    """A profile of this package, and the other sources of profiles of its middleware."""

    middlewares: tuple[str, ...]
    """Values of ``RMW_IMPLEMENTATION``."""
    distros: tuple[str, ...]
    """The distributions of ROS 2 whose version of the middleware accepts it."""
    file: str
    """Path of the profile in the share directory of this package."""
    variable: str
    """The environment variable with the path of a file of profiles."""
    local_file: str = ''
    """The name of a file of profiles that is used in the working directory, if there is one."""


_FAST_DDS = ('', 'rmw_fastrtps_cpp', 'rmw_fastrtps_dynamic_cpp')

PROFILES = (
    Profile(_FAST_DDS, ('jazzy',), 'config/fastdds_profile.xml', 'FASTRTPS_DEFAULT_PROFILES_FILE',
            'DEFAULT_FASTRTPS_PROFILES.xml'),
    Profile(_FAST_DDS, ('kilted', 'lyrical'), 'config/fastdds3_profile.xml',
            'FASTDDS_DEFAULT_PROFILES_FILE', 'DEFAULT_FASTDDS_PROFILES.xml'),
)
"""The profiles; a version of a middleware ignores the variables of the others."""


def use_profile(environment: MutableMapping[str, str]) -> str:
    """
    Make the middleware use the profile of this package, unless the user has chosen another one.

    :param environment: the environment variables of the process. The middleware reads them when
        the first node is created.
    :return: one sentence for the log: the profile that is used, or why it is not.
    """
    middleware = environment.get('RMW_IMPLEMENTATION', '')
    distro = environment.get('ROS_DISTRO', '')
    profiles = [each for each in PROFILES if middleware in each.middlewares]
    variables = [each.variable for each in profiles]
    chosen = [variable for variable in variables if variable in environment]
    profile = next((each for each in profiles if distro in each.distros), None)
    if not profiles:
        reason = f'the middleware is {middleware}'
    elif chosen:
        reason = f'{chosen[0]} is set'
    elif profile is None:
        reason = f'there is none for ROS_DISTRO "{distro}"'
    elif Path(profile.local_file).is_file():
        reason = f'{profile.local_file} is in the working directory'
    else:
        try:
            path = str(Path(get_package_share_directory('sdf_pose_bridge'), profile.file))
        except (LookupError, OSError):
            reason = 'the package is not installed'
        else:
            environment[profile.variable] = path
            other = next((f', or {each} to an empty string to use none'
                          for each in variables if each != profile.variable), '')
            return (f'the middleware profile {path} is used; set {profile.variable} to use your '
                    f'own{other}')
    return f'no middleware profile of this package is used: {reason}'
