# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The page: its server, its controls, and what its sliders, buttons and clicks do."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from itertools import islice
from queue import Empty
from queue import SimpleQueue
from typing import Any

import numpy as np

from sdf_pose_bridge.cli.printing import kind_labels_of
from sdf_pose_bridge.cli.printing import Units
from sdf_pose_bridge.cli.viewer.browser_script import html_of_frame_names
from sdf_pose_bridge.cli.viewer.browser_script import page_with_script
from sdf_pose_bridge.cli.viewer.drawing import Drawing
from sdf_pose_bridge.cli.viewer.drawing import GROUPS
from sdf_pose_bridge.cli.viewer.drawing import HIDDEN_AT_FIRST
from sdf_pose_bridge.cli.viewer.frame_texts import escaped
from sdf_pose_bridge.cli.viewer.frame_texts import html_of_change
from sdf_pose_bridge.cli.viewer.frame_texts import html_of_difference
from sdf_pose_bridge.cli.viewer.frame_texts import html_of_frame
from sdf_pose_bridge.cli.viewer.frame_texts import html_of_lines
from sdf_pose_bridge.cli.viewer.frame_texts import rows_of_tree
from sdf_pose_bridge.cli.viewer.joint_sliders import add_joint_sliders
from sdf_pose_bridge.cli.viewer.joint_sliders import JointRange
from sdf_pose_bridge.cli.viewer.joint_sliders import range_of_dof
from sdf_pose_bridge.cli.viewer.meshes import MeshReader
from sdf_pose_bridge.cli.viewer.server import id_of_button
from sdf_pose_bridge.cli.viewer.server import server_for_its_owner
from sdf_pose_bridge.cli.viewer.view_point import DIRECTIONS
from sdf_pose_bridge.cli.viewer.view_point import view_of_bounds
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.geometry.chains import ends_from_pointers
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.scene.pose_setting import PoseChange
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.file_change import FileChange
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.include.uris import ResourceFinder
from sdf_pose_bridge.tf.joint_motion import JointMotion
from sdf_pose_bridge.tf.joint_positions import JointPositions
from sdf_pose_bridge.tf.joint_positions import scene_at_positions
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT
from sdf_pose_bridge.tf.parents import tf_parents_from_scene
from sdf_pose_bridge.tf.tree import elements_in_model
from sdf_pose_bridge.tf.tree import tf_tree_from_scene
from sdf_pose_bridge.tf.tree import TfOptions

MOST_ROWS = 300
"""How many rows of the tree of frames are in the page at once; a search finds the others."""

_MOST_SWITCHES = 50
_MOST_CHOICES = 1000
_ROWS_STYLE = ('<style>.rows{max-height:40vh;overflow:auto;margin:0 1em;font-size:0.8em}'
               '.rows label{display:block;cursor:pointer;white-space:pre}'
               '.rows .selected{font-weight:bold}div:has(>.rows)~*{display:none}</style>')
_HOW_TO_SELECT = '<div style="margin:0 1em;font-size:0.8em">Click one above or in the scene.</div>'


