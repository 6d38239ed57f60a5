# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The controls of the page, and what its sliders, buttons and clicks do."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from collections.abc import Iterable
from dataclasses import replace
from itertools import islice
import math
import threading
from typing import Any
from typing import TYPE_CHECKING

import numpy as np
import viser

from sdf_pose_bridge.cli.printing import kind_labels_of
from sdf_pose_bridge.cli.printing import Units
from sdf_pose_bridge.cli.viewer.drawing import Drawing
from sdf_pose_bridge.cli.viewer.drawing import GIZMO
from sdf_pose_bridge.cli.viewer.drawing import GROUPS
from sdf_pose_bridge.cli.viewer.drawing import node_of_kind
from sdf_pose_bridge.cli.viewer.frame_texts import escaped
from sdf_pose_bridge.cli.viewer.frame_texts import html_of_frame
from sdf_pose_bridge.cli.viewer.frame_texts import pose_of_frame
from sdf_pose_bridge.cli.viewer.frame_texts import rows_of_tree
from sdf_pose_bridge.cli.viewer.meshes import MeshReader
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.joint_motion import DegreeOfFreedom
from sdf_pose_bridge.tf.joint_motion import JointMotion
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.joint_positions import scene_at_positions
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT
from sdf_pose_bridge.tf.parents import tf_parents_from_scene
from sdf_pose_bridge.tf.tree import elements_in_model
from sdf_pose_bridge.tf.tree import tf_tree_from_scene
from sdf_pose_bridge.tf.tree import TfOptions

if TYPE_CHECKING:
    from numpy.typing import NDArray

MOST_ROWS = 300
"""How many rows of the tree of frames are in the page at once; a search finds the others."""

