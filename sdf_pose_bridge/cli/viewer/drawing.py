# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Draw a scene by viser: axes, names, lines and surfaces."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Sequence
import math
from typing import Any
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
import trimesh
import viser

from sdf_pose_bridge.cli.printing import kind_labels_of
from sdf_pose_bridge.cli.viewer.meshes import MeshPart
from sdf_pose_bridge.cli.viewer.meshes import MeshReader
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.poses import PoseArray
from sdf_pose_bridge.geometry.rotations import Floats
from sdf_pose_bridge.geometry.rotations import matrix_from_quaternion
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.names import shortened
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.shapes import Shape
from sdf_pose_bridge.tf.parents import NO_PARENT
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT
from sdf_pose_bridge.tf.tree import TfTree

MOST_SURFACES = 5_000
"""How many surfaces that differ are drawn."""
MOST_TRIANGLES = 3_000_000
"""How many triangles these may have together."""
MOST_NAMES = 500
"""How many names are shown at once."""

GROUPS = ('visuals', 'collisions', 'names', 'lines to parents')
"""What can be hidden, besides the kinds of frames by their labels."""

_WXYZ = [6, 3, 4, 5]
_DIRECTION_TO_EYE = np.array([0.75, -0.5, 0.45])
_FIELD_OF_VIEW_RAD = 0.8
_GRAY = (0.7, 0.7, 0.7, 1.0)
_LINE_COLOR = (134, 142, 150)
_LIGHT_FROM_BELOW = (160, 160, 160)
_OPACITY = 0.6
"""That of surfaces, so that the frames in them are seen."""

_LINE_HEIGHT, _CHARACTER_WIDTH = 0.018, 0.008
"""Size of a name, as a part of the height of a window of 720 pixels."""
_MOST_IN_A_LABEL = 8


class Surface(NamedTuple):
    """The surface of visuals or collisions that differ only in place, size and color."""

    kind: Kind
    part: MeshPart
    elements: list[int]
    """The visual or collision of each copy."""
    scales: Floats
    """Shape (n, 3): the factors of each copy along x, y and z."""
    rgba: NDArray[np.float64]
    """Shape (n, 4): the color of each copy, components from 0 to 1."""


