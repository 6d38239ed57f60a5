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
from typing import TYPE_CHECKING

import numpy as np

from sdf_pose_bridge.geometry.rotations import quaternion_from_rpy

if TYPE_CHECKING:
    import numpy.typing as npt

IDENTITY = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)
"""The pose that moves nothing: x y z, quaternion x y z w."""

SMALLEST_QUATERNION_NORM = 1e-9
"""A quaternion shorter than this has no direction that its author can have meant."""

# Patterns are left for `re` to compile when they are first needed; most files need only _TINY.
_NUMBER = r'[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?'
_NOT_ZERO = r'[^eE]*[1-9]'
_MARK = '|'
_LONGEST_PLAIN = 200
_SOME = 1 << 12
_TINY = re.compile(r'[eE]-0*[1-9][0-9][0-9]')
"""A number without this, and of no more than 200 characters, is not too small for a double."""
_NUMBER_CHARACTERS = b'0123456789+-.eE \t\n\r|'
_RPY_COUNT = 6
_QUATERNION_COUNT = 7
_IDENTITY_TEXTS = {_RPY_COUNT: '0 0 0 0 0 0', _QUATERNION_COUNT: '0 0 0 0 0 0 1'}
_PLAIN_NUMBER = r'[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,2})?'
_PLAIN = {
    count: rf'[ \t\n\r]*(?:{_PLAIN_NUMBER}[ \t\n\r]+){{{count - 1}}}{_PLAIN_NUMBER}[ \t\n\r]*'
    for count in (_RPY_COUNT, _QUATERNION_COUNT)}


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
    texts: Sequence[str], *, quaternions: Sequence[int] = (), degrees: Sequence[int] = (),
) -> tuple[npt.NDArray[np.float64], list[tuple[int, str]]]:
    """
    Read many poses.

    :param texts: n poses as written; blank text is the identity.
    :param quaternions: indices of those in ``quat_xyzw``; others are in ``euler_rpy``.
    :param degrees: indices of those whose roll, pitch and yaw are in degrees.
    :return: an array of shape (n, 7): x y z in metres, unit quaternion x y z w; and, for each text
        that is no pose, its index and the reason. The row of such a text is the identity.
    """
    poses = np.zeros((len(texts), 7))
    poses[:, 6] = 1.0
    is_quaternion = _marked(len(texts), quaternions)
    is_degrees = _marked(len(texts), degrees)
    doubtful: list[int] = []
    for form_is_quaternion, form_is_degrees in ((False, False), (False, True), (True, False)):
        indices = np.flatnonzero(
            (is_quaternion == form_is_quaternion) & (is_degrees == form_is_degrees))
        if not len(indices):
            continue
        width = _QUATERNION_COUNT if form_is_quaternion else _RPY_COUNT
        form_texts = texts if len(indices) == len(texts) else [
            texts[index] for index in indices.tolist()]
        if '' in form_texts:
            form_texts = [text or _IDENTITY_TEXTS[width] for text in form_texts]
        table = _table_from_many_texts(form_texts, width)
        if table is None:
            is_plain = [
                len(text) <= _LONGEST_PLAIN and re.fullmatch(_PLAIN[width], text) is not None
                for text in form_texts]
            doubtful += indices[np.logical_not(is_plain)].tolist()
            indices = indices[is_plain]
            table = np.array([
                float(number) for text, plain in zip(form_texts, is_plain, strict=True) if plain
                for number in text.split()]).reshape(-1, width)
        doubtful += _fill(poses, indices, table, form_is_quaternion, form_is_degrees).tolist()
    doubtful += np.flatnonzero(is_quaternion & is_degrees).tolist()
    failures: list[tuple[int, str]] = []
    for index in sorted(doubtful):
        text = PoseText(texts[index], bool(is_quaternion[index]), bool(is_degrees[index]))
        try:
            poses[index] = pose_from_text(text)
        except PoseTextError as error:
            poses[index] = IDENTITY
            failures.append((index, str(error)))
    return poses, failures


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
        if not re.fullmatch(_NUMBER, token):
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


def _marked(count: int, indices: Sequence[int]) -> npt.NDArray[np.bool_]:
    marks = np.zeros(count, dtype=bool)
    marks[np.array(indices, dtype=np.intp)] = True
    return marks


def _table_from_many_texts(
    texts: Sequence[str], width: int,
) -> npt.NDArray[np.float64] | None:
    """Do as the next function does, some at a time: the texts of all numbers take much memory."""
    tables = []
    for start in range(0, len(texts), _SOME):
        table = _table_from_texts(texts[start:start + _SOME], width)
        if table is None:
            return None
        tables.append(table)
    return np.concatenate(tables)


def _table_from_texts(texts: Sequence[str], width: int) -> npt.NDArray[np.float64] | None:
    """
    Read the numbers of many texts at once.

    :param texts: n texts.
    :param width: how many numbers each should hold.
    :return: shape (n, width); None where any text holds anything else, or a number that needs a
        closer look: one that Python and SDFormat may read differently, or so small that it may
        have become zero.
    """
    joined = f' {_MARK} '.join(texts)
    if (not joined.isascii() or joined.encode().translate(None, _NUMBER_CHARACTERS)
            or _TINY.search(joined) or len(max(texts, key=len)) > _LONGEST_PLAIN):
        return None
    tokens = joined.split()
    if tokens[width::width + 1] != [_MARK] * (len(texts) - 1):
        return None
    del tokens[width::width + 1]
    try:
        table = np.fromiter(map(float, tokens), np.float64, len(tokens))
    except ValueError:
        return None
    return table.reshape(-1, width) if len(table) == len(texts) * width else None


def _is_representable(number: str) -> bool:
    """Tell whether C's strtod takes a number without a range error."""
    value = float(number)
    if value == 0.0:
        return not re.match(_NOT_ZERO, number)
    return sys.float_info.min <= abs(value) <= sys.float_info.max


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
