# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Rotations that are hard on floating point, and references that are not: for the tests alone."""

import itertools
import math

import mpmath
import numpy as np

LARGEST_TURN = 3 * 4e-16
"""
Largest turn allowed between a rotation given and what comes out of it, or comes back.

4e-16 is about what rounding does to one angle near pi.
"""

LONG_DOUBLE_HELPS = np.finfo(np.longdouble).eps < 2e-19

DISTANCES = np.concatenate(([0.0], 10.0 ** np.arange(-16.0, -2.5, 0.25)))


def random_rpy(count, seed=4):
    return np.random.default_rng(seed).uniform(-math.pi, math.pi, (count, 3))


def random_quaternions(count, seed=4):
    quat = np.random.default_rng(seed).normal(size=(count, 4))
    return quat / np.linalg.norm(quat, axis=1)[:, None]


def lock_rpy(count, seed=4):
    """Give pitch at right angles, up and down, from either side: +-0 and +-1e-16 to +-1e-3."""
    rng = np.random.default_rng(seed)
    rpy = rng.uniform(-4.0, 4.0, (count, 3))
    sides = rng.choice((-1.0, 1.0), count)
    rpy[:, 1] = rng.choice((-0.5, 0.5), count) * math.pi + sides * rng.choice(DISTANCES, count)
    return rpy


def fine_lock_rpy(count, seed=4):
    """Give pitch where the rule for lock changes sides, a few steps of a float from it."""
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


def eighths_rpy():
    """Give all multiples of an eighth of a turn, up to a whole turn: every edge of the ranges."""
    eighths = np.arange(-8, 9) * (math.pi / 4.0)
    return np.array(list(itertools.product(eighths, repeat=3)))


RPY_SETS = {
    'random': random_rpy,
    'lock': lock_rpy,
    'lock, step by step': fine_lock_rpy,
    'tiny': tiny_rpy,
    'large': large_rpy,
    'eighths': lambda _: eighths_rpy(),
}


def half_turn_axes():
    """Give all axes through corners, edges and faces of a cube, and some between, not unit."""
    steps = (-2.0, -1.0, -1e-9, 0.0, 1e-9, 1.0, 2.0)
    axes = np.array([axis for axis in itertools.product(steps, repeat=3) if any(axis)])
    return axes / np.linalg.norm(axes, axis=1)[:, None]


def half_turns(angle=math.pi):
    """Give quaternions of turns by an angle about all of them."""
    axes = half_turn_axes()
    real = math.cos(0.5 * angle) if angle != math.pi else 0.0
    return np.column_stack((math.sin(0.5 * angle) * axes, np.full(len(axes), real)))


def extended_quaternions(rpy):
    """Convert roll, pitch, yaw to quaternions with the processor's 64 bits of mantissa."""
    half = np.asarray(rpy, dtype=np.longdouble) * np.longdouble(0.5)
    (sin_r, sin_p, sin_y), (cos_r, cos_p, cos_y) = np.sin(half).T, np.cos(half).T
    return np.stack(
        (
            sin_r * cos_p * cos_y - cos_r * sin_p * sin_y,
            cos_r * sin_p * cos_y + sin_r * cos_p * sin_y,
            cos_r * cos_p * sin_y - sin_r * sin_p * cos_y,
            cos_r * cos_p * cos_y + sin_r * sin_p * sin_y,
        ),
        axis=1,
    )


def largest_turn(quats_a, quats_b):
    """Return the angle of the largest rotation between two rows of quaternions near unit."""
    a = np.asarray(quats_a, dtype=np.longdouble)
    b = np.asarray(quats_b, dtype=np.longdouble)
    a = a / np.sqrt(np.sum(a * a, axis=1))[:, None]
    b = b / np.sqrt(np.sum(b * b, axis=1))[:, None]
    chords = np.minimum(
        np.sqrt(np.sum((a - b) ** 2, axis=1)), np.sqrt(np.sum((a + b) ** 2, axis=1))
    )
    return float(np.max(4.0 * np.arcsin(np.minimum(0.5 * chords, 1.0)), initial=0.0))


def exact_quaternion(rpy):
    """Convert roll, pitch, yaw to a quaternion of 50 digits."""
    with mpmath.workdps(50):
        (sin_r, cos_r), (sin_p, cos_p), (sin_y, cos_y) = (
            (mpmath.sin(half), mpmath.cos(half))
            for half in (mpmath.mpf(float(angle)) / 2 for angle in rpy)
        )
        return (
            sin_r * cos_p * cos_y - cos_r * sin_p * sin_y,
            cos_r * sin_p * cos_y + sin_r * cos_p * sin_y,
            cos_r * cos_p * sin_y - sin_r * sin_p * cos_y,
            cos_r * cos_p * cos_y + sin_r * sin_p * sin_y,
        )


def exact_matrix(quat):
    """Convert a quaternion of any norm to nine numbers of 50 digits, row after row."""
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


def exact_turn(quat_a, quat_b):
    """Return the angle between two rotations, with 50 digits on the way."""
    with mpmath.workdps(50):
        a, b = exact_unit(quat_a), exact_unit(quat_b)
        chords = [
            mpmath.sqrt(sum((p - sign * q) ** 2 for p, q in zip(a, b, strict=True)))
            for sign in (1, -1)
        ]
        return float(4 * mpmath.asin(min(chords) / 2))
