# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Serialized joint states: the same content as rclpy reads, and broken messages."""

import struct

from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from rclpy.serialization import serialize_message
from sensor_msgs.msg import JointState

from sdf_pose_bridge.ros.joint_state_bytes import joint_state_from_bytes
from sdf_pose_bridge.ros.joint_state_bytes import MOST_BYTES

TEXTS = st.text(st.characters(exclude_characters='\0', exclude_categories=['Cs']), max_size=9)
NUMBERS = st.lists(st.floats(allow_nan=False), max_size=5)


def message(names, positions, *, frame_id='', sec=0, nanosec=0, velocities=()):
    made = JointState(name=names, position=positions, velocity=velocities)
    made.header.frame_id = frame_id
    made.header.stamp.sec, made.header.stamp.nanosec = sec, nanosec
    return serialize_message(made)


@pytest.mark.parametrize('length', range(48))
def test_a_message_that_ends_too_early_is_refused(length):
    whole = message(['a', 'bc'], [1.0])
    assert len(whole) > 48
    with pytest.raises(ValueError, match=r'ends too early|not plain CDR'):
        joint_state_from_bytes(whole[:length])


@pytest.mark.parametrize('count', [2**31, 2**32 - 1])
def test_a_message_that_says_it_has_more_than_it_has_is_refused(count):
    whole = message([], [])
    place = 4 + 12 + 4
    with pytest.raises(ValueError, match='ends too early'):
        joint_state_from_bytes(whole[:place] + struct.pack('<I', count) + whole[place + 4:])


def test_a_message_that_is_too_large_is_refused():
    whole = message([], [], frame_id='x' * MOST_BYTES)
    with pytest.raises(ValueError, match=f'more than {MOST_BYTES}'):
        joint_state_from_bytes(whole)


def test_another_encoding_is_refused():
    with pytest.raises(ValueError, match='0x0003, which is not plain CDR'):
        joint_state_from_bytes(b'\0\3' + message(['a'], [1.0])[2:])


@given(st.lists(TEXTS, max_size=5), NUMBERS, TEXTS, st.integers(0, 2**31 - 1), NUMBERS)
def test_content_is_that_of_the_message(names, positions, frame_id, sec, velocities):
    data = message(
        names, positions, frame_id=frame_id, sec=sec, nanosec=sec // 3, velocities=velocities)
    found = joint_state_from_bytes(data)
    assert found.stamp == (sec, sec // 3)
    assert found.name_list() == names
    np.testing.assert_array_equal(found.positions, positions)
    again = joint_state_from_bytes(data, found.names)
    assert again.names == found.names
    np.testing.assert_array_equal(again.positions, positions)


@given(st.lists(TEXTS, min_size=1, max_size=5), st.lists(TEXTS, max_size=5), NUMBERS)
def test_names_of_another_message_do_not_mislead(known, names, positions):
    known_names = joint_state_from_bytes(message(known, [])).names
    found = joint_state_from_bytes(message(names, positions), known_names)
    assert found.name_list() == names
    np.testing.assert_array_equal(found.positions, positions)


def test_big_endian_is_read():
    header_and_names = struct.pack('>iII4xII2s2x', 7, 8, 1, 1, 2, b'j\0')
    data = b'\0\0\0\0' + header_and_names + struct.pack('>Id', 1, 2.5)
    found = joint_state_from_bytes(data)
    assert (found.stamp, found.name_list(), found.positions.tolist()) == ((7, 8), ['j'], [2.5])
