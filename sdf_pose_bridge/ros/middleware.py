# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Choose the profile of Fast DDS, the default middleware of ROS 2.

With its default settings, the first message arrives late in many starts, as the profiles of this
package explain.
"""

from __future__ import annotations

from collections.abc import MutableMapping
from pathlib import Path
from typing import NamedTuple

from ament_index_python.packages import get_package_share_directory


class Profile(NamedTuple):
    """A profile of this package, and the other sources of profiles of its Fast DDS."""

    file: str
    """Path of the profile in the share directory of this package."""
    variable: str
    """The environment variable with the path of a file of profiles."""
    local_file: str
    """The name of a file of profiles that is used in the working directory."""


FAST_DDS_2 = Profile(
    'config/fastdds_profile.xml', 'FASTRTPS_DEFAULT_PROFILES_FILE',
    'DEFAULT_FASTRTPS_PROFILES.xml')
FAST_DDS_3 = Profile(
    'config/fastdds3_profile.xml', 'FASTDDS_DEFAULT_PROFILES_FILE', 'DEFAULT_FASTDDS_PROFILES.xml')

PROFILES = {'jazzy': FAST_DDS_2, 'kilted': FAST_DDS_3, 'lyrical': FAST_DDS_3}
"""The profile for each distribution of ROS 2; their Fast DDS reject each other's."""

VARIABLES = (FAST_DDS_2.variable, FAST_DDS_3.variable)
"""The environment variables; each Fast DDS ignores the other one."""

_FAST_DDS = ('', 'rmw_fastrtps_cpp', 'rmw_fastrtps_dynamic_cpp')


def use_profile(environment: MutableMapping[str, str]) -> str:
    """
    Make Fast DDS use the profile of this package, unless the user has chosen another one.

    :param environment: the environment variables of the process. Fast DDS reads them when the
        first node is created.
    :return: one sentence for the log: the profile that is used, or why it is not.
    """
    middleware = environment.get('RMW_IMPLEMENTATION', '')
    chosen = [variable for variable in VARIABLES if variable in environment]
    distro = environment.get('ROS_DISTRO', '')
    profile = PROFILES.get(distro)
    if middleware not in _FAST_DDS:
        reason = f'the middleware is {middleware}'
    elif chosen:
        reason = f'{chosen[0]} is set'
    elif profile is None:
        reason = f'there is none for ROS_DISTRO "{distro}"'
    elif Path(profile.local_file).exists():
        reason = f'{profile.local_file} is in the working directory'
    else:
        try:
            path = str(Path(get_package_share_directory('sdf_pose_bridge'), profile.file))
        except (LookupError, OSError):
            reason = 'the package is not installed'
        else:
            environment[profile.variable] = path
            (other_variable,) = set(VARIABLES) - {profile.variable}
            return (f'the Fast DDS profile {path} is used; set {profile.variable} to use your '
                    f'own, or {other_variable} to an empty string to use none')
    return f'the Fast DDS profile of this package is not used: {reason}'
