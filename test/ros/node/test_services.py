# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Answers of the services: refused with a sentence, or given, and never raised."""

import array
import contextlib
from functools import partial
import math
import threading

from deadline import DEADLINE_S, spin_until
from folders import ROOT
from geometry_msgs.msg import PoseStamped
from growth.turns import fault_of_growth
import numpy as np
import pytest
from rclpy.clock import Clock
from rclpy.logging import get_logger
from rclpy.qos import qos_profile_parameters
from rclpy.time import Time
from sdf_texts import joint, model_file, posed, world_file

from sdf_pose_bridge import load
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.export.published_scene import LoadRequest
from sdf_pose_bridge.export.scene_from_request import loaded_scene_from_request
from sdf_pose_bridge.ros.node import services
from sdf_pose_bridge.ros.node.services import (
    answer_to_convert_poses,
    answer_to_convert_rotation,
    answer_to_lookup_pose,
    response_from_answer,
    set_pose,
)
from sdf_pose_bridge.ros.parameters.given import settings_from_node
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge.tf.tree import tf_tree_from_scene
from sdf_pose_bridge_interfaces.srv import ConvertPoses, ConvertRotation, LookupPose, SetPose


def answered(answer, request, response):
    return response_from_answer(answer, request, response, get_logger('bridge').error)


def convert_rotation(given=0, rpy=(0.0, 0.0, 0.0), quat_xyzw=(0.0, 0.0, 0.0, 1.0), degrees=False):
    request = ConvertRotation.Request(given=given, degrees=degrees)
    request.rpy.x, request.rpy.y, request.rpy.z = rpy
    quat = request.quaternion
    quat.x, quat.y, quat.z, quat.w = quat_xyzw
    return answered(answer_to_convert_rotation, request, ConvertRotation.Response())


def convert_poses(values, from_format='sdf_rpy', to_format='sdf_quat_xyzw'):
    request = ConvertPoses.Request(from_format=from_format, to_format=to_format)
    request.values = array.array('d', values)
    return answered(answer_to_convert_poses, request, ConvertPoses.Response())


def look_up(frame, relative_to=''):
    scene = load_text(world_file(
        '<model name="m"><pose>0.1 -1e-300 1e300 0 0 3</pose><link name="l"/></model>'))
    lookup = PoseLookup(scene, tf_tree_from_scene(scene))
    return answered(
        lambda request, response: answer_to_lookup_pose(request, response, lookup, Clock()),
        LookupPose.Request(frame=frame, relative_to=relative_to), LookupPose.Response())


@pytest.mark.parametrize(('convert', 'fields', 'word'), [
    (convert_rotation, {'given': 2}, '2'),
    (convert_rotation, {'rpy': (0.0, math.nan, 0.0)}, 'nan'),
    (convert_rotation, {'given': 1, 'quat_xyzw': (0.0, math.nan, 0.0, 1.0)}, 'nan'),
    (convert_rotation, {'quat_xyzw': (0.0, 0.0, 0.7, 0.7)}, 'set given to 1 (quaternion)'),
    (convert_rotation, {'quat_xyzw': (0.0, 0.0, math.nan, 1.0)}, 'set given to 1'),
    (convert_rotation, {'given': 1, 'rpy': (0.0, 0.0, 1.0)}, 'set given to 0 (rpy)'),
    (convert_rotation, {'given': 1, 'rpy': (0.0, math.nan, 0.0)}, 'set given to 0'),
    (convert_rotation, {'given': 1, 'quat_xyzw': (0.0, 0.0, 0.0, 0.0)},
     'is zero, which is not a rotation'),
    (convert_poses, {'values': [0.0] * 6, 'from_format': 'rpy'}, 'near: sdf_rpy'),
    (convert_poses, {'values': [0.0] * 6, 'to_format': ''}, 'all: docs/pose_formats.md'),
    (convert_poses, {'values': [0.0] * 7}, '7'),
    (look_up, {'frame': 'm::k'}, 'no frame or element is called "m::k"'),
])
def test_a_bad_request_is_refused_with_the_value_or_the_rule(convert, fields, word):
    response = convert(**fields)
    assert not response.success
    assert word in response.message
    assert len(getattr(response, 'values', ())) == 0


