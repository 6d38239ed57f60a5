# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Read and write numbers and poses as libsdformat's conversion of URDF does."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
import math
from typing import TypeAlias

from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.rotations import rpy_from_quaternion
from sdf_pose_bridge.printed_text import shortened
from sdf_pose_bridge.sdformat.grammar import Item
from sdf_pose_bridge.sdformat.values import number_from_stream
from sdf_pose_bridge.sdformat.xml_tree import text_of, WHITE_SPACE, written_tag, XmlElement

_URDFDOM_GIMBAL_LOCK = 1e-5
_GZ_MATH_GIMBAL_LOCK = 1e-15
"""If 1 - abs(sin(pitch)) is less, libsdformat writes angles that are only nearly the same."""

Numbers: TypeAlias = Mapping[str, Sequence[float]]
"""Numbers by the names of attributes in URDF, or of child elements in SDFormat."""


def is_true(xml: XmlElement) -> bool:
    """
    Return whether an option in a ``<gazebo>`` element is ``true``, ``yes`` or ``1`` in any case.

    :param xml: the option; its value is its attribute ``value`` or its text, unless a comment
        comes first.
    """
    # CDATA has an empty comment before it.
    is_hidden = not (xml.text or '').strip(WHITE_SPACE) and len(xml) and xml[0].text
    value = xml.get('value', '' if is_hidden else text_of(xml))
    return value.strip(WHITE_SPACE).lower() in ('true', 'yes', '1')


def numbers_of_attributes(xml: XmlElement, rules: Iterable[Item]) -> dict[str, list[float]]:
    """
    Read the attributes of an element that are numbers, as urdfdom does (``strToDouble``).

    :param rules: the rules of the grammar for attributes; those of other types are only required.
    :return: the numbers of those that it has.
    :raises ValueError: if one is missing or is not numbers.
    """
    tag = written_tag(xml)
    result = {}
    for rule in rules:
        name, count, text = rule.name, rule.value_type.count, xml.get(rule.name)
        if text is None:
            if rule.required:
                msg = f'<{tag}> has no {name}'
                raise ValueError(msg)
        elif count:
            words = [text] if count == 1 else [*filter(None, text.split(' '))]
            numbers = [number for word in words for number in number_from_stream(word)]
            if not len(numbers) == len(words) == count:
                msg = (f'{name} of <{tag}> is "{shortened(text)}"; it must be '
                       f'{rule.value_type.description} such as 1.5 or -2e-3, '
                       f'{"with nothing behind it" if count == 1 else "separated by blanks"}')
                raise ValueError(msg)
            result[name] = numbers
    return result


def pose_from_xyz_rpy(
    xyz: Sequence[float] = (0.0, 0.0, 0.0), rpy: Sequence[float] = (0.0, 0.0, 0.0),
) -> Pose:
    """
    Convert a pose.

    :return: the pose. Its quaternion has the sign and the rounding of libsdformat's
        (``urdf::Rotation::setFromRPY``), on which the angles of ``rpy_by_urdfdom`` depend.
    """
    sin_r, sin_p, sin_y = (math.sin(angle / 2.0) for angle in rpy)
    cos_r, cos_p, cos_y = (math.cos(angle / 2.0) for angle in rpy)
    quaternion = (
        sin_r * cos_p * cos_y - cos_r * sin_p * sin_y,
        cos_r * sin_p * cos_y + sin_r * cos_p * sin_y,
        cos_r * cos_p * sin_y - sin_r * sin_p * cos_y,
        cos_r * cos_p * cos_y + sin_r * sin_p * sin_y)
    norm = math.sqrt(sum(component * component for component in quaternion))
    return Pose(*xyz, *(component / norm for component in quaternion))


def text_from_numbers(numbers: Sequence[float], digits: int = 16) -> str:
    """Write numbers with a number of significant digits."""
    return ' '.join([f'%.{digits}g'] * len(numbers)) % tuple(numbers)


def rpy_by_gz_math(pose: Pose) -> Sequence[float]:
    """Return roll, pitch and yaw in radians as ``gz::math::Quaternion::Euler`` does."""
    x, y, z, w = pose[3:]
    sin_pitch = max(-1.0, min(1.0, 2.0 * (w * y - x * z)))
    if 1.0 - abs(sin_pitch) >= _GZ_MATH_GIMBAL_LOCK:
        return rpy_from_quaternion((x, y, z, w))
    roll = math.atan2(2.0 * (x * y - z * w), w * w - x * x + y * y - z * z)
    return math.copysign(1.0, sin_pitch) * roll, math.asin(sin_pitch), 0.0


def rpy_by_urdfdom(pose: Pose) -> Sequence[float]:
    """Return roll, pitch and yaw in radians as ``urdf::Rotation::getRPY`` does."""
    x, y, z, w = pose[3:]
    sin_pitch = 2.0 * (w * y - x * z)
    if 1.0 - abs(sin_pitch) > _URDFDOM_GIMBAL_LOCK:
        # At half a turn of roll, the rounding decides between pi and -pi.
        return (
            math.atan2(2.0 * (y * z + w * x), w * w - x * x - y * y + z * z),
            math.asin(sin_pitch),
            math.atan2(2.0 * (x * y + w * z), w * w + x * x - y * y - z * z))
    sign = math.copysign(1.0, sin_pitch)
    return 0.0, sign * math.pi / 2.0, 2.0 * math.atan2(-sign * x, sign * y)
