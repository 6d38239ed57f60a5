# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The page: its server, its controls in each tab of a browser, and their actions."""

from __future__ import annotations

from collections.abc import Iterable
import contextlib
from functools import partial
from itertools import cycle
import json
import math
from pathlib import Path
import threading
from typing import Any

import numpy as np
import viser

from sdf_pose_bridge import Pose, Scene
from sdf_pose_bridge.cli.viewer.drawing import Drawing, GROUPS, HIDDEN_AT_FIRST, NAMES, VisiblePart
from sdf_pose_bridge.cli.viewer.frame_texts import (
    html_of_data,
    html_of_frame,
    html_of_lines,
    html_of_points,
    html_of_reasons,
    html_of_selection,
)
from sdf_pose_bridge.cli.viewer.joint_sliders import JointSliders
from sdf_pose_bridge.cli.viewer.meshes import ALLOWANCE, MeshReader
from sdf_pose_bridge.cli.viewer.selected_frame import FindChange, PoseEdit, SelectedFrame
from sdf_pose_bridge.cli.viewer.server import Events, page_with_script, server_for_its_owner
from sdf_pose_bridge.cli.viewer.shown_scene import ShownScene
from sdf_pose_bridge.cli.viewer.view_point import (
    DIRECTIONS,
    FIELD_OF_VIEW_RAD,
    view_in_window,
    view_of_bounds,
)
from sdf_pose_bridge.geometry.poses import pose_product, relative_pose
from sdf_pose_bridge.geometry.units import DEGREES, RADIANS, Units
from sdf_pose_bridge.printed_text import printable
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT
from sdf_pose_bridge.tf.tree import TfOptions

_ANGLES = {unit.name: unit for unit in (RADIANS, DEGREES)}

_PANEL_WIDTH, _PANEL_PART, _LEAST_WIDTH = 360, 0.35, 720
"""The largest width of the panel in pixels and as a part of a window, and the least width of a
window in which it is open at first."""


