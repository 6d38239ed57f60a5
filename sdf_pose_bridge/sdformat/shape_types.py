# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
The types of shapes, in one table.

Sources: the classes of shapes of libsdformat 14, and for masses the classes of gz-math 7.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
import enum
import math
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.geometry.rotations import Floats

_SEGMENTS = 24
"""Number of sides of a surface that is round about its z axis."""


class Primitive(enum.Enum):
    """The bodies that RViz and URDF have."""

    BOX = enum.auto()
    CYLINDER = enum.auto()
    """Along z."""
    ELLIPSOID = enum.auto()


class Part(NamedTuple):
    """A body that is a part of a shape, with the axes of the shape."""

    primitive: Primitive
    extent_m: tuple[float, float, float]
    """Its full length along x, y and z."""
    z_m: float = 0.0
    """Position of its center on the z axis of the shape."""


class Solid(NamedTuple):
    """The mass properties of a solid shape."""

    volume_m3: float
    moments_m2: tuple[float, float, float]
    """The moments of inertia of 1 kg about axes parallel to x, y and z through its center of
    mass, which are its principal axes."""
    center_z_m: float = 0.0
    """The z of its center of mass; x and y are 0."""


class Surface(NamedTuple):
    """The surface of a shape, in its frame."""

    points_m: Floats
    """Shape (n, 3)."""
    faces: NDArray[np.int64]
    """Shape (m, 3): the points of each triangle, counterclockwise from outside."""


class ShapeType(NamedTuple):
    """
    A type of shapes.

    The functions get the sizes, which are positive if required. A function is None if the type
    does not support it.
    """

    sizes_m: Mapping[str, tuple[float, ...]] = MappingProxyType({})
    """Tags of its sizes, with their defaults."""
    required_count: int = 3
    """Number of sizes, from the first, that have to be positive."""
    surface: Callable[..., Surface] | None = None
    """Makes triangles. Those of a plane have the normal z."""
    parts: Callable[..., tuple[Part, ...]] | None = None
    """Lists its parts."""
    solid: Callable[..., Solid] | None = None
    """Computes its mass properties."""


def _box(x_m: float, y_m: float, z_m: float) -> tuple[Part, ...]:
    return (Part(Primitive.BOX, (x_m, y_m, z_m)),)


def _ellipsoid(x_m: float, y_m: float, z_m: float) -> tuple[Part, ...]:
    return (Part(Primitive.ELLIPSOID, (2.0 * x_m, 2.0 * y_m, 2.0 * z_m)),)


def _cylinder(radius_m: float, length_m: float) -> tuple[Part, ...]:
    return (Part(Primitive.CYLINDER, (2.0 * radius_m, 2.0 * radius_m, length_m)),)


def _capsule(radius_m: float, length_m: float) -> tuple[Part, ...]:
    (end,) = _ellipsoid(radius_m, radius_m, radius_m)
    if length_m <= 0.0:
        return (end,)
    return (*_cylinder(radius_m, length_m),
            end._replace(z_m=-0.5 * length_m), end._replace(z_m=0.5 * length_m))


def _box_solid(x_m: float, y_m: float, z_m: float) -> Solid:
    return _symmetric_solid(x_m * y_m * z_m, 12.0, x_m, y_m, z_m)


def _ellipsoid_solid(x_m: float, y_m: float, z_m: float) -> Solid:
    return _symmetric_solid(4.0 / 3.0 * math.pi * x_m * y_m * z_m, 5.0, x_m, y_m, z_m)


def _symmetric_solid(volume_m3: float, divisor: float, *sizes_m: float) -> Solid:
    x, y, z = (size_m ** 2 / divisor for size_m in sizes_m)
    return Solid(volume_m3, (y + z, x + z, x + y))


def _cylinder_solid(radius_m: float, length_m: float) -> Solid:
    across = radius_m ** 2 / 4.0 + length_m ** 2 / 12.0
    return Solid(math.pi * radius_m ** 2 * length_m, (across, across, radius_m ** 2 / 2.0))


def _cone_solid(radius_m: float, length_m: float) -> Solid:
    across = 3.0 / 80.0 * (4.0 * radius_m ** 2 + length_m ** 2)
    return Solid(math.pi * radius_m ** 2 * length_m / 3.0,
                 (across, across, 0.3 * radius_m ** 2), -0.25 * length_m)


def _capsule_solid(radius_m: float, length_m: float) -> Solid:
    length_m = max(length_m, 0.0)
    (middle, (across, _, along), _), ends = (
        _cylinder_solid(radius_m, length_m), _ellipsoid_solid(radius_m, radius_m, radius_m))
    volume_m3 = middle + ends.volume_m3
    # The centers of the halves of a sphere are 3/8 of its radius beyond the cylinder.
    across_of_ends = 0.4 * radius_m ** 2 + length_m ** 2 / 4.0 + 0.375 * length_m * radius_m
    across = (middle * across + ends.volume_m3 * across_of_ends) / volume_m3
    along = (middle * along + ends.volume_m3 * 0.4 * radius_m ** 2) / volume_m3
    return Solid(volume_m3, (across, across, along))


