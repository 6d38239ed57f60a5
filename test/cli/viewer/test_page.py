# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What the page shows, without a browser; page/ uses it in one."""

from contextlib import closing
import html
import json
import re
from threading import Event

import pytest

pytest.importorskip('viser', reason='needs viser')

from sdf_pose_bridge import load
from sdf_pose_bridge.cli.viewer.page import Page, Pages, SelectedFrame
from sdf_pose_bridge.cli.viewer.server import Events
from sdf_pose_bridge.cli.viewer.shown_scene import ShownScene
from sdf_pose_bridge.export.pose_setting import PoseChange
from sdf_pose_bridge.file_change import FileChange
from sdf_pose_bridge.geometry.units import DEGREES, Units
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.tf.tree import TfOptions

TEXT = """<sdf version="1.11"><model name="m"><link name="l"/></model></sdf>"""
MESH = '<geometry><mesh><uri>&lt;b&gt;</uri></mesh></geometry>'


@pytest.fixture
def scene_of(tmp_path):
    """Returns a scene with a link of this content."""
    def make(content):
        (tmp_path / 'm.sdf').write_text(TEXT.replace('"l"/>', f'"l">{content}</link>'))
        return ShownScene(load(tmp_path / 'm.sdf', shapes=True), TfOptions())
    return make


@pytest.fixture
def page_of(scene_of, server, mesh_reader):
    """Returns the page of a file whose link has this content."""
    return lambda content, find_change=None: Page(
        server, scene_of(content), '', Event(), Units(), mesh_reader, find_change)


def set_switches(page, value, *labels):
    for switch in list(page._client.gui._gui_input_handle_from_uuid.values()):
        if switch.label in labels:
            switch.value = value
    while any((label in page._hidden) is value for label in labels):
        page.act()


def nodes(page, *names):
    prefix = page._drawing._name
    return [page._client.scene.get_handle_by_name(f'{prefix}/{name}') for name in names]


def select(page, frame):
    page._answer(f'select {page._shown.ids.index(frame)}')
    page._refresh()


def labels(page):
    (data,) = re.findall('data-labels="([^"]*)"', page._data['labels'].content)
    return json.loads(html.unescape(data))['labels']


def test_name_moves_with_its_frame_when_the_file_is_read_again(page_of, scene_of):
    sensor = '<sensor name="s" type="imu"><pose>0 0 {} 0 0 0</pose></sensor>'
    page = page_of(sensor.format(0))
    select(page, 'l/s')
    page.show(scene_of(sensor.format(0.1)))
    assert labels(page) == [['s', True, 0.0, 0.0, 0.1]]


def test_what_is_switched_off_is_not_drawn(page_of):
    page = page_of('<visual name="v"><geometry><box/></geometry></visual>')
    assert all(nodes(page, 'grid', 'visuals/0'))
    set_switches(page, False, 'visuals', 'grid')
    assert not any(nodes(page, 'grid', 'visuals/0'))


def test_drawing_shares_no_name_with_the_one_before(page_of):
    page = page_of('<visual name="v"><geometry><box/></geometry></visual>')
    (before,) = nodes(page, 'visuals/0')
    set_switches(page, False, 'grid')
    (after,) = nodes(page, 'visuals/0')
    assert before.name != after.name
    assert page._client.scene.get_handle_by_name(before.name) is None


def test_joints_move_on_while_the_page_acts(page_of):
    page = page_of('')
    page._joints.moves = moves = iter([None, None])
    page.act()
    assert list(moves) == [None]


def test_number_that_is_typed_while_a_file_is_read_stays(page_of, scene_of):
    page = page_of('', find_change=lambda scene, *_: PoseChange(
        FileChange(scene.path, 'utf-8', b'', b'', b'', b''), 1, scene))
    select(page, 'l')
    while page._edit._numbers[0].disabled:
        page.act()
    page._edit._numbers[0].value = '0.5'
    page.show(scene_of(''))
    assert page._edit.pose.x == pytest.approx(0.5)


def test_tab_has_the_unit_that_was_chosen_last(scene_of, mesh_reader, server):
    pages = Pages(scene_of('').loaded, TfOptions(), 0, Units(), mesh_reader)
    clients = {1: server}
    pages._server.get_clients = lambda: clients
    pages.act(0.0)
    pages._pages[1]._angles.value = 'deg'
    while pages._units.angle is not DEGREES:
        pages.act(0.1)
    clients[2] = clients.pop(1)  # both would draw on one server
    pages.act(0.0)
    assert pages._pages[2].units.angle is DEGREES
    pages.close()


