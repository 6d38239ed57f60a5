# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The page in a real browser: the picture, its names and colors, and who may see it."""

import re
from urllib.parse import urlsplit

from deadline import DEADLINE_S
import mesh_texts
import needs
import pytest
from shown_page import (
    BOX,
    control,
    enter,
    IN_WINDOW,
    is_in_window,
    LABELS,
    point_on_screen,
    ROWS,
    run_view,
    select,
    TEXT,
    view_of,
    wait_for_name_at,
)


def test_name_stays_at_its_frame(page):
    select(page, 'slide')
    for position in (0.2, 0.0):
        enter(page, control('rail'), str(position))
        x, y = point_on_screen(page, (0.0, 0.0, position))
        page.wait_for(f"""{LABELS}.some(label => (box => label.innerText === 'slide'
          && Math.hypot(box.left - {x}, box.top - {y}) < 2)(label.getBoundingClientRect()))""")


def test_written_page_has_names_that_do_not_overlap_and_asks_for_nothing(tab, tmp_path):
    # From the camera, the last one is a little further, and further right.
    long = 40 * 'a'
    points = {**{f'p{number}': (0.0, 0.0, 2.0) for number in range(6)},
              long: (1.0, 0.0, 0.0), 'far': (1.05, 0.15, 0.0)}
    frames = ''.join(f'<frame name="{name}"><pose>{" ".join(map(str, point))} 0 0 0</pose></frame>'
                     for name, point in points.items())
    (tmp_path / 'cell.sdf').write_text(
        f'<sdf version="1.11"><world name="w">{frames}</world></sdf>')
    process = run_view(tmp_path, 'cell.sdf', '-o', 'page.html')
    assert process.communicate(timeout=DEADLINE_S) == ('', '')
    tab.open((tmp_path / 'page.html').as_uri())
    tab.wait_for(f'{LABELS}.length')
    texts = tab.run(f'{LABELS}.map(label => label.innerText)')
    assert sorted(texts) == sorted([
        'p0\np1\np2\np3\nand 2 more', long,
        '1 more name does not fit; the page of "sdf_pose view" shows names at the pointer'])
    assert tab.run('document.title') == 'cell.sdf'
    assert [request for request in tab.requests
            if not re.match('file:|data:|blob:|about:', request)] == []


def test_names_of_frames_are_switched_on(page):
    page.run(f"{control('names of frames')}.click()")
    page.wait_for(f"{LABELS}.some(label => label.innerText.includes('base'))")
    page.run(f"{control('names of frames')}.click()")
    page.wait_for(f'{LABELS}.length === 1')


def test_name_of_a_body_is_that_of_the_last_drawing(page, shown):
    shown.file.write_text(TEXT.replace('<visual name="v">', '<visual name="other">'))
    wait_for_name_at(page, *point_on_screen(page, (0.1, -0.1, 0.09)), 'arm/base, visual other')


def test_opacity_of_bodies_with_and_without_a_texture(page, shown):
    image = pytest.importorskip('PIL.Image', reason='needs Pillow')
    folder = shown.file.parent
    image.new('RGB', (4, 4)).save(folder / 'texture.png')
    (folder / 'colors.mtl').write_text('newmtl red\nmap_Kd texture.png\n')
    (folder / 'mesh.obj').write_text(mesh_texts.TEXTURED_OBJ)
    shown.file.write_text(TEXT.replace(
        '<box><size>0.2 0.2 0.2</size></box>', '<mesh><uri>mesh.obj</uri></mesh>').replace(
        '<material><diffuse>1 0 0 1</diffuse></material>', '').replace(
        '<link name="slide"/>', f'<link name="slide">{BOX}</link>'))
    page.wait_for("opacities() === '1 1'")
    for opacity in ('0.5', '1'):
        enter(page, control('opacity'), opacity)
        page.wait_for(f"opacities() === '{opacity} {opacity}'")


def test_axes_of_the_root_frame_are_in_a_corner(page):
    # The camera is above and in front, so that x points down, and z up.
    page.wait_for(f"{IN_WINDOW}(document.querySelector('.axis-cross')?.getBoundingClientRect())")
    page.wait_for("document.querySelector('.axis-cross').children[2].hasAttribute('d')")
    x_end, z_end = (float(page.run(
        f"document.querySelector('.axis-cross').children[{axis}].getAttribute('d')").split()[-1])
        for axis in (0, 2))
    assert x_end > 5
    assert z_end < -15


