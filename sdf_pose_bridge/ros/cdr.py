# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Serialize messages about frames from arrays, and read serialized joint states into an array.

This avoids the message objects of rclpy, which are slow for 10,000 transforms; for a JointState
they take longer than its processing. The format is plain CDR, version 1: the four bytes 0 1 0 0
(or 0 0 0 0 if it is big-endian, which is only read), then the fields one after the other. Each
number is at a multiple of its size, counted from behind the four bytes. A string is its length as
uint32, its UTF-8 bytes and a zero, which the length includes. A sequence is its length as uint32
and its entries. Source: OMG, DDS-XTypes 1.3, chapter 7.4.1, and the definitions of TFMessage,
TransformStamped, PoseStamped and JointState.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
import struct
from typing import NamedTuple, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.geometry.poses import PoseArray

Offset = TypeVar('Offset', int, NDArray[np.int64])

Stamps: TypeAlias = NDArray[np.int64] | tuple[int, int]
"""Shape (n, 2), seconds and nanoseconds from 0 to 999,999,999 of each record; shape (2,) if they
are the same for all."""

# Sizes in bytes.
_LENGTH = 4
_STAMP = 8
_NUMBERS = 7 * 8
_BYTES_AT_A_TIME = 100_000

_BEGIN = b'\0\1\0\0'
"""The first bytes of a message."""

class _Formats(NamedTuple):
    """Formats with an order of bytes."""

    stamp_and_length: struct.Struct
    length: struct.Struct
    number: np.dtype[np.float64]


_FORMATS = {
    begin: _Formats(
        struct.Struct(f'{order}iII'), struct.Struct(f'{order}I'), np.dtype(f'{order}f8'))
    for begin, order in ((b'\0\0', '>'), (b'\0\1', '<'))}
"""Those of plain CDR, by the first two bytes of a message."""

MOST_BYTES = 1_000_000
"""Largest size of a message that is read; other callbacks wait meanwhile."""

_START = 4
"""Offset of the fields in a message, from which alignment is counted."""


