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
from typing import NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.geometry.poses import PoseArray

Offset = TypeVar('Offset', int, NDArray[np.int64])

# Sizes in bytes.
_LENGTH = 4
_STAMP = 8
_NUMBERS = 7 * 8
_BYTES_AT_A_TIME = 100_000
_HEADER = 8
"""Bytes before the fields of a message: four bytes of padding, then the four fixed ones."""

_ORDERS = {b'\0\0': '>', b'\0\1': '<'}
"""The order of bytes in plain CDR, by the first two bytes."""

MOST_BYTES = 1_000_000
"""Largest size of a message that is read; other callbacks wait meanwhile."""

_START = 4
"""Offset of the fields in a message, from which alignment is counted."""


class StampedMessages(NamedTuple):
    """Serialized messages in one buffer."""

    buffer: NDArray[np.uint8]
    """The buffer, with room for the stamps and poses; its size is a multiple of 8."""
    stamps: NDArray[np.int64]
    """Indices of the two integers of each stamp, in a buffer of integers; shape (n, 2)."""
    numbers: NDArray[np.int64]
    """Indices of the seven numbers behind each stamp, in a buffer of numbers; shape (n, 7)."""
    bounds: Sequence[tuple[int, int]]
    """Offsets of the first byte of each message and of the byte behind its last one."""

    def with_stamp(self, sec: int, nanosec: int) -> list[bytes]:
        """
        Return the messages with a stamp.

        :param nanosec: nanoseconds of the stamp, from 0 to 999,999,999.
        """
        return self.with_stamps(np.array([sec, nanosec]))

    def with_stamps(self, stamps: NDArray[np.int64]) -> list[bytes]:
        """
        Return the messages with a stamp for each pose or transform.

        :param stamps: shape (n, 2), seconds and nanoseconds from 0 to 999,999,999; shape (2,) if
            all are the same.
        """
        self.buffer.view('<i4')[self.stamps] = stamps
        data = self.buffer.tobytes()
        return [data[begin:end] for begin, end in self.bounds]

    def set_poses(self, poses: PoseArray) -> None:
        """
        Replace the poses or transforms in the messages.

        :param poses: shape (n, 7), in the order of the messages, in metres, quaternion x y z w.
        """
        self.buffer.view('<f8')[self.numbers] = poses


