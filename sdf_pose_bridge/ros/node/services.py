# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The services that convert rotations and poses, look up poses and set them."""

from __future__ import annotations

import array
from collections.abc import Awaitable, Callable, Iterable
from functools import partial
from typing import Any, TYPE_CHECKING, TypeAlias

import numpy as np
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.clock import Clock
from rclpy.node import Node
from rclpy.qos import qos_profile_parameters

from sdf_pose_bridge.errors import (
    JointPositionError,
    Place,
    PoseNotSetError,
    SdfError,
    UnknownFrameError,
)
from sdf_pose_bridge.export.published_scene import fingerprint_of_scene, LoadedScene
from sdf_pose_bridge.geometry.formats import (
    converted_poses,
    converted_rotations,
    format_from_name,
    POSE_FORMATS,
    PoseFormatError,
    ROTATION_FORMATS,
)
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.rotations import RotationError
from sdf_pose_bridge.geometry.sequences import ZYX
from sdf_pose_bridge.ros.background import Worker
from sdf_pose_bridge.ros.log_lines import text_about_defect
from sdf_pose_bridge.tf.lookup import PoseLookup
from sdf_pose_bridge_interfaces.srv import ConvertPoses, ConvertRotation, LookupPose, SetPose

if TYPE_CHECKING:
    from sdf_pose_bridge.export.pose_setting import FrameChange

Answer: TypeAlias = Callable[[Any, Any], None]
"""Fills the response to a request."""

_UNSET = ((0.0,) * 3, (0.0, 0.0, 0.0, 1.0), (0.0,) * 4)
"""Angles and quaternions that a request does not set."""

REFUSALS = (RotationError, PoseFormatError, UnknownFrameError, JointPositionError)
"""Exceptions about requests that are not valid."""

MOST_NUMBERS = 1_000_000
"""Largest number of values in a call of ``~/convert_poses``."""

FEW_NUMBERS = 1000
"""Largest number of values that the executor converts itself, in less than a millisecond."""


def add_services(node: Node, lookup: Callable[[], Awaitable[PoseLookup]]) -> None:
    """
    Offer ``~/convert_rotation``, ``~/convert_poses`` and ``~/lookup_pose``.

    :param lookup: returns the current look-up of poses.
    """
    # It answers requests that may take long, one after the other.
    worker = Worker(node, 'conversions')
    answered = partial(response_from_answer, log_error=node.get_logger().error)

    async def convert_poses(request: ConvertPoses.Request, response: ConvertPoses.Response) -> Any:
        answer = partial(answered, answer_to_convert_poses, request, response)
        return answer() if len(request.values) <= FEW_NUMBERS else await worker.run(answer)

    async def lookup_pose(request: LookupPose.Request, response: LookupPose.Response) -> Any:
        current = await lookup()
        answer = partial(
            answered, partial(answer_to_lookup_pose, lookup=current, clock=node.get_clock()),
            request, response)
        is_known = current.knows(request.frame) and (
            not request.relative_to or current.knows(request.relative_to))
        # Finding the nearest name takes long if there are many.
        return answer() if is_known else await worker.run(answer)

    for service_type, name, callback in (
        (ConvertRotation, 'convert_rotation', partial(answered, answer_to_convert_rotation)),
        (ConvertPoses, 'convert_poses', convert_poses),
        (LookupPose, 'lookup_pose', lookup_pose),
    ):
        add_service(node, service_type, name, callback, MutuallyExclusiveCallbackGroup())


def add_service(
    node: Node, service_type: type, name: str, callback: Callable[[Any, Any], Any],
    group: MutuallyExclusiveCallbackGroup,
) -> None:
    """Offer a service; its group takes one request at a time."""
    # The others wait in the middleware, which keeps 1000 of them, and by default only ten.
    node.create_service(
        service_type, f'~/{name}', callback, qos_profile=qos_profile_parameters,
        callback_group=group)


def answer_to_convert_rotation(
    request: ConvertRotation.Request, response: ConvertRotation.Response,
) -> None:
    """Convert one rotation, unless a value is in the field that would be ignored."""
    angles = 'rpy_degrees' if request.degrees else 'rpy'
    # In the order of the constants RPY and QUATERNION.
    fields = (
        ('rpy', angles, _numbers(request.rpy, 'xyz')),
        ('quaternion', 'quaternion', _numbers(request.quaternion, 'xyzw')))
    if request.given >= len(fields):
        msg = f'given is {request.given}, and must be 0 (RPY) or 1 (QUATERNION)'
        raise RotationError(msg)
    name, source, values = fields[request.given]
    other, _, ignored = fields[1 - request.given]
    if ignored not in _UNSET:
        msg = (f'given is {request.given} ({name}), but {other} is {ignored}; set given to'
               f' {1 - request.given} ({other}), or leave that out')
        raise RotationError(msg)
    quat = converted_rotations(values, source, 'quaternion')
    _fill(response.rpy, converted_rotations(values, source, angles).tolist())
    _fill(response.quaternion, quat.tolist())
    response.gimbal_lock = bool(ZYX.near_lock(quat))
    response.message = ROTATION_FORMATS[source].doubt(values)


