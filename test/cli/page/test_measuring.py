# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The page in a real browser: the distance of two points that are clicked on shapes."""

import re

import pytest
from shown_page import control, HOSTILE, LABELS, point_on_screen, select, wait_for_name_at

POINTS = (0.1, 0.05, -0.05), (-0.05, -0.1, -0.05)
"""Points on two faces of the box."""
STRIP = "document.querySelector('.strip').innerText"
SELECTED = "document.querySelector('.rows .selected')?.textContent"


def click(page, point):
    page.mouse(point_on_screen(page, point))


def test_points_are_clicked_until_escape(page):
    wait_for_name_at(page, *point_on_screen(page, POINTS[0]), 'arm/base, visual v')
    click(page, POINTS[0])
    page.wait_for(f"{SELECTED} === 'base'")
    select(page, HOSTILE)
    switch = control('measure points')
    page.run(f'{switch}.click()')
    for point in POINTS:
        page.wait_for(f"{STRIP}.includes('point {1 + POINTS.index(point)} of 2')")
        click(page, point)
    page.wait_for(f"{STRIP}.includes('from point 1 to 2')")
    distance, *xyz = re.search(
        r'^(\S+) m from point 1 to 2, xyz (\S+) (\S+) (\S+) in world', page.run(STRIP)).groups()
    # A pixel is 2 mm wide.
    assert [*map(float, xyz)] == pytest.approx((-0.15, -0.15, 0.0), abs=0.005)
    page.wait_for(f"{LABELS}.some(label => label.innerText === '{distance} m')")
    # A drag turns the camera, and is no click.
    x, y = point_on_screen(page, POINTS[0])
    page.mouse((x, y), (x + 20, y))
    page.run(f"{control('names of frames')}.click()")
    page.wait_for(f"{LABELS}.some(label => label.innerText.includes('base'))")
    assert page.run(STRIP).startswith(f'{distance} m')
    assert page.run(SELECTED) == HOSTILE
    page.keys('Escape')
    page.wait_for(f"!{switch}.checked && !{STRIP}.includes('point')")
    page.run(f"{control('names of frames')}.click()")
    home = "[...document.querySelectorAll('button')].find(each => each.innerText === 'home')"
    page.run(f'{home}.click()')
    wait_for_name_at(page, *point_on_screen(page, POINTS[0]), 'arm/base, visual v')
