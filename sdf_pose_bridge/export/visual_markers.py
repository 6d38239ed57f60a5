# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Choose the marker of RViz for each visual, in a frame of TF that the visual moves with."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.errors import SdfError, SdfWarning
from sdf_pose_bridge.export.published_scene import fingerprint_of_scene, LoadRequest
from sdf_pose_bridge.geometry.poses import Pose, pose_product
from sdf_pose_bridge.geometry.rotations import Floats
from sdf_pose_bridge.printed_text import shortened
from sdf_pose_bridge.problems import MOST_PROBLEMS, Problems
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.include.uris import resource_finder, ResourceFinder
from sdf_pose_bridge.sdformat.shape_types import Primitive
from sdf_pose_bridge.sdformat.shapes import Shape
from sdf_pose_bridge.tf.parents import NO_PARENT
from sdf_pose_bridge.tf.tree import elements_in_model, tf_tree_from_scene, TfTree

MOST_MARKERS = 10_000
"""Largest number of markers. Sending these takes a fifth of a second, in one piece."""

MOST_POINTS = 150_000
"""Largest number of corners of triangles of all markers; sending these takes as long."""

_NO_POINTS = np.zeros((0, 3))
_MARKER_TYPES = {
    Primitive.BOX: 'CUBE', Primitive.CYLINDER: 'CYLINDER', Primitive.ELLIPSOID: 'SPHERE'}


class VisualMarker(NamedTuple):
    """The marker of a visual, or of a part of it."""

    type: str
    """The name of a constant of ``visualization_msgs/Marker``: ``CUBE``, ``SPHERE``,
    ``CYLINDER``, ``MESH_RESOURCE`` or ``TRIANGLE_LIST``."""
    scale: tuple[float, ...] = (1.0, 1.0, 1.0)
    """Along x, y and z: metres, but factors for a mesh and triangles."""
    pose: Pose = Pose()
    """Its pose in the frame."""
    points: Floats = _NO_POINTS
    """Shape (3 n, 3): the corners of n triangles, one after the other; empty for others."""
    mesh_resource: str = ''
    """The URI of a mesh; empty for others."""
    frame_id: str = ''
    """Frame id of the link, or of its nearest ancestor in TF that is published."""
    namespace: str = ''
    """Scoped name of the model, so that RViz can show and hide each."""
    rgba: tuple[float, ...] | None = None
    """Color, each component from 0 to 1; None for the materials of the mesh itself."""


def visual_markers_from_scene(
    scene: Scene, tree: TfTree, model: str, finder: ResourceFinder,
) -> tuple[list[VisualMarker], tuple[SdfWarning, ...]]:
    """
    Choose the markers of visuals.

    Visuals that are fully transparent have none. The markers of a large file are limited to
    ``MOST_MARKERS`` and ``MOST_POINTS``.

    :param scene: the scene, loaded with its shapes.
    :param model: scoped name of the only model to show; empty for everything.
    :return: the markers in file order, and warnings about visuals that cannot be shown.
    :raises UnknownFrameError: if there is no such model.
    """
    is_shown = (
        elements_in_model(scene, model) & (scene.roots == 0) & (scene.kinds == Kind.VISUAL))
    problems = Problems(scene.files)
    hidden: dict[tuple[str, int, str], list[int]] = {}
    markers: list[VisualMarker] = []
    point_count = 0
    for element, shape in scene.shapes.items():
        if not is_shown[element] or not shape.is_visible:
            continue
        link = int(scene.parents[element])
        frame = int(tree.nearest_frames[link])
        place = scene.place(element)
        # Further reasons are only counted.
        found = _markers_from_shape(
            shape, place.file, finder, has_reason=len(hidden) < MOST_PROBLEMS)
        if frame == NO_PARENT and not isinstance(found, str):
            found = 'neither its link nor a frame above that in TF is published'
        if isinstance(found, str):
            hidden.setdefault((place.file, place.line, found), []).append(element)
            continue
        point_count += sum(len(marker.points) for marker in found)
        if len(markers) + len(found) > MOST_MARKERS or point_count > MOST_POINTS:
            msg = (f'the visual "{scene.names[element]}" and all that follow are not shown: there '
                   'are too many')
            problems.warning(msg, place)
            break
        if shape.submesh:
            msg = (f'all of the mesh "{shortened(shape.mesh_uri)}" is shown instead of its part '
                   f'"{shortened(shape.submesh)}", because RViz cannot show a part of a mesh')
            problems.warning(msg, place)
        namespace = scene.names[scene.parents[link]]
        frame_id, reference = (tree.root_frame, 0) if frame < 0 else (
            tree.frame_ids[frame], int(tree.elements[frame]))
        pose = scene.relative_pose_of(element, reference)
        markers += [
            marker._replace(
                pose=pose_product(pose, marker.pose), frame_id=frame_id, namespace=namespace,
                rgba=shape.drawn_rgba)
            for marker in found]
    groups: dict[tuple[object, ...], list[tuple[int, str]]] = {}
    for (file, line, reason), elements in hidden.items():
        # Meshes of one package or folder are missing for one reason.
        _, is_missing, cause = reason.partition('" is not found')
        group = groups.setdefault((file, cause) if is_missing else (file, line, reason), [])
        group += [(element, reason) for element in elements]
    for (element, reason), *others in groups.values():
        like = f', like {len(others)} more' if others else ''
        msg = f'the visual "{scene.names[element]}" is not shown{like}: {reason}'
        problems.warning(msg, scene.place(element))
    return markers, problems.warnings


def markers_from_text(
    text: str | bytes, path: Path, request: LoadRequest, fingerprint: bytes,
) -> tuple[list[VisualMarker], tuple[SdfWarning, ...]] | None:
    """
    Resolve the text of a loaded scene again, with its shapes, and make their markers.

    Other loads leave out shapes, which would make them longer by a quarter or more, and which few
    nodes need.

    :param text: the text of the loaded scene.
    :param path: its path.
    :param fingerprint: the fingerprint of the loaded scene.
    :return: the markers, and warnings about visuals that cannot be shown; None if a file that it
        includes has changed, so that it is not valid or has other elements or poses.
    """
    try:
        scene = load_text(
            text, str(path), resource_paths=request.resource_paths,
            on_missing_include=request.on_missing_include, shapes=True,
        ).with_model_name(request.model_name)
    except SdfError:
        return None
    if fingerprint_of_scene(scene) != fingerprint:
        return None
    options = request.tf_options
    return visual_markers_from_scene(
        scene, tf_tree_from_scene(scene, options), options.model,
        resource_finder(request.resource_paths))


def _markers_from_shape(
    shape: Shape, file: str, finder: ResourceFinder, *, has_reason: bool,
) -> list[VisualMarker] | str:
    """Return the markers of a shape in the frame of its visual, or why it cannot be shown."""
    if shape.type == 'mesh':
        uri = finder.uri_for_others(shape.mesh_uri, file)
        if uri is None:
            reason = f': {finder.reason_not_found(shape.mesh_uri, file)}' if has_reason else ''
            return f'the mesh "{shortened(shape.mesh_uri)}" is not found{reason}'
        return [VisualMarker('MESH_RESOURCE', shape.mesh_scale, mesh_resource=uri)]
    if shape.reason_without_surface:
        return shape.reason_without_surface
    if shape.parts:
        return [
            VisualMarker(_MARKER_TYPES[part.primitive], part.extent_m, Pose(z=part.z_m))
            for part in shape.parts]
    points_m, faces = shape.surface
    return [VisualMarker('TRIANGLE_LIST', points=points_m[faces.reshape(-1)])]
