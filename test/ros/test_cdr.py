# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Messages are read by rclpy as what they were made of, and joint states are read as by rclpy."""

import importlib
import struct

from geometry_msgs.msg import PoseStamped, TransformStamped
import numpy as np
import pytest
from rclpy.serialization import deserialize_message, serialize_message
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

pytest.importorskip('hypothesis', reason='needs hypothesis')
from hypothesis import given
from hypothesis import strategies as st

from sdf_pose_bridge.ros.cdr import (
    joint_state_from_bytes,
    MOST_BYTES,
    POSE_TYPES,
    poses_from_bytes,
    StampedRecords,
    TF_MESSAGE,
)

STAMPS = st.integers(0, 2**31 * 10**9 - 1)
NAMES = st.text(st.characters(codec='utf-8', exclude_characters='\0'), max_size=20)
NUMBERS = st.lists(
    st.floats(allow_nan=False) | st.sampled_from([-0.0, 5e-324, -2.3e-308]),
    min_size=7, max_size=7)
ROWS = st.lists(st.tuples(NAMES, NAMES, NUMBERS), max_size=6)
STAMP = 1_000_000_002
POSITIONS = st.lists(st.floats(allow_nan=False), max_size=5)
NAMED_POSITIONS = st.lists(st.tuples(NAMES, st.floats(allow_nan=False)), max_size=5)


def columns(rows):
    """Return rows of (parent, child, numbers) as what the functions take."""
    numbers = np.array([row[2] for row in rows], dtype=np.float64).reshape(-1, 7)
    return ([row[0] for row in rows], [row[1] for row in rows]), numbers


def tf_message(ids, numbers, stamp=STAMP):
    records = StampedRecords(ids, numbers)
    records.set_stamps(stamp)
    return records.tf_message()


def stamped_messages(ids, numbers, stamps=STAMP):
    records = StampedRecords(ids, numbers)
    records.set_stamps(stamps)
    return records.messages()


def assert_read_by_rclpy(data, message):
    """Check that bytes are those of a message."""
    assert deserialize_message(data, type(message)) == message
    assert len(data) == len(serialize_message(message))


def stamped(message, stamp, frame_id):
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 10**9)
    message.header.frame_id = frame_id
    return message


def transform_message(row, stamp):
    parent_id, child_id, numbers = row
    message = stamped(TransformStamped(child_frame_id=child_id), stamp, parent_id)
    xyz, quat = message.transform.translation, message.transform.rotation
    xyz.x, xyz.y, xyz.z, quat.x, quat.y, quat.z, quat.w = numbers
    return message


def tf_message_object(rows, stamp):
    return TFMessage(transforms=[transform_message(row, stamp) for row in rows])


@given(rows=ROWS, stamp=STAMPS)
def test_a_tf_message_is_read_by_rclpy(rows, stamp):
    assert_read_by_rclpy(tf_message(*columns(rows), stamp), tf_message_object(rows, stamp))


@given(rows=ROWS, stamp=STAMPS)
def test_transforms_are_read_by_rclpy(rows, stamp):
    for data, row in zip(stamped_messages(*columns(rows), stamp), rows, strict=True):
        assert_read_by_rclpy(data, transform_message(row, stamp))


@given(rows=ROWS, stamp=STAMPS)
def test_poses_are_read_by_rclpy(rows, stamp):
    (frame_ids, _), numbers = columns(rows)
    ours = stamped_messages([frame_ids], numbers, stamp)
    for data, (frame_id, _, values) in zip(ours, rows, strict=True):
        message = stamped(PoseStamped(), stamp, frame_id)
        xyz, quat = message.pose.position, message.pose.orientation
        xyz.x, xyz.y, xyz.z, quat.x, quat.y, quat.z, quat.w = values
        assert_read_by_rclpy(data, message)


def test_long_names_are_read_by_rclpy():
    lengths = [0, 1, 3, *range(50, 64), *range(108, 116), 1000]
    rows = [('p' * first, 'c' * second, [1.0] * 7) for first in lengths for second in lengths]
    assert_read_by_rclpy(tf_message(*columns(rows)), tf_message_object(rows, STAMP))


@given(rows=ROWS, first=STAMPS, second=STAMPS)
def test_messages_can_be_stamped_again(rows, first, second):
    records = StampedRecords(*columns(rows))
    for stamp in (first, second):
        records.set_stamps(stamp)
        assert records.messages() == stamped_messages(*columns(rows), stamp)


