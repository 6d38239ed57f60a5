# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The page in a real browser: the distance of two points that are clicked on shapes."""

import re

import pytest
from shown_page import control, HOSTILE, LABELS, point_on_screen, ROWS, select, wait_for_name_at

POINTS = (0.1, 0.05, -0.05), (-0.05, -0.1, -0.05)
"""Points on two faces of the box."""
STRIP = "document.querySelector('.strip').innerText"
SELECTED = "document.querySelector('.rows .selected')?.textContent"


def click(tab, point):
    tab.mouse(point_on_screen(tab, point))


def test_points_are_clicked_until_escape(page, tab, shown):
    tab.size(1366, 768)
    tab.open(shown.address)
    tab.wait_for(f'{ROWS}.length === 5')
    wait_for_name_at(tab, *point_on_screen(tab, POINTS[0]), 'arm/base, visual v')
    click(tab, POINTS[0])
    tab.wait_for(f"{SELECTED} === 'base'")
    select(tab, HOSTILE)
    switch = control('measure points')
    tab.run(f'{switch}.click()')
    for point in POINTS:
        tab.wait_for(f"{STRIP}.includes('point {1 + POINTS.index(point)} of 2')")
        click(tab, point)
    tab.wait_for(f"{STRIP}.includes('from point 1 to 2')")
    distance, *xyz = re.search(
        r'^(\S+) m from point 1 to 2, xyz (\S+) (\S+) (\S+) in world', tab.run(STRIP)).groups()
    # A pixel is 2 mm wide.
    assert [*map(float, xyz)] == pytest.approx((-0.15, -0.15, 0.0), abs=0.005)
    tab.wait_for(f"{LABELS}.some(label => label.innerText === '{distance} m')")
    # A drag turns the camera, and is no click.
    x, y = point_on_screen(tab, POINTS[0])
    tab.mouse((x, y), (x + 20, y))
    tab.run(f"{control('names of frames')}.click()")
    tab.wait_for(f"{LABELS}.some(label => label.innerText.includes('base'))")
    assert tab.run(STRIP).startswith(f'{distance} m')
    assert tab.run(SELECTED) == HOSTILE
    tab.keys('Escape')
    tab.wait_for(f"!{switch}.checked && !{STRIP}.includes('point')")