class Page:
    """The page of a file in one tab of a browser; ``wake`` is set when it has to act."""

    def __init__(
        self, client: viser.ClientHandle, shown: ShownScene, errors: str, wake: threading.Event,
        units: Units, meshes: MeshReader, find_change: FindChange | None,
    ) -> None:
        self._client, self._shown, self._meshes = client, shown, meshes
        self._events, self._hidden, gui = Events(wake), {*HIDDEN_AT_FIRST}, client.gui
        self.units = units
        """The units of the poses and sliders that are shown."""
        gui.main_panel.dock_right()
        gui.main_panel.set_width(_PANEL_WIDTH)
        self._reasons = gui.add_html('')
        # The script reads these in a hidden panel that is never folded, as a folded panel has no
        # content.
        data = gui.add_panel()
        data.float()
        with data.add_tab('data'):
            self._data = {
                name: gui.add_html('')
                for name in ('errors', 'strip', 'names', 'labels', 'opacity', 'points', 'kept')}
            gui.add_html('<div class="asked"></div>')
            asked = gui.add_text('asked', '')

        # The next request may come before this one is processed.
        @asked.on_update
        async def put(_: object) -> None:
            self._events.put(partial(self._answer, asked.value.partition(' ')[2]))

        folder_of_frames = gui.add_folder('Frames')
        # They are in view where a frame is clicked in the tree.
        self._edit = None if find_change is None else PoseEdit(
            client, shown, find_change, self._events, self.show)
        self._selected = SelectedFrame(gui, folder_of_frames, self._events)
        self._controls = dict[str, Any]()
        """Those whose values the page of the next start gets."""
        self._add_view_controls(units)
        self._points, self._lost, self._drawn = list[tuple[int, Pose]](), '', shown
        self._add_switches()
        self._joints = JointSliders(gui, shown.joints, {}, units, self._events)
        self._node_names = cycle(('/drawing', '/other drawing'))
        self._drawing = self._new_drawing()
        self.show(shown)
        self.tell_script('errors', errors)
        self._look('home')

    def show(self, shown: ShownScene) -> None:
        """Show another scene; hidden groups, the selected frame and positions of joints stay."""
        before, self._shown = self._shown, shown
        old, new = before.scene, shown.scene
        points = [(body, point) for each, point in self._points
                  for body in new.elements_called(old.names[each])
                  if shown.is_in_model[body] and new.kinds[body] == old.kinds[each]]
        if len(points) < len(self._points):
            points, self._lost = [], '<div>the points are gone with their body</div>'
        self._points = points
        with self._client.atomic():
            if {*shown.labels} != {*before.labels}:
                self._switches.remove()
                self._add_switches(self._switches.order)
            self._refresh()
            if not before.tree.frame_ids:
                self._look('home')

    def act(self) -> None:
        """Process the requests of the tab."""
        next(self._joints.moves, None)
        actions = self._events.asked()
        with self._client.atomic():
            for action in actions:
                action()
            # While a gizmo moves, there is no time to read a file.
            if actions or (self._edit is not None and self._edit.look_ahead()):
                self._refresh()

    def _refresh(self) -> None:
        """Show the current state of the controls."""
        shown, selected, edit = self._shown, self._selected, self._edit
        self.units = units = self.units._replace(angle=_ANGLES.get(self._angles.value, RADIANS))
        refusals = self._joints.refresh()
        # Many sliders take a browser long.
        if (shown.joints, units) != (self._joints.ranges, self._joints.units):
            self._joints.folder.remove()
            refusals = ''
            self._joints = JointSliders(
                self._client.gui, shown.joints, self._joints.positions, units, self._events,
                self._joints.folder.order)
        if shown.positions != self._joints.positions:
            self._shown = shown = shown.at(self._joints.positions)
        selected.list_frames(shown)
        if (shown.loaded, self._hidden, selected.hidden) != self._drawn_for:
            self._drawing.remove()
            self._drawing = self._new_drawing()
        drawn, frame, reference, strip = shown, selected.frame, selected.reference, ''
        if edit is not None:
            edit.refresh(shown, frame, reference, units)
            strip, drawn = edit.html, edit.shown_ahead
        if frame >= 0:
            strip = html_of_selection(shown, drawn, frame, reference, units) + strip
        ends = drawn.poses[[] if ROOT_IS_PARENT in (reference, frame) else [reference, frame], :3]
        self._drawn = drawn
        if self._measures.value:
            ends = np.array([
                pose_product(drawn.scene.pose_of(body), point)[:3]
                for body, point in self._points]).reshape(-1, 3)
            strip = self._lost + html_of_points(drawn, ends, frame, units.length) + strip
        else:
            self._points, self._lost = [], ''
        self.tell_script('points', str(self._measures.value))
        self.tell_script('opacity', str(self._controls['opacity'].value))
        self.tell_script('labels', self._drawing.show(drawn, frame, ends, units.length))
        selected.describe(html_of_frame(drawn, frame, reference, units) if frame >= 0 else '')
        self.tell_script('strip', refusals + strip)
        self.tell_script('kept', json.dumps([
            *selected.kept, *(['joint', *each] for each in self._joints.positions.items()),
            *(['set', name, control.value] for name, control in self._controls.items())]))

    def tell_script(self, name: str, value: str) -> None:
        """Give the script a value, such as the errors of the file in HTML."""
        self._data[name].content = html_of_data(name, value)

    def _new_drawing(self) -> Drawing:
        hidden = self._hidden, self._selected.hidden
        self._drawn_for = self._shown.loaded, *map(frozenset, hidden)
        visible = VisiblePart(self._shown, self._meshes, *hidden)
        self._reasons.content = html_of_reasons(visible.reasons)
        self.tell_script('names', visible.names)
        return Drawing(
            self._client.scene, next(self._node_names), visible,
            lambda frame_id: self._events.put(partial(self._process, 'click', [frame_id])))

    # Controls

    def _answer(self, text: str) -> None:
        """Process requests of the script, a list in JSON; it ends at the first wrong one."""
        with contextlib.suppress(ValueError, TypeError, LookupError, RecursionError):
            for verb, *values in json.loads(text):
                self._process(verb, values)

    def _process(self, verb: str, values: list[Any]) -> None:
        panel, camera, scene = self._client.gui.main_panel, self._client.camera, self._drawn.scene
        match verb, values:
            case 'select' | 'relative' | 'fold' | 'hide', [str(frame_id)]:
                self._selected.answer(verb, frame_id)
            case 'click', [frame_id] if not self._measures.value:
                self._selected.answer('select', frame_id)
            case 'point', [number, x, y, z] if math.isfinite(x + y + z):
                body = self._drawing.visible.bodies.item(number)
                # The third one begins anew.
                self._points[len(self._points) % 2:], self._lost = [
                    (body, relative_pose(scene.pose_of(body), Pose(x, y, z)))], ''
            case 'camera', [*numbers]:
                camera.position, camera.look_at = np.array(numbers, float).reshape(2, 3)
            case 'width', [width]:
                panel.set_width(min(_PANEL_WIDTH, _PANEL_PART * width))
                if width < _LEAST_WIDTH:
                    panel.minimize()
            case 'joint', [name, position] if math.isfinite(position):
                self._joints.joints[name].move(position)
            case 'set', [name, value]:
                self._controls[name].value = value
            case action, [] if self._edit is not None and action in self._edit.actions:
                # Errors in it are not errors of the script.
                self._events.put(self._edit.actions[action])

    def _add_switches(self, order: float | None = None) -> None:
        """Add the folder "Show"."""
        self._switches = self._client.gui.add_folder('Show', expand_by_default=False, order=order)
        with self._switches:
            for name in dict.fromkeys((*self._shown.labels, *GROUPS)):
                self._add_switch(name)

    def _add_switch(self, name: str) -> None:
        switch = self._client.gui.add_checkbox(printable(name), name not in self._hidden)
        self._controls[name] = switch
        self._events.when(switch.on_update, lambda: (
            self._hidden.discard if switch.value else self._hidden.add)(name))

    def _add_view_controls(self, units: Units) -> None:
        """Add the folder "View"."""
        gui = self._client.gui
        with gui.add_folder('View'):
            views = gui.add_button_group('view', ('home', *DIRECTIONS, 'zoom to'))
            opacity = gui.add_slider('opacity', 0.1, 1.0, 0.05, 1.0)
            angles = gui.add_dropdown(
                'angles', tuple(_ANGLES), initial_value=units.angle.name)
            self._add_switch(NAMES)
            dark = gui.add_checkbox('dark background', initial_value=False)
            measures = gui.add_checkbox(
                'measure points', initial_value=False, hint='of shapes, where they are clicked')
        self._controls |= {control.label: control for control in (opacity, angles, dark, measures)}
        self._angles, self._measures = angles, measures
        for control in (opacity, angles, measures):
            self._events.when(control.on_update)
        self._events.when(views.on_click, lambda: self._look(views.value))
        self._events.when(dark.on_update, lambda: gui.configure_theme(
            show_logo=False, show_share_button=False, dark_mode=dark.value))

    def _look(self, name: str) -> None:
        """Turn the camera to a view; "zoom to" shows the selected frame, link or model."""
        visible, client = self._drawing.visible, self._client
        view = visible.home
        if name in DIRECTIONS:
            view = view_of_bounds(visible.bounds, DIRECTIONS[name])
        elif name == 'zoom to' and self._selected.frame >= 0:
            bounds = visible.bounds_of_frame(self._shown, self._selected.frame)
            view = view_of_bounds(bounds, view.position - view.look_at)
        client.camera.position, client.camera.look_at = view_in_window(view, client.camera.aspect)
        client.camera.up_direction = 0.0, 0.0, 1.0
        client.camera.near, client.camera.far = visible.range_m


