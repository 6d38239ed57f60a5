# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What the page shows, without a browser; page/ uses it in one."""

import asyncio
from contextlib import closing
import html
import json
import re
from threading import Event

import numpy as np
import pytest

pytest.importorskip('viser', reason='needs viser')
from viser import MainPanelHandle

from sdf_pose_bridge import load
from sdf_pose_bridge.cli.viewer.drawing import HIDDEN_AT_FIRST
from sdf_pose_bridge.cli.viewer.page import Page, Pages
from sdf_pose_bridge.cli.viewer.shown_scene import ShownScene
from sdf_pose_bridge.export.pose_setting import PoseChange
from sdf_pose_bridge.file_change import FileChange
from sdf_pose_bridge.geometry.units import DEGREES, RADIANS, Units
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.tf.tree import TfOptions

TEXT = """<sdf version="1.11"><model name="m"><link name="l"/></model></sdf>"""
BOX = '<visual name="v"><geometry><box/></geometry></visual>'
JOINT = """</link><link name="k"/><joint name="j" type="prismatic"><parent>l</parent>
  <child>k</child><axis><xyz>0 0 1</xyz></axis></joint><link name="other">"""
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


def ask(page, *request):
    page._answer(json.dumps([request]))


def measure(page):
    """Switch measuring on, or off."""
    ask(page, 'set', 'measure points', not page._measures.value)


def select(page, frame):
    ask(page, 'select', frame)
    page._refresh()


def given(page, name):
    """What the script is given under a name."""
    (data,) = re.findall(f'data-{name}="([^"]*)"', page._data[name].content)
    return html.unescape(data)


def labels(page):
    return json.loads(given(page, 'labels'))['labels']


def test_name_moves_with_its_frame_when_the_file_is_read_again(page_of, scene_of):
    sensor = '<sensor name="s" type="imu"><pose>0 0 {} 0 0 0</pose></sensor>'
    page = page_of(sensor.format(0))
    select(page, 'l/s')
    page.show(scene_of(sensor.format(0.1)))
    assert labels(page) == [['s', True, 0.0, 0.0, 0.1]]


def test_what_is_switched_off_is_not_drawn(page_of):
    page = page_of(BOX)
    assert all(nodes(page, 'grid', 'visual 0'))
    set_switches(page, False, 'visuals', 'grid')
    assert not any(nodes(page, 'grid', 'visual 0'))


def test_drawing_shares_no_name_with_the_one_before(page_of):
    page = page_of(BOX)
    (before,) = nodes(page, 'visual 0')
    set_switches(page, False, 'grid')
    (after,) = nodes(page, 'visual 0')
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
    ask(page, 'relative', 'l')
    select(page, 'l/s')
    assert page._drawing._measured.points.tolist()[-1] == [[0, 0, 0], [1, 2, 3]]
    assert labels(page)[0] == ['3.7417 m', True, 0.5, 1.0, 1.5]


def test_each_click_on_a_shape_adds_a_point_to_measure_and_the_third_begins_anew(page_of):
    page = page_of(BOX)
    measure(page)
    for point, line_count in (((0, 0, 1), 3), ((0, 2, 1), 7), ((3, 0, 0), 3), ((3, 0, 4), 7)):
        ask(page, 'point', 0, *point)
        page._refresh()
        # Each point is marked by three lines.
        assert len(page._drawing._measured.points) == line_count
    assert page._drawing._measured.points.tolist()[-1] == [[3, 0, 0], [3, 0, 4]]
    assert labels(page)[0] == ['4.0000 m', True, 3.0, 0.0, 2.0]
    for _ in range(2):
        measure(page)
        page._refresh()
    assert len(page._drawing._measured.points) == 0


def test_measured_points_stay_on_their_bodies(page_of, scene_of):
    page = page_of(BOX)
    measure(page)
    ask(page, 'point', 0, 0, 0, 0.5)
    ask(page, 'point', 0, 0, 0.5, 0)
    page.show(scene_of(BOX.replace(
        '<geometry>', '<pose degrees="1">1 0 0 90 0 0</pose><geometry>')))
    assert page._drawing._measured.points[-1] == pytest.approx(
        np.array([[1, -0.5, 0], [1, 0, 0.5]]))
    page.show(scene_of(BOX.replace('visual', 'collision')))
    assert 'the points are gone' in given(page, 'strip')
    for _ in range(2):
        measure(page)
        page._refresh()
    assert 'are gone' not in given(page, 'strip')


