# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read ``<pose>`` values: text in one of SDFormat's notations to x y z and a unit quaternion.

Rules: http://sdformat.org/spec, ``pose.sdf`` (``rotation_format``, ``degrees``), and the checks of
libsdformat's ``Param.cc``. Of the numbers that C's ``strtod`` takes, only plain decimal ones are
accepted here: no ``0x10``, no ``1.5abc``.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
import re
import sys
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from sdf_pose_bridge.rotation import quaternion_from_rpy

IDENTITY = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
"""The pose that moves nothing: x y z, quaternion x y z w."""

SMALLEST_QUATERNION_NORM = 1e-9
"""A quaternion shorter than this has no direction that its author can have meant."""

_NUMBER = re.compile(r'[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?')
_NOT_ZERO = re.compile(r'[^eE]*[1-9]')
_NUMBER_CHARACTERS = b'0123456789+-.eE \t\n\r'
_RPY_COUNT = 6
_QUATERNION_COUNT = 7


class PoseText(NamedTuple):
    """The value of one ``<pose>`` as it is written."""

    text: str
    """The numbers."""
    is_quaternion: bool
    """True for ``rotation_format="quat_xyzw"``, false for ``euler_rpy``."""
    is_degrees: bool
    """True if roll, pitch and yaw are in degrees; only where they are given."""


class PoseTextError(ValueError):
    """The text of a pose is not one; the message says why, without the place."""


def poses_from_texts(
    texts: Sequence[PoseText],
) -> tuple[npt.NDArray[np.float64], list[tuple[int, str]]]:
    """
    Read many poses.

    :param texts: n poses as written.
    :return: an array of shape (n, 7): x y z in metres, unit quaternion x y z w; and, for each text
        that is no pose, its index and the reason. The row of such a text is the identity.
    """
    poses = np.zeros((len(texts), 7))
    poses[:, 6] = 1.0
    if _are_plain(texts):
        failures: list[tuple[int, str]] = []
        rows: dict[tuple[bool, bool], list[int]] = {}
        values: dict[tuple[bool, bool], list[float]] = {}
        for index, (text, is_quaternion, is_degrees) in enumerate(texts):
            numbers = text.split()
            if len(numbers) == (_QUATERNION_COUNT if is_quaternion else _RPY_COUNT):
                form = (is_quaternion, is_degrees)
                try:
                    values.setdefault(form, []).extend(list(map(float, numbers)))
                except ValueError:
                    _one_at_a_time(index, texts[index], poses, failures)
                else:
                    rows.setdefault(form, []).append(index)
            elif numbers:
                _one_at_a_time(index, texts[index], poses, failures)
        for form, indices in rows.items():
            table = np.array(values[form]).reshape(len(indices), -1)
            doubtful = set(_fill(poses, np.array(indices), table, *form).tolist())
            # A number too small for a double has become zero by now.
            doubtful.update(index for index in indices if 'e-' in texts[index].text.lower())
            for index in doubtful:
                _one_at_a_time(index, texts[index], poses, failures)
    else:
        failures = []
        for index, pose in enumerate(texts):
            _one_at_a_time(index, pose, poses, failures)
    return poses, sorted(failures)


def pose_from_text(pose: PoseText) -> tuple[float, ...]:
    """
    Read one pose.

    :param pose: a pose as written; blank text is the identity.
    :return: x y z in metres, unit quaternion x y z w.
    :raises PoseTextError: if it is no pose, with the offending value and the rule.
    """
    tokens = re.split(r'[ \t\n\r\f\v]+', pose.text.strip(' \t\n\r\f\v'))
    if tokens == ['']:
        return IDENTITY
    count = _QUATERNION_COUNT if pose.is_quaternion else _RPY_COUNT
    layout = 'x y z qx qy qz qw' if pose.is_quaternion else 'x y z roll pitch yaw'
    shown = ' '.join(tokens)
    shown = shown if len(shown) <= 80 else shown[:77] + '...'
    for token in tokens:
        if not _NUMBER.fullmatch(token):
            msg = f'"{token[:80]}" in the pose "{shown}" is not a finite decimal number'
            raise PoseTextError(msg)
        if not _is_representable(token):
            msg = f'"{token[:80]}" in the pose "{shown}" is beyond the range of a double'
            raise PoseTextError(msg)
    if len(tokens) != count:
        msg = f'a pose has {count} values ({layout}), "{shown}" has {len(tokens)}'
        raise PoseTextError(msg)
    values = [float(token) for token in tokens]
    if not pose.is_quaternion:
        angles = [math.radians(a) for a in values[3:]] if pose.is_degrees else values[3:]
        roll, pitch, yaw = angles
        return (*values[:3], *quaternion_from_rpy((roll, pitch, yaw)))
    norm = math.hypot(*values[3:])
    if norm < SMALLEST_QUATERNION_NORM:
        msg = f'the quaternion of the pose "{shown}" is zero, so it is no rotation'
        raise PoseTextError(msg)
    if math.isinf(norm):
        msg = f'the quaternion of the pose "{shown}" is beyond the range of a double'
        raise PoseTextError(msg)
    return (*values[:3], *(value / norm for value in values[3:]))


def _are_plain(texts: Sequence[PoseText]) -> bool:
    """Tell whether the texts hold nothing that Python and SDFormat read differently."""
    try:
        characters = ' '.join([text[0] for text in texts]).encode('ascii')
    except UnicodeEncodeError:
        return False
    return not characters.translate(None, _NUMBER_CHARACTERS)


def _is_representable(number: str) -> bool:
    """Tell whether C's strtod takes a number without a range error."""
    value = float(number)
    if value == 0.0:
        return not _NOT_ZERO.match(number)
    return sys.float_info.min <= abs(value) <= sys.float_info.max


def _one_at_a_time(
    index: int,
    text: PoseText,
    poses: npt.NDArray[np.float64],
    failures: list[tuple[int, str]],
) -> None:
    try:
        poses[index] = pose_from_text(text)
    except PoseTextError as error:
        poses[index] = IDENTITY
        failures.append((index, str(error)))


def _fill(
    poses: npt.NDArray[np.float64],
    indices: npt.NDArray[np.intp],
    table: npt.NDArray[np.float64],
    is_quaternion: bool,  # noqa: FBT001
    is_degrees: bool,  # noqa: FBT001
) -> npt.NDArray[np.intp]:
    """Write one notation's rows into the poses; return the indices that need a closer look."""
    sizes = np.abs(table)
    odd = ((sizes < sys.float_info.min) & (sizes != 0.0)) | (sizes > sys.float_info.max)
    odd_rows = odd.any(axis=1)
    rotations = table[:, 3:]
    if is_quaternion:
        norms = np.sqrt(np.einsum('ij,ij->i', rotations, rotations))
        odd_rows |= (norms < SMALLEST_QUATERNION_NORM) | (norms > 1e150)
        quat_xyzw = rotations / np.where(odd_rows, 1.0, norms)[:, np.newaxis]
    else:
        rotations = np.where(odd_rows[:, np.newaxis], 0.0, rotations)
        quat_xyzw = quaternion_from_rpy(np.radians(rotations) if is_degrees else rotations)
    good = ~odd_rows
    poses[indices[good], :3] = table[good, :3]
    poses[indices[good], 3:] = quat_xyzw[good]
    odd_indices: npt.NDArray[np.intp] = indices[odd_rows]
    return odd_indices
