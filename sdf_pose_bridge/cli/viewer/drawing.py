# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Draw a scene by viser: axes, names, lines and surfaces."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Sequence
from typing import Any
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
import trimesh
import viser

from sdf_pose_bridge.cli.printing import kind_labels_of
from sdf_pose_bridge.cli.viewer.labels import labels_from_names
from sdf_pose_bridge.cli.viewer.meshes import MeshPart
from sdf_pose_bridge.cli.viewer.meshes import MeshReader
from sdf_pose_bridge.cli.viewer.view_point import bounds_of_interest
from sdf_pose_bridge.cli.viewer.view_point import bounds_of_points
from sdf_pose_bridge.cli.viewer.view_point import FIELD_OF_VIEW_RAD
from sdf_pose_bridge.cli.viewer.view_point import grid_spacing_m
from sdf_pose_bridge.cli.viewer.view_point import home_view
from sdf_pose_bridge.cli.viewer.view_point import View
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

GROUPS = ('visuals', 'collisions', 'all names', 'all lines to parents', 'grid')
"""What can be hidden, besides the kinds of frames by their labels."""
HIDDEN_AT_FIRST = frozenset(('collisions', 'all names', 'all lines to parents'))
"""Those that a page does not show until they are switched on."""

_WXYZ = [6, 3, 4, 5]
_GRAY = (0.52, 0.54, 0.57, 1.0)
"""The color of what has none, which shows on a light and on a dark ground."""
_LINE_COLOR = (255, 146, 43)
_GRID_COLOR, _GRID_SECTION_COLOR = (173, 178, 184), (134, 141, 149)
_COLLISION_RGBA = (0.05, 0.62, 0.55, 1.0)
_LIGHT_FROM_BELOW = (120, 124, 130)
_DIRECTION_TO_LIGHT = (0.35, -0.6, 1.0)


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
        self.opacity = 1.0
        """That of surfaces; see :meth:`set_opacity`."""
        self._camera: Any = None
        self._marked = -1
        self._labels: list[viser.LabelHandle] = []

    def look_from(self, camera: viser.CameraHandle) -> None:
        """Place names for this camera from the next :meth:`place` on."""
        self._camera = camera

    def draw(
        self, scene: Scene, tree: TfTree, is_shown: NDArray[np.bool_],
        is_in_robot: NDArray[np.bool_], hidden: set[str],
    ) -> list[str]:
        """
        Draw a scene instead of the one before.

        :param is_shown: whether to draw each element of the scene.
        :param is_in_robot: whether each element is in a model that moves.
        :param hidden: the groups and kinds of frames that are not drawn.
        :return: why visuals and collisions are not drawn as the file means them, for each of them.
        """
        nodes, self._hidden = self._server.scene, hidden
        # Other nodes replace those of their name. Of these there may be fewer now.
        for name in ('/visuals', '/collisions'):
            nodes.remove_by_name(name)
        # An optical frame is shown with its parent.
        elements = np.where(
            tree.elements < 0, tree.elements[np.maximum(tree.parents, 0)], tree.elements)
        self.frames = np.array([
            frame for frame, label in enumerate(kind_labels_of(scene, tree))
            if label not in hidden and is_shown[elements[frame]]], int)
        origins = tree.poses[:, :3]
        extent_m = float(np.ptp(origins, axis=0).max()) if len(origins) else 0.0
        surfaces, reasons = surfaces_from_scene(
            scene, [element for element in scene.shapes if is_shown[element]
                    and f'{Kind(scene.kinds[element]).label}s' not in hidden],
            extent_m or 1.0, self._meshes)
        boxes = boxes_of_surfaces(scene, surfaces)
        size_m = float(np.ptp(bounds_of_points(
            np.concatenate([origins, np.zeros((1, 3)), boxes.reshape(-1, 3)])), axis=0).max())
        size_m = size_m or 1.0
        self.bounds = bounds_of_interest(
            origins[self.frames], is_in_robot[elements[self.frames]], boxes)
        view_m = float(np.linalg.norm(self.bounds[1] - self.bounds[0])) or size_m
        self.home = home_view(self.bounds, origins[self.frames], boxes)
        self._add_surroundings(view_m, size_m)
        if self._camera is None:
            self._look_at(self.home, size_m)
        self.axes_length_m = length_m = _length_of_axes(tree, view_m)
        self._marker = nodes.add_frame(
            '/selected', axes_length=2.0 * length_m, axes_radius=0.06 * length_m, visible=False)
        self.gizmo = nodes.add_transform_controls(
            '/gizmo', 2.5 * length_m, depth_test=False, visible=False)
        self._lines = nodes.add_line_segments(
            '/lines to parents', _lines(tree, self._lined(tree)), _LINE_COLOR, thickness=2.0,
            thickness_units='screen')
        self._axes = nodes.add_batched_axes(
            '/frames', *_places(tree.poses[self.frames]), axes_length=length_m,
            axes_radius=0.035 * length_m)
        self._select_by_click(self._axes, self.frames)
        self._copies = [
            (self._add_surface(number, surface, scene, tree), surface.elements)
            for number, surface in enumerate(surfaces)]
        self.place(scene, tree)
        return reasons

    def place(self, scene: Scene, tree: TfTree) -> None:
        """Move what is drawn to the poses of a scene that differs in nothing else."""
        self._axes.batched_wxyzs, self._axes.batched_positions = _places(tree.poses[self.frames])
        for copies, elements in self._copies:
            copies.batched_wxyzs, copies.batched_positions = _places(scene.poses[elements])
        self._lines.points = _lines(tree, self._lined(tree))
        self._place_names(tree)

    def mark(self, frame: int, pose: Pose | None) -> None:
        """
        Show larger axes, the name, and the lines to the ancestors of a frame.

        :param frame: its index, or -1 for none.
        :param pose: where the axes are, in the root frame.
        """
        self._marked = frame
        self._marker.visible = pose is not None
        if pose is not None:
            self._marker.position, self._marker.wxyz = pose[:3], (pose.qw, *pose[3:6])

    def set_opacity(self, opacity: float) -> None:
        """Let surfaces be seen through, from 0 to 1, where 1 is opaque."""
        self.opacity = opacity
        for copies, _ in self._copies:
            copies.opacity = None if opacity >= 1.0 else opacity

    def _lined(self, tree: TfTree) -> NDArray[np.intp]:
        """Return the frames with a line to their parents."""
        if 'all lines to parents' not in self._hidden:
            return self.frames
        lined, frame = [], self._marked
        while frame >= 0:
            lined.append(frame)
            frame = int(tree.parents[frame])
        return np.array(lined, int)

    def _place_names(self, tree: TfTree) -> None:
        frames = [] if 'all names' in self._hidden else self.frames[:MOST_NAMES].tolist()
        if self._marked >= 0 and self._marked not in frames:
            frames.append(self._marked)
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

    def _look_at(self, view: View, size_m: float) -> None:
        """Choose what a browser sees at first."""
        self._camera = camera = self._server.initial_camera
        camera.position, camera.look_at = view
        camera.fov = FIELD_OF_VIEW_RAD
        camera.near, camera.far = 0.001 * size_m, 100.0 * size_m

    def _add_surroundings(self, view_m: float, size_m: float) -> None:
        """Add light from above and from one side, and a grid on the ground."""
        nodes = self._server.scene
        nodes.add_light_hemisphere('/light/sky', ground_color=_LIGHT_FROM_BELOW, intensity=1.7)
        # Far away and without decay, so that its rays are parallel.
        nodes.add_light_point(
            '/light/sun', intensity=1.9, decay=0.0,
            position=tuple(100.0 * size_m * np.array(_DIRECTION_TO_LIGHT)))
        spacing_m, has_grid = grid_spacing_m(view_m), 'grid' not in self._hidden
        middle = np.round(self.bounds.mean(axis=0)[:2] / spacing_m) * spacing_m
        width_m = 2.0 * spacing_m * np.ceil(view_m / spacing_m)
        # A little above the floors that many files have there.
        height_m = 0.001 * view_m
        nodes.add_grid(
            '/grid', width_m, width_m, cell_size=spacing_m, section_size=5.0 * spacing_m,
            cell_color=_GRID_COLOR, section_color=_GRID_SECTION_COLOR, shadow_opacity=0.0,
            fade_distance=4.0 * view_m, position=(*middle, height_m), visible=has_grid)
        to_camera = 0.3 * (self.home.position - self.home.look_at)[:2]
        nodes.add_label(
            '/grid spacing', f'grid {spacing_m:g} m', font_screen_scale=0.8, visible=has_grid,
            position=(*(middle + spacing_m * np.round(to_camera / spacing_m)), height_m))

    def _add_surface(self, number: int, surface: Surface, scene: Scene, tree: TfTree) -> Any:
        is_collision = surface.kind == Kind.COLLISION
        rgba = np.clip(surface.rgba, 0.0, 1.0)
        if is_collision:
            rgba[:] = _COLLISION_RGBA
        copies = self._server.scene.add_batched_meshes_simple(
            f'/{surface.kind.label}s/{number}', surface.part.points, surface.part.faces,
            *_places(scene.poses[surface.elements]), batched_scales=surface.scales,
            batched_colors=np.round(255.0 * rgba[:, :3]).astype(np.uint8),
            batched_opacities=rgba[:, 3] if (rgba[:, 3] < 1.0).any() else None,
            opacity=None if self.opacity >= 1.0 else self.opacity, lod='off',
            wireframe=is_collision, flat_shading=not is_collision, side='double')
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


def boxes_of_surfaces(scene: Scene, surfaces: Sequence[Surface]) -> Floats:
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
