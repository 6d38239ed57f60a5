# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The page: its server, its controls and their actions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial
from itertools import cycle
from pathlib import Path

import numpy as np
import viser

from sdf_pose_bridge.cli.printing import DEGREES, RADIANS, Units
from sdf_pose_bridge.cli.viewer.browser_script import html_of_data, page_with_script
from sdf_pose_bridge.cli.viewer.drawing import Drawing, GROUPS, HIDDEN_AT_FIRST
from sdf_pose_bridge.cli.viewer.frame_texts import (
    html_of_lines,
    html_of_moved,
    html_of_place,
    html_of_reasons,
)
from sdf_pose_bridge.cli.viewer.joint_sliders import JointSliders
from sdf_pose_bridge.cli.viewer.meshes import MeshReader
from sdf_pose_bridge.cli.viewer.pose_edit import EditedFrame, PoseEdit, SetPose
from sdf_pose_bridge.cli.viewer.selected_frame import SelectedFrame
from sdf_pose_bridge.cli.viewer.server import Events, server_for_its_owner
from sdf_pose_bridge.cli.viewer.shown_scene import ShownScene
from sdf_pose_bridge.cli.viewer.view_point import (
    bounds_of_points,
    DIRECTIONS,
    FIELD_OF_VIEW_RAD,
    View,
    view_in_window,
    view_of_bounds,
)
from sdf_pose_bridge.geometry.poses import relative_pose
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.tf.joint_positions import scene_at_positions
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT

_ANGLES = {unit.name: unit for unit in (RADIANS, DEGREES)}


