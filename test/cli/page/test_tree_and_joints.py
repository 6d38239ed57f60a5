# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The page in a real browser: the tree of frames, joints, errors and hostile names."""

import html
import json

import pytest
from shown_page import (
    control,
    enter,
    has_keyboard,
    HOSTILE,
    is_in_window,
    point_on_screen,
    ROWS,
    select,
    TEXT,
    type_over,
    wait_for_name_at,
)


def test_slider_moves_frames_and_those_that_mimic(page):
    select(page, 'slide')
    assert page.run("document.body.innerText.includes('arm/second')") is False
    enter(page, control('rail'), '0.5')
    page.wait_for("document.body.innerText.includes('xyz 0.0000 0.0000 0.5000 m')")
    select(page, 'follower')
    page.wait_for("document.body.innerText.includes('xyz 0.0000 0.0000 1.0000 m')")


def test_arrow_keys_move_a_slider_and_nothing_else(page):
    page.run("window.keys = 0; window.addEventListener('keydown', () => { window.keys++; })")
    thumb = "document.querySelectorAll('[role=slider]')[1]"
    page.run(f'{thumb}.focus()')
    before = page.run(f'{thumb}.ariaValueNow')
    page.keys('ArrowRight')
    page.wait_for(f"{thumb}.ariaValueNow !== '{before}'")
    assert page.run('window.keys') == 0
    enter(page, control('rail'), '0')


def test_joint_goes_where_is_typed_or_says_why_not(page):
    select(page, 'slide')
    type_over(page, control('rail'), '5e-1')
    page.wait_for("document.body.innerText.includes('xyz 0.0000 0.0000 0.5000 m')")
    assert page.run(f'{control("rail")}.value') == '5e-1'
    type_over(page, control('rail'), '30')
    page.wait_for("""document.querySelector('.strip .errors')?.innerText
      === 'rail: 30 is not between 0.0000 and 2.0000 m'""")
    assert page.run(f'{control("rail")}.value') == '30'
    type_over(page, control('rail'), '0')
    page.wait_for("document.body.innerText.includes('xyz 0.0000 0.0000 0.0000 m')")
    assert page.run("document.querySelector('.strip .errors')") is None


@pytest.mark.parametrize('sized_page', [(1366, 768), (800, 600), (390, 844)], indirect=True)
def test_selected_frame_and_errors_are_in_view(sized_page, shown):
    select(sized_page, 'slide')
    strip = "document.querySelector('.strip')"
    sized_page.wait_for(f"{strip}.innerText.includes('arm/slide in world')")
    sized_page.wait_for(is_in_window(strip))
    shown.file.write_text(TEXT.replace('<parent>base', '<parent>bass'))
    sized_page.wait_for("document.querySelector('.strip .errors')")
    sized_page.wait_for(is_in_window("document.querySelector('.strip .errors')"))


def test_each_tab_has_its_own_selection(page, shown, tab):
    tab.open(shown.address)
    for each, name in ((page, 'slide'), (tab, 'base'), (page, 'follower')):
        select(each, name)
        each.wait_for(f"document.querySelector('.strip').innerText.includes('arm/{name} in')")
    assert tab.run("""['.rows .selected', '.strip b'].map(
        found => document.querySelector(found).textContent)""") == ['base', 'arm/base']


def test_tree_scrolls_to_the_frame_that_is_selected_in_the_scene(page, shown):
    frames = ''.join(f'<frame name="f{number}"/>' for number in range(60))
    shown.file.write_text(TEXT.replace('</world>', f'{frames}</world>'))
    page.wait_for(f'{ROWS}.length === 65')
    assert page.run("document.querySelector('.rows').scrollTop") == 0
    select(page, 'f59')
    page.wait_for("""(row => row.offsetTop + row.clientHeight <= row.parentElement.offsetTop
      + row.parentElement.scrollTop + row.parentElement.clientHeight)(
      document.querySelector('.rows .selected'))""")


def test_frame_is_folded_and_hidden_in_the_tree(page):
    sign = "document.querySelector('.rows [data-ask^={}]:not(:empty)')"
    x, y = point_on_screen(page, (0.1, -0.1, 0.09))
    page.wait_for(f"{sign.format('fold')}.nextSibling.title === 'link'")
    page.run(f"{sign.format('fold')}.click()")
    page.wait_for(f'{ROWS}.length === 2')
    wait_for_name_at(page, x, y, 'arm/base, visual v')
    page.run(f"{sign.format('hide')}.click()")
    wait_for_name_at(page, x, y, '')
    page.run(f"{sign.format('hide')}.click()")
    wait_for_name_at(page, x, y, 'arm/base, visual v')
    page.run(f"{sign.format('fold')}.click()")
    page.wait_for(f'{ROWS}.length === 5')


def test_arrow_keys_move_in_the_tree(page):
    page.run(f'{ROWS}[0].focus()')
    page.keys('ArrowDown', 'ArrowDown', 'ArrowUp', 'Enter')
    second = page.run(f'{ROWS}[1].textContent')
    page.wait_for(f"document.querySelector('.rows .selected')?.textContent === '{second}'")
    page.wait_for(has_keyboard(f'{ROWS}[1]'))
    page.keys('ArrowRight')
    page.wait_for(has_keyboard(f'{ROWS}[1].parentElement.lastChild'))


def test_search(page):
    enter(page, control('search'), 'SLI')
    page.wait_for(f'{ROWS}.length === 1')
    enter(page, control('search'), '')
    page.wait_for(f'{ROWS}.length === 5')


def test_errors_are_shown_above_the_last_scene(page, shown, tab):
    shown.file.write_text(TEXT.replace('<parent>base', '<parent>bass'))
    page.wait_for("document.querySelector('.errors')?.textContent.includes('cell.sdf:')")
    assert page.run(f'{ROWS}.length') == 5
    tab.open(shown.address)
    tab.wait_for("document.querySelector('.strip .errors')")
    shown.file.write_text(TEXT)
    page.wait_for("!document.querySelector('.errors')")


def test_names_and_errors_are_text(page, shown):
    select(page, HOSTILE)
    assert page.run(f"document.body.innerText.includes('{HOSTILE}')")
    wrong = TEXT.replace('<link name="slide"/>', f'<link name="{html.escape(HOSTILE)}::a"/>')
    shown.file.write_text(wrong)
    page.wait_for("document.querySelector('.errors')?.textContent.includes('<img')")
    assert page.run('window.wasRun') is None
    assert page.run("document.querySelectorAll('img[src=x]').length") == 0


def test_folded_section_is_a_line(page):
    section = """[...document.querySelectorAll('.mantine-Paper-root')].findLast(
      each => each.innerText === 'Show').parentElement"""
    page.wait_for(f'{section}.clientHeight < 15')
    assert page.run(f'getComputedStyle({section}).borderBottomWidth') == '0px'


def test_path_of_the_file_is_shown_at_its_name(page, shown):
    title = "[...document.querySelectorAll('div')].findLast(e => e.innerText === 'cell.sdf')"
    x, y = page.run(f"""(box => [box.left + 5, box.top + 5])({title}.getBoundingClientRect())""")
    page.call('Input.dispatchMouseEvent', type='mouseMoved', x=x, y=y)
    page.wait_for(f'{title}.title === {json.dumps(str(shown.file))}')