@pytest.mark.parametrize('text', [
    '', '[', '3', '{"a": 1}', '[' * 100_000, '[3]', '[[]]', '[["point"]]', '[["point", 0]]',
    '[["point", 0, 0, 0]]', '[["point", 1, 0, 0, 0]]',
    '[["point", 0, "a", 0, 0]]', '[["point", 0, null, 0, 0]]', '[["point", 0, 1, 2, 3, 4]]',
    '[["point", 0, 1e999, 0, 0]]', '[["point", [], 0, 0, 0]]', '[["camera", 1, 2]]',
    '[["camera", 1, 2, "a", 0, 0, 0]]', '[["width", -1]]', '[["width", "a"]]',
    '[["joint", "x", 1]]', '[["joint", "j", "a"]]', '[["joint", "j", 1e999]]',
    '[["set", "opacity", "a"]]', '[["set", "opacity", null]]', '[["set", "x", 1.0]]',
    '[["set", [], 1.0]]', '[["set", "opacity"]]',
    '[["select", 3]]', '[["fold"]]', '[["relative", "x"]]', '[["write to file"]]'])
def test_wrong_request_of_the_script_does_nothing(page_of, text):
    page = page_of(BOX + JOINT, find_change=print)
    measure(page)
    page._refresh()
    before = given(page, 'kept')
    page._answer(text)
    page._refresh()
    assert (given(page, 'kept'), page._points) == (before, [])


def test_requests_of_the_script_that_come_at_once_are_all_processed(page_of):
    page = page_of(JOINT)
    (asked,) = (each for each in page._client.gui._gui_input_handle_from_uuid.values()
                if each.label == 'asked')
    for number, request in enumerate((['select', 'k'], ['fold', 'l'])):
        # As viser does with a message of a browser.
        asked._impl.value = f'{number} {json.dumps([request])}'
        for told in asked._impl.update_cb:
            asyncio.run(told(None))
    page.act()
    kept = json.loads(given(page, 'kept'))
    assert ['select', 'k'] in kept
    assert ['fold', 'l'] in kept


@pytest.mark.parametrize(('width', 'panel'), [(2000, [360]), (800, [280]), (700, [245, 'folded'])])
def test_panel_leaves_room_for_the_scene_in_a_window(page_of, monkeypatch, width, panel):
    page, done = page_of(''), []
    monkeypatch.setattr(MainPanelHandle, 'set_width', lambda _, width: done.append(round(width)))
    monkeypatch.setattr(MainPanelHandle, 'minimize', lambda _: done.append('folded'))
    ask(page, 'width', width)
    assert done == panel


def test_unknown_unit_of_angles_is_radians(page_of):
    page = page_of('')
    ask(page, 'set', 'angles', 'x')
    page._refresh()
    assert page.units.angle is RADIANS


def test_page_of_the_next_start_is_as_the_one_before(page_of, server):
    first = page_of(JOINT)
    for request in (
            ('select', 'k'), ('relative', 'l'), ('fold', 'l'), ('hide', 'other'),
            ('joint', 'j', 0.25), ('set', 'visuals', False), ('set', 'opacity', 0.5),
            ('set', 'angles', 'deg'), ('set', 'dark background', True)):
        ask(first, *request)
    first._refresh()
    kept = given(first, 'kept')
    server.scene.reset()
    server.gui.reset()
    second = page_of(JOINT)
    assert kept != given(second, 'kept')
    second._answer(kept)
    while second._hidden != {*HIDDEN_AT_FIRST, 'visuals'}:
        second.act()
    second._refresh()
    assert given(second, 'kept') == kept
    assert second._shown.positions == {'j': 0.25}


def test_click_on_a_frame_selects_it_only_where_nothing_is_measured(page_of):
    page = page_of('')
    measure(page)
    ask(page, 'click', 'l')
    assert page._selected.frame == -1
    measure(page)
    ask(page, 'click', 'l')
    assert page._shown.ids[page._selected.frame] == 'l'


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


def test_camera_of_a_file_that_was_empty_sees_all_of_the_mended_one(mesh_reader, server):
    empty, large = (
        load_text(f'<sdf version="1.11"><world name="w">{content}</world></sdf>', 'w.sdf')
        for content in (
            '', '<frame name="a"/><frame name="b"><pose>1000 0 0 0 0 0</pose></frame>'))
    with closing(Pages(empty, TfOptions(), 0, Units(), mesh_reader)) as pages:
        pages.show(large)
        pages._server.get_clients = lambda: {1: server}
        pages.act(0.0)
        assert server.camera.far > 10_000.0
        assert server.camera.look_at[0] > 100.0