@given(rows=ROWS)
def test_each_pose_can_have_its_stamp(rows):
    stamps = np.arange(len(rows)) * 1_000_000_007
    assert stamped_messages(*columns(rows), stamps) == [
        stamped_messages(*columns([row]), stamp)[0]
        for stamp, row in zip(stamps.tolist(), rows, strict=True)]


@given(rows=ROWS.filter(len), data=st.data())
def test_a_tf_message_of_some_transforms_is_that_of_a_scene_with_these_alone(rows, data):
    records = StampedRecords(*columns(rows))
    chosen = sorted(data.draw(st.sets(st.integers(0, len(rows) - 1), min_size=1)))
    records.set_stamps(3_000_000_004, np.array(chosen))
    assert records.tf_message(np.array(chosen)) == tf_message(
        *columns([rows[row] for row in chosen]), 3_000_000_004)


def test_no_transforms_are_one_empty_message():
    assert tf_message([[], []], np.empty((0, 7))) == bytes([0, 1, 0, 0, 0, 0, 0, 0])


def test_no_poses_are_no_messages():
    assert stamped_messages([[]], np.empty((0, 7))) == []


@given(ROWS)
def test_poses_can_be_replaced(rows):
    ids, numbers = columns(rows)
    records = StampedRecords(ids, np.zeros_like(numbers))
    records.set_poses(numbers)
    assert records.messages() == stamped_messages(ids, numbers, 0)


def joint_state(names, positions, *, frame_id='', sec=0, nanosec=0, velocities=()):
    made = JointState(name=names, position=positions, velocity=velocities)
    made.header.frame_id = frame_id
    made.header.stamp.sec, made.header.stamp.nanosec = sec, nanosec
    return serialize_message(made)


@pytest.mark.parametrize('length', range(48))
def test_a_message_that_ends_too_early_is_refused(length):
    whole = joint_state(['a', 'bc'], [1.0])
    assert len(whole) > 48
    with pytest.raises(ValueError, match=r'ends too early|not plain CDR'):
        joint_state_from_bytes(whole[:length])


@pytest.mark.parametrize('count', [2**31, 2**32 - 1])
def test_a_message_that_says_it_has_more_than_it_has_is_refused(count):
    whole = joint_state([], [])
    place = 4 + 12 + 4
    with pytest.raises(ValueError, match='ends too early'):
        joint_state_from_bytes(whole[:place] + struct.pack('<I', count) + whole[place + 4:])


def test_a_message_that_is_too_large_is_refused():
    largest = joint_state([], []).ljust(MOST_BYTES, b'x')
    assert joint_state_from_bytes(largest)[1].names == ()
    with pytest.raises(ValueError, match=f'more than {MOST_BYTES}'):
        joint_state_from_bytes(largest + b'x')


@pytest.mark.parametrize(('fields', 'reason'), [
    ({'positions': [1.0, 2.0]}, '1 names and 2 positions, and each name must have a position$'),
    ({'nanosec': 10**9}, 'nanosec must be less than 1000000000'),
])
def test_fields_that_contradict_one_another_are_refused(fields, reason):
    with pytest.raises(ValueError, match=reason):
        joint_state_from_bytes(joint_state(['a'], **{'positions': [1.0], **fields}))


def test_another_encoding_is_refused():
    with pytest.raises(ValueError, match='0x0003, which is not plain CDR'):
        joint_state_from_bytes(b'\0\3' + joint_state(['a'], [1.0])[2:])


@given(NAMED_POSITIONS, NAMES, STAMPS, POSITIONS)
def test_content_is_that_of_the_message(named, frame_id, stamp_ns, velocities):
    names, positions = list(zip(*named, strict=True)) or ((), ())
    sec, nanosec = divmod(stamp_ns, 10**9)
    data = joint_state(
        names, positions, frame_id=frame_id, sec=sec, nanosec=nanosec, velocities=velocities)
    stamp, found, values = joint_state_from_bytes(data)
    assert stamp == stamp_ns
    assert found.names == names
    np.testing.assert_array_equal(values, positions)
    _, again, values = joint_state_from_bytes(data, found)
    assert again is found
    np.testing.assert_array_equal(values, positions)


