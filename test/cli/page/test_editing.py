# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The page in a real browser: numbers, the gizmo and the file that they change."""

import html
import json

import pytest
from shown_page import (
    control,
    drag,
    enter,
    has_keyboard,
    HOSTILE,
    is_in_window,
    LABELS,
    point_on_screen,
    press,
    ROWS,
    select,
    strip_button,
    TEXT,
    type_over,
    wait_for_name_at,
    wait_until_movable,
)

from sdf_pose_bridge import load


@pytest.mark.parametrize('number', ['-0.25', '6.1e-05'])
def test_typed_number_is_the_one_that_is_written(page, shown, number):
    type_over(page, control('x [m]'), number)
    page.wait_for(f"document.querySelector('.difference')?.rows[1].cells[2].innerText "
                  f"=== '{float(number):.4f}'")
    assert page.run(f'{control("x [m]")}.value') == number
    press(page, 'write to file')
    line = 1 + TEXT[:TEXT.index('1 0 0 0 0 0')].count('\n')
    page.wait_for(f"""document.querySelector('.strip').innerText.includes(
      'written to cell.sdf:{line}')""")
    assert load(shown.file).pose(HOSTILE)[:3] == pytest.approx((float(number), 0, 0), abs=1e-9)
    press(page, 'undo the last write')


@pytest.mark.parametrize('text', ['1/2', '1,234.5'])
def test_typed_text_that_is_no_number_is_not_written(page, text):
    type_over(page, control('y [m]'), text)
    page.wait_for(f"""document.querySelector('.strip .errors')?.innerText
      === "'{text}' is not a number" """)
    page.wait_for(is_in_window(strip_button('cancel')))
    assert page.run(f"{strip_button('write to file')}") is None
    press(page, 'cancel')
    page.wait_for(f"{control('y [m]')}.value === '0.0000'")


FIELDS = [f'{label} [{unit}]' for label, unit in zip(
    ('x', 'y', 'z', 'roll', 'pitch', 'yaw'), 3 * ['m'] + 3 * ['deg'], strict=True)]


def test_fields_are_in_view_beside_the_tree_where_a_frame_is_clicked(sized_page, shown):
    select(sized_page, 'slide')
    for label in FIELDS:
        sized_page.wait_for(is_in_window(control(label)))
    sized_page.wait_for(is_in_window("document.querySelector('.rows .selected')"))
    line = 1 + TEXT[:TEXT.index('"slide"')].count('\n')
    text = f'in the file {shown.file}:{line} relative_to="arm": no pose'
    sized_page.wait_for(f"document.querySelector('.strip').innerText.includes({json.dumps(text)})")


def test_frame_is_selected_typed_written_and_cancelled_by_the_keyboard(page, shown):
    page.run(f"{control('search')}.focus()")
    page.keys(*'IMG', 'Enter')
    page.wait_for(has_keyboard("document.querySelector('.rows .selected')"))
    wait_until_movable(page)
    # The folder of the fields can be folded by keys, too.
    page.keys('Tab', 'Tab')
    page.wait_for(has_keyboard(control('x [m]')))
    page.keys(*'0.25')
    page.wait_for(strip_button('write to file'))
    page.run("window.clicks = 0; window.addEventListener('click', () => { window.clicks++; })")
    page.keys('Enter')
    assert page.run('window.clicks') == 0
    page.wait_for(has_keyboard(strip_button('write to file')))
    page.keys('Enter')
    page.wait_for("document.querySelector('.strip').innerText.includes('written to')")
    assert load(shown.file).pose(HOSTILE)[:3] == pytest.approx((0.25, 0, 0), abs=1e-9)
    assert page.run("document.querySelector('.difference').rows[1].innerText").split('\t') == [
        'x [m]', '1.0000', '0.2500', '-0.7500']
    page.wait_for(has_keyboard(control('x [m]')))
    page.keys('7', 'Escape')
    page.wait_for(f"{control('x [m]')}.value === '0.2500' && !{strip_button('cancel')}")
    press(page, 'undo the last write')
    enter(page, control('search'), '')


