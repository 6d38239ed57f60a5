# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Choose the surfaces of visuals and collisions."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
import trimesh

from sdf_pose_bridge import Kind, Scene
from sdf_pose_bridge.cli.viewer.meshes import MeshPart, MeshReader
from sdf_pose_bridge.geometry.rotations import Floats, matrix_from_quaternion
from sdf_pose_bridge.printed_text import printable, quoted_names
from sdf_pose_bridge.sdformat.shapes import Shape

MOST_SURFACES = 5_000
"""Largest number of different surfaces."""
MOST_TRIANGLES = 3_000_000
"""Largest number of triangles of all surfaces."""

_GRAY = (0.52, 0.54, 0.57, 1.0)
"""The default color, which is visible on a light and on a dark background."""
_MOST_LISTED = 3


class DrawnSurface(NamedTuple):
    """The surface of visuals or collisions that differ only in place, size and color."""

    kind: Kind
    part: MeshPart
    elements: list[int]
    """The visual or collision of each copy."""
    scales: Floats
    """Shape (n, 3): the factors of each copy along x, y and z."""
    rgba: Floats
    """Shape (n, 4): the color of each copy, components from 0 to 1."""
    reason: str
    """The reason why this replaces a mesh; empty for the surface in the file."""


def surfaces_from_scene(
    scene: Scene, elements: Sequence[int], size_m: float, meshes: MeshReader,
) -> tuple[list[DrawnSurface], dict[str, list[str]]]:
    """
    Choose the surfaces of visuals and collisions.

    :param elements: the visuals and collisions to draw.
    :param size_m: extent of the frames; it limits the sides of planes, and the box for an unknown
        mesh is a small part of it.
    :return: the surfaces, and by the reason the elements that cannot be drawn: of each the URI of
        its mesh, empty for another shape.
    """
    copies: dict[tuple[Kind, Shape, str, bool], list[int]] = defaultdict(list)
    for element in elements:
        shape = scene.shapes[element]
        if shape.is_visible:
            form = shape._replace(
                rgba=None, opacity=1.0, mesh_scale=(1.0,) * 3,
                sizes_m=(1.0,) * 3 if shape.type == 'box' and shape.has_extent else shape.sizes_m)
            file = scene.place(element).file if shape.type == 'mesh' else ''
            kind = Kind(scene.kinds[element])
            # As in Gazebo, a material in the file replaces the materials of the mesh.
            has_texture = kind == Kind.VISUAL and shape.rgba is None and shape.opacity == 1.0
            copies[kind, form, file, has_texture].append(element)
    surfaces: list[DrawnSurface] = []
    not_drawn: dict[str, list[str]] = defaultdict(list)
    triangle_count = 0
    for (kind, form, file, has_texture), same in copies.items():
        mesh = meshes.mesh(form, file, size_m)
        if mesh.reason:
            not_drawn[mesh.reason] += [form.mesh_uri] * len(same)
        triangle_count += sum(len(part.faces) for part in mesh.parts)
        if len(surfaces) + len(mesh.parts) > MOST_SURFACES or triangle_count > MOST_TRIANGLES:
            not_drawn['there are too many surfaces'] += [''] * len(same)
            continue
        shapes = [scene.shapes[element] for element in same]
        scales = np.array([
            shape.sizes_m if shape.type == 'box' else shape.mesh_scale for shape in shapes])
        if mesh.reason:
            scales[:] = 1.0
        surfaces += [
            DrawnSurface(
                kind, part if has_texture else part._replace(glb=b''), same, scales, np.array([
                    part.rgba if mesh.reason else shape.rgba_or(part.rgba or _GRAY)
                    for shape in shapes]), mesh.reason)
            for part in mesh.parts]
    return surfaces, not_drawn


def lines_from_not_drawn(not_drawn: Mapping[str, Sequence[str]]) -> list[str]:
    """Say which shapes cannot be drawn, one line for each reason."""
    lines = []
    for reason, uris in not_drawn.items():
        names = list(dict.fromkeys(filter(None, uris)))
        meshes = f'the mesh{"es" * (len(names) > 1)} {quoted_names(names, _MOST_LISTED)}: '
        lines.append(printable(
            f'{len(uris)} shape{"s" * (len(uris) > 1)} cannot be drawn: '
            f'{meshes if names else ""}{reason}'))
    return lines


def boxes_of_surfaces(scene: Scene, surfaces: Sequence[DrawnSurface]) -> Floats:
    """Return the lowest and the highest corner of each copy of surfaces, shape (n, 2, 3)."""
    boxes = [np.zeros((0, 2, 3))]
    for surface in surfaces:
        part, poses = surface.part.points, scene.poses[surface.elements]
        corners = trimesh.bounds.corners([part.min(axis=0), part.max(axis=0)])
        matrices = matrix_from_quaternion(poses[:, 3:])
        turned = (surface.scales[:, np.newaxis] * corners) @ matrices.transpose(0, 2, 1)
        turned += poses[:, np.newaxis, :3]
        boxes.append(np.stack([turned.min(axis=1), turned.max(axis=1)], axis=1))
    return np.concatenate(boxes)
