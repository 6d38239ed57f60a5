# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Make triangles of shapes that libraries for drawing do not know, or not like SDFormat."""

from __future__ import annotations

from typing import Any
from typing import NamedTuple
from typing import TypeAlias

import numpy as np

from sdf_pose_bridge.geometry.rotations import matrix_from_quaternion
from sdf_pose_bridge.sdformat.shapes import Shape

Points: TypeAlias = 'np.ndarray[Any, np.dtype[np.float64]]'
"""Shape (n, 3): x y z in metres."""

_PLANE_FACES = np.array([(0, 1, 2), (0, 2, 3)])
_SEGMENTS = 24


class Triangles(NamedTuple):
    """A surface."""

    points: Points
    faces: np.ndarray[Any, np.dtype[np.int64]]
    """Shape (m, 3): indices of the corners of each triangle, counterclockwise from outside."""


def triangles_from_shape(shape: Shape) -> Triangles:
    """
    Make the surface of a cone or a plane.

    :param shape: the shape, which has an extent.
    :return: the surface in the frame of the shape.
    """
    first_m, second_m = shape.sizes_m
    if shape.type == 'cone':
        return _cone(first_m, second_m)
    return _plane(first_m, second_m, shape.normal)


def _cone(radius: float, length: float) -> Triangles:
    angles = np.linspace(0.0, 2.0 * np.pi, _SEGMENTS, endpoint=False)
    ends = np.array([(0.0, 0.0, 0.5 * length), (0.0, 0.0, -0.5 * length)])
    circle = ends[1] + radius * np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1)
    first = np.arange(_SEGMENTS)
    second, top, middle = np.roll(first, -1), 0 * first + _SEGMENTS, 0 * first + _SEGMENTS + 1
    return Triangles(np.concatenate([circle, ends]), np.concatenate([
        np.stack([first, second, top], axis=1), np.stack([second, first, middle], axis=1)]))


def _plane(x: float, y: float, normal: tuple[float, ...]) -> Triangles:
    """Make a rectangle whose z is rotated to a normal by the shortest way, as libsdformat does."""
    corners = 0.5 * np.array([(-x, -y, 0.0), (x, -y, 0.0), (x, y, 0.0), (-x, y, 0.0)])
    nx, ny, nz = np.array(normal) / np.linalg.norm(normal)
    # Half a turn has no shortest way.
    rotation = (1.0, 0.0, 0.0, 0.0) if nz < -1.0 + 1e-9 else (-ny, nx, 0.0, 1.0 + nz)
    quat_xyzw = np.array(rotation) / np.linalg.norm(rotation)
    return Triangles(corners @ np.array(matrix_from_quaternion(quat_xyzw)).T, _PLANE_FACES)