def test_frame_is_dragged_and_written(page, shown):
    select(page, HOSTILE)
    drag(page)
    press(page, 'write to file')
    pose = load(shown.file).pose(HOSTILE)
    assert pose[:3] == pytest.approx((1.0, 0.0, 0.1), abs=0.02)
    changed = shown.file.read_text().splitlines()
    assert [line for line in TEXT.splitlines() if line not in changed] == [
        f'  <frame name="{html.escape(HOSTILE)}"><pose>1 0 0 0 0 0</pose></frame>']
    press(page, 'undo the last write')
    assert shown.file.read_text() == TEXT


URDF = """<robot name="r">
<link name="base"/><link name="tool"/>
<joint name="j" type="fixed">
  <!-- measured --><origin rpy="0 0 0" xyz="1 0 0"/><parent link="base"/><child link="tool"/>
</joint></robot>"""


def test_the_origin_of_a_urdf_is_written(page, shown):
    shown.file.write_text(URDF)
    select(page, 'tool')
    enter(page, control('x [m]'), '0.25')
    press(page, 'write to file')
    page.wait_for("""document.querySelector('.strip').innerText.includes(
        'written to cell.sdf:4')""")
    assert shown.file.read_text() == URDF.replace('xyz="1 ', 'xyz="0.25 ')
    press(page, 'undo the last write')
    assert shown.file.read_text() == URDF


def test_what_moves_is_drawn_and_named_before_it_is_written(sized_page, shown):
    select(sized_page, 'arm')
    enter(sized_page, control('x [m]'), '0.5')
    sized_page.wait_for(is_in_window("document.querySelector('.strip .moved')"))
    assert '"arm/base"' in sized_page.run("document.querySelector('.moved').innerText")
    wait_for_name_at(
        sized_page, *point_on_screen(sized_page, (0.6, -0.1, 0.09)), 'arm/base, visual v')
    assert shown.file.read_text() == TEXT
    press(sized_page, 'cancel')
    wait_for_name_at(
        sized_page, *point_on_screen(sized_page, (0.1, -0.1, 0.09)), 'arm/base, visual v')
    assert sized_page.run("document.querySelector('.moved')") is None


def test_scene_is_seen_while_one_types_on_a_phone(page, tab, shown):
    tab.size(390, 844)
    tab.open(shown.address)
    select(tab, HOSTILE)
    field = control('yaw [deg]')
    type_over(tab, field, '1')
    tab.wait_for(is_in_window(strip_button('write to file')))
    tab.wait_for(is_in_window(field))
    # From above: the strip, the scene, the field.
    tab.wait_for(f"""(canvas => canvas.height >= 0.29 * innerHeight
      && canvas.top >= document.querySelector('.strip').getBoundingClientRect().bottom - 1
      && canvas.bottom <= {field}.getBoundingClientRect().top)(
      document.querySelector('canvas').getBoundingClientRect())""")


def test_frame_is_moved_in_a_narrow_window_where_the_panel_is_folded(page, tab, shown):
    tab.size(700, 600)
    tab.open(shown.address)
    tab.wait_for(
        "(width => width > 600 && width < 700)(document.querySelector('canvas')?.clientWidth)")
    wait_for_name_at(tab, *point_on_screen(tab, (1.0, 0.0, 0.0)), HOSTILE)
    tab.mouse(point_on_screen(tab, (1.0, 0.0, 0.05)))
    drag(tab)
    press(tab, 'cancel')
    assert tab.run(f'{LABELS}.map(label => label.innerText)') == [HOSTILE]
    assert tab.run(f'{ROWS}.length') == 0
    assert tab.run('window.wasRun') is None


def test_page_asks_for_nothing_elsewhere(page, shown):
    assert [request for request in page.requests if not request.startswith(
        (shown.address, shown.address.replace('http', 'ws'), 'data:', 'blob:', 'about:'))] == []
    assert page.errors == []
