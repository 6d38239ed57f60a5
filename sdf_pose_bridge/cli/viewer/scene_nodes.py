# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The scene of the page: axes, names, lines and surfaces as nodes of viser."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from typing import TYPE_CHECKING

import numpy as np
import viser

from sdf_pose_bridge.cli.printing import kind_labels_of
from sdf_pose_bridge.cli.viewer.drawing import bounds_of_scene
from sdf_pose_bridge.cli.viewer.drawing import names_at_places
from sdf_pose_bridge.cli.viewer.drawing import NotDrawn
from sdf_pose_bridge.cli.viewer.drawing import Surface
from sdf_pose_bridge.cli.viewer.drawing import surfaces_from_scene
from sdf_pose_bridge.cli.viewer.meshes import MeshReader
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.poses import PoseArray
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.names import shortened
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.tf.parents import NO_PARENT
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT
from sdf_pose_bridge.tf.tree import TfTree

if TYPE_CHECKING:
    from numpy.typing import NDArray

LINES = '/lines to parents'
GROUPS = ('/names', LINES, '/visuals', '/collisions')
"""The nodes that can be hidden, besides one for each kind of frame."""

_WXYZ = [6, 3, 4, 5]
_DIRECTION_TO_EYE = np.array([0.75, -0.5, 0.45])
_LINE_COLOR = (134, 142, 150)
_LIGHT_FROM_BELOW = (160, 160, 160)


def node_of_kind(label: str) -> str:
    """Return the node of all frames of a kind."""
    return f'/frames/{label}'


