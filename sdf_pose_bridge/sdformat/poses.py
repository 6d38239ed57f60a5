# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read the texts of ``<pose>``: x y z and a unit quaternion.

The attributes ``rotation_format`` and ``degrees`` define the numbers (``pose.sdf`` of
http://sdformat.org/spec). Only decimal numbers are accepted, unlike by C's ``strtod``: no
``0x10``, no ``1.5abc``. A comma may follow each number, as in ``1, 2, 3``, but does not separate
numbers. Quaternions are normalised, unlike by libsdformat.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import math
import re
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.formats import LARGEST_ANGLE_RAD
from sdf_pose_bridge.geometry.poses import Pose, PoseArray
from sdf_pose_bridge.geometry.rotations import Floats, quaternion_from_rpy, rpy_from_quaternion
from sdf_pose_bridge.sdformat.values import (
    boolean_from_text,
    DECIMAL,
    is_representable,
    plain_numbers_from_text,
)
from sdf_pose_bridge.sdformat.xml_tree import attribute_of, WHITE_SPACE, XmlElement

_SHORTEST_QUATERNION = 1e-9
"""A quaternion with a smaller norm has no meaningful direction."""

_LARGEST_NORM = 1e150
"""The squares of larger norms are beyond the range of a double."""

_NORM_TOLERANCE = 1e-3
"""A quaternion whose norm differs more from 1 is probably a mistake."""

_DECIMAL_NUMBER = re.compile(rf'[+-]?{DECIMAL}')


class PoseFormat(NamedTuple):
    """The format of the numbers of a pose."""

    is_quaternion: bool = False
    """True for ``rotation_format="quat_xyzw"``, False for ``euler_rpy``."""
    is_degrees: bool = False
    """Whether roll, pitch and yaw are in degrees."""


class PoseTextError(ValueError):
    """The text is not a pose; the message has the value and the rule."""


def pose_format_of(xml: XmlElement) -> PoseFormat:
    """
    Read the format of a ``<pose>``.

    :raises PoseTextError: if ``rotation_format`` or ``degrees`` is not valid.
    """
    if not xml.keys():
        return PoseFormat()
    rotation_format = attribute_of(xml, 'rotation_format')
    pose_format = PoseFormat(
        rotation_format == 'quat_xyzw', boolean_from_text(xml.get('degrees', '')) is True)
    if rotation_format not in ('', 'euler_rpy', 'quat_xyzw'):
        msg = f'rotation_format="{rotation_format}" must be euler_rpy or quat_xyzw'
        raise PoseTextError(msg)
    if pose_format.is_quaternion and pose_format.is_degrees:
        msg = 'degrees="true" cannot be combined with rotation_format="quat_xyzw"'
        raise PoseTextError(msg)
    return pose_format


def pose_from_text(text: str, pose_format: PoseFormat) -> Sequence[float]:
    """
    Convert one text.

    :param text: a pose as written; a blank text is the identity.
    :return: x y z in metres, unit quaternion x y z w.
    :raises PoseTextError: if it is not a pose.
    """
    numbers = np.array([pose_numbers_from_text(text, pose_format)])
    pose: list[float] = poses_from_numbers(numbers, pose_format)[0].tolist()
    return pose


def text_from_pose(pose: Pose) -> str:
    """
    Write a pose in the plain format, x y z roll pitch yaw, with all digits.

    :param pose: a pose whose numbers are in the range of a double.
    """
    numbers = (*pose[:3], *rpy_from_quaternion(pose[3:]))
    return ' '.join(
        repr(number if is_representable('1', number) else 0.0) for number in numbers)


def pose_numbers_from_text(text: str, pose_format: PoseFormat) -> Sequence[float]:
    """
    Read the numbers of a text.

    :return: x y z roll pitch yaw, or x y z qx qy qz qw; a quaternion that is too large is scaled.
    :raises PoseTextError: if the text is not a pose.
    """
    numbers = plain_numbers_from_text(text)
    if len(numbers) != (7 if pose_format.is_quaternion else 6):
        numbers = _numbers_from_words(text, pose_format)
    if pose_format.is_quaternion:
        norm = math.hypot(*numbers[3:])
        if norm < _SHORTEST_QUATERNION or math.isinf(norm):
            rule = ('zero, so it is not a rotation' if norm < _SHORTEST_QUATERNION
                    else 'beyond the range of a double')
            msg = f'the quaternion of the pose "{_shown(text)}" is {rule}'
            raise PoseTextError(msg)
        if norm > _LARGEST_NORM:
            return [*numbers[:3], *(number / norm for number in numbers[3:])]
    return numbers


def _numbers_from_words(text: str, pose_format: PoseFormat) -> Sequence[float]:
    layout = 'x y z qx qy qz qw' if pose_format.is_quaternion else 'x y z roll pitch yaw'
    count = len(layout.split())
    words = _words(text) or '0 0 0 0 0 0 1'.split()[:count]
    plain_words = [word.removesuffix(',') for word in words]
    for word, plain in zip(words[:count], plain_words, strict=False):
        is_decimal = _DECIMAL_NUMBER.fullmatch(plain) is not None
        if not is_decimal or not is_representable(plain, float(plain)):
            rule = 'beyond the range of a double' if is_decimal else 'not a finite decimal number'
            msg = f'"{word[:80]}" in the pose "{_shown(text)}" is {rule}'
            raise PoseTextError(msg)
    if len(words) != count:
        hint = '' if len(words) != 7 else '; did you mean rotation_format="quat_xyzw"?'
        msg = f'a pose has {count} values ({layout}), "{_shown(text)}" has {len(words)}{hint}'
        raise PoseTextError(msg)
    return [*map(float, plain_words)]


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
    for row, text in enumerate(texts):
        if ',' in text:
            yield row, (f'the commas in the pose "{_shown(text)}" are ignored; only white space '
                        'separates numbers')


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


def _words(text: str) -> list[str]:
    return re.findall(f'[^{WHITE_SPACE}]+', text)


def _shown(text: str) -> str:
    shown = ' '.join(_words(text))
    return shown if len(shown) <= 80 else shown[:77] + '...'
