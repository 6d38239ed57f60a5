# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Services of a running bridge, called from another process."""

import array
import math

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from changes import world
from sizes import size

from sdf_pose_bridge_interfaces.srv import ConvertPoses, ConvertRotation, LookupPose

ROTATION = '/sdf_pose_bridge/convert_rotation'
POSES = '/sdf_pose_bridge/convert_poses'
LOOKUP = '/sdf_pose_bridge/lookup_pose'


@pytest.fixture(scope='module')
def bridge(start_shared_bridge, tmp_path_factory):
    path = tmp_path_factory.mktemp('services') / 'cell.sdf'
    path.write_text(world(1), encoding='utf-8')
    return start_shared_bridge('--ros-args', '-p', f'sdf_file:={path}')


@pytest.fixture(scope='module')
def listener(bridge, start_shared_listener):
    return start_shared_listener()


def rotation_request(given, numbers, *, degrees=False):
    request = ConvertRotation.Request(given=given, degrees=degrees)
    if given == ConvertRotation.Request.RPY:
        request.rpy.x, request.rpy.y, request.rpy.z = numbers
    else:
        quat = request.quaternion
        quat.x, quat.y, quat.z, quat.w = numbers
    return request


def test_rpy_becomes_a_quaternion(listener):
    request = rotation_request(ConvertRotation.Request.RPY, (0.0, 0.0, math.pi / 2))
    answer = listener.call(ConvertRotation, ROTATION, request)
    assert answer.success, answer.message
    quat = answer.quaternion
    assert (quat.x, quat.y, quat.z, quat.w) == pytest.approx(
        (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))


def test_a_quaternion_becomes_rpy(listener):
    request = rotation_request(
        ConvertRotation.Request.QUATERNION, (0.0, 3.0, 0.0, 4.0), degrees=True)
    answer = listener.call(ConvertRotation, ROTATION, request)
    assert answer.success, answer.message
    pitch = math.degrees(2 * math.atan2(3, 4))
    assert (answer.rpy.x, answer.rpy.y, answer.rpy.z) == pytest.approx((0.0, pitch, 0.0))


def test_bad_input_is_answered_and_the_node_lives_on(bridge, listener):
    bad_rotations = [
        rotation_request(7, (0.0, 0.0, 0.0, 1.0)),
        rotation_request(ConvertRotation.Request.RPY, (math.nan, 0.0, 0.0)),
        rotation_request(ConvertRotation.Request.RPY, (0.0, -math.inf, 0.0)),
        rotation_request(ConvertRotation.Request.QUATERNION, (0.0, 0.0, 0.0, 0.0)),
        rotation_request(ConvertRotation.Request.QUATERNION, (math.nan, 0.0, 0.0, 1.0)),
    ]
    bad_poses = [
        ConvertPoses.Request(from_format=source, to_format=target, values=array.array('d', values))
        for source, target, values in (
            ('sdf_rpy', 'euler', [0.0] * 6),
            ('', '', []),
            ('größe\x00', 'sdf_rpy', [0.0] * 6),
            ('sdf_rpy', 'sdf_rpy', [0.0] * 5),
            ('sdf_rpy', 'sdf_rpy', [math.nan] * 6),
            ('sdf_quat_xyzw', 'sdf_rpy', [0.0] * 7),
            ('matrix_row_major', 'sdf_rpy', [0.0] * 16),
            ('franka_matrix', 'sdf_rpy',
             [1.0, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1]),
        )
    ]
    answers = [
        *(listener.call(ConvertRotation, ROTATION, request) for request in bad_rotations),
        *(listener.call(ConvertPoses, POSES, request) for request in bad_poses)]
    assert not [answer for answer in answers if answer.success]
    assert not [answer for answer in answers if not answer.message]
    assert not [answer for answer in answers if 'internal' in answer.message]
    assert not [line for line in bridge.lines if line.startswith('[ERROR]')]


@pytest.mark.parametrize(('frame', 'relative_to', 'x', 'frame_id'), [
    ('crate::body', '', 1.0, 'world'),
    ('crate/body', 'world', 1.0, 'world'),
    ('world', 'crate::body', -1.0, 'crate/body'),
])
def test_poses_are_looked_up_by_either_name(listener, frame, relative_to, x, frame_id):
    request = LookupPose.Request(frame=frame, relative_to=relative_to)
    answer = listener.call(LookupPose, LOOKUP, request)
    assert answer.success, answer.message
    assert (answer.pose.pose.position.x, answer.pose.header.frame_id) == (x, frame_id)


def test_a_name_that_means_nothing_is_answered(listener):
    request = LookupPose.Request(frame='crate::bodi')
    answer = listener.call(LookupPose, LOOKUP, request)
    assert not answer.success
    assert answer.message == (
        'no frame or element is called "crate::bodi"; did you mean "crate::body"?')


def test_a_large_batch_of_poses(listener):
    count = size(10_000, 100_000)
    request = ConvertPoses.Request(from_format='franka_measured', to_format='sdf_quat_xyzw')
    request.values = array.array('d', [1000.0, 2000.0, -500.0, 0.0, 0.0, 180.0] * count)
    answer = listener.call(ConvertPoses, POSES, request)
    assert answer.success, answer.message
    assert len(answer.values) == 7 * count
    assert answer.values[:7] == pytest.approx([1.0, 2.0, -0.5, 0.0, 0.0, 1.0, 0.0])
    assert answer.values[:7] * count == answer.values