class SceneNodes:
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
        self._nodes: dict[str, Any] = {}
        self.opacity = 0.6
        """That of surfaces, so that the frames in them are seen."""
        self.hidden = {'/collisions'}
        """The names of nodes and of models that are hidden."""

    def draw(
        self, scene: Scene, tree: TfTree, is_shown: NDArray[np.bool_],
    ) -> list[NotDrawn]:
        """
        Draw a scene instead of the one before.

        :param is_shown: whether to draw each element of the scene.
        :return: what is not drawn as the file means it.
        """
        nodes, labels = self._server.scene, kind_labels_of(scene, tree)
        nodes.reset()
        nodes.add_light_hemisphere('/light', ground_color=_LIGHT_FROM_BELOW, intensity=1.5)
        origins = tree.poses[:, :3]
        extent_m = float(np.ptp(origins, axis=0).max()) if len(origins) else 0.0
        self._surfaces, not_drawn = surfaces_from_scene(
            scene, [element for element in scene.shapes if is_shown[element]], extent_m or 1.0,
            self._meshes)
        bounds = bounds_of_scene(scene, origins, self._surfaces)
        self._size_m = float(np.ptp(bounds, axis=0).max()) or 1.0
        # A floor is often much larger than what stands on it.
        self._view_m = max(extent_m, 0.3 * self._size_m)
        self._middle = 0.5 * np.sum(
            bounds if extent_m == 0.0 else (origins.min(axis=0), origins.max(axis=0)), axis=0)
        shown = np.flatnonzero(is_shown[_elements_of_frames(tree)])
        self._frames = {
            label: np.array([frame for frame in shown.tolist() if labels[frame] == label], int)
            for label in dict.fromkeys(labels)}
        self._length_m = length_m = self._length_of_axes(tree)
        self._nodes = {
            name: nodes.add_frame(name, show_axes=False, visible=name not in self.hidden)
            for name in ('/frames', '/names', '/visuals', '/collisions')}
        self._nodes[LINES] = nodes.add_line_segments(
            LINES, self._lines(tree), _LINE_COLOR, thickness=0.002 * self._view_m,
            visible=LINES not in self.hidden)
        for label, frames in self._frames.items():
            name, poses = node_of_kind(label), tree.poses[frames]
            self._nodes[name] = nodes.add_batched_axes(
                name, poses[:, _WXYZ], poses[:, :3], axes_length=length_m,
                axes_radius=0.05 * length_m, visible=name not in self.hidden)
            self._nodes[name].on_click(
                lambda event, frames=frames: self._select(int(frames[event.instance_index])))
        self._copies = [
            self._add_surface(number, surface, scene, tree)
            for number, surface in enumerate(self._surfaces)]
        self._names: list[viser.LabelHandle] = []
        self._place_names(tree)
        return not_drawn

    def place(self, scene: Scene, tree: TfTree) -> None:
        """Move what is drawn to the poses of a scene that differs in nothing else."""
        for label, frames in self._frames.items():
            _set_poses(self._nodes[node_of_kind(label)], tree.poses[frames])
        for copies, surface in zip(self._copies, self._surfaces, strict=True):
            _set_poses(copies, scene.poses[surface.elements])
        self._nodes[LINES].points = self._lines(tree)
        self._place_names(tree)

    def set_visible(self, name: str, tree: TfTree, *, visible: bool) -> None:
        """Show or hide a node."""
        if name in self._nodes:
            self._nodes[name].visible = visible
            self._place_names(tree)

    def set_opacity(self, opacity: float) -> None:
        """Make surfaces more or less transparent."""
        self.opacity = opacity
        for copies in self._copies:
            copies.opacity = opacity if opacity < 1.0 else None

    def mark(self, pose: Pose | None) -> None:
        """Show larger axes at a pose in the root frame; none for None."""
        name = '/selected'
        if name in self._nodes:
            self._nodes.pop(name).remove()
        if pose is not None:
            self._nodes[name] = self._server.scene.add_frame(
                name, axes_length=2.0 * self._length_m, axes_radius=0.08 * self._length_m,
                position=pose[:3], wxyz=(pose.qw, *pose[3:6]))

    def add_gizmo(self, pose: Pose) -> Any:
        """Return a gizmo at a pose in the root frame."""
        return self._server.scene.add_transform_controls(
            '/gizmo', 4.0 * self._length_m, position=pose[:3], wxyz=(pose.qw, *pose[3:6]),
            depth_test=False)

    def look_at_everything(self) -> None:
        """Choose what a browser sees at first."""
        camera = self._server.initial_camera
        camera.look_at = self._middle
        camera.position = self._middle + 1.6 * self._view_m * _DIRECTION_TO_EYE
        camera.near, camera.far = 0.001 * self._size_m, 100.0 * self._size_m
        camera.fov = 0.8

    def _add_surface(self, number: int, surface: Surface, scene: Scene, tree: TfTree) -> Any:
        poses, rgba = scene.poses[surface.elements], np.clip(surface.rgba, 0.0, 1.0)
        frames = tree.nearest_frames[surface.elements]
        copies = self._server.scene.add_batched_meshes_simple(
            f'/{surface.kind.label}s/{number}', surface.triangles.points, surface.triangles.faces,
            poses[:, _WXYZ], poses[:, :3], batched_scales=surface.scales,
            batched_colors=np.round(255.0 * rgba[:, :3]).astype(np.uint8),
            batched_opacities=rgba[:, 3] if (rgba[:, 3] < 1.0).any() else None,
            opacity=self.opacity if self.opacity < 1.0 else None, lod='off', flat_shading=True,
            side='double')
        copies.on_click(lambda event: self._select(int(frames[event.instance_index or 0])))
        return copies

    def _lines(self, tree: TfTree) -> NDArray[np.float64]:
        """Return lines from the parents of frames to the frames, shape (n, 2, 3)."""
        shown = np.concatenate([np.zeros(0, int), *self._frames.values()])
        frames = shown[tree.parents[shown] != NO_PARENT]
        # The last entry is the root frame, which the index of the root as a parent means.
        origins = np.concatenate([tree.poses[:, :3], np.zeros((1, 3))])
        assert ROOT_IS_PARENT == -1
        return np.stack([origins[tree.parents[frames]], origins[frames]], axis=1)

    def _place_names(self, tree: TfTree) -> None:
        if '/names' in self.hidden:
            return
        frames = [
            frame for label, each in self._frames.items()
            if node_of_kind(label) not in self.hidden for frame in each.tolist()]
        texts = [
            printable(shortened(tree.frame_ids[frame].rpartition('/')[2])) for frame in frames]
        places = list(names_at_places(texts, tree.poses[frames, :3], 0.025 * self._view_m))
        while len(self._names) > len(places):
            self._names.pop().remove()
        for number, (text, point) in enumerate(places):
            if number == len(self._names):
                self._names.append(self._server.scene.add_label(
                    f'/names/{number}', text, position=point, font_screen_scale=0.8))
                continue
            self._names[number].position = point
            if self._names[number].text != text:
                self._names[number].text = text

    def _length_of_axes(self, tree: TfTree) -> float:
        """Return the length of axes, in metres: short where frames are near to one another."""
        distances_m = np.linalg.norm(tree.transforms[:, :3], axis=1)
        distances_m = distances_m[distances_m > 1e-6 * self._size_m]
        typical_m = float(np.median(distances_m)) if len(distances_m) else self._size_m
        return min(max(0.4 * typical_m, 0.01 * self._size_m), 0.1 * self._size_m)


def _set_poses(node: Any, poses: PoseArray) -> None:
    node.batched_positions = poses[:, :3].astype(np.float32)
    node.batched_wxyzs = poses[:, _WXYZ].astype(np.float32)


def _elements_of_frames(tree: TfTree) -> NDArray[np.intp]:
    """Return the element of each frame; of an optical frame that of its parent."""
    elements = tree.elements.tolist()
    for frame, parent in enumerate(tree.parents.tolist()):
        if elements[frame] < 0:
            elements[frame] = elements[parent]
    return np.array(elements, int)