class Drawing:
    """
    The nodes that show a scene.

    :param server: the server that shows them.
    :param meshes: reads the meshes.
    :param select: is called with the frame that is clicked, an index into the TF tree.
    """

    def __init__(
        self, server: viser.ViserServer, meshes: MeshReader, select: Callable[[int], None],
    ) -> None:
        self._server, self._meshes, self._select = server, meshes, select
        self.gizmo: Any = None
        """The gizmo, which is not visible at first."""
        self._camera: Any = None
        self._labels: list[viser.LabelHandle] = []

    def look_from(self, camera: viser.CameraHandle) -> None:
        """Place names for this camera from the next :meth:`place` on."""
        self._camera = camera

    def draw(
        self, scene: Scene, tree: TfTree, is_shown: NDArray[np.bool_], hidden: set[str],
    ) -> list[str]:
        """
        Draw a scene instead of the one before.

        :param is_shown: whether to draw each element of the scene.
        :param hidden: the groups and kinds of frames that are not drawn.
        :return: why visuals and collisions are not drawn as the file means them, for each of them.
        """
        nodes, self._hidden = self._server.scene, hidden
        # Other nodes replace those of their name. Of these there may be fewer now.
        for name in ('/visuals', '/collisions'):
            nodes.remove_by_name(name)
        nodes.add_light_hemisphere('/light', ground_color=_LIGHT_FROM_BELOW, intensity=1.5)
        # An optical frame is shown with its parent.
        elements = np.where(
            tree.elements < 0, tree.elements[np.maximum(tree.parents, 0)], tree.elements)
        self._frames = np.array([
            frame for frame, label in enumerate(kind_labels_of(scene, tree))
            if label not in hidden and is_shown[elements[frame]]], int)
        origins = tree.poses[:, :3]
        extent_m = float(np.ptp(origins, axis=0).max()) if len(origins) else 0.0
        surfaces, reasons = surfaces_from_scene(
            scene, [element for element in scene.shapes if is_shown[element]
                    and f'{Kind(scene.kinds[element]).label}s' not in hidden],
            extent_m or 1.0, self._meshes)
        bounds = bounds_of_scene(scene, origins, surfaces)
        size_m = float(np.ptp(bounds, axis=0).max()) or 1.0
        view_m = size_m
        if 0.0 < extent_m < 0.55 * size_m:
            # A floor is often much larger than what stands on it.
            bounds, view_m = bounds_of_scene(scene, origins, []), max(extent_m, 0.3 * size_m)
        if self._camera is None:
            self._look_at(0.5 * bounds.sum(axis=0), view_m, size_m)
        length_m = _length_of_axes(tree, size_m)
        self._marker = nodes.add_frame(
            '/selected', axes_length=2.0 * length_m, axes_radius=0.08 * length_m, visible=False)
        self.gizmo = nodes.add_transform_controls(
            '/gizmo', 4.0 * length_m, depth_test=False, visible=False)
        self._lines = nodes.add_line_segments(
            '/lines to parents', _lines(tree, self._frames), _LINE_COLOR,
            thickness=0.002 * view_m, visible='lines to parents' not in hidden)
        self._axes = nodes.add_batched_axes(
            '/frames', *_places(tree.poses[self._frames]), axes_length=length_m,
            axes_radius=0.05 * length_m)
        self._select_by_click(self._axes, self._frames)
        self._copies = [
            (self._add_surface(number, surface, scene, tree), surface.elements)
            for number, surface in enumerate(surfaces)]
        self.place(scene, tree)
        return reasons

    def place(self, scene: Scene, tree: TfTree) -> None:
        """Move what is drawn to the poses of a scene that differs in nothing else."""
        self._axes.batched_wxyzs, self._axes.batched_positions = _places(tree.poses[self._frames])
        for copies, elements in self._copies:
            copies.batched_wxyzs, copies.batched_positions = _places(scene.poses[elements])
        self._lines.points = _lines(tree, self._frames)
        self._place_names(tree)

    def mark(self, pose: Pose | None) -> None:
        """Show larger axes at a pose in the root frame; none for None."""
        self._marker.visible = pose is not None
        if pose is not None:
            self._marker.position, self._marker.wxyz = pose[:3], (pose.qw, *pose[3:6])

    def _place_names(self, tree: TfTree) -> None:
        frames = [] if 'names' in self._hidden else self._frames[:MOST_NAMES].tolist()
        names = [
            printable(shortened(tree.frame_ids[frame].rpartition('/')[2])) for frame in frames]
        labels = labels_from_names(
            names, tree.poses[frames, :3], self._camera.position, self._camera.look_at)
        # A browser leaves a label that is removed and added again at once where it was.
        while len(self._labels) < len(labels):
            self._labels.append(self._server.scene.add_label(f'/names/{len(self._labels)}', ''))
        for number, label in enumerate(self._labels):
            label.visible = number < len(labels)
            if label.visible:
                label.text, label.position = labels[number]

    def _look_at(self, middle: Floats, view_m: float, size_m: float) -> None:
        """Choose what a browser sees at first."""
        self._camera = camera = self._server.initial_camera
        camera.look_at, camera.fov = middle, _FIELD_OF_VIEW_RAD
        camera.position = middle + 1.6 * view_m * _DIRECTION_TO_EYE
        camera.near, camera.far = 0.001 * size_m, 100.0 * size_m

    def _add_surface(self, number: int, surface: Surface, scene: Scene, tree: TfTree) -> Any:
        rgba = np.clip(surface.rgba, 0.0, 1.0)
        copies = self._server.scene.add_batched_meshes_simple(
            f'/{surface.kind.label}s/{number}', surface.part.points, surface.part.faces,
            *_places(scene.poses[surface.elements]), batched_scales=surface.scales,
            batched_colors=np.round(255.0 * rgba[:, :3]).astype(np.uint8),
            batched_opacities=rgba[:, 3] if (rgba[:, 3] < 1.0).any() else None,
            opacity=_OPACITY, lod='off', flat_shading=True, side='double')
        self._select_by_click(copies, tree.nearest_frames[surface.elements])
        return copies

    def _select_by_click(self, copies: Any, frames: NDArray[Any]) -> None:
        copies.on_click(lambda event: self._select(int(frames[event.instance_index or 0])))


