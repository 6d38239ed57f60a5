# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The tree in which a frame is selected, and the gizmo, numbers and buttons that move it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
import re
from typing import TypeAlias

import viser

from sdf_pose_bridge import Pose, Scene, SdfError
from sdf_pose_bridge.cli.viewer.frame_texts import (
    escaped,
    html_of_difference,
    html_of_lines,
    html_of_tree,
)
from sdf_pose_bridge.cli.viewer.server import Events
from sdf_pose_bridge.cli.viewer.shown_scene import ShownScene
from sdf_pose_bridge.export.pose_setting import Lookup, PoseChange
from sdf_pose_bridge.geometry.formats import converted_poses, POSE_FORMATS, PoseFormatError
from sdf_pose_bridge.geometry.pose_texts import (
    number_from_text,
    only_pose,
    typed_poses_from_text,
    TypedPose,
)
from sdf_pose_bridge.geometry.poses import pose_product, relative_pose
from sdf_pose_bridge.geometry.rotations import rpy_from_quaternion
from sdf_pose_bridge.geometry.units import POSE_LABELS, Units
from sdf_pose_bridge.tf.lookup import lookup_from_scene
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT

FindChange: TypeAlias = Callable[[Scene, int, Pose, Lookup], PoseChange]
"""Finds a change as :func:`~sdf_pose_bridge.export.pose_setting.pose_change` does."""

_MOST_CHOICES = 1000
_SEVERAL = re.compile(r'\s|[\[({<:=]|[,;].*[,;]', re.DOTALL)
"""A text of one number has none of these, but for a comma of thousands."""


class SelectedFrame:
    """A given folder with the tree of frames, and one of the selected frame."""

    def __init__(self, gui: viser.GuiApi, folder: viser.GuiFolderHandle, events: Events) -> None:
        self._ids: tuple[str, ...] = ()
        self._frame_id = ''
        self._folded: set[str] = set()
        self.hidden: set[str] = set()
        """The ids of the frames that are hidden with all that is in them."""
        with folder:
            self._search = gui.add_text('search', '')
            self._rows = gui.add_html('')
        self._folder = gui.add_folder('Selected frame', visible=False)
        with self._folder:
            self._choice = gui.add_dropdown(
                'relative to', ('',), hint='for the pose and the distance')
            measure = gui.add_button(
                'measure from this frame', hint='to frames that are selected next', color='gray')
            self._description = gui.add_html('')
        events.when(self._search.on_update)
        events.when(self._choice.on_update)
        events.when(measure.on_click, lambda: self._refer_to(self._frame_id))

    @property
    def kept(self) -> list[list[str]]:
        """Arguments of :meth:`answer` with which another page shows the same."""
        return [['select', self._frame_id], ['relative', self._choice.value],
                *(['fold', each] for each in self._folded),
                *(['hide', each] for each in self.hidden)]

    @property
    def frame(self) -> int:
        """Index of the selected frame, or ``ROOT_IS_PARENT``, which is -1, for none."""
        return self._index(self._frame_id)

    @property
    def reference(self) -> int:
        """Index of the frame to which its pose is relative, or ``ROOT_IS_PARENT``."""
        return self._index(self._choice.value)

    def _index(self, frame_id: str) -> int:
        return self._ids.index(frame_id) if frame_id in self._ids else ROOT_IS_PARENT

    def answer(self, verb: str, frame_id: str) -> None:
        """Select a frame, show poses "relative" to it, or "fold" or "hide" it or undo this."""
        if verb == 'select':
            self._frame_id = frame_id
        elif verb == 'relative':
            self._refer_to(frame_id)
        else:
            ids = self._folded if verb == 'fold' else self.hidden
            ids ^= {frame_id}

    def list_frames(self, shown: ShownScene) -> None:
        """List the frames of a scene; the selected one stays."""
        self._ids = shown.tree.frame_ids
        choices = (shown.tree.root_frame, *self._ids[:_MOST_CHOICES])
        if choices != self._choice.options:
            self._choice.options = choices
        self._rows.content = html_of_tree(
            shown, self._search.value, self._frame_id, self._folded, self.hidden)

    def describe(self, html: str) -> None:
        """Show the description of the selected frame; empty for none."""
        self._folder.visible = bool(html)
        self._description.content = html

    def _refer_to(self, frame_id: str) -> None:
        if frame_id in self._choice.options:
            self._choice.value = frame_id