def _box_surface(x_m: float, y_m: float, z_m: float) -> Surface:
    corners = np.array([(x, y, z) for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)])
    return Surface(corners * (x_m, y_m, z_m), np.array([
        (0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4),
        (2, 6, 7), (2, 7, 3), (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]))


def _plane_surface(x_m: float, y_m: float) -> Surface:
    corners = 0.5 * np.array([(-x_m, -y_m, 0), (x_m, -y_m, 0), (x_m, y_m, 0), (-x_m, y_m, 0)])
    return Surface(corners, np.array([(0, 1, 2), (0, 2, 3)]))


def _ellipsoid_surface(x_m: float, y_m: float, z_m: float) -> Surface:
    points, faces = _capsule_surface(1.0, 0.0)
    return Surface(points * (x_m, y_m, z_m), faces)


def _cylinder_surface(radius_m: float, length_m: float) -> Surface:
    end_m = 0.5 * length_m
    return _round_surface([(0, -end_m), (radius_m, -end_m), (radius_m, end_m), (0, end_m)])


def _cone_surface(radius_m: float, length_m: float) -> Surface:
    end_m = 0.5 * length_m
    return _round_surface([(0, -end_m), (radius_m, -end_m), (0, end_m)])


def _capsule_surface(radius_m: float, length_m: float) -> Surface:
    end_m = 0.5 * max(length_m, 0.0)
    angles = np.linspace(0.0, 0.5 * math.pi, _SEGMENTS // 4 + 1)
    arc = [(radius_m * math.sin(angle), end_m + radius_m * math.cos(angle)) for angle in angles]
    # At the poles the sine is 0. Both halves share the equator if nothing is between them.
    upper = arc[::-1][0 if end_m else 1:]
    return _round_surface([*((radius, -z) for radius, z in arc), *upper])


def _round_surface(profile_m: Sequence[tuple[float, float]]) -> Surface:
    """
    Turn a line about the z axis.

    :param profile_m: distance from the axis and z of each point, from the lowest to the highest;
        the first and the last are on the axis.
    """
    angles = np.linspace(0.0, 2.0 * np.pi, _SEGMENTS, endpoint=False)
    radii, heights = np.array(profile_m, float).T[:, :, np.newaxis]
    points = np.stack(np.broadcast_arrays(
        radii * np.cos(angles), radii * np.sin(angles), heights), axis=-1)
    indices = np.arange(len(profile_m) * _SEGMENTS).reshape(len(profile_m), _SEGMENTS)
    following = np.roll(indices, -1, axis=1)
    # A ring on the axis is a point, beside which only one of two triangles has an area.
    has_area = radii[:, 0] > 0.0
    lower = np.stack([indices[:-1], following[:-1], following[1:]], axis=-1)[has_area[:-1]]
    upper = np.stack([indices[:-1], following[1:], indices[1:]], axis=-1)[has_area[1:]]
    return Surface(
        points.reshape(-1, 3), np.concatenate([lower.reshape(-1, 3), upper.reshape(-1, 3)]))


_RADIUS_AND_LENGTH = {'radius': (1.0,), 'length': (1.0,)}

SHAPE_TYPES: Mapping[str, ShapeType] = {
    'box': ShapeType({'size': (1.0, 1.0, 1.0)}, 3, _box_surface, _box, _box_solid),
    # Without a length it is a sphere.
    'capsule': ShapeType(
        {'radius': (0.5,), 'length': (1.0,)}, 1, _capsule_surface, _capsule, _capsule_solid),
    'cone': ShapeType(_RADIUS_AND_LENGTH, 2, _cone_surface, None, _cone_solid),
    'cylinder': ShapeType(_RADIUS_AND_LENGTH, 2, _cylinder_surface, _cylinder, _cylinder_solid),
    'ellipsoid': ShapeType(
        {'radii': (1.0, 1.0, 1.0)}, 3, _ellipsoid_surface, _ellipsoid, _ellipsoid_solid),
    'plane': ShapeType({'size': (1.0, 1.0)}, 2, _plane_surface),
    'sphere': ShapeType(
        {'radius': (1.0,)}, 1,
        lambda radius_m: _ellipsoid_surface(radius_m, radius_m, radius_m),
        lambda radius_m: _ellipsoid(radius_m, radius_m, radius_m),
        lambda radius_m: _ellipsoid_solid(radius_m, radius_m, radius_m)),
    'mesh': ShapeType(),
    'heightmap': ShapeType(),
    'image': ShapeType(),
    'polyline': ShapeType(),
}
"""The types of shapes by their tags, in the order of precedence."""
