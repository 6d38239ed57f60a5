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

import numpy as np

from sdf_pose_bridge.geometry.poses import PoseArray
from sdf_pose_bridge.tf.texts import CHUNK
from sdf_pose_bridge.tf.texts import Places
from sdf_pose_bridge.tf.texts import Texts

if TYPE_CHECKING:
    import numpy.typing as npt

_ENCAPSULATION = 4
_COUNT = 4
_STAMP = 8
_LENGTH = 4
_NUMBERS = CHUNK
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
        self, buffer: npt.NDArray[np.uint8], stamps: Places, bounds: Sequence[tuple[int, int]],
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
    parent_ids: Sequence[str] | Texts, child_ids: Sequence[str] | Texts, transforms: PoseArray,
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
    parent_ids: Sequence[str] | Texts, child_ids: Sequence[str] | Texts, transforms: PoseArray,
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


def pose_stamped_bytes(frame_ids: Sequence[str] | Texts, poses: PoseArray) -> StampedBytes:
    """
    Lay out a geometry_msgs/PoseStamped for each pose.

    :param frame_ids: the frame that each pose is given in.
    :param poses: shape (n, 7), in metres, quaternion x y z w.
    :return: the messages.
    :raises ValueError: if a frame id holds a zero character.
    """
    return _single_messages([frame_ids], poses)


class _Records(NamedTuple):
    """A stamp, texts and seven numbers each; places count from where the alignment does."""

    shifts: Places
    """Where each begins: its remainder by 8."""
    texts: list[tuple[Texts, Places]]
    """The texts, and where each has its length."""
    numbers: Places
    sizes: Places


def _records(columns: Sequence[Sequence[str] | Texts], shifts: Places) -> _Records:
    texts = []
    place = shifts + _STAMP
    for column in columns:
        text = column if isinstance(column, Texts) else Texts.from_strings(column)
        place = _aligned(place, _LENGTH)
        texts.append((text, place))
        place = place + _LENGTH + text.lengths
    numbers = _aligned(place, 8)
    return _Records(shifts, texts, numbers, numbers + _NUMBERS - shifts)


def _single_messages(
    columns: Sequence[Sequence[str] | Texts], numbers: PoseArray,
) -> StampedBytes:
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
    records: _Records, starts: Places, end: int, numbers: PoseArray,
) -> npt.NDArray[np.uint8]:
    # Texts are copied in chunks. What is too much of one falls on what is written later: other
    # texts, lengths, and the numbers, which take up a chunk behind all texts. Of the zeros behind
    # a text there are enough for all that may be left out before the numbers.
    buffer = np.zeros((end + 7) // 8 * 8, np.uint8)
    words = buffer.view('<i4')
    bases = starts - records.shifts
    chunks = _chunks(buffer.data, 4)
    for text, places in records.texts:
        firsts, lasts = text.starts, bases + places + _LENGTH
        if text.lengths.max(initial=0) > CHUNK:
            rows, steps = _steps(text.lengths)
            firsts, lasts = firsts[rows] + steps, lasts[rows] + steps
        chunks[lasts // 4] = _chunks(text.data, 1)[firsts]
    for text, places in records.texts:
        words[(bases + places) // 4] = text.lengths
    _chunks(buffer.data, 8)[(bases + records.numbers) // 8] = _chunks(
        np.ascontiguousarray(numbers, '<f8').data, CHUNK)
    return buffer


def _chunks(data: bytes | memoryview, distance: int) -> npt.NDArray[np.void]:
    """Let chunks begin at every so many bytes, which may overlap."""
    count = max(0, (memoryview(data).nbytes - CHUNK) // distance + 1)
    chunks: npt.NDArray[np.void] = np.ndarray(
        (count,), f'V{CHUNK}', data, strides=(distance,))
    return chunks


def _steps(lengths: Places) -> tuple[npt.NDArray[np.intp], Places]:
    """Return the rows of all chunks of texts, and how far behind its beginning each is."""
    counts = (lengths + CHUNK - 1) // CHUNK
    rows = np.repeat(np.arange(len(counts)), counts)
    return rows, (np.arange(len(rows)) - _sums_before(counts)[rows]) * CHUNK


def _sums_before(sizes: Places) -> Places:
    return np.cumsum(sizes) - sizes


def _aligned(places: Places, size: int) -> Places:
    return (places + (size - 1)) & -size