class PoseEdit:
    """The folder that changes the pose of the selected frame, and the gizmo at the frame."""

    def __init__(
        self, client: viser.ClientHandle, shown: ShownScene, find_change: FindChange,
        events: Events, show: Callable[[ShownScene], object],
    ) -> None:
        self._find_change, self._show_file, self._shown = find_change, show, shown
        self._frame = -1
        self._target, self._reference = ('', Pose()), Pose()
        self.pose: Pose | None = None
        """The new pose in the root frame; None until something is changed."""
        self._overwritten: Pose | None = None
        """The pose before the last write, while the frame has the written one."""
        self._change: PoseChange | None = None
        self._looked_at: tuple[object, ...] = ()
        self._notes: tuple[str, ...] = ()
        self._failures: tuple[str, ...] = ()
        self._question = ''
        """A question about the typed numbers, which writing them answers."""
        self._errors: list[str] = []
        self._refusal = ''
        """The reason why a typed text is rejected."""
        self._undone: list[PoseChange] = []
        """The changes that take back the writes of this page, the last one at the end."""
        # In pixels: with lines of this width, 24 of them react to the pointer.
        self._gizmo = client.scene.add_transform_controls(
            '/gizmo', 110.0, line_width=6.0, fixed=True, depth_test=False, visible=False)
        self._placed = Pose()
        gui = client.gui
        with gui.add_folder('Edit'):
            self._frame_of_numbers = gui.add_html('')
            self._numbers = [gui.add_text(label, '', disabled=True) for label in POSE_LABELS]
        for control in (self._gizmo, *self._numbers):
            # What was typed counts before a click that follows.
            events.when(control.on_update, self._read_numbers)
        self._texts, self._shown_for = [''] * 6, (Pose(), Pose(), Units())

    def refresh(self, shown: ShownScene, frame: int, reference: int, units: Units) -> None:
        """
        Edit a frame; read the fields and the gizmo.

        The new pose stays if the frame is the same and has not moved, even if the file has changed
        elsewhere.

        :param frame: its index, or -1 for none.
        :param reference: index of the frame relative to which numbers are.
        """
        before, target = self._target, (shown.ids[frame], shown.pose_of(frame))
        if shown.loaded is not self._shown.loaded or target[0] != before[0]:
            self._looked_at = ()
        self._shown, self._frame = shown, frame
        self._target, self._reference = target, shown.pose_of(reference)
        if target[0] != before[0]:
            self._change = None
        if target != before:
            self._overwritten = None
            self._set_pose(None)
        elif self._change is not None:
            self._read_numbers()
            self._read_gizmo()
        text = f'{escaped(target[0])} in <b>{escaped(shown.ids[reference])}</b>'
        self._frame_of_numbers.content = '<div class="frame-of-numbers">{}</div>'.format(
            text if frame >= 0 else 'select a frame to move it')
        self._show(units)

    def look_ahead(self) -> bool:
        """Find the scene with the new pose; return False if it was known already."""
        shown, asked = self._shown, (self.pose, self.pose and self._shown.positions)
        element = shown.element_of(self._frame)
        if element < 0 or asked == self._looked_at:
            return False
        self._looked_at, self._errors = asked, []
        try:
            self._change = self._find_change(
                shown.loaded, element, self._pose,
                partial(lookup_from_scene, positions=shown.positions))
        except SdfError as error:
            self._errors = list(map(str, error.errors))
            # While one drags, the next pose may be possible.
            self._change = self._change if self.pose else None
        return True

    @property
    def shown_ahead(self) -> ShownScene:
        """The scene with the new pose, and all that moves with it if known."""
        if self.pose is None:
            return self._shown
        shown = self._shown
        if self._change is not None and self._looked_at and not self._errors:
            shown = shown.at(shown.positions, self._change.scene)
        return shown.with_pose(self._frame, self.pose)

    @property
    def _pose(self) -> Pose:
        return self.pose or self._target[1]

    @property
    def actions(self) -> dict[str, Callable[[], object]]:
        """The actions that are possible now, by the labels to click."""
        actions: dict[str, Callable[[], object]] = {}
        if self.pose is not None and not self._refusal:
            actions['write anyway' if self._question else 'write to file'] = self._write_pose
        if self.pose is not None or self._refusal:
            actions['cancel'] = partial(self._set_pose, None)
        if self._undone:
            actions['undo the last write'] = partial(self._write, self._undone[-1], None)
        return actions

    @property
    def html(self) -> str:
        """The new pose beside the one in the file, errors, and buttons."""
        text = '' if self._change is None or self.pose else (
            '<div>drag the arrows or type numbers to move it; Enter leads to the buttons, '
            'Escape cancels</div>')
        old = self._overwritten if self.pose is None else self._target[1]
        if old is not None:
            text += html_of_difference(old, self._pose, self._reference, self._shown_for[2])
        if self._undone:
            path = Path(self._undone[-1].file.path)
            text += f'<div>written to {escaped(path.name)}:{self._undone[-1].line}</div>'
        buttons = (f'<button data-ask="{label}">{label}</button>' for label in self.actions)
        # Before anything is changed, they are only the reason why nothing can be.
        errors = html_of_lines('errors' if self.pose else 'errors_of_setting', self._errors)
        notes = html_of_lines('notes', self._notes) + html_of_lines(
            'errors', filter(None, (*self._failures, self._question, self._refusal)))
        return f'{text}{notes}{errors}{"".join(buttons)}'

    def _set_pose(self, pose: Pose | None, *notes: str, question: str = '') -> None:
        self.pose, self._notes, self._failures, self._question = pose, notes, (), question
        if pose is None:
            self._errors, self._refusal = [], ''
            # Also clear the rejected text.
            for number, text in zip(self._numbers, self._texts, strict=True):
                number.value = text

    def _read_numbers(self) -> None:
        typed, self._refusal = [number.value for number in self._numbers], ''
        if typed == self._texts:
            return
        reference, pose, units = self._shown_for
        at = relative_pose(reference, pose)
        source = POSE_FORMATS['sdf_rpy']._replace(length=units.length, angle=units.angle)
        pasted = [text for text in {*typed} - {*self._texts} if _SEVERAL.search(text.strip())]
        try:
            # Numbers that were not typed keep all their digits.
            given = only_pose(typed_poses_from_text(pasted[0], default=source) if pasted else [
                TypedPose([
                    exact * unit.factor if text == shown else number_from_text(text)
                    for exact, text, shown, unit in zip(
                        (*at[:3], *rpy_from_quaternion(at[3:])), typed, self._texts,
                        units.of_pose, strict=True)], source)])
            new = Pose(*converted_poses(given.numbers, given.format, 'sdf_quat_xyzw').tolist())
            # A rotation alone leaves the position.
            pose = pose_product(
                reference, new if given.format.position else Pose(*at[:3], *new[3:]))
        except PoseFormatError as error:
            self._refusal = str(error)
            return
        self._texts = typed
        if not pasted:
            self._shown_for = reference, pose, units
        question = given.format.doubt(given.numbers, is_written=True)
        self._set_pose(pose, *given.notes, question=question)

    def _read_gizmo(self) -> None:
        if (pose := self._pose_of_gizmo) != self._placed:
            # The gizmo is not placed again: under the pointer it may be elsewhere by now.
            self._placed = pose
            self._set_pose(pose)

    @property
    def _pose_of_gizmo(self) -> Pose:
        w, x, y, z = self._gizmo.wxyz.tolist()
        return Pose(*(*self._gizmo.position.tolist(), x, y, z, w))

    def _show(self, units: Units) -> None:
        for number, label, unit in zip(self._numbers, POSE_LABELS, units.of_pose, strict=True):
            number.label = f'{label} [{unit.name}]'
            number.disabled = self._change is None
        self._gizmo.visible = self._change is not None
        pose = self._pose
        if pose != self._placed:
            self._gizmo.position, self._gizmo.wxyz = pose[:3], (pose.qw, *pose[3:6])
            # viser does not move a gizmo by less than a rounding error.
            self._placed = self._pose_of_gizmo
        shown_for = self._reference, pose, units
        if shown_for != self._shown_for:
            before, self._shown_for = self._texts, shown_for
            self._texts = units.texts(relative_pose(self._reference, pose))
            for number, text, old in zip(self._numbers, self._texts, before, strict=True):
                # Other numbers may have been typed just now.
                if text != old:
                    number.value = text

    def _write_pose(self) -> None:
        self.look_ahead()
        if self._change is not None and not self._errors and not self._refusal:
            self._write(self._change, self._change._replace(
                file=self._change.file.undone, scene=self._shown.loaded))

    def _write(self, change: PoseChange, undone: PoseChange | None) -> None:
        try:
            change.file.write()
        except SdfError as error:
            self._failures = tuple(map(str, error.errors))
            return
        shown = self._shown.at(self._shown.positions, change.scene)
        self._undone = [*self._undone, undone] if undone else self._undone[:-1]
        self._overwritten = self._target[1] if undone else None
        self._target = self._target[0], shown.pose_of(self._frame)
        self._set_pose(None)
        self._show_file(shown)
