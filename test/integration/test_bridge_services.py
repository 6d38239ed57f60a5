# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Services of a running bridge, called from another process."""

import array
import math

import pytest

pytest.importorskip('rclpy', reason='needs ROS 2')

from changes import world

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
    answers = [
        listener.call(ConvertRotation, ROTATION, rotation_request(7, (0.0, 0.0, 0.0, 1.0))),
        listener.call(ConvertPoses, POSES, ConvertPoses.Request(
            from_format='größe\x00', to_format='sdf_rpy', values=array.array('d', [0.0] * 6))),
        listener.call(LookupPose, LOOKUP, LookupPose.Request(frame='crate::bodi'))]
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