@pytest.mark.parametrize(('text', 'title'), [
    (TEXT, 'm'), ('<sdf version="1.11"><world name="w"/></sdf>', 'cell.sdf')])
def test_title_is_the_name_of_the_model_or_else_of_the_file(text, title, mesh_reader):
    pages = Pages(
        load_text(text.encode(), 'cell.sdf', shapes=True), TfOptions(), 0, Units(), mesh_reader)
    assert f'<title>{title}</title>' in pages.html()
    pages.close()


def test_line_joins_the_frames_that_are_measured(page_of):
    page = page_of('<sensor name="s" type="imu"><pose>1 2 3 0 0 0</pose></sensor>')
    select(page, 'l')
    assert page._drawing._measured.points.shape == (0, 2, 3)
    page._selected._measure_from_here()
    select(page, 'l/s')
    assert page._drawing._measured.points.tolist()[-1] == [[0, 0, 0], [1, 2, 3]]
    assert labels(page)[0] == ['3.7417 m', True, 0.5, 1.0, 1.5]


def test_each_click_on_a_shape_adds_a_point_to_measure_and_the_third_begins_anew(page_of):
    page = page_of('')
    page._measures.value = True
    for point, line_count in (('0 0 1', 3), ('0 2 1', 7), ('3 0 0', 3), ('3 0 4', 7)):
        page._answer(f'point {point}')
        page._refresh()
        # Each point is marked by three lines.
        assert len(page._drawing._measured.points) == line_count
    assert page._drawing._measured.points.tolist()[-1] == [[3, 0, 0], [3, 0, 4]]
    assert labels(page)[0] == ['4.0000 m', True, 3.0, 0.0, 2.0]
    page._answer('end measuring')
    page._refresh()
    page._measures.value = True
    page._refresh()
    assert len(page._drawing._measured.points) == 0


def test_click_on_a_frame_selects_it_only_where_nothing_is_measured(page_of):
    page = page_of('')
    page._measures.value = True
    page._answer('click 0')
    assert page._selected.frame == -1
    page._answer('end measuring')
    page._answer('click 0')
    assert page._selected.frame == 0


def test_bounds_of_a_frame_have_its_axes_and_bodies(page_of):
    page = page_of('<visual name="v"><pose>5 0 0 0 0 0</pose><geometry><box/></geometry></visual>')
    visible = page._drawing.visible
    lowest, highest = visible.bounds_of_frame(page._shown, page._shown.ids.index('l'))
    assert (lowest[0], highest[0]) == (-3.0 * visible.axes_length_m, 5.5)
    assert visible.bounds_of_frame(page._shown, -1)[1, 0] == 3.0 * visible.axes_length_m


def test_page_says_so_when_collisions_are_switched_on(page_of):
    page = page_of(f'<collision name="c">{MESH}</collision>')
    assert page._reasons.content == ''
    set_switches(page, True, 'collisions')
    assert '1 shape cannot be drawn: the mesh &quot;&lt;b&gt;&quot;: ' in page._reasons.content


# The selected frame

def shown_scene(*frames):
    text = ''.join(f'<frame name="{name}"/>' for name in frames)
    scene = load_text(
        f'<sdf version="1.11"><world name="w">{text}</world></sdf>'.encode(), 'cell.sdf')
    return ShownScene(scene, TfOptions())


@pytest.fixture
def selected(server):
    selected = SelectedFrame(server.gui, server.gui.add_folder(''), Events(Event()))
    selected.list_frames(shown_scene('a', 'b', 'c'))
    return selected


def test_frame_that_is_gone_is_not_selected(selected):
    selected.answer('select', 3)
    assert selected.frame == -1


def test_selected_frame_stays_where_others_are_listed(selected):
    selected.answer('select', 1)
    selected.list_frames(shown_scene('b'))
    assert selected.frame == 0
    selected.list_frames(shown_scene('a'))
    assert selected.frame == -1


def test_camera_of_a_file_that_was_empty_sees_all_of_the_mended_one(mesh_reader):
    empty, large = (
        load_text(f'<sdf version="1.11"><world name="w">{content}</world></sdf>', 'w.sdf')
        for content in (
            '', '<frame name="a"/><frame name="b"><pose>1000 0 0 0 0 0</pose></frame>'))
    with closing(Pages(empty, TfOptions(), 0, Units(), mesh_reader)) as pages:
        pages.show(large)
        camera = pages._server.initial_camera
        assert camera.far > 10_000.0
        assert camera.look_at[0] > 100.0