class StampedRecords:
    """
    Serialized records of a stamp, frame ids and seven numbers, of which messages consist.

    :param ids: for transforms the parent frame of each, and the child frame of each; for poses
        only the frame that each is given in.
    :param poses: shape (n, 7), the numbers of each record, in metres, quaternion x y z w.
    :raises ValueError: if a frame id contains a zero character.
    """

    def __init__(self, ids: Sequence[Sequence[str]], poses: PoseArray) -> None:
        # Offsets in a record at first, one for each record. Each begins and ends at a multiple
        # of eight.
        offsets = np.full(len(poses), _STAMP)
        strings = []
        for column in ids:
            data = np.frombuffer('\0'.join([*column, '']).encode(), np.uint8)
            lengths = np.diff(np.flatnonzero(data == 0), prepend=-1)
            if len(lengths) != len(column):
                msg = 'a frame id contains a zero character, which no message can carry'
                raise ValueError(msg)
            offsets = _aligned(offsets, 4)
            strings.append((data, lengths, offsets))
            offsets = offsets + _LENGTH + lengths
        self._sizes_before_numbers = offsets
        sizes = _aligned(offsets, 8) + _NUMBERS
        self._bounds = np.append(0, np.cumsum(sizes))
        begins, ends = self._bounds[:-1], self._bounds[1:]
        self._buffer = np.zeros(self._bounds[-1], np.uint8)
        for data, lengths, places in strings:
            self._write_strings(data, lengths, begins + places)
        # Indices in the buffer as one of integers, and as one of numbers.
        self._stamps = begins[:, np.newaxis] // 4 + np.arange(2)
        self._numbers = (ends - _NUMBERS)[:, np.newaxis] // 8 + np.arange(7)
        self.set_poses(poses)
        # The rows of the last message, the indices of their stamps, and the parts of the message.
        self._rows = np.array([], np.intp)
        self._stamps_of_rows = self._stamps[:0]
        self._parts_of_rows = self._parts_of_message(self._rows)

    def __len__(self) -> int:
        return len(self._stamps)

    def set_poses(self, poses: PoseArray) -> None:
        """
        Replace the poses or transforms.

        :param poses: shape (n, 7), in metres, quaternion x y z w.
        """
        self._buffer.view('<f8')[self._numbers] = poses

    def set_stamps(self, stamps: Stamps) -> None:
        """Replace the stamps."""
        self._buffer.view('<i4')[self._stamps] = stamps

    def messages(self) -> list[bytes]:
        """Return a geometry_msgs/TransformStamped or PoseStamped for each record."""
        data = self._buffer.tobytes()
        return [_BEGIN + data[begin:end] for begin, end in pairwise(self._bounds.tolist())]

    def tf_message(self) -> bytes:
        """Return one tf2_msgs/TFMessage of all records, which are transforms."""
        return b''.join(self._parts_of_message(np.arange(len(self))))

    def tf_message_of_rows(self, rows: NDArray[np.intp], stamps: Stamps) -> bytes:
        """
        Return one tf2_msgs/TFMessage of some records.

        :param rows: their indices, in ascending order. This is quicker if they are those of the
            last call.
        :param stamps: the stamps that they get.
        """
        if not np.array_equal(rows, self._rows):
            self._rows, self._stamps_of_rows = rows, self._stamps[rows]
            self._parts_of_rows = self._parts_of_message(rows)
        self._buffer.view('<i4')[self._stamps_of_rows] = stamps
        return b''.join(self._parts_of_rows)

    def _parts_of_message(self, rows: NDArray[np.intp]) -> list[bytes | memoryview]:
        """Return the parts of a tf2_msgs/TFMessage; most of them are views of the buffer."""
        parts: list[bytes | memoryview] = [_BEGIN, struct.pack('<I', len(rows))]
        if len(rows):
            # Behind the length of the sequence, the first record is not at a multiple of eight,
            # so that another number of bytes aligns its numbers.
            data, bounds = self._buffer.data, self._bounds
            begin, end = bounds[rows[0]:rows[0] + 2].tolist()
            size = int(self._sizes_before_numbers[rows[0]])
            parts += [
                data[begin:begin + size], bytes(-(_LENGTH + size) % 8), data[end - _NUMBERS:end]]
            runs = np.split(rows[1:], np.flatnonzero(np.diff(rows[1:]) != 1) + 1)
            parts += [data[bounds[run[0]]:bounds[run[-1] + 1]] for run in runs if len(run)]
        return parts

    def _write_strings(
        self, data: NDArray[np.uint8], lengths: NDArray[np.int64], places: NDArray[np.int64],
    ) -> None:
        """
        Write a string into each record.

        :param data: the bytes of all strings, with their zeros.
        :param lengths: the length of each.
        :param places: the offset of each in the buffer.
        """
        self._buffer.view('<i4')[places // 4] = lengths
        bounds = np.append(0, np.cumsum(lengths))
        # Each byte moves as far as the first one of its string.
        moves = places + _LENGTH - bounds[:-1]
        # The indices of all bytes at once would take many times the memory of the strings.
        parts = np.searchsorted(bounds[:-1], np.arange(0, len(data), _BYTES_AT_A_TIME))
        for first, last in pairwise([*parts.tolist(), len(lengths)]):
            begin, end = bounds[[first, last]].tolist()
            targets = np.arange(begin, end) + np.repeat(moves[first:last], lengths[first:last])
            self._buffer[targets] = data[begin:end]


class SerializedNames(NamedTuple):
    """The names in a JointState."""

    names: tuple[str, ...]
    data: bytes
    """Bytes of alignment between the names may differ from message to message."""


class JointStateBytes(NamedTuple):
    """The fields of a JointState that are read."""

    stamp: tuple[int, int]
    """Seconds and nanoseconds."""
    names: SerializedNames
    positions: NDArray[np.float64]


def joint_state_from_bytes(data: bytes, known: SerializedNames | None = None) -> JointStateBytes:
    """
    Read a message.

    :param data: the serialized message.
    :param known: names of an earlier message; they are not read again if they are the same.
    :raises ValueError: if it is not a whole message in plain CDR, or if it is too large.
    """
    if len(data) > MOST_BYTES:
        msg = f'it has {len(data)} bytes, more than {MOST_BYTES}'
        raise ValueError(msg)
    formats = _FORMATS.get(data[:2])
    if formats is None:
        msg = f'it begins with 0x{data[:2].hex()}, which is not plain CDR'
        raise ValueError(msg)
    try:
        sec, nanosec, length = formats.stamp_and_length.unpack_from(data, _START)
        begin = _aligned(_START + 12 + length, 4)
        (name_count,) = formats.length.unpack_from(data, begin)
        if known is not None and data.startswith(known.data, begin):
            names, end = known, begin + len(known.data)
        else:
            end = begin + 4
            read = []
            for _ in range(name_count):
                place = _aligned(end, 4)
                (length,) = formats.length.unpack_from(data, place)
                end = place + 4 + length
                # The length counts a zero at the end.
                read.append(data[place + 4:end - 1].decode(errors='replace'))
            names = SerializedNames(tuple(read), data[begin:end])
        (count,) = formats.length.unpack_from(data, _aligned(end, 4))
        # Numbers are aligned to eight bytes, counted from the beginning of the fields.
        numbers = _aligned(_aligned(end, 4) + 4 - _START, 8) + _START
        positions = np.frombuffer(data, formats.number, count, numbers)
    except (struct.error, ValueError) as error:
        msg = f'it ends too early: {error}'
        raise ValueError(msg) from error
    return JointStateBytes((sec, nanosec), names, positions)


def _aligned(offset: Offset, size: int) -> Offset:
    return (offset + size - 1) // size * size
