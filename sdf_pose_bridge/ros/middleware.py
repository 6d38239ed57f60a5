# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Choose the profile of Fast DDS, the default middleware of ROS 2.

With the default settings of the Fast DDS of ROS 2 Jazzy the first message arrives late in many
starts; the profile of this package says why.
"""

from __future__ import annotations

from collections.abc import Mapping
from collections.abc import MutableMapping
from pathlib import Path

from ament_index_python.packages import get_package_share_directory

PROFILE = 'config/fastdds_profile.xml'
"""The profile of this package, below its share directory."""

PROFILES_VARIABLE = 'FASTRTPS_DEFAULT_PROFILES_FILE'
"""The environment variable that the Fast DDS of ROS 2 Jazzy reads."""

NEW_PROFILES_VARIABLE = 'FASTDDS_DEFAULT_PROFILES_FILE'
"""Its name in later versions of Fast DDS; the version of ROS 2 Jazzy ignores it."""

LOCAL_PROFILES = 'DEFAULT_FASTRTPS_PROFILES.xml'
"""The file that Fast DDS reads from the working directory."""

DISTRO = 'jazzy'
"""The distribution of ROS 2 whose Fast DDS understands the profile.

Fast DDS 3, which Kilted has, refuses a file with ``<throughputController>``.
"""

_FAST_DDS = ('', 'rmw_fastrtps_cpp', 'rmw_fastrtps_dynamic_cpp')


def use_profile(environment: MutableMapping[str, str]) -> str:
    """
    Make Fast DDS use the profile of this package, unless the user has chosen another one.

    :param environment: the environment variables of the process. Fast DDS reads them when the
        first node is created.
    :return: one sentence for the log: the profile that is used, or why it is not.
    """
    reason = _reason_against_profile(environment)
    if reason:
        return f'the Fast DDS profile of this package is not used: {reason}'
    try:
        share = get_package_share_directory('sdf_pose_bridge')
    except (LookupError, OSError):
        return 'the Fast DDS profile of this package is not used: the package is not installed'
    environment[PROFILES_VARIABLE] = str(Path(share, PROFILE))
    return (f'the Fast DDS profile {environment[PROFILES_VARIABLE]} is used; set '
            f'{PROFILES_VARIABLE} to use your own, or {NEW_PROFILES_VARIABLE} to an empty string '
            'to use none')


def _reason_against_profile(environment: Mapping[str, str]) -> str:
    middleware = environment.get('RMW_IMPLEMENTATION', '')
    if middleware not in _FAST_DDS:
        return f'the middleware is {middleware}'
    for variable in (PROFILES_VARIABLE, NEW_PROFILES_VARIABLE):
        if variable in environment:
            return f'{variable} is set'
    if Path(LOCAL_PROFILES).exists():
        return f'{LOCAL_PROFILES} is in the working directory'
    distro = environment.get('ROS_DISTRO', '')
    if distro != DISTRO:
        return f'it is for ROS 2 {DISTRO}, and ROS_DISTRO is "{distro}"'
    return ''