class Page:
    """
    The page of a file; one thread processes the requests of browsers.

    :param shown: the scene that it shows at first.
    :param port: its port, or the next one that is free; 0 for any.
    :param units: the units of poses and sliders at first.
    :param meshes: reads the meshes.
    :param set_pose: writes a pose into the file; None if frames cannot be moved.
    :param hidden: groups and kinds of frames that are hidden at first.
    """

    def __init__(
        self, shown: ShownScene, port: int, units: Units, meshes: MeshReader,
        set_pose: SetPose | None = None, hidden: Iterable[str] = HIDDEN_AT_FIRST,
    ) -> None:
        title = printable(Path(shown.loaded.path).name)
        self._server, self.address = server_for_its_owner(port, title)
        gui = self._server.gui
        self._shown, self._units, self._hidden = shown, units, set(hidden)
        self._events, self._meshes = Events(), meshes
        gui.set_panel_label(title)
        self._strip, self._reasons, self._names, self._labels = (
            gui.add_html('') for _ in range(4))
        gui.add_html(html_of_data('path', str(Path(shown.loaded.path).resolve())))
        gui.add_html('<div class="asked"></div>')
        asked = gui.add_text('asked', '')
        self._events.when(asked.on_update, lambda: self._answer(asked.value.partition(' ')[2]))
        self._errors: Iterable[str] = ()
        self._edit = None if set_pose is None else PoseEdit(
            self._server, set_pose, self._events, self._describe)
        place_of_selected = gui.add_folder(None)
        self._add_view_controls()
        self._switches = self._add_switches()
        self._sliders, self._joints = self._add_joints({})
        self._posed = shown.at(self._joints.positions)
        self._positions = dict(self._joints.positions)
        self._selected = SelectedFrame(
            gui, place_of_selected, self._posed, self._events, self._show_frame)
        self._node_names = cycle(('/drawing', '/other drawing'))
        self._drawing = self._new_drawing()
        camera = self._server.initial_camera
        camera.position, camera.look_at = self._drawing.home
        camera.fov = FIELD_OF_VIEW_RAD
        camera.near, camera.far = 0.001 * self._drawing.size_m, 100.0 * self._drawing.size_m
        self._server.on_client_connect(
            lambda client: self._events.put(partial(self._add_client, client)))
        self._describe()

    @property
    def reasons(self) -> list[str]:
        """Lines about shapes that cannot be drawn."""
        return self._drawing.reasons

    def html(self, title: str) -> str:
        """Return the scene, without controls, as a page that needs no network."""
        page: str = self._server.get_scene_serializer().as_html()
        return page_with_script(page, printable(title), self._names.content + self._labels.content)

    def close(self) -> None:
        """End the server."""
        self._server.stop()

    def show(self, shown: ShownScene) -> None:
        """
        Show a scene instead of the one before.

        Hidden groups, the selected frame and the positions of joints stay.
        """
        with self._server.atomic():
            before, self._shown = self._shown, shown
            if shown.kinds != before.kinds:
                self._switches.remove()
                self._switches = self._add_switches(self._switches.order)
            # Many sliders take a browser long.
            if shown.joints != before.joints:
                self._replace_joints()
            self._move()
            self._selected.list_frames(self._posed)
            self._redraw()
            self.show_errors([])

    def show_errors(self, lines: Iterable[str]) -> None:
        """Show the errors of a file, a line for each, over its last scene."""
        self._errors = lines
        self._describe()

    def act(self, seconds: float) -> None:
        """Process the requests of browsers; wait no longer than this for them."""
        actions = self._events.asked(seconds)
        with self._server.atomic():
            for action in actions:
                action()
            next(self._joints.moves, None)
            if self._positions != self._joints.positions:
                self._move()
                self._show_frame()
            # While a gizmo moves, there is no time to read a file.
            if not actions and self._edit is not None:
                self._edit.look_ahead()

    # Drawing

    def _move(self) -> None:
        self._positions = dict(self._joints.positions)
        self._posed = self._shown.at(self._positions)

    def _new_drawing(self) -> Drawing:
        drawing = Drawing(
            self._server.scene, next(self._node_names), self._meshes, self._shown, self._posed,
            self._hidden, self._selected.hidden,
            lambda frame: self._events.put(partial(self._selected.select, frame)))
        self._drawn = self._posed
        self._reasons.content = html_of_reasons(drawing.reasons)
        self._names.content = html_of_data('names', drawing.names)
        return drawing

    def _redraw(self) -> None:
        self._drawing.remove()
        self._drawing = self._new_drawing()
        self._show_frame()

    def _show_frame(self) -> None:
        """Show the selected frame at its current pose."""
        if self._edit is None:
            self._describe()
        else:
            self._edit.begin(self._edited_frame(), self._units)

    def _edited_frame(self) -> EditedFrame | None:
        tree, positions = self._posed.tree, dict(self._positions)
        frame, reference = self._selected.frame, self._selected.reference
        if frame < 0 or tree.elements[frame] < 0:
            return None
        return EditedFrame(
            self._shown.loaded, int(tree.elements[frame]), self._posed.pose_of(frame),
            self._posed.pose_of(reference), tree.frame_ids[frame],
            lambda scene, element: scene_at_positions(scene, positions).pose_of(element))

    def _describe(self) -> None:
        """Describe the selected frame, and mark it in the scene at its current or new pose."""
        frame, pose = self._selected.frame, None if self._edit is None else self._edit.pose
        if frame >= 0 and pose is None:
            pose = self._posed.pose_of(frame)
        ahead = None if self._edit is None else self._edit.scene_ahead
        drawn = self._posed if ahead is None else self._shown.at(self._positions, ahead)
        if drawn is not self._drawn:
            self._drawing.place(drawn)
            self._drawn = drawn
        tree, reference = self._posed.tree, self._selected.reference
        origin, place = self._posed.pose_of(reference), ''
        if pose is not None:
            place = html_of_place(
                tree.frame_ids[frame], (*tree.frame_ids, tree.root_frame)[reference],
                relative_pose(origin, pose), self._units)
        self._drawing.mark(
            drawn.tree, frame, pose, None if reference == ROOT_IS_PARENT else origin,
            self._units.length)
        self._labels.content = html_of_data('labels', self._drawing.labels(drawn, frame, pose))
        self._selected.describe(drawn, pose, self._units)
        self._strip.content = html_of_data(
            'strip', f'{html_of_lines("errors", self._errors)}{place}'
            f'{html_of_moved(tree, drawn.tree, frame)}'
            f'{"" if self._edit is None else self._edit.html}')

    def _add_client(self, client: viser.ClientHandle) -> None:
        if client.camera.aspect < 1.0:
            self._turn(client, self._drawing.home)

    # Controls

    def _answer(self, ask: str) -> None:
        """Do what was clicked outside of the controls."""
        verb, _, frame = ask.partition(' ')
        if verb == 'select':
            self._selected.select(int(frame))
        elif verb in {'fold', 'hide'}:
            self._selected.toggle(verb, int(frame))
            if verb == 'hide':
                self._redraw()
        elif self._edit is not None and ask in self._edit.actions:
            self._edit.actions[ask]()

    def _add_switches(self, order: float | None = None) -> viser.GuiFolderHandle:
        """Add the folder "Show"."""
        switches = self._server.gui.add_folder('Show', expand_by_default=False, order=order)
        with switches:
            for name in (*self._shown.kinds, *GROUPS):
                self._add_switch(name)
        return switches

    def _add_joints(
        self, positions: Mapping[str, float], order: float | None = None,
    ) -> tuple[viser.GuiFolderHandle, JointSliders]:
        """Add the folder "Joints"."""
        folder = self._server.gui.add_folder(None, order=order)
        with folder:
            return folder, JointSliders(
                self._server.gui, self._shown.joints, positions, self._units, self._events)

    def _replace_joints(self) -> None:
        self._sliders.remove()
        self._sliders, self._joints = self._add_joints(
            self._joints.positions, self._sliders.order)

    def _add_switch(self, name: str) -> None:
        switch = self._server.gui.add_checkbox(printable(name), name not in self._hidden)

        def change() -> None:
            (self._hidden.discard if switch.value else self._hidden.add)(name)
            self._redraw()
        self._events.when(switch.on_update, change)

    def _add_view_controls(self) -> None:
        """Add the folder "View"."""
        gui = self._server.gui
        with gui.add_folder('View'):
            views = gui.add_button_group('view', ('home', *DIRECTIONS, 'zoom to'))
            opacity = gui.add_slider('opacity', 0.1, 1.0, 0.05, 1.0)
            angles = gui.add_dropdown(
                'angles', tuple(_ANGLES), initial_value=self._units.angle.name)
            dark = gui.add_checkbox('dark background', initial_value=False)
            shown_opacity = gui.add_html('')

        def change_angles() -> None:
            self._units = self._units._replace(angle=_ANGLES[angles.value])
            self._replace_joints()
            self._show_frame()
        self._events.when(views.on_click, lambda: self._look(views.value))
        self._events.when(opacity.on_update, lambda: setattr(
            shown_opacity, 'content', html_of_data('opacity', str(opacity.value))))
        self._events.when(angles.on_update, change_angles)
        self._events.when(dark.on_update, lambda: gui.configure_theme(
            show_logo=False, show_share_button=False, dark_mode=dark.value))

    def _look(self, name: str) -> None:
        """Turn the cameras to a view; "zoom to" shows the selected frame, link or model."""
        drawing = self._drawing
        view = drawing.home
        if name in DIRECTIONS:
            view = view_of_bounds(drawing.bounds, DIRECTIONS[name])
        elif name == 'zoom to' and self._selected.frame >= 0:
            tree, frame = self._posed.tree, self._selected.frame
            origin, half_m = tree.poses[frame, :3], 3.0 * drawing.axes_length_m
            boxes = drawing.boxes(self._posed, self._shown.is_in(int(tree.elements[frame])))
            view = view_of_bounds(bounds_of_points(np.concatenate([
                [origin - half_m, origin + half_m], boxes.reshape(-1, 3)])),
                view.position - view.look_at)
        for client in self._server.get_clients().values():
            self._turn(client, view)

    def _turn(self, client: viser.ClientHandle, view: View) -> None:
        with client.atomic():
            client.camera.position, client.camera.look_at = view_in_window(
                view, client.camera.aspect)
            client.camera.up_direction = 0.0, 0.0, 1.0
