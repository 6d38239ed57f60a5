# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Make the surfaces of a scene's shapes; meshes are drawn as their bounding boxes."""

from __future__ import annotations

import importlib
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.scene.triangles import Points
from sdf_pose_bridge.scene.triangles import points_in_parent
from sdf_pose_bridge.scene.triangles import Triangles
from sdf_pose_bridge.scene.triangles import triangles_from_shape
from sdf_pose_bridge.scene.triangles import triangles_of_box
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.include.uris import ResourceFinder
from sdf_pose_bridge.sdformat.shapes import Shape
from sdf_pose_bridge.tf.tree import elements_in_model
from sdf_pose_bridge.tf.tree import TfTree

_GRAY = (0.7, 0.7, 0.7)


class DrawnShape(NamedTuple):
    """The surface of a visual or a collision."""

    kind: str
    """``visual`` or ``collision``."""
    triangles: Triangles
    """In the root frame."""
    rgb: tuple[float, ...]
    """Three components from 0 to 1."""


class Marker(NamedTuple):
    """The place of a shape that cannot be drawn."""

    name: str
    """Scoped name of the visual or collision."""
    pose: Pose
    """Its pose in the root frame."""
    reason: str


def drawn_shapes_from_scene(
    scene: Scene, tree: TfTree, model: str, finder: ResourceFinder,
) -> tuple[list[DrawnShape], list[Marker]]:
    """
    Make the surfaces of the shapes beside a TF tree.

    :param scene: the scene, loaded with its shapes.
    :param model: scoped name of the only model to draw; empty for everything.
    :param finder: finds the files of meshes.
    :return: the surfaces, and markers for shapes that cannot be drawn.
    :raises UnknownFrameError: if there is no such model.
    """
    is_inside = elements_in_model(scene, model) & (scene.roots == 0)
    boxes = _MeshBoxes(finder)
    drawn: list[DrawnShape] = []
    markers: list[Marker] = []
    largest_m = 0.0
    # Planes come last: they are cut to the size of everything else.
    for of_planes in (False, True):
        for element, shape in scene.shapes.items():
            if not is_inside[element] or (shape.type == 'plane') is not of_planes:
                continue
            pose = scene.pose_of(element)
            triangles: Triangles | str = boxes.triangles(shape, scene.place(element).file) if (
                shape.type == 'mesh') else (
                triangles_from_shape(shape, largest_m) or shape.reason_without_surface)
            if isinstance(triangles, str):
                markers.append(Marker(scene.names[element], pose, reason=triangles))
                continue
            drawn.append(DrawnShape(
                Kind(scene.kinds[element]).label,
                Triangles(points_in_parent(pose, triangles.points), triangles.faces),
                (shape.rgba or _GRAY)[:3]))
        largest_m = 1.2 * _size_m(tree, drawn)
    return drawn, markers


def _size_m(tree: TfTree, drawn: list[DrawnShape]) -> float:
    points = [tree.poses[:, :3], np.zeros((1, 3)), *(shape.triangles.points for shape in drawn)]
    return float(np.ptp(np.concatenate(points), axis=0).max()) or 1.0


class _MeshBoxes:
    """Finds the bounding boxes of meshes."""

    def __init__(self, finder: ResourceFinder) -> None:
        self._finder = finder
        self._bounds: dict[str, Points | str] = {}

    def triangles(self, shape: Shape, file: str) -> Triangles | str:
        """
        Return the box around a mesh; that of the whole mesh if only a part of it is meant.

        :param file: path of the file that names it.
        :return: its surface, or why there is none.
        """
        path = self._finder.file_from_uri(shape.mesh_uri, file)
        if path is None:
            return f'the mesh "{shape.mesh_uri}" is not found'
        if path not in self._bounds:
            self._bounds[path] = _bounds_of_file(path)
        bounds = self._bounds[path]
        if isinstance(bounds, str):
            return bounds
        corners = bounds * shape.mesh_scale
        if not np.isfinite(corners).all():
            return f'the size of the mesh "{shape.mesh_uri}" is not finite'
        return triangles_of_box(*corners)


def _bounds_of_file(path: str) -> Points | str:
    """Return the lowest and the highest corner of a mesh, or why there are none."""
    try:
        trimesh = importlib.import_module('trimesh')
    except ImportError:
        return 'meshes need the library trimesh (pip install trimesh)'
    try:
        bounds: Points | None = trimesh.load(path, force='scene', skip_materials=True).bounds
    except Exception as error:  # noqa: BLE001  # its loaders raise errors of all classes
        return f'trimesh cannot read {path}: {error}'
    return f'{path} has no surface' if bounds is None else bounds
