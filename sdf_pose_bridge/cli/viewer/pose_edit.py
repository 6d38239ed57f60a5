# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The gizmo and the numbers that move the selected frame, and the buttons that write its pose."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import NamedTuple

import viser

from sdf_pose_bridge.cli.printing import POSE_LABELS, Units
from sdf_pose_bridge.cli.viewer.frame_texts import escaped, html_of_difference, html_of_lines
from sdf_pose_bridge.cli.viewer.server import Events
from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.geometry.formats import POSE_FORMATS
from sdf_pose_bridge.geometry.poses import Pose, pose_product, relative_pose
from sdf_pose_bridge.geometry.rotations import quaternion_from_rpy, rpy_from_quaternion
from sdf_pose_bridge.scene.pose_setting import PoseChange
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.file_change import FileChange

SetPose = Callable[..., PoseChange]
"""Writes a pose of a scene into its file: takes the arguments of
:func:`~sdf_pose_bridge.scene.pose_setting.pose_change` but the load, and whether to write
nothing."""

_STEPS = (1.0, 10.0, 100.0, 1000.0)
"""Step of the arrows beside a number, in units of its last digit."""


class EditedFrame(NamedTuple):
    """The edited frame."""

    scene: Scene
    """The scene as it was loaded."""
    element: int
    pose: Pose
    """Its pose in the root frame."""
    reference: Pose
    """The pose, in the root frame, of the frame relative to which numbers are."""
    name: str
    measured: Callable[[Scene, int], Pose]
    """Returns the pose of an element of a scene in the root frame."""


