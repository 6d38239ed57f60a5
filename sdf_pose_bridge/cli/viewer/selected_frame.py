# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The tree of frames in the page, and the description of the selected frame."""

from __future__ import annotations

from itertools import islice

import viser

from sdf_pose_bridge.cli.viewer.frame_texts import escaped, rows_of_tree
from sdf_pose_bridge.cli.viewer.server import Events
from sdf_pose_bridge.cli.viewer.shown_scene import ShownScene
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
    The folder with the tree of frames, and the one of the selected frame.

    :param folder: the folder of the selected frame.
    """

    def __init__(
        self, gui: viser.GuiApi, folder: viser.GuiFolderHandle, events: Events,
    ) -> None:
        self._ids: tuple[str, ...] = ()
        self._frame_id = ''
        self._folded: set[str] = set()
        self.hidden: set[str] = set()
        """The ids of the frames that are hidden with all that is in them."""
        with gui.add_folder('Frames'):
            self._search = gui.add_text('search', '', hint='frames are selected in the scene, too')
            self._rows = gui.add_html('')
        self._folder = folder
        with folder:
            self._choice = gui.add_dropdown(
                'relative to', ('',), hint='for the pose and the distance')
            measure = gui.add_button(
                'measure from this frame', hint='to frames that are selected next', color='gray')
            self._description = gui.add_html('')
        events.when(self._search.on_update)
        events.when(self._choice.on_update)
        events.when(measure.on_click, self._measure_from_here)

    @property
    def frame(self) -> int:
        """Index of the selected frame, or -1 for none."""
        return self._ids.index(self._frame_id) if self._frame_id in self._ids else -1

    @property
    def reference(self) -> int:
        """Index of the frame to which its pose is relative, or ``ROOT_IS_PARENT``."""
        other = self._choice.value
        return self._ids.index(other) if other in self._ids else ROOT_IS_PARENT

    def answer(self, verb: str, frame: int) -> None:
        """Select, fold or hide a frame ("select", "fold" or "hide"), or undo the latter."""
        if frame >= len(self._ids):
            return
        if verb == 'select':
            self._frame_id = self._ids[frame]
        else:
            ids = self._folded if verb == 'fold' else self.hidden
            ids ^= {self._ids[frame]}

    def list_frames(self, shown: ShownScene) -> None:
        """List the frames of a scene; the selected one stays."""
        tree, kinds = shown.tree, shown.labels
        self._ids = ids = tree.frame_ids
        choices = (tree.root_frame, *ids[:_MOST_CHOICES])
        if choices != self._choice.options:
            self._choice.options = choices
        rows = list(islice(rows_of_tree(tree, self._search.value, self._folded), MOST_ROWS))
        content = ''.join(
            f'<div style="padding-left:{depth}em"><i data-ask="fold {frame}">'
            f'{_FOLDS[ids[frame] in self._folded] if has_children else ""}</i>'
            f'<b title="{kinds[frame]}">{_SIGNS.get(kinds[frame], "+")}</b>'
            f'<label data-ask="select {frame}"'
            f'{" class=selected" if ids[frame] == self._frame_id else ""}>{escaped(text)}</label>'
            f'<i data-ask="hide {frame}" title="show or hide">{_EYES[ids[frame] in self.hidden]}'
            '</i></div>'
            for frame, depth, text, has_children in rows)
        if not self._search.value and len(rows) < len(ids):
            content += f'{len(ids) - len(rows)} more, to be found by the search'
        self._rows.content = f'{_ROWS_STYLE}<div class="rows">{content}</div>'

    def describe(self, html: str) -> None:
        """Show the description of the selected frame; empty for none."""
        self._folder.visible = bool(html)
        self._description.content = html

    def _measure_from_here(self) -> None:
        if self.frame >= 0 and self._frame_id in self._choice.options:
            self._choice.value = self._frame_id