@given(st.lists(NAMES, min_size=1, max_size=5), NAMED_POSITIONS)
def test_names_of_another_message_do_not_mislead(known, named):
    names, positions = list(zip(*named, strict=True)) or ((), ())
    _, before, _ = joint_state_from_bytes(joint_state(known, [0.0] * len(known)))
    _, found, values = joint_state_from_bytes(joint_state(names, positions), before)
    assert found.names == names
    np.testing.assert_array_equal(values, positions)


@pytest.mark.parametrize('length', range(9))
def test_names_are_behind_a_frame_id_of_any_length(length):
    data = joint_state(['a'], [1.0], frame_id='x' * length)
    assert joint_state_from_bytes(data)[1].names == ('a',)


def test_a_name_that_is_not_utf_8_is_read_as_far_as_it_is():
    data = joint_state(['elbow'], [2.5]).replace(b'elbow', b'elb\xffw')
    assert joint_state_from_bytes(data)[1].names == ('elb\ufffdw',)


def test_big_endian_is_read():
    header_and_names = struct.pack('>iII4xII2s2x', 7, 8, 1, 1, 2, b'j\0')
    data = b'\0\0\0\0' + header_and_names + struct.pack('>Id', 1, 2.5)
    stamp, names, positions = joint_state_from_bytes(data)
    assert (stamp, names.names, positions.tolist()) == (7_000_000_008, ('j',), [2.5])


# Poses

POSE = (1.0, 2.0, 3.0, 0.5, -0.5, 0.5, -0.5)


def pose_message(type_name, frame_id, child='', pose=POSE, sec=7):
    """Return a serialized message with one pose, or with two equal ones, and the first of them."""
    package, _, name = type_name.split('/')
    one = message = getattr(importlib.import_module(f'{package}.msg'), name)()
    if hasattr(message, 'transforms'):
        one = TransformStamped()
        message.transforms = [one] * 2
    stamp_ns = 0
    if hasattr(one, 'header'):
        one.header.frame_id, one.header.stamp.sec, one.header.stamp.nanosec = frame_id, sec, 8
        stamp_ns = sec * 10**9 + 8
    if hasattr(one, 'child_frame_id'):
        one.child_frame_id = child
    found = one
    while hasattr(found, 'pose'):
        found = found.pose
    places = (one.transform.translation, one.transform.rotation) if hasattr(
        one, 'transform') else (found.position, found.orientation)
    for place, values in zip(places, (pose[:3], pose[3:]), strict=True):
        for name, value in zip('xyzw', values, strict=False):
            setattr(place, name, value)
    return serialize_message(message), (
        stamp_ns, frame_id if stamp_ns else '', getattr(one, 'child_frame_id', ''), pose)


@pytest.mark.parametrize('type_name', POSE_TYPES)
@given(frame_id=NAMES, child=NAMES)
def test_poses_are_those_of_the_message(type_name, frame_id, child):
    data, one = pose_message(type_name, frame_id, child)
    assert list(poses_from_bytes(data, POSE_TYPES[type_name])) == [one] * (
        2 if type_name == TF_MESSAGE else 1)


@pytest.mark.parametrize('type_name', POSE_TYPES)
def test_a_message_with_a_pose_that_ends_too_early_is_refused(type_name):
    whole, _ = pose_message(type_name, 'abc', 'de')
    for length in range(len(whole) if 'Transform' in type_name else 60):
        with pytest.raises(ValueError, match=r'ends too early|not plain CDR'):
            list(poses_from_bytes(whole[:length], POSE_TYPES[type_name]))


@pytest.mark.parametrize('place', [4, 12])
def test_a_length_beyond_the_message_is_refused(place):
    whole, _ = pose_message(TF_MESSAGE, 'abc', 'de')
    broken = whole[:place] + struct.pack('<I', 2**32 - 1) + whole[place + 4:]
    with pytest.raises(ValueError, match=r'ends too early|nanosec'):
        list(poses_from_bytes(broken, POSE_TYPES[TF_MESSAGE]))


def test_a_negative_time_of_a_pose_is_refused():
    with pytest.raises(ValueError, match='sec must not be negative'):
        list(poses_from_bytes(pose_message(TF_MESSAGE, '', sec=-1)[0], POSE_TYPES[TF_MESSAGE]))
