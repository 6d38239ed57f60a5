# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Make triangles of shapes, for drawing."""

from __future__ import annotations

from typing import Any
from typing import NamedTuple
from typing import TypeAlias

import numpy as np

from sdf_pose_bridge.geometry.rotations import matrix_from_quaternion
from sdf_pose_bridge.sdformat.shapes import Shape

Points: TypeAlias = 'np.ndarray[Any, np.dtype[np.float64]]'
"""Shape (n, 3): x y z in metres."""

_CORNERS = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
_BOX_FACES = np.array([
    (0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6),
    (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)])
_PLANE_FACES = np.array([(0, 1, 2), (0, 2, 3)])
_SEGMENTS = 24
_QUARTER = np.linspace(0.0, np.pi / 2.0, _SEGMENTS // 4 + 1)


class Triangles(NamedTuple):
    """A surface."""

    points: Points
    faces: np.ndarray[Any, np.dtype[np.int64]]
    """Shape (m, 3): indices of the corners of each triangle, counterclockwise from outside."""


def triangles_from_shape(shape: Shape) -> Triangles | None:
    """
    Make the surface of a shape.

    :return: the surface in the frame of the shape; None for a shape without an extent, a mesh and
        other shapes from files.
    """
    sizes = shape.sizes_m
    if shape.reason_without_surface:
        return None
    if shape.type == 'box':
        return Triangles(_CORNERS * sizes, _BOX_FACES)
    if shape.type == 'plane':
        return _plane(sizes[0], sizes[1], shape.normal)
    if shape.type == 'ellipsoid':
        sphere = _surface_of_revolution(_arc(1.0, -1.0, 0.0) + _arc(1.0, 1.0, 0.0))
        return Triangles(sphere.points * sizes, sphere.faces)
    radius, half = sizes[0], 0.5 * max((*sizes, 0.0)[1], 0.0)
    if shape.type == 'cylinder':
        return _surface_of_revolution([(0.0, -half), (radius, -half), (radius, half), (0.0, half)])
    if shape.type == 'cone':
        return _surface_of_revolution([(0.0, -half), (radius, -half), (0.0, half)])
    # A capsule; a sphere is one without a length.
    return _surface_of_revolution(_arc(radius, -1.0, -half) + _arc(radius, 1.0, half))


def _arc(radius: float, side: float, middle: float) -> list[tuple[float, float]]:
    """Return the profile of half a sphere from below to above: distances from z, and z."""
    angles = _QUARTER if side > 0.0 else _QUARTER[::-1]
    return list(zip(
        (radius * np.cos(angles)).tolist(), (middle + side * radius * np.sin(angles)).tolist(),
        strict=True))


def _surface_of_revolution(profile: list[tuple[float, float]]) -> Triangles:
    """Rotate a profile, given from below to above, about z."""
    radii, heights = np.array(profile).T
    angles = np.linspace(0.0, 2.0 * np.pi, _SEGMENTS, endpoint=False)
    points = np.stack([
        np.outer(radii, np.cos(angles)), np.outer(radii, np.sin(angles)),
        np.repeat(heights[:, np.newaxis], _SEGMENTS, axis=1)], axis=-1)
    below = np.arange((len(profile) - 1) * _SEGMENTS).reshape(-1, _SEGMENTS)
    below_next = np.roll(below, -1, axis=1)
    above, above_next = below + _SEGMENTS, below_next + _SEGMENTS
    faces = np.concatenate([
        np.stack([below, below_next, above_next], axis=-1).reshape(-1, 3),
        np.stack([below, above_next, above], axis=-1).reshape(-1, 3)])
    return Triangles(points.reshape(-1, 3), faces)


def _plane(x: float, y: float, normal: tuple[float, ...]) -> Triangles:
    """Make a rectangle whose z is rotated to a normal by the shortest way, as libsdformat does."""
    corners = 0.5 * np.array([(-x, -y, 0.0), (x, -y, 0.0), (x, y, 0.0), (-x, y, 0.0)])
    nx, ny, nz = np.array(normal) / np.linalg.norm(normal)
    # Half a turn has no shortest way.
    rotation = (1.0, 0.0, 0.0, 0.0) if nz < -1.0 + 1e-9 else (-ny, nx, 0.0, 1.0 + nz)
    quat_xyzw = np.array(rotation) / np.linalg.norm(rotation)
    return Triangles(corners @ np.array(matrix_from_quaternion(quat_xyzw)).T, _PLANE_FACES)