def answer_to_convert_poses(
    request: ConvertPoses.Request, response: ConvertPoses.Response,
) -> None:
    """Convert poses with at most ``MOST_NUMBERS`` numbers."""
    if len(request.values) > MOST_NUMBERS:
        msg = f'values has {len(request.values)} numbers; a call can have at most {MOST_NUMBERS}'
        raise PoseFormatError(msg)
    converted = converted_poses(np.asarray(request.values), request.from_format, request.to_format)
    source = format_from_name(request.from_format, POSE_FORMATS)
    response.message = source.doubt(request.values)
    # The message would check every element of anything but an array.array.
    response.values = array.array('d', converted.tobytes())


def answer_to_lookup_pose(
    request: LookupPose.Request, response: LookupPose.Response, lookup: PoseLookup, clock: Clock,
) -> None:
    """Look up a pose."""
    found = lookup.pose(request.frame, request.relative_to)
    _fill(response.pose.pose.position, found.pose[:3])
    _fill(response.pose.pose.orientation, found.pose[3:])
    response.pose.header.frame_id = found.frame_id
    response.pose.header.stamp = clock.now().to_msg()


def set_pose(
    request: SetPose.Request, loaded: LoadedScene, call: Callable[..., FrameChange],
) -> SetPose.Response:
    """
    Write the measured pose of a frame into its file, unless it is a dry run.

    :param loaded: the published scene.
    :param call: calls a function in another process, as ``FileProcess.calling``, and returns its
        result.
    :return: the response with the change; the changed file is valid and can be published.
    :raises SdfError: if the request is not valid, no change of a single pose gives this pose, or
        the file cannot be written.
    """
    if not loaded.request.sdf_file:
        msg = 'the pose is in the parameter robot_description, not in a file'
        raise PoseNotSetError(msg, Place(str(loaded.path)))
    # Imported here because it takes 7 ms, and few nodes write files.
    from sdf_pose_bridge.export.pose_setting import write_frame_change
    change = call(
        loaded.request, write_frame_change, loaded.request, fingerprint_of_scene(loaded.scene),
        request.frame, _pose_from_request(request, loaded), request.pose.header.frame_id,
        loaded.joint_positions, request.dry_run)
    return SetPose.Response(success=True, **change._asdict())


def _pose_from_request(request: SetPose.Request, loaded: LoadedScene) -> Pose:
    given = request.pose.pose
    numbers = [*_numbers(given.position, 'xyz'), *_numbers(given.orientation, 'xyzw')]
    place = Place(str(loaded.path))
    try:
        pose = Pose(*converted_poses(numbers, 'sdf_quat_xyzw', 'sdf_quat_xyzw').tolist())
    except PoseFormatError as error:
        raise PoseNotSetError(str(error), place) from error
    if doubt := POSE_FORMATS['sdf_quat_xyzw'].doubt(numbers, is_written=True):
        msg = f'{doubt} ("sdf_pose set" writes it with --metres or --force)'
        raise PoseNotSetError(msg, place)
    return pose


def _numbers(message: Any, fields: str) -> Any:
    return tuple(getattr(message, field) for field in fields)


def _fill(message: Any, numbers: Iterable[float]) -> None:
    for field, number in zip('xyzw', numbers, strict=False):
        setattr(message, field, number)


def response_from_answer(
    answer: Answer, request: Any, response: Any, log_error: Callable[[str], object],
) -> Any:
    """
    Answer a request, also after a refusal or a defect, which would end the node.

    :param answer: fills the response to a request, or raises one of ``REFUSALS``.
    :param log_error: takes the traceback of another exception.
    :return: the response; with ``success: false`` after an exception.
    """
    try:
        answer(request, response)
    except REFUSALS as error:
        response.message = error.message if isinstance(error, SdfError) else str(error)
    except MemoryError:
        raise
    except Exception as error:  # noqa: BLE001 - whatever it is, the client must be answered
        log_error(text_about_defect('a service'))
        response = type(response)()
        response.message = f'internal error, see the log of the node: {error!r}'
    else:
        response.success = True
    return response
