# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What the page shows, without a browser; integration/test_view_page.py uses it in one."""

import pytest

pytest.importorskip('viser', reason='needs viser')
from sdf_pose_bridge import load
from sdf_pose_bridge.cli.printing import Units
from sdf_pose_bridge.cli.viewer.page import Page
from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.scene.pose_setting import PoseChange
from sdf_pose_bridge.sdformat.file_change import FileChange
from sdf_pose_bridge.sdformat.include.uris import resource_finder
from sdf_pose_bridge.tf.tree import TfOptions

TEXT = """<sdf version="1.11"><model name="m"><link name="l"/>
  <frame name="free"><pose>0 0 1 0 0 0</pose></frame><frame name="fixed"/></model></sdf>"""


def put(scene, element, pose, measured, *, dry_run):
    """Refuse to place one of the frames, as the file cannot say some poses."""
    if scene.names[element].endswith('fixed'):
        raise ElementInvalidError('no', scene.place(element))
    change = FileChange(scene.path, b'', 'utf-8', 0, 0, b'')
    return PoseChange(change, 1, scene)


@pytest.fixture
def page():
    """A page, the frames of which can be dragged."""
    shown = Page(0, TfOptions(), Units(), resource_finder([], {}), put)
    yield shown
    shown.close()


def test_page_says_what_it_does_not_draw(page, tmp_path):
    geometry = '<visual name="v"><geometry><mesh><uri>&lt;b&gt;</uri></mesh></geometry></visual>'
    (tmp_path / 'm.sdf').write_text(TEXT.replace('"l"/>', f'"l">{geometry}</link>'))
    assert page.show(load(tmp_path / 'm.sdf', shapes=True)) == [
        '1 shape is not drawn as the file means it: the mesh "<b>": it is not found']
    assert '&lt;b&gt;&quot;: it is not found' in page._reasons.content


def test_gizmo_is_there_for_frames_that_can_be_placed_only(page, tmp_path):
    (tmp_path / 'm.sdf').write_text(TEXT)
    assert page.show(load(tmp_path / 'm.sdf', shapes=True)) == []
    frames = page._tree.frame_ids
    for name, has_gizmo in (('free', True), ('fixed', False), ('free', True)):
        page._select(frames.index(name))
        assert page._server.scene.get_handle_by_name('/gizmo').visible is has_gizmo


def test_what_is_switched_off_is_not_drawn(page, tmp_path):
    box = '<visual name="v"><geometry><box/></geometry></visual>'
    (tmp_path / 'm.sdf').write_text(TEXT.replace('"l"/>', f'"l">{box}</link>'))
    page.show(load(tmp_path / 'm.sdf', shapes=True))
    grid = page._server.scene.get_handle_by_name('/grid')
    assert grid.visible
    assert page._server.scene.get_handle_by_name('/visuals/0') is not None
    for switch in page._server.gui._gui_input_handle_from_uuid.values():
        if switch.value is True:
            switch.value = False
    while not page._actions.empty() or {'visuals', 'grid'} - page._hidden:
        page.act(0.1)
    assert not page._server.scene.get_handle_by_name('/grid').visible
    assert page._server.scene.get_handle_by_name('/visuals/0') is None


def test_page_says_so_when_collisions_are_switched_on(page, tmp_path):
    mesh = '<collision name="c"><geometry><mesh><uri>a</uri></mesh></geometry></collision>'
    (tmp_path / 'm.sdf').write_text(TEXT.replace('"l"/>', f'"l">{mesh}</link>'))
    assert page.show(load(tmp_path / 'm.sdf', shapes=True)) == []
    (switch,) = (
        switch for switch in page._server.gui._gui_input_handle_from_uuid.values()
        if switch.label == 'collisions')
    switch.value = True
    while 'collisions' in page._hidden:
        page.act(0.1)
    assert '1 shape is not drawn as the file means it' in page._reasons.content
