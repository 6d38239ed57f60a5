# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The attributes of ``<pose>`` that define its numbers (``pose.sdf`` of http://sdformat.org/spec)."""

from __future__ import annotations

import re
from typing import NamedTuple

from sdf_pose_bridge.geometry.formats import PoseFormatError

_BOOLEANS = {'true': True, '1': True, 'false': False, '0': False}

ATTRIBUTES_OF_NUMBERS = '@rotation_format @degrees:bool'
"""In the notation of the module ``grammar``."""
FORMAT_ATTRIBUTES = re.findall(r'@(\w+)', ATTRIBUTES_OF_NUMBERS)


class PoseFormat(NamedTuple):
    """The format of the numbers of a pose."""

    is_quaternion: bool = False
    """True for ``rotation_format="quat_xyzw"``, False for ``euler_rpy``."""
    is_degrees: bool = False
    """Whether roll, pitch and yaw are in degrees."""


class PoseTextError(PoseFormatError):
    """The text is not a pose; the message has the value and the rule."""


def boolean_from_text(text: str) -> bool | None:
    """
    Read a boolean.

    :param text: the value, stripped.
    :return: the boolean; None if the text is not ``true``, ``false``, ``1`` or ``0`` in any case.
    """
    return _BOOLEANS.get(text.lower())


def pose_format_from_attributes(rotation_format: str, degrees: str) -> PoseFormat:
    """
    Read the format of a ``<pose>``.

    The arguments are the stripped values of ``FORMAT_ATTRIBUTES``; empty if there is none.

    :raises PoseTextError: if ``rotation_format`` or ``degrees`` is not valid.
    """
    pose_format = PoseFormat(rotation_format == 'quat_xyzw', boolean_from_text(degrees) is True)
    if rotation_format not in ('', 'euler_rpy', 'quat_xyzw'):
        msg = f'rotation_format="{rotation_format}" must be euler_rpy or quat_xyzw'
        raise PoseTextError(msg)
    if pose_format.is_quaternion and pose_format.is_degrees:
        msg = 'degrees="true" cannot be combined with rotation_format="quat_xyzw"'
        raise PoseTextError(msg)
    return pose_format