class PoseEdit:
    """
    The folder that changes the pose of the selected frame, and the gizmo at the frame.

    :param set_pose: writes a pose into the file.
    :param changed: called when :attr:`html` has changed.
    """

    def __init__(
        self, server: viser.ViserServer, set_pose: SetPose, events: Events,
        changed: Callable[[], object],
    ) -> None:
        self._set_pose, self._changed = set_pose, changed
        self._frame: EditedFrame | None = None
        self._file: PoseChange | list[str] = []
        self._errors: Iterable[str] = ()
        self._undone: FileChange | None = None
        self._units, self._shown = Units(), [0.0] * 6
        self.pose: Pose | None = None
        """The new pose in the root frame; None until something is changed."""
        self._ahead: PoseChange | list[str] = []
        self._looked_at: Pose | None = None
        # In pixels: with lines of this width, 24 of them react to the pointer.
        self._gizmo = server.scene.add_transform_controls(
            '/gizmo', 110.0, line_width=6.0, fixed=True, depth_test=False, visible=False)
        gui = server.gui
        with gui.add_folder('Edit'):
            self._numbers = [gui.add_number(label, 0.0, disabled=True) for label in POSE_LABELS]
            self._steps = gui.add_dropdown('steps', ('',))
        events.when(self._gizmo.on_update, self._take_gizmo)
        for number in self._numbers:
            events.when(number.on_update, self._take_numbers)
        events.when(self._steps.on_update, self._set_steps)
        self._set_units(self._units)

    def begin(self, frame: EditedFrame | None, units: Units) -> None:
        """
        Edit a frame, or none.

        The new pose stays if the frame is the same and has not moved, even if the file has changed
        elsewhere.
        """
        before, self._frame = self._frame, frame
        self._ahead, self._looked_at = [], None
        if units != self._units:
            self._set_units(units)
        is_same = frame is not None and before is not None and (
            frame.name, frame.pose) == (before.name, before.pose)
        if not is_same:
            self.pose, self._errors = None, ()
        if frame is None:
            self._file = []
        elif before is None or frame.scene is not before.scene or frame.element != before.element:
            self._file = self._change(frame.pose, dry_run=True)
        self._place_gizmo()
        self._show_numbers()
        self._show()

    def look_ahead(self) -> None:
        """Find the scene with the new pose, unless it is known."""
        if self.pose not in (None, self._looked_at):
            self._looked_at = self.pose
            self._ahead = self._change(self.pose, dry_run=True)
            self._show()

    @property
    def scene_ahead(self) -> Scene | None:
        """The scene as the file would give it, or gives it by now; None if nothing is changed."""
        return self._ahead.scene if isinstance(self._ahead, PoseChange) else None

    @property
    def actions(self) -> dict[str, Callable[[], object]]:
        """The actions that are possible now, by the labels to click."""
        actions: dict[str, Callable[[], object]] = {}
        if self.pose is not None:
            actions |= {'write to file': self._write_pose, 'cancel': self._cancel_edit}
        if self._undone is not None:
            actions['undo the last write'] = self._undo_write
        return actions

    @property
    def html(self) -> str:
        """The new pose beside the one in the file, errors, and labels to click."""
        if isinstance(self._file, PoseChange):
            text = f'<div>in the file {escaped(str(Path(self._file.file.path).resolve()))}</div>'
        else:
            text = html_of_lines('errors_of_setting', self._file)
        if self._frame is not None and self.pose is not None:
            text += html_of_difference(
                self._frame.pose, self.pose, self._frame.reference, self._units)
        labels = (f'<label data-ask="{label}">{label}</label>' for label in self.actions)
        errors = [*self._errors, *(self._ahead if isinstance(self._ahead, list) else ())]
        return f'{text}{html_of_lines("errors", errors)}{"".join(labels)}'

    def _set_units(self, units: Units) -> None:
        self._units = units
        for number, label, unit in zip(self._numbers, POSE_LABELS, units.of_pose, strict=True):
            number.label = f'{label} [{unit.name}]'
            number.precision = unit.digits + 2
        self._steps.options = tuple(', '.join(
            f'{step * 0.1 ** unit.digits:g} {unit.name}' for unit in units) for step in _STEPS)
        self._steps.value = self._steps.options[1]
        self._set_steps()

    def _set_steps(self) -> None:
        step = _STEPS[self._steps.options.index(self._steps.value)]
        for number, unit in zip(self._numbers, self._units.of_pose, strict=True):
            number.step = step * 0.1 ** unit.digits

    def _take_gizmo(self) -> None:
        if self._gizmo.visible:
            w, x, y, z = self._gizmo.wxyz.tolist()
            # The gizmo is not placed again: under the pointer it may be elsewhere by now.
            self._take(Pose(*(*self._gizmo.position.tolist(), x, y, z, w)))
            self._show_numbers()

    def _take_numbers(self) -> None:
        """Read the typed numbers; the others keep all their digits."""
        typed = [number.value for number in self._numbers]
        if self._frame is not None and typed != self._shown:
            at = relative_pose(self._frame.reference, self.pose or self._frame.pose)
            values = [
                exact if number == shown else number / unit.factor
                for exact, number, shown, unit in zip(
                    (*at[:3], *rpy_from_quaternion(at[3:])), typed, self._shown,
                    self._units.of_pose, strict=True)]
            self._shown = typed
            doubt = POSE_FORMATS['sdf_rpy'].doubt([
                number / unit.factor
                for number, unit in zip(typed, self._units.of_pose, strict=True)])
            self._take(
                pose_product(self._frame.reference, Pose(
                    *(*values[:3], *quaternion_from_rpy(tuple(values[3:]))))),
                [f'{doubt.reason}; did you mean {doubt.likely_unit}?'] if doubt else ())
            self._place_gizmo()

    def _cancel_edit(self) -> None:
        self._take(None)
        self._place_gizmo()
        self._show_numbers()

    def _take(self, pose: Pose | None, doubts: Iterable[str] = ()) -> None:
        self.pose, self._errors = pose, doubts
        if pose is None:
            self._ahead, self._looked_at = [], None
        self._show()

    def _place_gizmo(self) -> None:
        if self._frame is not None:
            pose = self.pose or self._frame.pose
            self._gizmo.position, self._gizmo.wxyz = pose[:3], (pose.qw, *pose[3:6])

    def _show_numbers(self) -> None:
        if self._frame is not None:
            pose = relative_pose(self._frame.reference, self.pose or self._frame.pose)
            before, self._shown = self._shown, [float(text) for text in self._units.texts(pose)]
            for number, value, old in zip(self._numbers, self._shown, before, strict=True):
                # Others may have been typed just now. This change is reported, too, and ignored.
                if value != old:
                    number.value = value

    def _show(self) -> None:
        is_possible = isinstance(self._file, PoseChange)
        for number in self._numbers:
            number.disabled = not is_possible
        self._gizmo.visible = is_possible
        self._changed()

    def _write_pose(self) -> None:
        assert self.pose
        assert self._frame
        change = self._change(self.pose, dry_run=False)
        if isinstance(change, PoseChange):
            self._undone = change.file.undone
            self._frame, self.pose = self._frame._replace(pose=self.pose), None
        else:
            self._errors = change
        self._show()

    def _undo_write(self) -> None:
        assert self._undone is not None
        try:
            self._undone.write()
            self._undone = None
        except SdfError as error:
            self._errors = list(map(str, error.errors))
        self._show()

    def _change(self, pose: Pose, *, dry_run: bool) -> PoseChange | list[str]:
        """Write the pose into the file; return the reason if this is not possible."""
        assert self._frame is not None
        try:
            return self._set_pose(
                self._frame.scene, self._frame.element, pose, self._frame.measured,
                dry_run=dry_run)
        except SdfError as error:
            return list(map(str, error.errors))