def test_both_representations_are_answered():
    response = convert_rotation(rpy=(0.0, 0.0, 90.0), degrees=True)
    assert (response.success, response.message) == (True, '')
    quat = response.quaternion
    half = math.sqrt(0.5)
    assert (quat.x, quat.y, quat.z, quat.w) == pytest.approx((0.0, 0.0, half, half))
    assert (response.rpy.x, response.rpy.y, response.rpy.z) == (0.0, 0.0, 90.0)
    assert not response.gimbal_lock


def test_angles_that_look_like_degrees_are_asked_about():
    response = convert_rotation(rpy=(0.0, 0.0, 90.0))
    assert (response.success, response.message) == (
        True, 'the angles 0 0 90 are radians; did you mean degrees?')
    assert convert_rotation(rpy=(0.0, 0.0, 90.0), degrees=True).message == ''


@pytest.mark.parametrize(('values', 'converted', 'message'), [
    ([], [], ''),
    ([1, 2, 3, 0, 0, math.pi, 4, 5, 6, 0, 0, 0],
     [1, 2, 3, 0, 0, 1, 0, 4, 5, 6, 0, 0, 0, 1], ''),
    ([1, 2, 3, math.pi, 0, 6 * math.pi], [1, 2, 3, 1, 0, 0, 0],
     'the angles 3.14159 0 18.8496 are radians; did you mean degrees?'),
    ([0] * 6 + [1, 1197, 3, 0, 0, 0], [0] * 6 + [1, 1, 1197, 3, 0, 0, 0, 1],
     'the position 1 1197 3 is in metres; did you mean mm?'),
])
def test_poses_are_converted_row_by_row_and_another_unit_is_asked_about(
        values, converted, message):
    response = convert_poses(values)
    assert (response.success, response.message) == (True, message)
    assert response.values == pytest.approx(converted)


@pytest.mark.parametrize(('distance', 'expected'), [(0.0, True), (2e-8, True), (7e-8, False)])
def test_gimbal_lock_is_reported_as_near_to_it_as_by_gz_math(distance, expected):
    assert convert_rotation(
        rpy=(0.1, math.pi / 2 - distance, 0.2)).gimbal_lock is expected


def test_a_quaternion_of_zeros_is_unset():
    response = convert_rotation(rpy=(0.0, 0.0, 1.0), quat_xyzw=(0.0, 0.0, 0.0, 0.0))
    assert (response.success, response.rpy.z) == (True, 1.0)


def test_a_pose_has_every_number_in_its_place():
    response = look_up('m')
    assert (response.success, response.message) == (True, '')
    xyz, quat = response.pose.pose.position, response.pose.pose.orientation
    assert (xyz.x, xyz.y, xyz.z) == (0.1, -1e-300, 1e300)
    assert (quat.x, quat.y, quat.z, quat.w) == (0.0, 0.0, math.sin(1.5), math.cos(1.5))


def test_a_pose_has_its_frame_and_stamp():
    before = Clock().now().nanoseconds
    header = look_up('m', 'm::l').pose.header
    assert header.frame_id == 'm/l'
    assert before <= Time.from_msg(header.stamp).nanoseconds <= Clock().now().nanoseconds


def test_a_defect_is_answered_and_logged(capfd):
    def defective(request, response):
        response.success = True
        msg = 'the moon is full'
        raise KeyError(msg)

    response = answered(defective, ConvertPoses.Request(), ConvertPoses.Response())
    assert not response.success
    assert response.message.startswith('internal error')
    assert 'the moon is full' in response.message
    assert 'Traceback' in capfd.readouterr().err


