# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Lay out messages about frames as the bytes that are sent, straight from arrays.

The form is plain CDR, version 1, in little-endian order, which all middlewares of ROS 2 take: the
four bytes 0 1 0 0, and then the fields one after the other. Each number stands at a multiple of
its size, counted from behind the four bytes. A text is its length and its UTF-8 bytes with a zero
behind them; a list is its length and its entries. Source: OMG, DDS-XTypes 1.3, chapter 7.4.1, and
the definitions of TFMessage, TransformStamped and PoseStamped.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple
from typing import TYPE_CHECKING
from typing import TypeAlias

import numpy as np

from sdf_pose_bridge.poses import PoseArray

if TYPE_CHECKING:
    import numpy.typing as npt

_Places: TypeAlias = 'npt.NDArray[np.int64]'

_ENCAPSULATION = 4
_COUNT = 4
_STAMP = 8
_NUMBERS = 56
_ORIGIN = 8
"""Where the first message begins to count in the buffer: behind its four bytes, and aligned."""


class StampedBytes:
    """
    Messages in one buffer, which can be given another time all at once.

    :param buffer: their bytes, its size a multiple of 8.
    :param stamps: where the stamps stand in it, counted in numbers of 4 bytes.
    :param bounds: where each message begins and ends in it, in bytes.
    """

    def __init__(
        self, buffer: npt.NDArray[np.uint8], stamps: _Places, bounds: Sequence[tuple[int, int]],
    ) -> None:
        self._buffer = buffer
        self._stamps = stamps
        self._bounds = bounds

    def __len__(self) -> int:
        return len(self._bounds)

    def at(self, sec: int, nanosec: int) -> list[bytes]:
        """
        Stamp all messages.

        :param sec: seconds of the time that they get.
        :param nanosec: nanoseconds of it, from 0 to 999,999,999.
        :return: the bytes of each message.
        """
        words = self._buffer.view('<i4')
        words[self._stamps] = sec
        words[self._stamps + 1] = nanosec
        if len(self._bounds) == 1:
            (begin, end), = self._bounds
            return [self._buffer[begin:end].tobytes()]
        data = self._buffer.tobytes()
        return [data[begin:end] for begin, end in self._bounds]


def tf_message_bytes(
    parent_ids: Sequence[str], child_ids: Sequence[str], transforms: PoseArray,
) -> StampedBytes:
    """
    Lay out one tf2_msgs/TFMessage.

    :param parent_ids: the frame that each transform starts from.
    :param child_ids: the frame that each leads to.
    :param transforms: shape (n, 7): pose of each child in its parent, in metres, quaternion
        x y z w.
    :return: the message.
    :raises ValueError: if a frame id holds a zero character.
    """
    shifts = np.zeros(len(child_ids), np.int64)
    shifts[:1] = _COUNT
    records = _records([parent_ids, child_ids], shifts)
    starts = _ORIGIN + _COUNT + _sums_before(records.sizes)
    end = _ORIGIN + _COUNT + int(records.sizes.sum())
    buffer = _filled(records, starts, end, transforms)
    buffer.view('<i4')[_ORIGIN // 4] = len(child_ids)
    buffer[_ORIGIN - _ENCAPSULATION + 1] = 1
    return StampedBytes(buffer, starts // 4, [(_ORIGIN - _ENCAPSULATION, end)])


def transform_stamped_bytes(
    parent_ids: Sequence[str], child_ids: Sequence[str], transforms: PoseArray,
) -> StampedBytes:
    """
    Lay out a geometry_msgs/TransformStamped for each transform.

    :param parent_ids: the frame that each transform starts from.
    :param child_ids: the frame that each leads to.
    :param transforms: shape (n, 7): pose of each child in its parent, in metres, quaternion
        x y z w.
    :return: the messages.
    :raises ValueError: if a frame id holds a zero character.
    """
    return _single_messages([parent_ids, child_ids], transforms)


def pose_stamped_bytes(frame_ids: Sequence[str], poses: PoseArray) -> StampedBytes:
    """
    Lay out a geometry_msgs/PoseStamped for each pose.

    :param frame_ids: the frame that each pose is given in.
    :param poses: shape (n, 7), in metres, quaternion x y z w.
    :return: the messages.
    :raises ValueError: if a frame id holds a zero character.
    """
    return _single_messages([frame_ids], poses)


class _Texts(NamedTuple):
    """Texts one behind the other, each with its zero."""

    data: npt.NDArray[np.uint8]
    starts: _Places
    lengths: _Places


class _Records(NamedTuple):
    """A stamp, texts and seven numbers each; places count from where the alignment does."""

    shifts: _Places
    """Where each begins: its remainder by 8."""
    texts: list[tuple[_Texts, _Places]]
    """The texts, and where each has its length."""
    numbers: _Places
    sizes: _Places


def _records(columns: Sequence[Sequence[str]], shifts: _Places) -> _Records:
    texts = []
    place = shifts + _STAMP
    for column in columns:
        text = _joined(column)
        place = _aligned(place, 4)
        texts.append((text, place))
        place = place + 4 + text.lengths
    numbers = _aligned(place, 8)
    return _Records(shifts, texts, numbers, numbers + _NUMBERS - shifts)


def _single_messages(columns: Sequence[Sequence[str]], numbers: PoseArray) -> StampedBytes:
    # Between them room for the next one's four bytes, and as much to keep it aligned.
    gap = _ORIGIN
    records = _records(columns, np.zeros(len(numbers), np.int64))
    starts = _ORIGIN + _sums_before(records.sizes + gap)
    buffer = _filled(records, starts, _ORIGIN + int((records.sizes + gap).sum()), numbers)
    buffer[starts - _ENCAPSULATION + 1] = 1
    bounds = zip(
        (starts - _ENCAPSULATION).tolist(), (starts + records.sizes).tolist(), strict=True)
    return StampedBytes(buffer, starts // 4, list(bounds))


def _filled(
    records: _Records, starts: _Places, end: int, numbers: PoseArray,
) -> npt.NDArray[np.uint8]:
    buffer = np.zeros((end + 7) // 8 * 8, np.uint8)
    words = buffer.view('<i4')
    bases = starts - records.shifts
    for text, places in records.texts:
        targets = bases + places
        words[targets // 4] = text.lengths
        moves = np.repeat(targets + 4 - text.starts, text.lengths)
        moves += np.arange(len(moves))
        buffer[moves] = text.data
    first = (bases + records.numbers) // 8
    buffer.view('<f8')[first[:, np.newaxis] + np.arange(7)] = numbers
    return buffer


def _joined(texts: Sequence[str]) -> _Texts:
    data = np.frombuffer(''.join(['\0'.join(texts), '\0'[:len(texts)]]).encode(), np.uint8)
    behind = np.flatnonzero(data == 0) + 1
    if len(behind) != len(texts):
        msg = 'a frame id holds a zero character, which no message can carry'
        raise ValueError(msg)
    starts = np.concatenate([[0], behind[:-1]])[:len(texts)]
    return _Texts(data, starts, behind - starts)


def _sums_before(sizes: _Places) -> _Places:
    return np.cumsum(sizes) - sizes


def _aligned(places: _Places, size: int) -> _Places:
    return (places + size - 1) // size * size
