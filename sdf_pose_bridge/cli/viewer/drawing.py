# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Choose what is drawn of a scene, in arrays: surfaces, and the names of frames."""

from __future__ import annotations

from collections.abc import Iterator
from collections.abc import Sequence
from typing import NamedTuple
from typing import TYPE_CHECKING

import numpy as np

from sdf_pose_bridge.cli.viewer.meshes import MeshReader
from sdf_pose_bridge.geometry.rotations import matrix_from_quaternion
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.scene.triangles import Points
from sdf_pose_bridge.scene.triangles import Triangles
from sdf_pose_bridge.scene.triangles import triangles_from_shape
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.shapes import Shape

if TYPE_CHECKING:
    from numpy.typing import NDArray

MOST_SURFACES = 20_000
"""How many visuals and collisions are drawn, and how many parts of meshes."""
MOST_TRIANGLES = 3_000_000
"""How many triangles all surfaces that differ may have together."""
MOST_NAMES = 500
"""How many names are shown at once."""

_GRAY = (0.7, 0.7, 0.7, 1.0)
_MISSING = (0.88, 0.19, 0.19, 0.5)
_MOST_AT_A_PLACE = 3
_BOX = Shape('box', (1.0, 1.0, 1.0), (0.0, 0.0, 1.0), '', '', (1.0, 1.0, 1.0), None)


class Surface(NamedTuple):
    """The surface of visuals or collisions that differ only in place, size and color."""

    kind: Kind
    triangles: Triangles
    elements: NDArray[np.intp]
    """The visual or collision of each copy."""
    scales: Points
    """Shape (n, 3): the factors of each copy along x, y and z."""
    rgba: NDArray[np.float64]
    """Shape (n, 4): the color of each copy, components from 0 to 1."""


class NotDrawn(NamedTuple):
    """A shape that is drawn as a red box, or not at all."""

    element: int
    reason: str


def surfaces_from_scene(
    scene: Scene, elements: Sequence[int], size_m: float, meshes: MeshReader,
) -> tuple[list[Surface], list[NotDrawn]]:
    """
    Choose the surfaces of visuals and collisions.

    :param scene: the scene, loaded with its shapes.
    :param elements: the visuals and collisions to draw.
    :param size_m: extent of the frames; no side of a plane is much longer, and a mesh of which
        nothing is known is a box of a small part of it.
    :param meshes: reads meshes.
    :return: the surfaces, and what is not drawn as the file means it.
    """
    copies: dict[object, list[tuple[int, tuple[float, ...], tuple[float, ...]]]] = {}
    forms: dict[object, tuple[Kind, Triangles]] = {}
    not_drawn: list[NotDrawn] = []
    copy_count = triangle_count = 0
    for element in elements:
        shape, kind = scene.shapes[element], Kind(scene.kinds[element])
        if not shape.is_visible:
            continue
        parts, reason = _parts(shape, scene.place(element).file, size_m, meshes)
        for form, triangles, scale, rgba in parts:
            key = (kind, form)
            new_count = len(triangles.faces) if key not in forms else 0
            if copy_count >= MOST_SURFACES or triangle_count + new_count > MOST_TRIANGLES:
                reason = 'there are too many surfaces'
                break
            copy_count += 1
            triangle_count += new_count
            forms.setdefault(key, (kind, triangles))
            copies.setdefault(key, []).append((element, scale, rgba))
        if reason:
            not_drawn.append(NotDrawn(element, reason))
    return [
        Surface(kind, triangles, *map(np.array, zip(*copies[key], strict=True)))
        for key, (kind, triangles) in forms.items()], not_drawn


def _parts(
    shape: Shape, file: str, size_m: float, meshes: MeshReader,
) -> tuple[list[tuple[object, Triangles, tuple[float, ...], tuple[float, ...]]], str]:
    """Return form, triangles, scale and color of each part, and what is wrong with the shape."""
    if shape.type != 'mesh':
        if shape.reason_without_surface:
            return [], shape.reason_without_surface
        unit, scale = _unit_shape(shape._replace(rgba=None, opacity=1.0), 2.0 * size_m)
        triangles = triangles_from_shape(unit)
        assert triangles is not None
        return [(unit, triangles, scale, shape.rgba_or(_GRAY))], ''
    mesh = meshes.mesh(shape, file)
    if mesh.parts:
        return [
            ((id(part.triangles.points),), part.triangles, shape.mesh_scale,
             shape.rgba_or(part.rgba or _GRAY)) for part in mesh.parts], ''
    box = triangles_from_shape(_BOX)
    assert box is not None
    reason = f'the mesh "{shape.mesh_uri}": {mesh.reason}'
    if mesh.bounds is None:
        return [(_BOX, box, (0.03 * size_m,) * 3, _MISSING)], reason
    middle, sides = mesh.bounds.mean(axis=0), np.ptp(mesh.bounds, axis=0)
    around = Triangles(box.points * sides + middle, box.faces)
    return [((shape.mesh_uri, file), around, shape.mesh_scale, _MISSING)], reason


def _unit_shape(shape: Shape, largest_m: float) -> tuple[Shape, tuple[float, ...]]:
    """Split a shape into one that many share, and the factors to its own size."""
    sizes = shape.sizes_m
    if shape.type in ('box', 'ellipsoid'):
        return shape._replace(sizes_m=(1.0, 1.0, 1.0)), sizes
    if shape.type == 'sphere':
        return shape._replace(sizes_m=(1.0,)), sizes * 3
    if shape.type in ('cylinder', 'cone'):
        return shape._replace(sizes_m=(1.0, 1.0)), (sizes[0], sizes[0], sizes[1])
    if shape.type == 'capsule':
        return shape._replace(sizes_m=(1.0, sizes[1] / sizes[0])), sizes[:1] * 3
    # Planes are often much larger than what stands on them.
    return shape._replace(sizes_m=tuple(min(size, largest_m) for size in sizes)), (1.0, 1.0, 1.0)


def bounds_of_scene(scene: Scene, origins: Points, surfaces: Sequence[Surface]) -> Points:
    """
    Find what a view of everything has to contain.

    :param origins: shape (n, 3), the origins of frames.
    :return: shape (2, 3): the lowest and the highest corner.
    """
    points = [origins, np.zeros((1, 3))]
    for surface in surfaces:
        half = np.abs(surface.triangles.points).max(axis=0) * np.abs(surface.scales)
        poses = scene.poses[surface.elements]
        reach = np.abs(matrix_from_quaternion(poses[:, 3:])) @ half[:, :, np.newaxis]
        points += [poses[:, :3] - reach[:, :, 0], poses[:, :3] + reach[:, :, 0]]
    together = np.concatenate(points)
    return np.array([together.min(axis=0), together.max(axis=0)])


def names_at_places(
    names: Sequence[str], points: Points, distance_m: float,
) -> Iterator[tuple[str, Points]]:
    """
    Join names that would lie on one another.

    :param names: the names of frames.
    :param points: shape (n, 3), their origins.
    :param distance_m: names nearer than this are joined.
    :return: the texts, and where they are.
    """
    left = np.arange(min(len(names), MOST_NAMES))
    while len(left):
        is_near = np.linalg.norm(points[left] - points[left[0]], axis=1) < distance_m
        near = left[is_near]
        text = ', '.join(names[index] for index in near[:_MOST_AT_A_PLACE])
        more = len(near) - _MOST_AT_A_PLACE
        yield f'{text} and {more} more' if more > 0 else text, points[left[0]]
        left = left[~is_near]