_LARGEST_RANGE = 1000.0
"""A joint with a wider range counts as one without limits, which the page moves by half a turn or
half a metre to either side."""
_MOST_SWITCHES = 50
_MOST_CHOICES = 1000
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
    :param set_pose: puts a pose into the file, as ``sdf_pose_bridge.cli.set.set_pose`` does, of
        which it has the arguments but for the options; None if frames cannot be dragged.
    """

    def __init__(
        self, server: viser.ViserServer, options: TfOptions, units: Units, meshes: MeshReader,
        set_pose: Callable[..., object] | None = None,
    ) -> None:
        self._server, self._options, self._units = server, options, units
        self._set_pose = set_pose
        # The functions that viser calls run in many threads.
        self._lock = threading.RLock()
        self._is_moved = threading.Event()
        self._drawing = Drawing(server, meshes, self._select)
        self._positions: dict[str, float] = {}
        self._selected = self._reference = ''
        self._dragged: Pose | None = None
        self._loaded: Scene | None = None
        threading.Thread(target=self._follow_sliders, name='sliders', daemon=True).start()

    def show(self, scene: Scene) -> list[str]:
        """
        Show a scene instead of the one before.

        What is hidden, the frame that is selected and the positions of joints stay.

        :param scene: the scene, loaded with its shapes.
        :return: lines that say which shapes are not drawn as the file means them.
        :raises SdfError: if the scene has no TF tree, or a model to show does not exist; then the
            page stays as it is.
        """
        tree = tf_tree_from_scene(scene, self._options)
        is_in_model = elements_in_model(scene, self._options.model) & (scene.roots == 0)
        with self._lock, self._server.atomic():
            is_first = self._loaded is None
            self._loaded = self._scene = scene
            self._tree, self._is_in_model = tree, is_in_model
            self._tops = _tops_of_scene(scene)
            self._dofs = self._movable_dofs()
            self._positions = {
                name: value for name, value in self._positions.items() if name in self._dofs}
            self._move()
            self._add_controls()
            lines = [
                f'{"1 shape is" if count == 1 else f"{count} shapes are"} not drawn as the file '
                f'means it: {printable(reason)}'
                for reason, count in Counter(self._draw()).items()]
            self._show_lines('reasons', lines)
        if is_first:
            # This calls the function for browsers that have connected already, too.
            self._server.on_client_connect(self._follow_camera)
        return lines

    def show_errors(self, lines: Iterable[str]) -> None:
        """Show the errors of a file, a line for each, above its last scene."""
        with self._lock:
            self._show_lines('errors', lines)

    def _show_lines(self, name: str, lines: Iterable[str]) -> None:
        text = '\n'.join(map(escaped, lines))
        self._lines.content = text and f'<pre class="{name}" style="{_ERROR_STYLE}">{text}</pre>'

    def _draw(self) -> list[str]:
        hidden = [
            self._scene.index(name) for name in self._drawing.hidden if self._scene.has(name)]
        is_shown = self._is_in_model & ~np.isin(self._tops, hidden)
        reasons = self._drawing.draw(self._scene, self._tree, is_shown)
        self._show_frame()
        return reasons

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
        self._drawn_positions = dict(self._positions)
        self._scene = scene_at_positions(self._loaded, self._drawn_positions)
        self._tree = tf_tree_from_scene(self._scene, self._options)

    def _follow_sliders(self) -> None:
        """Draw what is newest; what is older by then is never drawn."""
        while True:
            self._is_moved.wait()
            self._is_moved.clear()
            with self._lock, self._server.atomic():
                if self._drawn_positions != self._positions:
                    self._move()
                    self._drawing.place(self._scene, self._tree)
                    self._show_frame()
                else:
                    self._drawing.place_names(self._tree)

    def _follow_camera(self, client: viser.ClientHandle) -> None:
        @client.camera.on_update
        def _(camera: viser.CameraHandle) -> None:
            self._drawing.camera = camera
            self._is_moved.set()

    def _add_slider(self, name: str, dof: DegreeOfFreedom) -> Any:
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
        def _(_: object) -> None:
            self._positions[name] = slider.value / factor
            self._is_moved.set()

        return slider

    # Controls

    def _add_controls(self) -> None:
        gui, labels = self._server.gui, kind_labels_of(self._scene, self._tree)
        gui.reset()
        gui.set_panel_label(printable(self._scene.path))
        self._lines = gui.add_html('')
        with gui.add_folder('Show'):
            for label in dict.fromkeys(labels):
                self._add_switch(node_of_kind(label), f'{label} ({labels.count(label)})')
            for name in GROUPS:
                self._add_switch(name, name[1:])
            opacity = gui.add_slider('opacity', 0.1, 1.0, 0.05, self._drawing.opacity)
        opacity.on_update(lambda _: self._set_opacity(opacity.value))
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
            self._write = gui.add_button('write to file', visible=False)
        self._choice.on_update(lambda _: self._choose(self._choice.value))
        self._write.on_click(lambda _: self._write_pose())
        self._show_rows()

    def _add_switch(
        self, name: str, label: str, redraw: Callable[[], object] | None = None,
    ) -> None:
        hidden = self._drawing.hidden
        switch = self._server.gui.add_checkbox(label, name not in hidden)

        @switch.on_update
        def _(_: object) -> None:
            with self._lock, self._server.atomic():
                (hidden.discard if switch.value else hidden.add)(name)
                if redraw is None:
                    self._drawing.set_visible(name, self._tree, visible=switch.value)
                else:
                    redraw()

    def _set_opacity(self, opacity: float) -> None:
        with self._lock, self._server.atomic():
            self._drawing.set_opacity(opacity)

    # Frames

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

    def _choose(self, reference: str) -> None:
        with self._lock:
            self._reference = reference
            self._show_frame()

    def _show_frame(self) -> None:
        """Describe the selected frame, and mark it in the scene."""
        ids, self._dragged = self._tree.frame_ids, None
        self._write.visible = False
        self._drawing.remove(GIZMO)
        if self._selected not in ids:
            self._drawing.mark(None)
            self._description.content = _HOW_TO_SELECT
            return
        frame = ids.index(self._selected)
        pose, element = pose_of_frame(self._tree, frame), int(self._tree.elements[frame])
        self._describe(frame, pose)
        if self._set_pose is None or element < 0:
            return
        try:
            self._put(element, pose, dry_run=True)
        except SdfError as error:
            self._description.content += f'<pre style="{_ERROR_STYLE}">{escaped(str(error))}</pre>'
            return
        gizmo = self._drawing.add_gizmo(pose)

        @gizmo.on_update
        def _(_: object) -> None:
            with self._lock:
                w, x, y, z = gizmo.wxyz.tolist()
                self._dragged = Pose(*(*gizmo.position.tolist(), x, y, z, w))
                self._describe(frame, self._dragged)
                self._write.visible = True

    def _describe(self, frame: int, pose: Pose) -> None:
        self._drawing.mark(pose)
        poses = self._tree.poses.copy()
        poses[frame] = pose
        ids = self._tree.frame_ids
        reference = ids.index(self._reference) if self._reference in ids else ROOT_IS_PARENT
        self._description.content = html_of_frame(
            self._scene, replace(self._tree, poses=poses), frame, reference, self._units)

    def _write_pose(self) -> None:
        with self._lock:
            if self._dragged is None:
                return
            frame = self._tree.frame_ids.index(self._selected)
            try:
                self._put(int(self._tree.elements[frame]), self._dragged)
            except SdfError as error:
                self.show_errors(map(str, error.errors))

    def _put(self, element: int, pose: Pose, *, dry_run: bool = False) -> None:
        def measured(scene: Scene, element: int) -> Pose:
            return scene_at_positions(scene, self._positions).pose_of(element)

        if self._set_pose is not None:
            self._set_pose(self._loaded, element, pose, measured, dry_run=dry_run)


def _tops_of_scene(scene: Scene) -> NDArray[np.intp]:
    """Return the outermost element around each, below a world or implicit root; -1 for these."""
    tops: list[int] = []
    for element, parent in enumerate(scene.parents.tolist()):
        tops.append(-1 if parent < 0 else element if tops[parent] < 0 else tops[parent])
    return np.array(tops)
