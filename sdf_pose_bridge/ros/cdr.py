# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Serialize messages about frames from arrays, and read serialized joint states and poses.

This avoids the message objects of rclpy, which are slow for 10,000 transforms; for a JointState
or a pose they take longer than its processing. The format is plain CDR, version 1: the four bytes
0 1 0 0 (or 0 0 0 0 if it is big-endian, which is only read), then the fields one after the other.
Each number is at a multiple of its size, counted from behind the four bytes. A string is its
length as uint32, its UTF-8 bytes and a zero, which the length includes. A sequence is its length
as uint32 and its entries. Source: OMG, DDS-XTypes 1.3, chapter 7.4.1, and the definitions of
TFMessage, TransformStamped, PoseStamped, PoseWithCovarianceStamped, Odometry and JointState.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
import struct
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.geometry.poses import PoseArray
from sdf_pose_bridge.geometry.rotations import Floats

NANOSECONDS = 1_000_000_000
"""In a second."""

Rows: TypeAlias = NDArray[np.intp]
"""Indices of records, such as those of the transforms that joints move."""

NO_ROWS: Rows = np.array([], np.intp)

# Sizes in bytes.
_LENGTH = 4
_STAMP = 8
_NUMBERS = 7 * 8

_BEGIN = b'\0\1\0\0'
"""The first bytes of a message."""

_FORMATS = {
    begin: (
        struct.Struct(f'{order}iII'), struct.Struct(f'{order}I'), np.dtype(f'{order}f8'),
        struct.Struct(f'{order}7d'))
    for begin, order in ((b'\0\0', '>'), (b'\0\1', '<'))}
"""The formats of a stamp with a length, of a length, a number and a pose, by the first two bytes
of a message, which give the order of bytes."""

MOST_BYTES = 1_000_000
"""Largest size of a message that is read; other callbacks wait meanwhile."""

LONGEST_READ_S = 1.0 / 30.0
"""Longest processor time in s to read messages at once, for the same reason."""

_START = 4
"""Offset of the fields in a message, from which alignment is counted."""


class StampedRecords:
    """
    Serialized records, each with a stamp, frame ids and seven numbers; messages consist of them.

    :param ids: the frame ids of all records, field by field: for transforms the parents, then the
        children; for poses the frames in which they are given.
    :param poses: shape (n, 7), the numbers of each record, in metres, quaternion x y z w.
    """

    def __init__(self, ids: Sequence[Sequence[str]], poses: PoseArray) -> None:
        # Each record begins and ends at a multiple of eight.
        records = []
        self._sizes_before_numbers = []
        for texts in zip(*ids, strict=True):
            record = bytes(_STAMP)
            for text in texts:
                string = text.encode() + b'\0'
                record += bytes(-len(record) % 4) + struct.pack('<I', len(string)) + string
            self._sizes_before_numbers.append(len(record))
            records.append(record + bytes(-len(record) % 8 + _NUMBERS))
        self._buffer = np.frombuffer(bytearray().join(records), np.uint8)
        bounds = np.cumsum([0, *map(len, records)])
        self._bounds: list[int] = bounds.tolist()
        # Indices in the buffer as one of integers, and as one of numbers.
        self._stamps = bounds[:-1] // 4
        self._numbers = (bounds[1:] - _NUMBERS)[:, np.newaxis] // 8 + np.arange(7)
        self.set_poses(poses)

    def __len__(self) -> int:
        return len(self._stamps)

    def set_poses(self, poses: PoseArray) -> None:
        """
        Replace the poses or transforms.

        :param poses: shape (n, 7), in metres, quaternion x y z w.
        """
        self._buffer.view('<f8')[self._numbers] = poses

    def set_stamps(
        self, stamps_ns: NDArray[np.int64] | int, rows: Rows | slice = slice(None),
    ) -> None:
        """
        Replace the stamps.

        :param stamps_ns: a stamp in nanoseconds for each record, or one for all.
        :param rows: the indices of the records that get them.
        """
        integers, seconds = self._buffer.view('<i4'), self._stamps[rows]
        integers[seconds], integers[seconds + 1] = divmod(stamps_ns, NANOSECONDS)

    def messages(self) -> list[bytes]:
        """Return a geometry_msgs/TransformStamped or PoseStamped for each record."""
        data = self._buffer.tobytes()
        return [_BEGIN + data[begin:end] for begin, end in pairwise(self._bounds)]

    def tf_message(self, rows: Rows | None = None) -> bytes:
        """
        Return one tf2_msgs/TFMessage of records that are transforms.

        :param rows: their indices in ascending order; all by default.
        """
        rows = np.arange(len(self)) if rows is None else rows
        begin = _BEGIN + struct.pack('<I', len(rows))
        if not len(rows):
            return begin
        data, bounds, first = self._buffer.data, self._bounds, rows[0]
        # The first record follows a length of four bytes, so it is not at a multiple of eight, and
        # its numbers need other bytes of alignment.
        size, end = self._sizes_before_numbers[first], bounds[first + 1]
        others = [data[bounds[row]:bounds[row + 1]] for row in rows[1:].tolist()]
        return b''.join([
            begin, data[bounds[first]:bounds[first] + size], bytes(-(_LENGTH + size) % 8),
            data[end - _NUMBERS:end], *others])


class SerializedNames(NamedTuple):
    """The names in a JointState."""

    names: tuple[str, ...]
    data: bytes
    """Bytes of alignment between the names may differ from message to message."""


