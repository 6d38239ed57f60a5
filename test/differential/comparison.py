# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Compare what the package and libsdformat make of one file, allowing for known defects."""

from __future__ import annotations

from dataclasses import dataclass
import math

from differential.reference import Answer, AxisValues, CRASH, EXCEPTION, JointValues
from sdf_pose_bridge import load, SdfError
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.joints import AXIS_TAGS

TOLERANCE = 1e-9
"""Metres, relative to the distance from the root where that is more than one; and radians."""

TOLERANCES = {'URDF': 2e-5, 'merge': 1e-6}
"""The same for scenes in which libsdformat writes angles: with few digits, or near gimbal lock."""


@dataclass(frozen=True)
class Difference:
    """One thing on which the two sides disagree."""

    kind: str
    """``accepted``, ``refused``, ``code`` (of the first error), ``missing``, ``extra``, ``pose``,
    ``joint`` or ``crash``."""
    text: str
    """What differs, in words."""


def own_answer(file, resource_path):
    """
    Resolve a file with the package.

    :param file: the file.
    :param resource_path: folder in which it looks for what the file includes.
    :return: the answer, in the terms of the reference.
    """
    try:
        scene = load(str(file), resource_paths=[str(resource_path)])
    except SdfError as error:
        codes = tuple(one.code for one in error.errors)
        return Answer(False, codes, str(error.errors[0]), {})
    except Exception as error:  # noqa: BLE001  whatever it is, it must not end the comparison
        return Answer(False, (CRASH,), f'{type(error).__name__}: {error}', {})
    poses = {}
    for index, name in enumerate(scene.names):
        kind = Kind(scene.kinds[index])
        if kind in (Kind.WORLD, Kind.ROOT):
            continue
        world = scene.world_names.get(int(scene.roots[index]), '')
        poses[(world, kind.label, name)] = tuple(scene.poses[index].tolist())
    joints = {(scene.world_names.get(int(scene.roots[joint.element]), ''),
               scene.names[joint.element]): own_joint(scene, joint) for joint in scene.joints}
    return Answer(True, (), '', poses, joints)


def own_joint(scene, joint):
    """Return a joint in the terms of the reference."""
    def body(frame):
        element = int(scene.bodies[frame])
        is_root = scene.kinds[element] in (Kind.WORLD, Kind.ROOT)
        return 'world' if is_root else scene.names[element]

    axes = tuple(
        AxisValues(axis.xyz, (axis.lower, axis.upper), axis.mimic and (
            scene.names[axis.mimic.joint], AXIS_TAGS[axis.mimic.axis], axis.mimic.multiplier,
            axis.mimic.offset, axis.mimic.reference))
        for axis in joint.axes)
    return JointValues(
        joint.type, body(joint.parent), body(joint.child), joint.screw_pitch_m, axes)


def difference_between(own, reference, traits=frozenset()):
    """
    Find the first thing on which the two sides disagree.

    :param own: what the package says.
    :param reference: what libsdformat says.
    :param traits: what is known of the scene.
    :return: the difference, or None.
    """
    if CRASH in own.codes:
        return Difference('crash', f'it raises what is no SdfError: {own.message}')
    if not is_comparable(reference):
        return None
    if own.accepted and not reference.accepted:
        said = f'{reference.codes[0]}: {reference.message}'
        return Difference('accepted', f'accepted here, refused by libsdformat: {said}')
    if reference.accepted and not own.accepted:
        return Difference('refused', f'accepted by libsdformat, refused here: {own.message}')
    if not own.accepted and reference.codes[0] not in (EXCEPTION, *own.codes):
        # The first one there may be a later one here: the package lists errors by file and line,
        # and libsdformat by steps of loading.
        text = f'{", ".join(own.codes)} here, {reference.codes[0]} by libsdformat'
        return Difference('code', f'{text}: {reference.message}')
    tolerance = max([TOLERANCE, *(TOLERANCES.get(trait, 0.0) for trait in traits)])
    for key, expected in reference.poses.items():
        got = own.poses.get(key)
        if got is None:
            return Difference('missing', f'{key[1]} "{key[2]}" is not in the scene')
        if not is_same_pose(expected, got, tolerance):
            text = f'{key[1]} "{key[2]}": {list(got)} here, {list(expected)} by libsdformat'
            return Difference('pose', text)
    for joint_key, joint in reference.joints.items():
        text = joint_difference(own.joints.get(joint_key), joint, tolerance)
        if text:
            return Difference('joint', f'joint "{joint_key[1]}": {text}')
    for _, kind, name in own.poses.keys() - reference.poses.keys():
        return Difference('extra', f'{kind} "{name}" is not resolved by libsdformat')
    return None


def is_comparable(reference):
    """
    Tell whether libsdformat has an answer, and one that the package wants to have.

    The package does not check whether moments of inertia fit together: they move no frame. Those
    of an automatic inertial, whose pose depends on the same numbers, are another error.
    """
    return CRASH not in reference.codes and not (
        reference.codes[:1] == ('LINK_INERTIA_INVALID',)
        and reference.message.startswith('A link named'))


def joint_difference(own, expected, tolerance):
    """Say what differs in a joint, or nothing."""
    if own is None:
        return '' if expected.parent == expected.child else 'it is not in the scene'
    if own[:3] != expected[:3]:
        return f'{own[:3]} here, {expected[:3]} by libsdformat'
    if own.type == 'screw' and expected.pitch_m != own.pitch_m:
        return f'the pitch is {own.pitch_m} here, {expected.pitch_m} by libsdformat'
    for own_axis, axis in zip(own.axes, expected.axes, strict=True):
        if axis is None:
            continue
        if math.dist(own_axis.xyz, axis.xyz) > tolerance:
            return f'an axis is {own_axis.xyz} here, {axis.xyz} by libsdformat'
        own_values, values = (str([*map(_with_floats, each[1:])]) for each in (own_axis, axis))
        if own_values != values:
            return f'{own_axis[1:]} here, {axis[1:]} by libsdformat'
    return ''


def _with_floats(values):
    # To add zero leaves no negative zeros.
    return values and tuple(
        value + 0.0 if isinstance(value, (int, float)) else value for value in values)


def is_same_pose(expected, got, tolerance):
    """Compare positions by distance, and orientations by the angle between them."""
    scale = max(1.0, math.hypot(*expected[:3]))
    if math.dist(expected[:3], got[:3]) > tolerance * scale:
        return False
    return angle_between(expected[3:], got[3:]) <= tolerance


def angle_between(first, second):
    """Return the angle in radians between two rotations given by quaternions of any length."""
    lengths = math.hypot(*first), math.hypot(*second)
    if not all(lengths):
        return math.pi
    sign = 1 if sum(a * b for a, b in zip(first, second, strict=True)) >= 0 else -1
    # From the chord: the arc cosine of nearly one has only half the digits.
    chord = math.dist([a / lengths[0] for a in first], [sign * b / lengths[1] for b in second])
    return 4 * math.asin(min(1.0, chord / 2))
