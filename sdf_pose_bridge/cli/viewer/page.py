# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What the page of a scene shows, and what its sliders, buttons and clicks do."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Sequence
from itertools import islice
import math
import threading
from typing import Any
from typing import TYPE_CHECKING

import numpy as np
import viser

from sdf_pose_bridge.cli.printing import kind_labels_of
from sdf_pose_bridge.cli.printing import Units
from sdf_pose_bridge.cli.viewer.drawing import bounds_of_scene
from sdf_pose_bridge.cli.viewer.drawing import names_at_places
from sdf_pose_bridge.cli.viewer.drawing import NotDrawn
from sdf_pose_bridge.cli.viewer.drawing import Surface
from sdf_pose_bridge.cli.viewer.drawing import surfaces_from_scene
from sdf_pose_bridge.cli.viewer.frame_texts import escaped
from sdf_pose_bridge.cli.viewer.frame_texts import html_of_frame
from sdf_pose_bridge.cli.viewer.frame_texts import rows_of_tree
from sdf_pose_bridge.cli.viewer.meshes import MeshReader
from sdf_pose_bridge.geometry.poses import PoseArray
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.names import shortened
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.joint_motion import DegreeOfFreedom
from sdf_pose_bridge.tf.joint_motion import JointMotion
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.joint_positions import scene_at_positions
from sdf_pose_bridge.tf.parents import NO_PARENT
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT
from sdf_pose_bridge.tf.parents import tf_parents_from_scene
from sdf_pose_bridge.tf.tree import elements_in_model
from sdf_pose_bridge.tf.tree import tf_tree_from_scene
from sdf_pose_bridge.tf.tree import TfOptions
from sdf_pose_bridge.tf.tree import TfTree

if TYPE_CHECKING:
    from numpy.typing import NDArray

MOST_ROWS = 300
"""How many rows of the tree of frames are in the page at once; a search finds the others."""

_LARGEST_RANGE = 1000.0
"""A joint with a wider range counts as one without limits, which the page moves by half a turn or
half a metre to either side."""
_MOST_SWITCHES = 50
_MOST_CHOICES = 1000
_WXYZ = [6, 3, 4, 5]
_DIRECTION_TO_EYE = np.array([0.75, -0.5, 0.45])
_ROWS_STYLE = ('<style>.rows{max-height:40vh;overflow:auto;margin:0 1em;font-size:0.8em}'
               '.rows label{display:block;cursor:pointer;white-space:pre}'
               '.rows .selected{font-weight:bold}div:has(>.rows)~*{display:none}</style>')
_HOW_TO_SELECT = '<div style="margin:0 1em;font-size:0.8em">Click one above or in the scene.</div>'
_ERROR_STYLE = 'color:#c92a2a;white-space:pre-wrap;overflow-wrap:anywhere;margin:0 1em;'


