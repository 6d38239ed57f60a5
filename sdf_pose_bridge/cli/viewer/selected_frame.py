# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The tree of frames in the page, and the description of the selected frame."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import islice

import viser

from sdf_pose_bridge.cli.printing import kind_labels_of, Units
from sdf_pose_bridge.cli.viewer.frame_texts import escaped, html_of_frame, rows_of_tree
from sdf_pose_bridge.cli.viewer.server import Events
from sdf_pose_bridge.cli.viewer.shown_scene import PosedScene
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT

MOST_ROWS = 300
"""Largest number of rows of the tree of frames in the page; a search finds the others."""

_MOST_CHOICES = 1000
_ROWS_STYLE = ('<style>.rows{max-height:40vh;overflow:auto;margin:0 1em;font-size:0.8em}'
               '.rows div{display:flex;white-space:pre} .rows label{flex:1}'
               '.rows [data-ask]{cursor:pointer} .rows :is(b, i){width:1.2em;color:#4dabf7}'
               '.rows .selected{font-weight:bold}</style>')
_SIGNS = {'model': '\u25a2', 'link': '\u25cf', 'sensor': '\u25c6'}
"""The signs of the kinds of frames; other frames have a cross."""
_EYES, _FOLDS = ('\u25c9', '\u25cb'), ('\u25be', '\u25b8')
"""The signs of a frame that is shown or hidden, and of one that is open or folded."""


class SelectedFrame:
    """
    The folders with the tree of frames and with the selected frame.

    :param place: the folder of the selected frame.
    :param changed: called when another frame, or another reference of its pose, is selected.
    """

    def __init__(
        self, gui: viser.GuiApi, place: viser.GuiFolderHandle, posed: PosedScene, events: Events,
        changed: Callable[[], object],
    ) -> None:
        tree = posed.tree
        self._changed, self._tree, self._frame_id = changed, tree, ''
        self._folded: set[str] = set()
        self.hidden: set[str] = set()
        """The ids of the frames that are hidden with all that is in them."""
        with gui.add_folder('Frames'):
            self._search = gui.add_text('search', '', hint='frames are selected in the scene, too')
            self._rows = gui.add_html('')
        with place:
            self._selected = gui.add_folder('Selected frame', visible=False)
        with self._selected:
            self._choice = gui.add_dropdown(
                'relative to', (tree.root_frame,), hint='for the pose and the distance')
            measure = gui.add_button(
                'measure from this frame', hint='to frames that are selected next', color='gray')
            self._description = gui.add_html('')
        events.when(self._search.on_update, self._show_rows)
        events.when(self._choice.on_update, changed)
        events.when(measure.on_click, self._measure_from_here)
        self.list_frames(posed)

    @property
    def frame(self) -> int:
        """Index of the selected frame, or -1 for none."""
        ids = self._tree.frame_ids
        return ids.index(self._frame_id) if self._frame_id in ids else -1

    @property
    def reference(self) -> int:
        """Index of the frame to which its pose is relative, or ``ROOT_IS_PARENT``."""
        other, ids = self._choice.value, self._tree.frame_ids
        return ids.index(other) if other in ids else ROOT_IS_PARENT

    def list_frames(self, posed: PosedScene) -> None:
        """List the frames of another scene; the selected frame stays."""
        self._tree, tree = posed.tree, posed.tree
        self._labels = kind_labels_of(*posed)
        self._choice.options = (tree.root_frame, *tree.frame_ids[:_MOST_CHOICES])
        self._show_rows()

    def select(self, frame: int) -> None:
        """Select a frame, unless it is gone."""
        if frame < len(self._tree.frame_ids):
            self._frame_id = self._tree.frame_ids[frame]
            self._show_rows()
            self._changed()

    def toggle(self, what: str, frame: int) -> None:
        """Fold or hide a frame ("fold" or "hide"), or undo this."""
        if frame < len(self._tree.frame_ids):
            ids = self._folded if what == 'fold' else self.hidden
            ids ^= {self._tree.frame_ids[frame]}
            self._show_rows()

    def describe(self, posed: PosedScene, pose: Pose | None, units: Units) -> None:
        """Describe the selected frame, which is or would be at a pose in the root frame."""
        self._selected.visible = pose is not None
        if pose is None:
            return
        poses = posed.tree.poses.copy()
        poses[self.frame] = pose
        self._description.content = html_of_frame(
            posed.scene, replace(posed.tree, poses=poses), self.frame, self.reference, units)

    def _show_rows(self) -> None:
        rows = list(islice(rows_of_tree(
            self._tree, self._search.value, self._folded), MOST_ROWS))
        ids = self._tree.frame_ids
        content = ''.join(
            f'<div style="padding-left:{depth}em"><i data-ask="fold {frame}">'
            f'{_FOLDS[ids[frame] in self._folded] if has_children else ""}</i>'
            f'<b title="{self._labels[frame]}">{_SIGNS.get(self._labels[frame], "+")}</b>'
            f'<label data-ask="select {frame}"'
            f'{" class=selected" if ids[frame] == self._frame_id else ""}>{escaped(text)}</label>'
            f'<i data-ask="hide {frame}" title="show or hide">{_EYES[ids[frame] in self.hidden]}'
            '</i></div>'
            for frame, depth, text, has_children in rows)
        if not self._search.value and len(rows) < len(ids):
            content += f'{len(ids) - len(rows)} more, to be found by the search'
        self._rows.content = f'{_ROWS_STYLE}<div class="rows">{content}</div>'

    def _measure_from_here(self) -> None:
        if self.frame >= 0 and self._frame_id in self._choice.options:
            self._choice.value = self._frame_id