def _places(poses: PoseArray) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return quaternions w x y z and positions, as viser takes them."""
    return poses[:, _WXYZ].astype(np.float32), poses[:, :3].astype(np.float32)


def _lines(tree: TfTree, shown: NDArray[np.intp]) -> Floats:
    """Return lines from the parents of frames to the frames, shape (n, 2, 3)."""
    frames = shown[tree.parents[shown] != NO_PARENT]
    # The last entry is the root frame, which the index of the root as a parent means.
    origins = np.concatenate([tree.poses[:, :3], np.zeros((1, 3))])
    assert ROOT_IS_PARENT == -1
    return np.stack([origins[tree.parents[frames]], origins[frames]], axis=1)


def _length_of_axes(tree: TfTree, size_m: float) -> float:
    """Return the length of axes, in metres: short where frames are near to one another."""
    distances_m = np.linalg.norm(tree.transforms[:, :3], axis=1)
    distances_m = distances_m[distances_m > 1e-6 * size_m]
    typical_m = np.median(distances_m) if len(distances_m) else size_m
    return float(np.clip(0.4 * typical_m, 0.01 * size_m, 0.1 * size_m))


def surfaces_from_scene(
    scene: Scene, elements: Sequence[int], size_m: float, meshes: MeshReader,
) -> tuple[list[Surface], list[str]]:
    """
    Choose the surfaces of visuals and collisions.

    :param scene: the scene, loaded with its shapes.
    :param elements: the visuals and collisions to draw.
    :param size_m: extent of the frames; no side of a plane is much longer, and a mesh of which
        nothing is known is a box of a small part of it.
    :param meshes: reads meshes.
    :return: the surfaces, and for each element that is not drawn as the file means it, why.
    """
    copies: dict[tuple[Kind, Shape, str], list[int]] = {}
    for element in elements:
        shape = scene.shapes[element]
        if shape.is_visible:
            form = shape._replace(
                rgba=None, opacity=1.0, mesh_scale=(1.0,) * 3,
                sizes_m=(1.0,) * 3 if shape.type == 'box' and shape.has_extent else shape.sizes_m)
            file = scene.place(element).file if shape.type == 'mesh' else ''
            copies.setdefault((Kind(scene.kinds[element]), form, file), []).append(element)
    surfaces: list[Surface] = []
    reasons: list[str] = []
    triangle_count = 0
    for (kind, form, file), same in copies.items():
        mesh = meshes.mesh(form, file, size_m)
        reasons += [mesh.reason] * len(same) * bool(mesh.reason)
        triangle_count += sum(len(part.faces) for part in mesh.parts)
        if len(surfaces) + len(mesh.parts) > MOST_SURFACES or triangle_count > MOST_TRIANGLES:
            reasons += ['there are too many surfaces'] * len(same)
            continue
        shapes = [scene.shapes[element] for element in same]
        scales = np.array([
            shape.sizes_m if shape.type == 'box' else shape.mesh_scale for shape in shapes])
        if mesh.reason:
            scales[:] = 1.0
        surfaces += [
            Surface(kind, part, same, scales, np.array([
                part.rgba if mesh.reason else shape.rgba_or(part.rgba or _GRAY)
                for shape in shapes]))
            for part in mesh.parts]
    return surfaces, reasons


def bounds_of_scene(scene: Scene, origins: Floats, surfaces: Sequence[Surface]) -> Floats:
    """
    Find what a view of everything has to contain.

    :param origins: shape (n, 3), the origins of frames.
    :return: shape (2, 3): the lowest and the highest corner.
    """
    points = [origins, np.zeros((1, 3))]
    for surface in surfaces:
        part, poses = surface.part.points, scene.poses[surface.elements]
        corners = trimesh.bounds.corners([part.min(axis=0), part.max(axis=0)])
        matrices = matrix_from_quaternion(poses[:, 3:])
        turned = (surface.scales[:, np.newaxis] * corners) @ matrices.transpose(0, 2, 1)
        points.append((turned + poses[:, np.newaxis, :3]).reshape(-1, 3))
    together = np.concatenate(points)
    return np.array([together.min(axis=0), together.max(axis=0)])


class _Label(NamedTuple):
    """Names in a rectangle of the picture, in parts of its height."""

    top: float
    left: float
    point: Floats
    names: list[str]

    @property
    def lines(self) -> list[str]:
        """Return the lines of the text."""
        more = len(self.names) - _MOST_IN_A_LABEL
        return self.names[:_MOST_IN_A_LABEL] + ([f'and {more} more'] if more > 0 else [])

    def is_on(self, other: _Label) -> bool:
        """Return whether a part of one would lie on the other."""
        higher, lower = sorted((self, other), key=lambda each: each.top)
        first, second = sorted((self, other), key=lambda each: each.left)
        return (lower.top < higher.top + _LINE_HEIGHT * len(higher.lines)
                and second.left < first.left + _CHARACTER_WIDTH * max(map(len, first.lines)))


def labels_from_names(
    names: Sequence[str], points: Floats, eye: Floats, look_at: Floats,
) -> list[tuple[str, Floats]]:
    """
    Join names that would lie on one another in the picture, as lines of one text.

    :param names: the names of frames.
    :param points: shape (n, 3), their origins.
    :param eye: shape (3,), where the camera is.
    :param look_at: shape (3,), what is in the middle of the picture, not above or below the eye.
    :return: the texts, and their points: each text is right of its point and below it.
    """
    forward = np.asarray(look_at) - eye
    right = np.cross(forward, (0.0, 0.0, 1.0))
    axes = np.array([
        axis / np.linalg.norm(axis) for axis in (right, np.cross(forward, right), forward)])
    x, y, depth = ((points - eye) @ axes.T).T
    seen = np.flatnonzero(depth > 0.0)
    scale = 0.5 / (math.tan(0.5 * _FIELD_OF_VIEW_RAD) * depth[seen])
    labels: list[_Label] = []
    places = scale * np.stack([y[seen], x[seen]])
    for top, left, index in sorted(zip(*places.tolist(), seen.tolist(), strict=True)):
        label = _Label(top, left, points[index], [names[index]])
        while other := next(filter(label.is_on, labels), None):
            labels = [each for each in labels if each is not other]
            higher, lower = sorted((other, label), key=lambda each: each.top)
            label = higher._replace(names=higher.names + lower.names)
        labels.append(label)
    return [('\n'.join(label.lines), label.point) for label in labels]