# Setting a pose

ARM = model_file(
    '<link name="base"><sensor name="camera" type="camera"/></link>'
    + posed('link', 'tool', '1 0 0 0 0 0')
    + '<frame name="tip" attached_to="tool"><pose>0 0 1 0 0 0</pose></frame>'
    + posed('frame', 'mark', '2 0 0 0 0 0') + posed('frame', 'on_mark', '0 0 1 0 0 0', 'mark')
    + joint('<pose relative_to="base"/><parent>base</parent><child>tool</child>'
            '<axis><xyz>0 0 1</xyz></axis>', 'turn', 'revolute'))


@pytest.fixture
def path(tmp_path):
    path = tmp_path / 'cell.sdf'
    path.write_text(ARM)
    return path


def test_large_requests_wait_in_the_middleware_until_it_is_their_turn(
        make_node, make_executor, monkeypatch):
    goes_on, taken = threading.Event(), []
    monkeypatch.setattr(services, 'answer_to_convert_poses', lambda *_: goes_on.wait(DEADLINE_S))
    node, caller = make_node('bridge'), make_node('caller')
    executor = make_executor(node, caller)
    services.add_services(node, None)
    service = next(each for each in node.services if each.srv_name.endswith('/convert_poses'))
    convert = service.callback

    async def counted(request, response):
        taken.append(request)
        return await convert(request, response)

    service.callback = counted
    client = caller.create_client(
        ConvertPoses, '/bridge/convert_poses', qos_profile=qos_profile_parameters)
    other_client = caller.create_client(ConvertRotation, '/bridge/convert_rotation')

    spin_until(executor, lambda: client.service_is_ready() and other_client.service_is_ready())
    request = ConvertPoses.Request(values=array.array('d', bytes(8 * services.FEW_NUMBERS + 8)))
    futures = [client.call_async(request) for _ in range(30)]  # by default, ten would wait

    spin_until(executor, lambda: taken)
    for _ in range(3):
        later = other_client.call_async(ConvertRotation.Request())
        spin_until(executor, later.done)
    assert len(taken) == 1
    goes_on.set()
    spin_until(executor, lambda: all(future.done() for future in futures))
    assert all(future.result().success for future in futures)


def call(_request, function, *arguments):
    """Call a function here, where the node calls it in another process."""
    return function(*arguments)


@pytest.fixture
def ask(make_node, path):
    settings = settings_from_node(make_node(
        'bridge', '-p', f'sdf_file:={path}', '-p', 'use_joint_states:=true'))
    loaded = loaded_scene_from_request(settings.load_request)
    positions = loaded.joint_positions
    positions.update(positions.selection(['turn']), np.array([np.pi / 2]))

    def ask(frame='mark', xyz=(3.0, 0.0, 0.0), quat_xyzw=(0.0, 0.0, 0.0, 1.0), frame_id='', *,
            dry_run=False):
        pose = PoseStamped()
        pose.header.frame_id = frame_id
        position, rotation = pose.pose.position, pose.pose.orientation
        position.x, position.y, position.z = xyz
        rotation.x, rotation.y, rotation.z, rotation.w = quat_xyzw
        return set_pose(
            SetPose.Request(frame=frame, pose=pose, dry_run=dry_run), loaded, call)

    return ask


def test_the_answer_has_the_file_and_the_frames_that_move(ask, path):
    response = ask()
    assert (response.success, response.message) == (True, '')
    assert (response.file, response.line) == (str(path), 1)
    assert '+<sdf' in response.diff
    assert response.moved_frames == ['on_mark']
    assert path.read_text() == ARM.replace('2 0 0 0 0 0', '3 0 0 0 0 0')