def test_dark_page_waits_for_its_file_and_says_when_its_program_has_ended(tab, tmp_path):
    (tmp_path / 'cell.sdf').write_text(TEXT.replace('<parent>base', '<parent>bass'))
    tab.size(800, 600)
    tab.call('Emulation.setEmulatedMedia', features=[
        {'name': 'prefers-color-scheme', 'value': 'dark'}])
    strip = "document.querySelector('.strip')"
    with view_of(tmp_path) as address:
        tab.open(address)
        tab.wait_for(f"{strip}?.querySelector('.errors')?.innerText.match("
                     "'bass.* [(]also line 9[)]$')")
        tab.wait_for(f"{strip}.getBoundingClientRect().right"
                     " <= document.querySelector('canvas')?.clientWidth")
        assert 'no frames' not in tab.run('document.body.innerText')
        (tmp_path / 'cell.sdf').write_text(TEXT)
        tab.wait_for(f"{ROWS}.length === 5 && !document.querySelector('.errors')")
        wait_for_name_at(tab, *point_on_screen(tab, (0.1, -0.1, 0.09)), 'arm/base, visual v')
        tab.wait_for("document.documentElement.dataset.mantineColorScheme === 'dark'")
        tab.size(700, 600)
        tab.wait_for("document.querySelector('canvas').clientWidth < 700")
    tab.wait_for(f"{strip}.innerText.includes('view has ended')")
    tab.wait_for(is_in_window(strip))
    color = tab.run(f'getComputedStyle({strip}).backgroundColor')
    assert max(map(int, re.findall('[0-9]+', color)[:3])) < 100


def test_panel_is_folded_in_a_small_window_of_a_display_with_small_pixels(tab, shown):
    tab.call('Emulation.setDeviceMetricsOverride', width=700, height=300, deviceScaleFactor=2,
             mobile=False)
    tab.open(shown.address)
    tab.wait_for("document.querySelector('[data-kept]') && !document.querySelector('.rows')")
    tab.wait_for("document.querySelector('canvas').clientWidth > 600")


LABELS_ARE_WHOLE = """[...document.querySelectorAll('p > label')].every(label => {
  const box = label.getBoundingClientRect(), text = label.parentElement;
  const limits = label.closest('.mantine-Flex-root').querySelectorAll('.mantine-Slider-markLabel');
  return text.scrollWidth <= text.clientWidth && box.right < innerWidth
    && [...limits].map(limit => limit.getBoundingClientRect()).every(
      limit => limit.left >= box.right || limit.top >= box.bottom);
})"""


def test_labels_are_whole_in_a_panel_that_leaves_room_to_the_scene(page, tab, shown):
    name = 'left_outer_finger_joint_of_the_gripper'
    shown.file.write_text(TEXT.replace('"rail"', f'"{name}"'))
    tab.size(800, 600)
    tab.open(shown.address)
    for each in (page, tab):
        each.wait_for(control(name))
        each.wait_for(LABELS_ARE_WHOLE)
        each.wait_for("document.querySelector('canvas').clientWidth >= 0.64 * innerWidth")


def test_strip_breaks_a_long_name(page, shown):
    name = 150 * 'n'
    shown.file.write_text(TEXT.replace('slide', name))
    select(page, name)
    page.wait_for(f"""(strip => strip?.innerText.includes('{name}')
      && strip.scrollWidth <= strip.clientWidth)(document.querySelector('.strip'))""")


@pytest.mark.parametrize(('has_secret', 'origin'), [
    (False, None), (True, 'http://example.org'), (True, 'null')])
def test_nobody_else_may_connect(shown, has_secret, origin):
    viser = pytest.importorskip('viser', reason='needs viser')
    client = pytest.importorskip('websockets.sync.client', reason='needs websockets')
    exceptions = pytest.importorskip('websockets.exceptions', reason='needs websockets')
    address = urlsplit(shown.address)
    path = address.path if has_secret else '/'
    with pytest.raises(exceptions.InvalidStatus, match='HTTP 403'):
        client.connect(
            f'ws://{address.netloc}{path}', origin=origin,
            subprotocols=[f'viser-v{viser.__version__}'])


def test_picture(tmp_path):
    needs.browser()
    (tmp_path / 'cell.sdf').write_text(TEXT)
    process = run_view(tmp_path, 'cell.sdf', '-o', 'picture.png')
    assert process.communicate(timeout=DEADLINE_S) == ('', '')
    imageio = pytest.importorskip('imageio.v3', reason='needs imageio')
    pixels = imageio.imread(tmp_path / 'picture.png').astype(int)
    assert pixels.shape == (1000, 1600, 3)
    is_red = (pixels[:, :, :1] > pixels[:, :, 1:] + 60).all(axis=2)
    assert 500 < is_red.sum() < 500_000