class Pages:
    """
    The pages of a file, one for each tab; one thread processes their requests.

    :param scene: the scene that they show at first, loaded with its shapes.
    :param options: the elements that are frames, and the rules for their names.
    :param port: their port, or the next one that is free; 0 for any.
    :param units: the units of poses and sliders at first; a tab that is opened later has those of
        the tab in which they were chosen last.
    :param find_change: finds the change of a file for a pose; None if frames cannot be moved.
    :raises SdfError: if the scene has no TF tree, or a model to show does not exist.
    """

    def __init__(
        self, scene: Scene, options: TfOptions, port: int, units: Units, meshes: MeshReader,
        find_change: FindChange | None = None,
    ) -> None:
        self._options, self._units, self._meshes = options, units, meshes
        self._shown = ShownScene(scene, options)
        self._visible = visible = VisiblePart(
            self._shown, meshes, HIDDEN_AT_FIRST - {NAMES})
        self.reasons = visible.reasons
        """Lines about shapes that cannot be drawn."""
        path = Path(scene.path)
        # Many files of models have the name model.sdf.
        self._title = printable(options.model or (
            path.name if scene.world_names else [*scene.names[1:2], path.name][0]))
        self.was_asked = threading.Event()
        """Set when a browser asks for a page."""
        self._server, self.address = server_for_its_owner(
            port, self._title, scene.path, self.was_asked)
        self._errors = ''
        camera = self._server.initial_camera
        camera.fov = FIELD_OF_VIEW_RAD
        camera.position, camera.look_at = visible.home
        camera.near, camera.far = visible.range_m
        self._wake, self._pages = threading.Event(), dict[int, Page]()
        self._new_page = partial(Page, wake=self._wake, meshes=meshes, find_change=find_change)
        self._server.on_client_connect(lambda _: self._wake.set())

    def html(self) -> str:
        """Return the scene with all names, without controls, as a page that needs no network."""
        # Nothing can be selected there.
        labels = Drawing(self._server.scene, '/drawing', self._visible, print).show(
            self._shown, ROOT_IS_PARENT, np.zeros((0, 3)), self._units.length)
        return page_with_script(
            self._server.get_scene_serializer().as_html(), self._title,
            html_of_data('names', self._visible.names) + html_of_data('labels', labels))

    def close(self) -> None:
        """End the server."""
        self._server.stop()

    def show(self, scene: Scene) -> None:
        """Show another scene; raise an SdfError as the constructor does."""
        self._shown = ShownScene(scene, self._options)
        self._meshes.left_s = ALLOWANCE.processor_s
        self.show_errors(())
        for page in self._pages.values():
            page.show(self._shown)

    def show_errors(self, lines: Iterable[str]) -> None:
        """Show the errors of a file, a line for each, over its last scene."""
        self._errors = html_of_lines('errors', lines)
        for page in self._pages.values():
            page.tell_script('errors', self._errors)

    def act(self, seconds: float) -> None:
        """Process the requests of browsers; wait no longer than this for them."""
        self._wake.wait(seconds)
        self._wake.clear()
        self._pages = {
            number: self._pages.get(number) or self._new_page(
                client, self._shown, self._errors, units=self._units)
            for number, client in self._server.get_clients().items()}
        for page in self._pages.values():
            before = page.units
            page.act()
            if page.units != before:
                self._units = page.units
