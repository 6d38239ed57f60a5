# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read a serialized sensor_msgs/JointState without making an object of it.

rclpy makes a string of each name and a number of each velocity and effort, which takes longer than
all that the node does with a message. The format is that of ``cdr.py``, in either order of bytes.
"""

from __future__ import annotations

import struct
from typing import NamedTuple
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_ORDERS = {b'\0\0': '>', b'\0\1': '<'}
"""The order of bytes in plain CDR, by the first two bytes."""

MOST_BYTES = 1_000_000
"""The size of a message; other callbacks wait while it is read."""

_START = 4
"""Where the fields begin, and what alignment is counted from."""


class JointStateBytes(NamedTuple):
    """What is read of a message."""

    stamp: tuple[int, int]
    """Seconds and nanoseconds."""
    names: bytes
    """The serialized names. The bytes that align them may differ from message to message."""
    name_count: int
    positions: NDArray[np.float64]
    order: str
    """The order of bytes, ``<`` or ``>``."""

    def name_list(self) -> list[str]:
        """Return the names."""
        found = []
        place = 4
        for _ in range(self.name_count):
            (length,) = struct.unpack_from(f'{self.order}I', self.names, place)
            # The length counts a zero at the end.
            name = self.names[place + 4:place + 3 + length]
            found.append(name.decode(errors='replace'))
            place = _aligned(place + 4 + length, 4)
        return found


def joint_state_from_bytes(data: bytes, known_names: bytes = b'') -> JointStateBytes:
    """
    Read a message.

    :param data: the serialized message.
    :param known_names: ``names`` of a message before; if the names are the same, they need not be
        walked through.
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
        end = begin + len(known_names)
        if not known_names or not data.startswith(known_names, begin):
            end = begin + 4
            for _ in range(name_count):
                (length,) = struct.unpack_from(f'{order}I', data, _aligned(end, 4))
                end = _aligned(end, 4) + 4 + length
        (count,) = struct.unpack_from(f'{order}I', data, _aligned(end, 4))
        # Numbers are aligned to eight bytes, counted from where the fields begin.
        numbers = _aligned(_aligned(end, 4) + 4 - _START, 8) + _START if count else 0
        positions = np.frombuffer(data, f'{order}f8', count, numbers)
    except (struct.error, ValueError) as error:
        msg = f'it ends too early: {error}'
        raise ValueError(msg) from error
    return JointStateBytes((sec, nanosec), data[begin:end], name_count, positions, order)


def _aligned(offset: int, size: int) -> int:
    return (offset + size - 1) // size * size
