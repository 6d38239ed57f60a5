# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read the texts of ``<pose>``: x y z and a unit quaternion.

The attributes ``rotation_format`` and ``degrees`` define the numbers (``pose.sdf`` of
http://sdformat.org/spec). White space separates them, and the rest of a word behind a number is
ignored. Quaternions are normalised, unlike by libsdformat.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import math
import re

import numpy as np

from sdf_pose_bridge.geometry.pose_attributes import (
    FORMAT_ATTRIBUTES,
    pose_format_from_attributes,
    PoseFormat,
    PoseTextError,
)
from sdf_pose_bridge.geometry.poses import Pose, PoseArray
from sdf_pose_bridge.geometry.rotations import Floats, quaternion_from_rpy, rpy_from_quaternion
from sdf_pose_bridge.geometry.units import LARGEST_ANGLE_RAD
from sdf_pose_bridge.sdformat.values import (
    doubt_about_numbers,
    is_representable,
    number_from_word,
    plain_numbers_from_text,
)
from sdf_pose_bridge.sdformat.xml_tree import attribute_of, WHITE_SPACE, words_of, XmlElement

_SHORTEST_QUATERNION = 1e-9
"""A quaternion with a smaller norm has no meaningful direction."""

_LARGEST_NORM = 1e150
"""The squares of larger norms are beyond the range of a double."""

_NORM_TOLERANCE = 1e-3
"""A quaternion whose norm differs more from 1 is probably a mistake."""

_IDENTITY = '0 0 0 0 0 0', '0 0 0 0 0 0 1'
"""The poses that blank texts are, in Euler angles and with a quaternion."""

_BEGINNING_OF_NUMBER = re.compile(r'[+-]?\.?[0-9]')


EULER_RPY = PoseFormat()
"""The default."""


def pose_format_of(xml: XmlElement) -> PoseFormat:
    """Read the format of a ``<pose>``; raise PoseTextError if it has an invalid attribute."""
    return pose_format_from_attributes(
        **{name: attribute_of(xml, name) for name in FORMAT_ATTRIBUTES})


def pose_from_text(text: str, pose_format: PoseFormat) -> tuple[Pose, list[str]]:
    """
    Convert one text.

    :param text: a pose as written; a blank text is the identity.
    :return: the pose, and the reasons why it may be a mistake.
    :raises PoseTextError: if it is not a pose.
    """
    numbers = np.array([pose_numbers_from_text(text, pose_format)[0]])
    doubts = [doubt for _, doubt in pose_doubts([text], numbers, pose_format)]
    return Pose(*poses_from_numbers(numbers, pose_format)[0].tolist()), doubts


def text_from_pose(pose: Pose) -> str:
    """
    Write a pose in the plain format, x y z roll pitch yaw, with all digits.

    :param pose: a pose whose numbers are in the range of a double.
    """
    numbers = (*pose[:3], *rpy_from_quaternion(pose[3:]))
    return ' '.join(
        repr(number if is_representable('1', number) else 0.0) for number in numbers)


def pose_numbers_from_text(text: str, pose_format: PoseFormat) -> tuple[Sequence[float], str]:
    """
    Read the numbers of a text.

    :return: x y z roll pitch yaw, or x y z qx qy qz qw, of which a quaternion that is too large is
        scaled; and a message if they are not the numbers that are written, else empty.
    :raises PoseTextError: if the text is not a pose.
    """
    text = text.strip(WHITE_SPACE) or _IDENTITY[pose_format.is_quaternion]
    numbers, doubt = plain_numbers_from_text(text), ''
    if len(numbers) != (7 if pose_format.is_quaternion else 6):
        numbers = _numbers_from_words(text, pose_format)
        doubt = doubt_about_numbers(text, numbers)
        doubt = f'the pose "{_shown(text)}" {doubt}' if doubt else ''
    if pose_format.is_quaternion:
        norm = math.hypot(*numbers[3:])
        if norm < _SHORTEST_QUATERNION or math.isinf(norm):
            rule = ('zero, so it is not a rotation' if norm < _SHORTEST_QUATERNION
                    else 'beyond the range of a double')
            msg = f'the quaternion of the pose "{_shown(text)}" is {rule}'
            raise PoseTextError(msg)
        if norm > _LARGEST_NORM:
            numbers = [*numbers[:3], *(number / norm for number in numbers[3:])]
    return numbers, doubt


def _numbers_from_words(text: str, pose_format: PoseFormat) -> Sequence[float]:
    layout = 'x y z qx qy qz qw' if pose_format.is_quaternion else 'x y z roll pitch yaw'
    count = 7 if pose_format.is_quaternion else 6
    words = words_of(text)
    numbers: list[float] = []
    for word in words[:count]:
        read = number_from_word(word)
        if not read or not math.isfinite(read[0]):
            is_number = not read and _BEGINNING_OF_NUMBER.match(word)
            rule = 'beyond the range of a double' if is_number else 'not a finite number'
            msg = f'"{word[:80]}" in the pose "{_shown(text)}" is {rule}'
            raise PoseTextError(msg)
        numbers += read
    if len(words) != count:
        hint = '; did you mean rotation_format="quat_xyzw"?' if len(words) == 7 else (
            '; separate them by blanks' if ',' in text else '')
        msg = f'a pose has {count} values ({layout}), "{_shown(text)}" has {len(words)}{hint}'
        raise PoseTextError(msg)
    return numbers


def pose_doubts(
    texts: Sequence[str], numbers: Floats, pose_format: PoseFormat,
) -> Iterator[tuple[int, str]]:
    """
    Find poses that may be mistakes.

    :param numbers: those of the texts, shape (n, 6) or (n, 7).
    :return: the row of each of them, and the reason.
    """
    if pose_format.is_quaternion:
        is_doubtful = np.abs(np.linalg.norm(numbers[:, 3:], axis=1) - 1.0) > _NORM_TOLERANCE
        doubt = 'the quaternion of the pose "{}" is not of length 1; it is normalised'
    else:
        largest_rad = math.inf if pose_format.is_degrees else LARGEST_ANGLE_RAD
        is_doubtful = np.abs(numbers[:, 3:]).max(axis=1) > largest_rad
        doubt = 'the angles of the pose "{}" are radians; did you mean degrees="true"?'
    for row in np.flatnonzero(is_doubtful).tolist():
        yield row, doubt.format(_shown(texts[row]))


def poses_from_numbers(numbers: Floats, pose_format: PoseFormat) -> PoseArray:
    """
    Convert the numbers of many poses.

    :param numbers: shape (n, 6) or (n, 7), each as from :func:`pose_numbers_from_text`.
    :return: shape (n, 7).
    """
    rotations = numbers[:, 3:]
    if pose_format.is_quaternion:
        norms = np.sqrt(np.einsum('ij,ij->i', rotations, rotations))
        quaternions = rotations / norms[:, np.newaxis]
    else:
        quaternions = quaternion_from_rpy(
            np.radians(rotations) if pose_format.is_degrees else rotations)
    return np.hstack((numbers[:, :3], quaternions))


def _shown(text: str) -> str:
    shown = ' '.join(words_of(text))
    return shown if len(shown) <= 80 else shown[:77] + '...'