class Page:
    """
    The page of a file.

    :param server: the server that shows it.
    :param options: which elements are frames, and how they are named.
    :param units: the units of poses and sliders.
    :param meshes: reads the meshes.
    """

    def __init__(
        self, server: viser.ViserServer, options: TfOptions, units: Units, meshes: MeshReader,
    ) -> None:
        self._server, self._options, self._units, self._meshes = server, options, units, meshes
        # The functions that viser calls run in many threads.
        self._lock = threading.RLock()
        self._is_moved = threading.Event()
        self._hidden = {'/collisions'}
        self._nodes: dict[str, Any] = {}
        self._opacity = 1.0
        self._positions: dict[str, float] = {}
        self._selected = self._reference = ''
        self._loaded: Scene | None = None
        threading.Thread(target=self._follow_sliders, name='sliders', daemon=True).start()

    def show(self, scene: Scene) -> list[NotDrawn]:
        """
        Show a scene instead of the one before.

        What is hidden, the frame that is selected and the positions of joints stay.

        :param scene: the scene, loaded with its shapes.
        :return: what is not drawn as the file means it.
        :raises SdfError: if the scene has no TF tree, or a model to show does not exist; then the
            page stays as it is.
        """
        tree = tf_tree_from_scene(scene, self._options)
        is_in_model = elements_in_model(scene, self._options.model) & (scene.roots == 0)
        with self._lock, self._server.atomic():
            is_first = self._loaded is None
            self._loaded = self._scene = scene
            self._tree, self._is_in_model = tree, is_in_model
            self._labels = kind_labels_of(scene, tree)
            self._tops, self._elements = _tops_of_scene(scene), _elements_of_frames(tree)
            self._dofs = self._movable_dofs()
            self._positions = {
                name: value for name, value in self._positions.items() if name in self._dofs}
            self._move()
            self._nodes = {}
            self._add_controls()
            not_drawn = self._draw()
            if is_first:
                self._look_at_everything()
        return not_drawn

    def show_errors(self, lines: Sequence[str]) -> None:
        """
        Show the errors of a file above its last scene.

        :param lines: a line for each error.
        """
        with self._lock:
            text = '\n'.join(map(escaped, lines))
            self._errors.content = f'<pre style="{_ERROR_STYLE}">{text}</pre>'

    # Joints

    def _movable_dofs(self) -> dict[str, DegreeOfFreedom]:
        """Return the degrees of freedom that do not follow another, by their names."""
        dofs = JointMotion(self._scene, tf_parents_from_scene(self._scene)).dofs
        names = JointPositions(self._scene, dofs).names
        return {
            name: dof for name, dof in zip(names, dofs, strict=True)
            if self._is_in_model[dof.joint.element]
            and (dof.axis is None or dof.joint.axes[dof.axis].mimic is None)}

    def _move(self) -> None:
        assert self._loaded is not None
        self._scene = scene_at_positions(self._loaded, self._positions)
        self._tree = tf_tree_from_scene(self._scene, self._options)

    def _follow_sliders(self) -> None:
        """Draw the newest positions; those that are older by then are never drawn."""
        while True:
            self._is_moved.wait()
            self._is_moved.clear()
            with self._lock, self._server.atomic():
                self._move()
                self._place()

    def _add_slider(self, name: str, dof: DegreeOfFreedom) -> viser.GuiSliderHandle[float]:
        turns, units = dof.rad_per_unit != 0.0, self._units
        factor = (math.degrees(units.is_degrees) if turns else 1000.0 * units.is_mm) or 1.0
        lower, upper = (-math.pi, math.pi) if turns else (-0.5, 0.5)
        axis = None if dof.axis is None else dof.joint.axes[dof.axis]
        if axis is not None and axis.upper - axis.lower < _LARGEST_RANGE:
            # Where the file puts the joint need not be within its limits.
            lower, upper = min(axis.lower, 0.0), max(axis.upper, 0.0)
        value = min(max(self._positions.get(name, 0.0), lower), upper)
        slider = self._server.gui.add_slider(
            f'{printable(name)} [{units.angle if turns else units.length}]', lower * factor,
            upper * factor, max((upper - lower) * factor / 1000.0, 1e-9), value * factor)

        @slider.on_update
        def _(event: viser.GuiEvent[Any]) -> None:
            self._positions[name] = event.target.value / factor
            self._is_moved.set()

        return slider

    # Controls

    def _add_controls(self) -> None:
        gui, labels = self._server.gui, self._labels
        gui.reset()
        gui.set_panel_label(printable(self._scene.path))
        self._errors = gui.add_html('')
        with gui.add_folder('Show'):
            for label in dict.fromkeys(labels):
                self._add_switch(f'/frames/{label}', f'{label} ({labels.count(label)})')
            for name in ('/names', '/lines to parents', '/visuals', '/collisions'):
                self._add_switch(name, name[1:])
            opacity = gui.add_slider('opacity', 0.1, 1.0, 0.05, self._opacity)

        @opacity.on_update
        def _(_: object) -> None:
            with self._lock, self._server.atomic():
                self._opacity = opacity.value
                for copies in self._copies:
                    copies.opacity = self._opacity if self._opacity < 1.0 else None

        models = [
            element for element in dict.fromkeys(self._tops.tolist())
            if element >= 0 and self._scene.kinds[element] == Kind.MODEL
            and self._is_in_model[element]]
        if 1 < len(models) <= _MOST_SWITCHES:
            with gui.add_folder('Models', expand_by_default=False):
                for element in models:
                    name = self._scene.names[element]
                    self._add_switch(name, printable(name), self._draw)
        if self._dofs:
            with gui.add_folder('Joints'):
                sliders = [self._add_slider(*each) for each in self._dofs.items()]
                zero = gui.add_button('all at zero')

            @zero.on_click
            def _(_: object) -> None:
                for slider in sliders:
                    slider.value = 0.0

        with gui.add_folder('Frames'):
            self._search = gui.add_text('search', '')
            self._rows = gui.add_html('')
            # The rows are labels of these buttons, which are not shown: HTML cannot do more.
            self._buttons = [
                gui.add_button('select')
                for _ in range(min(len(self._tree.frame_ids), MOST_ROWS))]
        self._search.on_update(lambda _: self._show_rows())
        for number, button in enumerate(self._buttons):
            button.on_click(lambda _, number=number: self._select(self._row_frames[number]))
        with gui.add_folder('Selected frame'):
            ids = (self._tree.root_frame, *self._tree.frame_ids[:_MOST_CHOICES])
            self._choice = gui.add_dropdown(
                'in', ids,
                initial_value=self._reference if self._reference in ids else ids[0])
            self._description = gui.add_html('')

        @self._choice.on_update
        def _(_: object) -> None:
            self._reference = self._choice.value
            self._show_frame()

        self._show_rows()
        self._show_frame()

    def _add_switch(
        self, name: str, label: str, redraw: Callable[[], object] | None = None,
    ) -> None:
        switch = self._server.gui.add_checkbox(label, name not in self._hidden)

        @switch.on_update
        def _(_: object) -> None:
            with self._lock, self._server.atomic():
                (self._hidden.discard if switch.value else self._hidden.add)(name)
                if redraw is not None:
                    redraw()
                elif name in self._nodes:
                    self._nodes[name].visible = switch.value
                    self._place_names()

    def _show_rows(self) -> None:
        with self._lock:
            rows = list(islice(rows_of_tree(self._tree, self._search.value), len(self._buttons)))
            self._row_frames = [frame for frame, _, _ in rows]
            ids = self._tree.frame_ids
            content = ''.join(
                f'<label for="{button._impl.uuid}" style="padding-left:{depth}em"'  # noqa: SLF001
                f'{" class=selected" if ids[frame] == self._selected else ""}>'
                f'{escaped(text)}</label>'
                for button, (frame, depth, text) in zip(self._buttons, rows, strict=False))
            if not self._search.value and len(rows) < len(ids):
                content += f'{len(ids) - len(rows)} more, to be found by the search'
            self._rows.content = f'{_ROWS_STYLE}<div class="rows">{content}</div>'

    def _select(self, frame: int) -> None:
        with self._lock:
            if 0 <= frame < len(self._tree.frame_ids):
                self._selected = self._tree.frame_ids[frame]
                self._show_rows()
                self._show_frame()

    def _show_frame(self) -> None:
        """Describe the selected frame, and mark it in the scene."""
        with self._lock:
            ids, marked = self._tree.frame_ids, self._nodes.get('/selected')
            frame = ids.index(self._selected) if self._selected in ids else NO_PARENT
            if marked is not None:
                marked.visible = frame != NO_PARENT
            if frame == NO_PARENT:
                self._description.content = _HOW_TO_SELECT
                return
            reference = ids.index(self._reference) if self._reference in ids else ROOT_IS_PARENT
            self._description.content = html_of_frame(
                self._scene, self._tree, frame, reference, self._units)
            if marked is not None:
                pose = self._tree.poses[frame]
                marked.position, marked.wxyz = pose[:3], pose[_WXYZ]

    # The scene

    def _draw(self) -> list[NotDrawn]:
        """Draw everything anew."""
        scene, tree, nodes = self._scene, self._tree, self._server.scene
        nodes.reset()
        nodes.add_light_hemisphere('/light', ground_color=(160, 160, 160), intensity=1.5)
        is_shown = self._is_in_model & ~np.isin(
            self._tops, [scene.index(name) for name in self._hidden if scene.has(name)])
        size_m = float(np.ptp(tree.poses[:, :3], axis=0).max(initial=0.0)) or 1.0
        self._surfaces, not_drawn = surfaces_from_scene(
            scene, [element for element in scene.shapes if is_shown[element]], size_m,
            self._meshes)
        self._bounds = bounds_of_scene(scene, tree.poses[:, :3], self._surfaces)
        self._size_m = float(np.ptp(self._bounds, axis=0).max()) or 1.0
        # A floor is often much larger than what stands on it.
        origins = tree.poses[:, :3]
        self._corners = np.array([origins.min(axis=0), origins.max(axis=0)]) if len(
            origins) else self._bounds
        self._view_m = max(float(np.ptp(self._corners, axis=0).max()), 0.3 * self._size_m)
        self._shown = np.flatnonzero(is_shown[self._elements])
        length_m = self._length_of_axes()
        self._nodes = {
            name: nodes.add_frame(name, show_axes=False, visible=name not in self._hidden)
            for name in ('/frames', '/names', '/visuals', '/collisions')}
        self._nodes['/selected'] = nodes.add_frame(
            '/selected', axes_length=2.0 * length_m, axes_radius=0.08 * length_m, visible=False)
        self._nodes['/lines to parents'] = nodes.add_line_segments(
            '/lines to parents', self._lines(), (134, 142, 150), thickness=0.002 * self._view_m,
            visible='/lines to parents' not in self._hidden)
        self._axes: list[tuple[Any, NDArray[np.intp]]] = []
        for label in dict.fromkeys(self._labels):
            frames = np.array([
                frame for frame in self._shown.tolist() if self._labels[frame] == label], int)
            name, poses = f'/frames/{label}', tree.poses[frames]
            axes = nodes.add_batched_axes(
                name, poses[:, _WXYZ], poses[:, :3], axes_length=length_m,
                axes_radius=0.05 * length_m, visible=name not in self._hidden)
            axes.on_click(lambda event, frames=frames: self._select(frames[event.instance_index]))
            self._nodes[name] = axes
            self._axes.append((axes, frames))
        self._copies = [
            self._add_surface(number, surface) for number, surface in enumerate(self._surfaces)]
        self._names: list[viser.LabelHandle] = []
        self._place_names()
        self._show_frame()
        return not_drawn

    def _add_surface(self, number: int, surface: Surface) -> Any:
        poses = self._scene.poses[surface.elements]
        copies = self._server.scene.add_batched_meshes_simple(
            f'/{surface.kind.label}s/{number}', surface.triangles.points, surface.triangles.faces,
            poses[:, _WXYZ], poses[:, :3], batched_scales=surface.scales,
            batched_colors=np.round(255.0 * np.clip(surface.rgba[:, :3], 0.0, 1.0)).astype(
                np.uint8),
            batched_opacities=surface.rgba[:, 3] if (surface.rgba[:, 3] < 1.0).any() else None,
            opacity=self._opacity if self._opacity < 1.0 else None, lod='off', flat_shading=True,
            side='double')
        copies.on_click(lambda event: self._select(
            int(self._tree.nearest_frames[surface.elements[event.instance_index or 0]])))
        return copies

    def _place(self) -> None:
        """Move what is drawn to where the joints put it."""
        for axes, frames in self._axes:
            _set_poses(axes, self._tree.poses[frames])
        for copies, surface in zip(self._copies, self._surfaces, strict=True):
            _set_poses(copies, self._scene.poses[surface.elements])
        self._nodes['/lines to parents'].points = self._lines()
        self._place_names()
        self._show_frame()

    def _lines(self) -> NDArray[np.float64]:
        """Return lines from the parents of frames to the frames, shape (n, 2, 3)."""
        frames = self._shown[self._tree.parents[self._shown] != NO_PARENT]
        # The last entry is the root frame, which the index of the root as a parent means.
        origins = np.concatenate([self._tree.poses[:, :3], np.zeros((1, 3))])
        assert ROOT_IS_PARENT == -1
        return np.stack([origins[self._tree.parents[frames]], origins[frames]], axis=1)

    def _place_names(self) -> None:
        if '/names' in self._hidden:
            return
        frames = [frame for frame in self._shown.tolist()
                  if f'/frames/{self._labels[frame]}' not in self._hidden]
        texts = [printable(shortened(self._tree.frame_ids[frame].rpartition('/')[2]))
                 for frame in frames]
        count = 0
        for count, (text, point) in enumerate(names_at_places(
                texts, self._tree.poses[frames, :3], 0.025 * self._view_m), 1):
            if count > len(self._names):
                self._names.append(self._server.scene.add_label(
                    f'/names/{count}', text, position=point, font_screen_scale=0.8))
                continue
            label = self._names[count - 1]
            label.position = point
            if label.text != text:
                label.text = text
        while len(self._names) > count:
            self._names.pop().remove()

    def _length_of_axes(self) -> float:
        """Return the length of axes, in metres: short where frames are near to one another."""
        distances_m = np.linalg.norm(self._tree.transforms[:, :3], axis=1)
        distances_m = distances_m[distances_m > 1e-6 * self._size_m]
        typical_m = float(np.median(distances_m)) if len(distances_m) else self._size_m
        return min(max(0.4 * typical_m, 0.01 * self._size_m), 0.1 * self._size_m)

    def _look_at_everything(self) -> None:
        camera, corners = self._server.initial_camera, self._corners
        camera.look_at = corners.mean(axis=0)
        camera.position = corners.mean(axis=0) + 1.6 * self._view_m * _DIRECTION_TO_EYE
        camera.near, camera.far = 0.001 * self._size_m, 100.0 * self._size_m
        camera.fov = 0.8


def _set_poses(node: Any, poses: PoseArray) -> None:
    node.batched_positions = poses[:, :3].astype(np.float32)
    node.batched_wxyzs = poses[:, _WXYZ].astype(np.float32)


def _tops_of_scene(scene: Scene) -> NDArray[np.intp]:
    """Return the outermost element around each, below a world or implicit root; -1 for these."""
    tops: list[int] = []
    for element, parent in enumerate(scene.parents.tolist()):
        tops.append(-1 if parent < 0 else element if tops[parent] < 0 else tops[parent])
    return np.array(tops)


def _elements_of_frames(tree: TfTree) -> NDArray[np.intp]:
    """Return the element of each frame; of an optical frame that of its parent."""
    elements = tree.elements.tolist()
    for frame, parent in enumerate(tree.parents.tolist()):
        if elements[frame] < 0:
            elements[frame] = elements[parent]
    return np.array(elements, int)
