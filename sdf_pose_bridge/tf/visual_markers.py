# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Choose the marker of RViz for each visual, in a frame of TF that the visual moves with."""

from __future__ import annotations

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.names import shortened
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.scene.triangles import Points
from sdf_pose_bridge.scene.triangles import triangles_from_shape
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.include.uris import ResourceFinder
from sdf_pose_bridge.sdformat.shapes import Shape
from sdf_pose_bridge.tf.parents import NO_PARENT
from sdf_pose_bridge.tf.tree import elements_in_model
from sdf_pose_bridge.tf.tree import TfTree

MOST_MARKERS = 20_000
MOST_POINTS = 1_000_000
"""How many corners of triangles all markers may have together."""

_GRAY = (0.7, 0.7, 0.7, 1.0)
_NO_POINTS = np.zeros((0, 3))


class Form(NamedTuple):
    """What a marker looks like, in its own frame."""

    type: str
    """The name of a constant of ``visualization_msgs/Marker``: ``CUBE``, ``SPHERE``,
    ``CYLINDER``, ``MESH_RESOURCE`` or ``TRIANGLE_LIST``."""
    scale: tuple[float, ...] = (1.0, 1.0, 1.0)
    """Along x, y and z: metres, but factors for a mesh and triangles."""
    points: Points = _NO_POINTS
    """Shape (3 n, 3): the corners of n triangles, one after the other; empty for others."""
    mesh_resource: str = ''
    """The URI of a mesh; empty for others."""


class VisualMarker(NamedTuple):
    """The marker of a visual."""

    namespace: str
    """Scoped name of the model, so that RViz can show and hide each."""
    frame_id: str
    """Frame id of the link, or of its nearest ancestor in TF that is published."""
    pose: Pose
    """Pose of the visual in this frame."""
    form: Form
    rgba: tuple[float, float, float, float] | None
    """Color, each component from 0 to 1; None for the materials of the mesh itself."""


def visual_markers_from_scene(
    scene: Scene, tree: TfTree, model: str, finder: ResourceFinder,
) -> tuple[list[VisualMarker], tuple[SdfWarning, ...]]:
    """
    Choose the markers of the visuals beside a TF tree.

    Visuals that are fully transparent have none. The markers of a large file are limited to
    ``MOST_MARKERS`` and ``MOST_POINTS``.

    :param scene: the scene, loaded with its shapes.
    :param tree: its TF tree.
    :param model: scoped name of the only model to show; empty for everything.
    :param finder: finds the files of meshes.
    :return: the markers in file order, and warnings about visuals that cannot be shown.
    :raises UnknownFrameError: if there is no such model.
    """
    is_shown = (
        elements_in_model(scene, model) & (scene.roots == 0) & (scene.kinds == int(Kind.VISUAL)))
    problems = Problems(scene.files)
    markers: list[VisualMarker] = []
    point_count = 0
    for element, shape in scene.shapes.items():
        if not is_shown[element] or (shape.rgba is not None and shape.rgba[3] <= 0.0):
            continue
        link = int(scene.parents[element])
        frame = int(tree.nearest_frames[link])
        place = scene.place(element)
        form = _form_from_shape(shape, place.file, finder)
        if isinstance(form, str) or frame == NO_PARENT:
            reason = form if isinstance(form, str) else (
                'neither its link nor a frame above that in TF is published')
            msg = f'the visual "{scene.names[element]}" is not shown: {reason}'
            problems.warning(msg, place)
            continue
        point_count += len(form.points)
        if len(markers) == MOST_MARKERS or point_count > MOST_POINTS:
            msg = f'only the first {len(markers)} visuals are shown'
            problems.warning(msg, place)
            break
        if shape.submesh:
            msg = (f'all of the mesh "{shortened(shape.mesh_uri)}" is shown instead of its part '
                   f'"{shortened(shape.submesh)}", because RViz cannot show a part of a mesh')
            problems.warning(msg, place)
        is_in_root = frame < 0
        markers.append(VisualMarker(
            scene.names[scene.parents[link]],
            tree.root_frame if is_in_root else tree.frame_ids[frame],
            scene.relative_pose_of(element, 0 if is_in_root else int(tree.elements[frame])),
            form,
            shape.rgba or (None if form.mesh_resource else _GRAY)))
    return markers, problems.warnings


def _form_from_shape(shape: Shape, file: str, finder: ResourceFinder) -> Form | str:
    """Return what a visual looks like, or why it cannot be shown."""
    if shape.type == 'mesh':
        return _form_from_mesh(shape, file, finder)
    if shape.reason_without_surface:
        return shape.reason_without_surface
    sizes_m = shape.sizes_m
    if shape.type == 'box':
        return Form('CUBE', sizes_m)
    if shape.type in ('sphere', 'ellipsoid'):
        radii_m = sizes_m if len(sizes_m) == 3 else 3 * sizes_m
        return Form('SPHERE', tuple(2.0 * radius_m for radius_m in radii_m))
    if shape.type == 'cylinder':
        radius_m, length_m = sizes_m
        return Form('CYLINDER', (2.0 * radius_m, 2.0 * radius_m, length_m))
    triangles = triangles_from_shape(shape, largest_m=math.inf)
    if triangles is None:
        return shape.reason_without_surface
    return Form('TRIANGLE_LIST', points=triangles.points[triangles.faces.reshape(-1)])


def _form_from_mesh(shape: Shape, file: str, finder: ResourceFinder) -> Form | str:
    if not all(map(math.isfinite, shape.mesh_scale)):
        return f'the scale of the mesh "{shortened(shape.mesh_uri)}" is not finite'
    uri = shape.mesh_uri
    # RViz may run on another machine, where the package is elsewhere.
    if not uri.startswith('package://'):
        path = finder.file_from_uri(uri, file)
        if path is None:
            return f'the mesh "{shortened(uri)}" is not found'
        uri = Path(path).absolute().as_uri()
    return Form('MESH_RESOURCE', shape.mesh_scale, mesh_resource=uri)
