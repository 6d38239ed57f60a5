# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The services that convert rotations and poses; bad input is answered, never raised."""

from __future__ import annotations

import array
from collections.abc import Callable
import traceback
from typing import Any
from typing import TypeAlias

import numpy as np
from rclpy.impl.rcutils_logger import RcutilsLogger
from rclpy.node import Node

from sdf_pose_bridge.geometry.formats import converted_poses
from sdf_pose_bridge.geometry.formats import converted_rotation
from sdf_pose_bridge.geometry.formats import PoseFormatError
from sdf_pose_bridge.geometry.rotations import RotationError
from sdf_pose_bridge_interfaces.srv import ConvertPoses
from sdf_pose_bridge_interfaces.srv import ConvertRotation

Answer: TypeAlias = Callable[[Any, Any], Any]
"""Fills the response to a request and returns it."""


def add_conversion_services(node: Node) -> None:
    """
    Offer ``~/convert_rotation`` and ``~/convert_poses``.

    :param node: the node that offers them.
    """
    logger = node.get_logger()
    node.create_service(
        ConvertRotation, '~/convert_rotation', never_raising(answer_to_convert_rotation, logger))
    node.create_service(
        ConvertPoses, '~/convert_poses', never_raising(answer_to_convert_poses, logger))


def answer_to_convert_rotation(
    request: ConvertRotation.Request, response: ConvertRotation.Response,
) -> ConvertRotation.Response:
    """
    Convert one rotation.

    :param request: the request.
    :param response: an empty response, which is filled.
    :return: that response.
    """
    rpy, quaternion = request.rpy, request.quaternion
    try:
        answer = converted_rotation(
            request.given, (rpy.x, rpy.y, rpy.z),
            (quaternion.x, quaternion.y, quaternion.z, quaternion.w), degrees=request.degrees)
    except RotationError as error:
        response.message = str(error)
        return response
    rpy, quaternion = response.rpy, response.quaternion
    rpy.x, rpy.y, rpy.z = answer.rpy
    quaternion.x, quaternion.y, quaternion.z, quaternion.w = answer.quat_xyzw
    response.gimbal_lock = answer.gimbal_lock
    response.success = True
    return response


def answer_to_convert_poses(
    request: ConvertPoses.Request, response: ConvertPoses.Response,
) -> ConvertPoses.Response:
    """
    Convert any number of poses.

    :param request: the request.
    :param response: an empty response, which is filled.
    :return: that response.
    """
    try:
        converted = converted_poses(
            np.asarray(request.values), request.from_format, request.to_format)
    except PoseFormatError as error:
        response.message = str(error)
        return response
    # The message would look at every element of anything but an array.array.
    values = array.array('d')
    values.frombytes(np.ascontiguousarray(converted, dtype=np.float64).data.cast('B'))
    response.values = values
    response.success = True
    return response


def never_raising(answer: Answer, logger: RcutilsLogger) -> Answer:
    """
    Keep a defect in a service from ending the node, as an exception in a callback does.

    :param answer: answers a request.
    :param logger: gets the traceback of what was raised.
    :return: a callback that answers ``success: false`` instead of raising.
    """
    def callback(request: Any, response: Any) -> Any:
        try:
            return answer(request, response)
        except Exception as error:  # noqa: BLE001 - whatever it is, the client must be answered
            logger.error(f'internal error in a service:\n{traceback.format_exc()}')
            refusal = type(response)()
            refusal.message = f'internal error, see the log of the node: {error!r}'
            return refusal
    return callback