def tf_message(ids: Sequence[Sequence[str]], transforms: PoseArray) -> StampedMessages:
    """
    Serialize one tf2_msgs/TFMessage.

    :param ids: the parent frame of each transform, and the child frame of each.
    :param transforms: shape (n, 7): pose of each child in its parent, in metres, quaternion
        x y z w.
    :raises ValueError: if a frame id contains a zero character.
    """
    # The length of the sequence is before the first transform.
    room = np.zeros(len(transforms), np.int64)
    room[:1] = _LENGTH
    buffer, stamps, numbers, ends = _records(ids, transforms, room, _HEADER)
    buffer.view('<i4')[_HEADER // 4] = len(transforms)
    buffer[_HEADER - 3] = 1
    end = int(ends[-1]) if len(transforms) else _HEADER + _LENGTH
    return StampedMessages(buffer, stamps, numbers, [(_HEADER - 4, end)])


def stamped_messages(ids: Sequence[Sequence[str]], poses: PoseArray) -> StampedMessages:
    """
    Serialize a geometry_msgs/TransformStamped or PoseStamped for each pose.

    Both are a stamp, frame ids and seven numbers.

    :param ids: for TransformStamped the parent frame of each transform, and the child frame of
        each; for PoseStamped only the frame that each pose is given in.
    :param poses: shape (n, 7), in metres, quaternion x y z w.
    :raises ValueError: if a frame id contains a zero character.
    """
    buffer, stamps, numbers, ends = _records(ids, poses, np.full(len(poses), _HEADER), 0)
    begins = 4 * stamps[:, 0] - 4
    buffer[begins + 1] = 1
    return StampedMessages(
        buffer, stamps, numbers, list(zip(begins.tolist(), ends.tolist(), strict=True)))


def _records(
    columns: Sequence[Sequence[str]], poses: PoseArray, room: NDArray[np.int64], start: int,
) -> tuple[NDArray[np.uint8], NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """
    Write records of a stamp, strings and seven numbers, one after the other.

    :param columns: sequences of as many strings as there are records.
    :param poses: the seven numbers of each record.
    :param room: number of free bytes at the beginning of each record.
    :param start: offset of the first record in the buffer, a multiple of 8. All others follow at
        multiples of 8, since each one ends with the numbers.
    :return: a buffer with the records, with zero stamps; the indices of the stamp and of the
        numbers of each record, as in :class:`StampedMessages`; and the offset behind its last
        byte.
    """
    # Offsets in a record at first, one for each record.
    offsets = room + _STAMP
    strings = []
    for column in columns:
        data = np.frombuffer('\0'.join([*column, '']).encode(), np.uint8)
        lengths = np.diff(np.flatnonzero(data == 0), prepend=-1)
        if len(lengths) != len(column):
            msg = 'a frame id contains a zero character, which no message can carry'
            raise ValueError(msg)
        offsets = _aligned(offsets, 4)
        strings.append((data, lengths, offsets))
        offsets = offsets + _LENGTH + lengths
    offsets = _aligned(offsets, 8)
    sizes = offsets + _NUMBERS
    ends = start + np.cumsum(sizes)
    begins = ends - sizes
    buffer = np.zeros(start + int(sizes.sum()) + 8, np.uint8)
    for data, lengths, place in strings:
        buffer.view('<i4')[(begins + place) // 4] = lengths
        bounds = np.append(0, np.cumsum(lengths))
        # Each byte moves as far as the first one of its string.
        moves = begins + place + _LENGTH - bounds[:-1]
        # The indices of all bytes at once would take many times the memory of the strings.
        parts = np.searchsorted(bounds[:-1], np.arange(0, len(data), _BYTES_AT_A_TIME))
        for first, last in pairwise([*parts.tolist(), len(lengths)]):
            begin, end = bounds[[first, last]].tolist()
            targets = np.arange(begin, end) + np.repeat(moves[first:last], lengths[first:last])
            buffer[targets] = data[begin:end]
    stamps = (begins + room)[:, np.newaxis] // 4 + np.arange(2)
    numbers = (begins + offsets)[:, np.newaxis] // 8 + np.arange(7)
    buffer.view('<f8')[numbers] = poses
    return buffer, stamps, numbers, ends


class JointStateBytes(NamedTuple):
    """The fields of a JointState that are read."""

    stamp: tuple[int, int]
    """Seconds and nanoseconds."""
    names: tuple[str, ...]
    positions: NDArray[np.float64]
    serialized_names: bytes
    """Bytes of alignment between the names may differ from message to message."""


def joint_state_from_bytes(data: bytes, before: JointStateBytes | None = None) -> JointStateBytes:
    """
    Read a message.

    :param data: the serialized message.
    :param before: an earlier message; equal names are not read again.
    :raises ValueError: if it is not a whole message in plain CDR, or if it is too large.
    """
    if len(data) > MOST_BYTES:
        msg = f'it has {len(data)} bytes, more than {MOST_BYTES}'
        raise ValueError(msg)
    order = _ORDERS.get(data[:2])
    if order is None:
        msg = f'it begins with 0x{data[:2].hex()}, which is not plain CDR'
        raise ValueError(msg)
    try:
        sec, nanosec, length = struct.unpack_from(f'{order}iII', data, _START)
        begin = _aligned(_START + 12 + length, 4)
        (name_count,) = struct.unpack_from(f'{order}I', data, begin)
        if before is not None and data.startswith(before.serialized_names, begin):
            names, end = before.names, begin + len(before.serialized_names)
        else:
            end = begin + 4
            read = []
            for _ in range(name_count):
                place = _aligned(end, 4)
                (length,) = struct.unpack_from(f'{order}I', data, place)
                end = place + 4 + length
                # The length counts a zero at the end.
                read.append(data[place + 4:end - 1].decode(errors='replace'))
            names = tuple(read)
        (count,) = struct.unpack_from(f'{order}I', data, _aligned(end, 4))
        # Numbers are aligned to eight bytes, counted from the beginning of the fields.
        numbers = _aligned(_aligned(end, 4) + 4 - _START, 8) + _START
        positions = np.frombuffer(data, f'{order}f8', count, numbers)
    except (struct.error, ValueError) as error:
        msg = f'it ends too early: {error}'
        raise ValueError(msg) from error
    return JointStateBytes((sec, nanosec), names, positions, data[begin:end])


def _aligned(offset: Offset, size: int) -> Offset:
    return (offset + size - 1) // size * size
