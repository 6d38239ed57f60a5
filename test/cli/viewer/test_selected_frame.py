# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Which frames are listed, and which is selected; integration/test_view_page.py clicks them."""

import pytest

pytest.importorskip('viser', reason='needs viser')
import viser

from sdf_pose_bridge.cli.viewer import selected_frame
from sdf_pose_bridge.cli.viewer.selected_frame import SelectedFrame
from sdf_pose_bridge.cli.viewer.server import Events
from sdf_pose_bridge.cli.viewer.shown_scene import ShownScene
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT
from sdf_pose_bridge.tf.tree import TfOptions


def shown_scene(*frames):
    text = ''.join(f'<frame name="{name}"/>' for name in frames)
    scene = load_text(
        f'<sdf version="1.11"><world name="w">{text}</world></sdf>'.encode(), 'cell.sdf')
    return ShownScene(scene, TfOptions())


@pytest.fixture
def selected():
    server = viser.ViserServer('127.0.0.1', 0, verbose=False)
    selected = SelectedFrame(server.gui, server.gui.add_folder(''), Events())
    selected.list_frames(shown_scene('a', 'b', 'c'))
    yield selected
    server.stop()


def test_frame_that_is_gone_is_not_selected(selected):
    selected.answer('select', 3)
    assert selected.frame == -1


def test_selected_frame_stays_where_others_are_listed(selected):
    selected.answer('select', 1)
    selected.list_frames(shown_scene('b'))
    assert selected.frame == 0
    selected.list_frames(shown_scene('a'))
    assert selected.frame == -1


def test_more_frames_than_rows(selected, monkeypatch):
    monkeypatch.setattr(selected_frame, 'MOST_ROWS', 4)
    selected.list_frames(shown_scene(*'abcdef'))
    assert '2 more, to be found by the search' in selected._rows.content


def test_frame_that_is_measured_from_is_the_reference(selected):
    assert selected.reference == ROOT_IS_PARENT
    selected.answer('select', 1)
    selected._measure_from_here()
    selected.answer('select', 2)
    assert (selected.frame, selected.reference) == (2, 1)