def joint_state_from_bytes(
    data: bytes, known: SerializedNames | None = None,
) -> tuple[int, SerializedNames, Floats]:
    """
    Read a message.

    :param data: the serialized message.
    :param known: names of an earlier message; they are not read again if they are the same.
    :return: its stamp in nanoseconds, its names, and a position for each name.
    :raises ValueError: if it is not a whole message in plain CDR, if it is too large, or if its
        fields contradict one another.
    """
    _check_encoding(data)
    stamp_and_length, length_format, number, _ = _FORMATS[data[:2]]
    try:
        sec, nanosec, length = stamp_and_length.unpack_from(data, _START)
        begin = _START + 12 + length
        begin += -begin % 4
        names = known
        if names is None or not data.startswith(names.data, begin):
            names = _names_from_bytes(data, begin, length_format)
        place = begin + len(names.data)
        place += -place % 4
        count, = length_format.unpack_from(data, place)
        place += 4
        # Numbers are aligned to eight bytes, counted from the beginning of the fields.
        positions = np.frombuffer(data, number, count, place + (_START - place) % 8)
    except (struct.error, ValueError) as error:
        msg = f'it ends too early: {error}'
        raise ValueError(msg) from error
    if count != len(names.names):
        msg = (
            f'it has {len(names.names)} names and {count} positions, and each name must have a '
            'position')
        raise ValueError(msg)
    return _stamp_ns(sec, nanosec), names, positions


class PoseType(NamedTuple):
    """The fields of a type of messages with poses, in their order; others follow a single pose."""

    is_sequence: bool = False
    """Whether it has many poses, and begins with their number."""
    has_child: bool = False
    """Whether it has a child frame id, which names a model or a frame in one."""


JOINT_STATE = 'sensor_msgs/msg/JointState'
TF_MESSAGE = 'tf2_msgs/msg/TFMessage'

POSE_TYPES = {
    'geometry_msgs/msg/PoseStamped': PoseType(),
    'geometry_msgs/msg/PoseWithCovarianceStamped': PoseType(),
    'geometry_msgs/msg/TransformStamped': PoseType(has_child=True),
    'nav_msgs/msg/Odometry': PoseType(has_child=True),
    TF_MESSAGE: PoseType(is_sequence=True, has_child=True),
}
"""The types of messages with poses of models."""


class StampedPose(NamedTuple):
    """A pose in a message."""

    stamp_ns: int
    """Its stamp in nanoseconds; 0 if it has none."""
    frame_id: str
    child_frame_id: str
    """Empty if the type of the message has none."""
    pose: tuple[float, ...]
    """Seven numbers as they were sent: x y z, quaternion x y z w."""


def poses_from_bytes(data: bytes, type_: PoseType) -> Iterator[StampedPose]:
    """
    Read a message with poses or transforms. Fields that follow a single pose are not read.

    :param data: the serialized message.
    :return: the poses, each of which is read when it is asked for.
    :raises ValueError: as for :func:`joint_state_from_bytes`, where the message is not valid.
    """
    _check_encoding(data)
    stamp_and_length, length_format, _, pose_format = _FORMATS[data[:2]]
    place, count = _START, 1
    try:
        if type_.is_sequence:
            count, = length_format.unpack_from(data, place)
            place += _LENGTH
        for _ in range(count):
            sec, nanosec, _ = stamp_and_length.unpack_from(data, place)
            frame_id, place = _string_from_bytes(data, place + _STAMP, length_format)
            child_frame_id = ''
            if type_.has_child:
                child_frame_id, place = _string_from_bytes(data, place, length_format)
            place += (_START - place) % 8
            pose = pose_format.unpack_from(data, place)
            place += _NUMBERS
            yield StampedPose(_stamp_ns(sec, nanosec), frame_id, child_frame_id, pose)
    except struct.error as error:
        msg = f'it ends too early: {error}'
        raise ValueError(msg) from error


def _check_encoding(data: bytes) -> None:
    if len(data) > MOST_BYTES:
        msg = f'it has {len(data)} bytes, more than {MOST_BYTES}'
        raise ValueError(msg)
    if data[:2] not in _FORMATS:
        msg = f'it begins with 0x{data[:2].hex()}, which is not plain CDR'
        raise ValueError(msg)


def _stamp_ns(sec: int, nanosec: int) -> int:
    if sec < 0 or nanosec >= NANOSECONDS:
        msg = (
            f'it has the stamp sec={sec} nanosec={nanosec}, and sec must not be negative and '
            f'nanosec must be less than {NANOSECONDS}')
        raise ValueError(msg)
    return sec * NANOSECONDS + nanosec


def _string_from_bytes(data: bytes, place: int, length_format: struct.Struct) -> tuple[str, int]:
    """Return a string, and the place of its end."""
    place += -place % 4
    length, = length_format.unpack_from(data, place)
    end = place + _LENGTH + length
    # The length counts a zero at the end.
    return data[place + _LENGTH:end - 1].decode(errors='replace'), end


def _names_from_bytes(data: bytes, begin: int, length_format: struct.Struct) -> SerializedNames:
    count, = length_format.unpack_from(data, begin)
    names, end = [], begin + 4
    for _ in range(count):
        name, end = _string_from_bytes(data, end, length_format)
        names.append(name)
    return SerializedNames(tuple(names), data[begin:end])
