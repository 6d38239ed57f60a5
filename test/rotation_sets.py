# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Rotations that are difficult for floating point, and references of high precision."""

import itertools
import math

import numpy as np
import pytest

pytest.importorskip('mpmath', reason='needs mpmath')
import mpmath

MAX_ANGLE = 3 * 4e-16
"""
Largest angle allowed between a rotation and its conversion, in radians.

Rounding changes an angle near pi by about 4e-16.
"""

HAS_LONG_DOUBLE = np.finfo(np.longdouble).eps < 2e-19

DISTANCES = np.concatenate(([0.0], 10.0 ** np.arange(-16.0, -2.5, 0.25)))


def random_rpy(count, seed=4):
    return np.random.default_rng(seed).uniform(-math.pi, math.pi, (count, 3))


def random_quaternions(count, seed=4):
    quat = np.random.default_rng(seed).normal(size=(count, 4))
    return quat / np.linalg.norm(quat, axis=1)[:, None]


def lock_rpy(count, seed=4):
    """Return RPY whose pitch differs from a right angle by 0 or by 1e-16 to 1e-3."""
    rng = np.random.default_rng(seed)
    rpy = rng.uniform(-4.0, 4.0, (count, 3))
    sides = rng.choice((-1.0, 1.0), count)
    rpy[:, 1] = rng.choice((-0.5, 0.5), count) * math.pi + sides * rng.choice(DISTANCES, count)
    return rpy


def fine_lock_rpy(count, seed=4):
    """Return RPY whose pitch is within a few floats of the tolerance of gimbal lock."""
    rpy = lock_rpy(count, seed)
    rpy[:, 1] = np.copysign(0.5 * math.pi, rpy[:, 1]) + np.linspace(-3e-15, 3e-15, count)
    return rpy


def tiny_rpy(count, seed=4):
    rng = np.random.default_rng(seed)
    sizes = 10.0 ** rng.uniform(-300.0, -3.0, (count, 1)) * rng.uniform(0.1, 1.0, (count, 3))
    return sizes * rng.choice((-1.0, 0.0, 1.0), (count, 3))


def large_rpy(count, seed=4):
    rng = np.random.default_rng(seed)
    return rng.uniform(-1e6, 1e6, (count, 3))


def rpy_in_steps_of_45_degrees():
    """Return all RPY in steps of 45 degrees up to 360: every edge of the ranges."""
    angles = np.arange(-8, 9) * (math.pi / 4.0)
    return np.array(list(itertools.product(angles, repeat=3)))


RPY_SETS = {
    'random': random_rpy,
    'lock': lock_rpy,
    'edge of lock': fine_lock_rpy,
    'tiny': tiny_rpy,
    'large': large_rpy,
    'steps of 45 degrees': lambda _: rpy_in_steps_of_45_degrees(),
}


def half_turn_axes():
    """Return unit axes through corners, edges and faces of a cube, and some between."""
    steps = (-2.0, -1.0, -1e-9, 0.0, 1e-9, 1.0, 2.0)
    axes = np.array([axis for axis in itertools.product(steps, repeat=3) if any(axis)])
    return axes / np.linalg.norm(axes, axis=1)[:, None]


def half_turns(angle=math.pi):
    """Return quaternions of rotations by an angle about all of these axes."""
    axes = half_turn_axes()
    real = math.cos(0.5 * angle) if angle != math.pi else 0.0
    return np.column_stack((math.sin(0.5 * angle) * axes, np.full(len(axes), real)))


def quaternion_from_halves(sines, cosines):
    """Return a quaternion x y z w from sines and cosines of half of the angles of RPY."""
    (sin_r, sin_p, sin_y), (cos_r, cos_p, cos_y) = sines, cosines
    return (
        sin_r * cos_p * cos_y - cos_r * sin_p * sin_y,
        cos_r * sin_p * cos_y + sin_r * cos_p * sin_y,
        cos_r * cos_p * sin_y - sin_r * sin_p * cos_y,
        cos_r * cos_p * cos_y + sin_r * sin_p * sin_y,
    )


def extended_quaternions(rpy):
    """Convert RPY to quaternions in long double, with 64 bits of mantissa where it has them."""
    half = np.asarray(rpy, dtype=np.longdouble) * np.longdouble(0.5)
    return np.stack(quaternion_from_halves(np.sin(half).T, np.cos(half).T), axis=1)


def largest_angle(quats_a, quats_b):
    """Return the largest angle between two arrays of rotations, given as quaternions."""
    a, b = (np.asarray(quats, dtype=np.longdouble) for quats in (quats_a, quats_b))
    a, b = (quats / np.linalg.norm(quats, axis=1, keepdims=True) for quats in (a, b))
    chords = np.minimum(np.linalg.norm(a - b, axis=1), np.linalg.norm(a + b, axis=1))
    return float(np.max(4.0 * np.arcsin(np.minimum(0.5 * chords, 1.0)), initial=0.0))


def exact_quaternion(rpy):
    """Convert RPY to a quaternion with 50 digits."""
    with mpmath.workdps(50):
        halves = [mpmath.mpf(float(angle)) / 2 for angle in rpy]
        return quaternion_from_halves(map(mpmath.sin, halves), map(mpmath.cos, halves))


def exact_matrix(quat):
    """Convert a quaternion of any norm to the nine numbers of its matrix, with 50 digits."""
    with mpmath.workdps(50):
        x, y, z, w = exact_unit(quat)
        return (
            1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
            2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
            2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y),
        )


def exact_norm(quat):
    with mpmath.workdps(50):
        return mpmath.sqrt(sum(mpmath.mpf(value) ** 2 for value in quat))


def exact_unit(quat):
    with mpmath.workdps(50):
        norm = exact_norm(quat)
        return tuple(mpmath.mpf(value) / norm for value in quat)


def exact_angle(quat_a, quat_b):
    """Return the angle between two rotations, computed with 50 digits."""
    with mpmath.workdps(50):
        a, b = exact_unit(quat_a), exact_unit(quat_b)
        chords = [
            mpmath.sqrt(sum((p - sign * q) ** 2 for p, q in zip(a, b, strict=True)))
            for sign in (1, -1)
        ]
        return float(4 * mpmath.asin(min(chords) / 2))