class Page:
    """
    The page of a file; one thread does what browsers ask for.

    :param port: its port, or the next one that is free; 0 for any.
    :param options: which elements are frames, and how they are named.
    :param units: the units of poses and sliders.
    :param finder: finds the meshes.
    :param hidden: what is not shown until it is switched on.
    :param set_pose: puts a pose into the file, as ``sdf_pose_bridge.cli.set.set_pose`` does, of
        which it has the arguments but for the options; None if frames cannot be dragged.
    """

    def __init__(
        self, port: int, options: TfOptions, units: Units, finder: ResourceFinder,
        set_pose: Callable[..., PoseChange] | None = None,
        hidden: Iterable[str] = HIDDEN_AT_FIRST,
    ) -> None:
        self._server, self.address = server_for_its_owner(port)
        self._options, self._units, self._set_pose = options, units, set_pose
        self._meshes = MeshReader(finder)
        self._actions: SimpleQueue[Callable[[], object]] = SimpleQueue()
        self._drawing = Drawing(
            self._server, self._meshes,
            lambda frame: self._actions.put(partial(self._select, frame)))
        self._positions: dict[str, float] = {}
        self._selected = ''
        self._dragged: Pose | None = None
        self._undone: FileChange | None = None
        self._hidden = set(hidden)
        self._listed: object = None
        self._is_dark = False
        self._server.on_client_connect(
            lambda client: self._when(
                client.camera.on_update, partial(self._drawing.look_from, client.camera)))

    def html(self, title: str) -> str:
        """Return the scene, without controls, as a page that needs no network."""
        page: str = self._server.get_scene_serializer().as_html()
        return page_with_script(page, printable(title), html_of_frame_names(self._names_of_axes()))

    def close(self) -> None:
        """End the server, and the process that reads meshes."""
        self._meshes.close()
        self._server.stop()

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
        self._is_in_model = elements_in_model(scene, self._options.model) & (scene.roots == 0)
        with self._server.atomic():
            self._loaded, self._tree = scene, tree
            # The outermost element around each, below the world or the implicit root.
            self._tops = ends_from_pointers(
                np.where(scene.parents[scene.parents] < 0, -1, scene.parents))
            ranges = self._find_joints()
            positions = {
                name: limits.clipped(self._positions.get(name, 0.0))
                for name, limits in ranges.items()}
            # The sliders change this dictionary.
            self._positions.clear()
            self._positions.update(positions)
            self._move()
            self._models = {
                f'model {scene.names[element]}': element
                for element in np.unique(self._tops).tolist()
                if scene.kinds[element] == Kind.MODEL and self._is_in_model[element]}
            switches = *dict.fromkeys(kind_labels_of(scene, tree)), *GROUPS
            listed = scene.path, switches, list(self._models), ranges
            if self._listed != listed:
                self._listed = listed
                self._add_controls(switches, ranges)
            self._list_frames()
            self.show_errors([])
            return self._draw()

    def show_errors(self, lines: Iterable[str]) -> None:
        """Show the errors of a file, a line for each, above its last scene."""
        self._errors.content = html_of_lines('errors', lines)

    def act(self, seconds: float) -> None:
        """Do what browsers ask for; wait for it, but no longer than this."""
        try:
            action = self._actions.get(timeout=seconds)
        except Empty:
            return
        with self._server.atomic():
            action()
            while not self._actions.empty():
                self._actions.get()()
            if self._drawn_positions != self._positions:
                self._move()
                self._show_frame()
            self._drawing.place(self._scene, self._tree)

    def _when(self, happens: Callable[..., object], action: Callable[[], object]) -> None:
        """Let :meth:`act` call a function for each event."""
        async def put(_: object) -> None:
            self._actions.put(action)
        happens(put)

    def _draw(self) -> list[str]:
        hidden = [element for name, element in self._models.items() if name in self._hidden]
        is_shown = self._is_in_model & ~np.isin(self._tops, hidden)
        reasons = self._drawing.draw(
            self._scene, self._tree, is_shown, self._is_in_robot, self._hidden)
        self._names.content = html_of_frame_names(self._names_of_axes())
        self._when(self._drawing.gizmo.on_update, self._drag)
        self._show_frame()
        lines = [
            f'{"1 shape is" if count == 1 else f"{count} shapes are"} not drawn as the file means '
            f'it: {printable(reason)}' for reason, count in Counter(reasons).items()]
        self._reasons.content = html_of_lines('reasons', lines)
        return lines

    def _names_of_axes(self) -> list[str]:
        return [printable(self._tree.frame_ids[frame]) for frame in self._drawing.frames]

    # Joints

    def _find_joints(self) -> dict[str, JointRange]:
        """Find the degrees of freedom in the models shown that do not follow another."""
        dofs = JointMotion(self._loaded, tf_parents_from_scene(self._loaded)).dofs
        names = JointPositions(self._loaded, dofs).names
        self._is_in_robot = np.isin(self._tops, self._tops[[dof.joint.element for dof in dofs]])
        return {
            name: range_of_dof(dof, self._units) for name, dof in zip(names, dofs, strict=True)
            if self._is_in_model[dof.joint.element] and dof.axis.mimic is None}

    def _move(self) -> None:
        self._drawn_positions = dict(self._positions)
        self._scene = scene_at_positions(self._loaded, self._drawn_positions)
        self._tree = tf_tree_from_scene(self._scene, self._options)

    # Controls

    def _add_controls(
        self, switches: tuple[str, ...], ranges: dict[str, JointRange],
    ) -> None:
        gui = self._server.gui
        gui.reset()
        # What was asked for until now, was asked by controls that are gone.
        self._actions = SimpleQueue()
        gui.set_panel_label(printable(self._loaded.path))
        self._errors, self._reasons, self._names = (gui.add_html('') for _ in range(3))
        self._write, self._cancel, self._undo = (
            gui.add_button(label, visible=False)
            for label in ('write to file', 'cancel', 'undo the last write'))
        self._undo.visible = self._undone is not None
        with gui.add_folder('View'):
            self._add_controls_of_looks()
        with gui.add_folder('Show', expand_by_default=False):
            for name in switches:
                self._add_switch(name)
        if 1 < len(self._models) <= _MOST_SWITCHES:
            with gui.add_folder('Models', expand_by_default=False):
                for name in self._models:
                    self._add_switch(name)
        if ranges:
            add_joint_sliders(gui, ranges, self._positions, self._when)
        self._folder_of_frames = gui.add_folder('Frames')
        with self._folder_of_frames:
            self._search = gui.add_text('search', '')
            self._rows = gui.add_html('')
        self._when(self._search.on_update, self._show_rows)
        # The rows are labels of these buttons, which are not shown: HTML cannot do more.
        self._buttons: list[Any] = []
        with gui.add_folder('Selected frame'):
            self._choice = gui.add_dropdown(
                'relative to', (self._tree.root_frame,), hint='for the pose and the distance')
            measure = gui.add_button(
                'measure from this frame', hint='to the frames that are selected next')
            self._description = gui.add_html('')
        self._when(self._choice.on_update, self._show_frame)
        self._when(measure.on_click, self._measure_from_here)
        self._when(self._write.on_click, self._write_pose)
        self._when(self._cancel.on_click, self._show_frame)
        self._when(self._undo.on_click, self._undo_write)

    def _add_controls_of_looks(self) -> None:
        gui, drawing = self._server.gui, self._drawing
        views = gui.add_button_group('view', ('home', *DIRECTIONS, 'zoom to'))
        self._when(views.on_click, lambda: self._look(views.value))
        opacity = gui.add_slider('opacity', 0.1, 1.0, 0.05, drawing.opacity)
        self._when(opacity.on_update, lambda: drawing.set_opacity(opacity.value))
        dark = gui.add_checkbox('dark background', self._is_dark)

        def change() -> None:
            self._is_dark = dark.value
            gui.configure_theme(show_logo=False, show_share_button=False, dark_mode=dark.value)
        self._when(dark.on_update, change)

    def _look(self, name: str) -> None:
        """Turn the cameras to a view, or to the selected frame for "zoom to"."""
        drawing = self._drawing
        view = drawing.home
        if name in DIRECTIONS:
            view = view_of_bounds(drawing.bounds, DIRECTIONS[name])
        elif name == 'zoom to' and self._selected in self._tree.frame_ids:
            origin = self._tree.poses[self._tree.frame_ids.index(self._selected), :3]
            half_m = 3.0 * drawing.axes_length_m
            view = view_of_bounds(
                np.array([origin - half_m, origin + half_m]), view.position - view.look_at)
        for client in self._server.get_clients().values():
            with client.atomic():
                client.camera.position, client.camera.look_at = view
                client.camera.up_direction = 0.0, 0.0, 1.0

    def _add_switch(self, name: str) -> None:
        switch = self._server.gui.add_checkbox(printable(name), name not in self._hidden)

        def change() -> None:
            (self._hidden.discard if switch.value else self._hidden.add)(name)
            self._draw()
        self._when(switch.on_update, change)

    # Frames

    def _list_frames(self) -> None:
        ids = self._tree.frame_ids
        self._choice.options = (self._tree.root_frame, *ids[:_MOST_CHOICES])
        with self._folder_of_frames:
            for number in range(len(self._buttons), min(len(ids), MOST_ROWS)):
                self._buttons.append(self._server.gui.add_button('select'))
                self._when(self._buttons[-1].on_click, partial(self._select_row, number))
        self._show_rows()

    def _show_rows(self) -> None:
        rows = list(islice(rows_of_tree(self._tree, self._search.value), len(self._buttons)))
        self._row_frames = [frame for frame, _, _ in rows]
        ids = self._tree.frame_ids
        content = ''.join(
            f'<label for="{id_of_button(button)}" style="padding-left:{depth}em"'
            f'{" class=selected" if ids[frame] == self._selected else ""}>'
            f'{escaped(text)}</label>'
            for button, (frame, depth, text) in zip(self._buttons, rows, strict=False))
        if not self._search.value and len(rows) < len(ids):
            content += f'{len(ids) - len(rows)} more, to be found by the search'
        self._rows.content = f'{_ROWS_STYLE}<div class="rows">{content}</div>'

    def _select_row(self, number: int) -> None:
        # What was clicked may be gone by now.
        if number < len(self._row_frames):
            self._select(self._row_frames[number])

    def _select(self, frame: int) -> None:
        if 0 <= frame < len(self._tree.frame_ids):
            self._selected = self._tree.frame_ids[frame]
            self._show_rows()
            self._show_frame()

    def _measure_from_here(self) -> None:
        if self._selected in self._choice.options:
            self._choice.value = self._selected

    def _show_frame(self) -> None:
        """Describe the selected frame, and mark it in the scene."""
        gizmo, ids, self._dragged = self._drawing.gizmo, self._tree.frame_ids, None
        self._write.visible = self._cancel.visible = gizmo.visible = False
        if self._selected not in ids:
            self._drawing.mark(-1, None)
            self._description.content = _HOW_TO_SELECT
            return
        frame = ids.index(self._selected)
        pose = Pose(*self._tree.poses[frame].tolist())
        self._describe(frame, pose)
        if self._set_pose is not None and self._tree.elements[frame] >= 0:
            change = self._change(pose, dry_run=True)
            self._description.content += html_of_change(change)
            gizmo.position, gizmo.wxyz = pose[:3], (pose.qw, *pose[3:6])
            gizmo.visible = isinstance(change, PoseChange)

    def _drag(self) -> None:
        gizmo = self._drawing.gizmo
        if gizmo.visible:
            w, x, y, z = gizmo.wxyz.tolist()
            self._dragged = Pose(*(*gizmo.position.tolist(), x, y, z, w))
            self._describe(self._tree.frame_ids.index(self._selected), self._dragged)
            self._write.visible = self._cancel.visible = True

    def _describe(self, frame: int, pose: Pose) -> None:
        self._drawing.mark(frame, pose)
        poses = self._tree.poses.copy()
        poses[frame] = pose
        other, ids = self._choice.value, self._tree.frame_ids
        reference = ids.index(other) if other in ids else ROOT_IS_PARENT
        text = html_of_frame(
            self._scene, replace(self._tree, poses=poses), frame, reference, self._units)
        if self._dragged is not None:
            text = html_of_difference(self._tree, frame, pose, reference, self._units) + text
        self._description.content = text

    def _write_pose(self) -> None:
        if self._dragged is not None:
            change = self._change(self._dragged, dry_run=False)
            self.show_errors([] if isinstance(change, PoseChange) else change)
            if isinstance(change, PoseChange):
                self._undone, self._undo.visible = change.file.undone, True

    def _undo_write(self) -> None:
        if self._undone is not None:
            try:
                self._undone.write()
            except SdfError as error:
                self.show_errors(map(str, error.errors))
                return
            self._undone, self._undo.visible = None, False

    def _change(self, pose: Pose, *, dry_run: bool) -> PoseChange | list[str]:
        """Put the selected frame there, in the file; return why if this is not possible."""
        def measured(scene: Scene, element: int) -> Pose:
            return scene_at_positions(scene, self._positions).pose_of(element)

        assert self._set_pose is not None
        element = int(self._tree.elements[self._tree.frame_ids.index(self._selected)])
        try:
            return self._set_pose(self._loaded, element, pose, measured, dry_run=dry_run)
        except SdfError as error:
            return list(map(str, error.errors))