def test_a_frame_that_moves_is_set_where_it_is_now(ask, path):
    ask('tip', (0.0, 1.0, 3.0), (0.0, 0.0, 0.5 ** 0.5, 0.5 ** 0.5))
    np.testing.assert_allclose(
        load(path).pose('m::tip', 'm::tool')[:6], (0.0, 0.0, 3.0, 0.0, 0.0, 0.0), atol=1e-9)


def test_a_frame_that_a_joint_moves_away_is_refused(ask, path):
    with pytest.raises(SdfError, match='a joint has moved "m::tool" away from "m"'):
        ask('tool', (0.0, 1.0, 0.0))
    assert path.read_text() == ARM


def test_a_dry_run_writes_nothing(ask, path):
    assert ask(dry_run=True).diff
    assert path.read_text() == ARM


@pytest.mark.parametrize(('fields', 'reason'), [
    ({'frame': 'marc'}, 'did you mean "mark"'),
    ({'frame_id': 'tol'}, 'did you mean "tool"'),
    ({'xyz': (np.nan, 0.0, 0.0)}, 'must be a finite number'),
    ({'quat_xyzw': (0.0, 0.0, 0.0, 0.0)}, 'is zero, which is not a rotation'),
    ({'xyz': (300.0, 0.0, 0.0)}, 'is in metres; did you mean mm?'),
    ({'quat_xyzw': (0.0, 0.0, 45.0, 1.0)}, '0 0 45 1 has the length 45.0111, not 1'),
])
def test_a_wrong_request_is_refused(ask, path, fields, reason):
    with pytest.raises(SdfError, match=reason):
        ask(**fields)
    assert path.read_text() == ARM


GROWING = {
    ('ConvertPoses', 'from_format'): lambda n, _: convert_poses([0.0] * 6, 'x' * n),
    ('ConvertPoses', 'to_format'): lambda n, _: convert_poses([0.0] * 6, to_format='x' * n),
    ('ConvertPoses', 'values'): lambda n, _: convert_poses([0.1] * 2 * n),
    ('LookupPose', 'frame'): lambda n, _: look_up('a::' * (n // 3)),
    ('LookupPose', 'relative_to'): lambda n, _: look_up('m::l', 'a::' * (n // 3)),
    ('SetPose', 'frame'): lambda n, ask: ask('a::' * (n // 3)),
}
"""Requests with a field of about n characters."""


def test_each_field_of_a_request_that_has_no_fixed_size_has_a_row():
    types = {(service.__name__, name): kind
             for service in (ConvertPoses, ConvertRotation, LookupPose, SetPose)
             for name, kind in service.Request.get_fields_and_field_types().items()}
    assert {*types.values()} <= {
        'boolean', 'uint8', 'string', 'sequence<double>', 'geometry_msgs/Vector3',
        'geometry_msgs/Quaternion', 'geometry_msgs/PoseStamped'}
    assert {key for key, kind in types.items() if kind.startswith(('string', 'sequence'))} == {
        *GROWING}


def test_each_service_is_one_of_those():
    folder = ROOT / 'sdf_pose_bridge_interfaces' / 'srv'
    names = {path.stem for path in folder.glob('*.srv')}
    assert names == {'ConvertPoses', 'ConvertRotation', 'LookupPose', 'SetPose'}


@pytest.mark.parametrize(('service', 'field'), GROWING)
def test_time_grows_with_a_request_and_not_faster(ask, service, field):
    def request(n):
        with contextlib.suppress(SdfError):
            GROWING[service, field](n, ask)

    n = 60_000
    plain = model_file(''.join(posed('link', f'l{i}', '0 1 2 0 0 0') for i in range(n // 60)))
    fault = fault_of_growth(
        partial(request, n), partial(request, n // 2), partial(load_text, plain))
    assert not fault, fault


def test_a_text_that_is_no_file_is_refused():
    loaded = loaded_scene_from_request(LoadRequest('', ARM))
    with pytest.raises(SdfError, match='in the parameter robot_description, not in a file'):
        set_pose(SetPose.Request(frame='mark'), loaded, call)
