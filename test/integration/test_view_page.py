# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The page in a real browser: joints, frames, edited files, errors, and hostile names."""

import contextlib
import html
import os
import re
import subprocess
from types import SimpleNamespace
from urllib.parse import urlsplit

from browser import browser
from command_line import COMMAND, ENVIRONMENT
from deadline import DEADLINE_S, wait_until
import mesh_texts
import numpy as np
import pytest

from sdf_pose_bridge import load
from sdf_pose_bridge.cli.viewer.view_point import view_of_bounds

pytest.importorskip('viser', reason='needs viser')

HOSTILE = '<img src=x onerror="window.wasRun=true">'
TEXT = f"""<sdf version="1.11"><world name="w">
  <model name="arm">
    <link name="base"><visual name="v"><geometry><box><size>0.2 0.2 0.2</size></box></geometry>
      <material><diffuse>1 0 0 1</diffuse></material></visual></link>
    <link name="slide"/>
    <link name="follower"/>
    <joint name="rail" type="prismatic"><parent>base</parent><child>slide</child>
      <axis><xyz>0 0 1</xyz><limit><lower>0</lower><upper>2</upper></limit></axis></joint>
    <joint name="second" type="prismatic"><parent>base</parent><child>follower</child>
      <axis><xyz>0 0 1</xyz><limit><lower>0</lower><upper>4</upper></limit>
        <mimic joint="rail"><multiplier>2</multiplier><offset>0</offset><reference>0</reference>
        </mimic></axis></joint>
  </model>
  <frame name="{html.escape(HOSTILE)}"><pose>1 0 0 0 0 0</pose></frame>
</world></sdf>"""
BOX = '<visual name="v"><geometry><box><size>0.1 0.1 0.1</size></box></geometry></visual>'
AXES_M = 0.1 * np.linalg.norm((1.1, 0.2, 0.2))
ROWS = "[...document.querySelectorAll('.rows [data-ask^=select]')]"


def run_view(folder, *arguments, **options):
    return subprocess.Popen(
        [*COMMAND, 'view', *arguments], cwd=folder, text=True,
        env={**os.environ, **ENVIRONMENT, 'PATH': os.environ['PATH'], 'BROWSER': 'true'},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)


@contextlib.contextmanager
def view_of(folder, *arguments):
    """Show the file cell.sdf in a folder; the address of its page."""
    process = run_view(folder, 'cell.sdf', '--port', '0', *arguments)
    try:
        yield process.stdout.readline().split()[1]
    finally:
        process.terminate()
        process.communicate()


@pytest.fixture(scope='module')
def shown(tmp_path_factory):
    """A file that ``view`` shows, and a browser that shows its page."""
    folder = tmp_path_factory.mktemp('page')
    file = folder / 'cell.sdf'
    file.write_text(TEXT)
    with browser(folder / 'browser') as page, view_of(folder, '--edit') as address:
        page.size(1366, 768)
        page.open(address)
        page.wait_for(f'{ROWS}.length > 0')
        yield SimpleNamespace(
            file=file, page=page, address=address, written_ns=file.stat().st_mtime_ns)


def select(page, name):
    page.wait_for(f"{ROWS}.find(row => row.textContent === '{name}')")
    page.run(f"{ROWS}.find(row => row.textContent === '{name}').click()")
    page.wait_for(f"document.querySelector('.rows .selected')?.textContent === '{name}'")


@pytest.fixture
def page(shown):
    """The page of the file as it was at first."""
    if shown.file.stat().st_mtime_ns != shown.written_ns:
        # Not all that tests write, and then undo, is seen in the tree; this is.
        shown.file.write_text(TEXT.replace('</world>', '<frame name="one more"/></world>'))
        shown.page.wait_for(f'{ROWS}.length === 6')
        shown.file.write_text(TEXT)
        shown.written_ns = shown.file.stat().st_mtime_ns
    shown.page.wait_for(f"{ROWS}.length === 5 && !document.querySelector('.errors')")
    # A frame that the last test has moved is back only when the file has been read again.
    select(shown.page, HOSTILE)
    shown.page.wait_for("document.body.innerText.includes('xyz 1.0000 0.0000 0.0000 m')")
    return shown.page


def enter(page, element, text):
    """Type a text into an input element."""
    page.run(f"""(input => {{
      const prototype = Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, 'value');
      prototype.set.call(input, '{text}');
      input.dispatchEvent(new Event('input', {{bubbles: true}}));
    }})({element})""")


def control(label):
    """Return the input element with a label."""
    return f"""(label => {{
      let node = [...document.querySelectorAll('label')].findLast(
        each => each.textContent.trim() === label);
      while (node && !node.querySelector('input:not([type=hidden])')) node = node.parentElement;
      return node?.querySelector('input:not([type=hidden])');
    }})('{label}')"""


def test_slider_moves_frames_and_those_that_mimic(page):
    select(page, 'slide')
    assert page.run("document.body.innerText.includes('arm/second')") is False
    enter(page, control('rail'), '0.5')
    page.wait_for("document.body.innerText.includes('xyz 0.0000 0.0000 0.5000 m')")
    select(page, 'follower')
    page.wait_for("document.body.innerText.includes('xyz 0.0000 0.0000 1.0000 m')")


IN_WINDOW = """(box => box && box.width > 0 && box.left >= 0 && box.top >= 0
  && box.right <= innerWidth && box.bottom <= innerHeight)"""


def is_in_window(element):
    """Return a condition: the element is wholly in the window, and nothing is above it."""
    return f"""(element => {IN_WINDOW}(element?.getBoundingClientRect())
      && (box => element.contains(document.elementFromPoint(box.left + 3, box.top + 3))
        && element.contains(document.elementFromPoint(box.right - 3, box.bottom - 3)))(
        element.getBoundingClientRect()))({element})"""


@pytest.fixture(params=[(1366, 768), (800, 600)])
def sized_page(page, request):
    page.size(*request.param)
    yield page
    page.size(1366, 768)


@pytest.mark.parametrize('sized_page', [(1366, 768), (800, 600), (390, 844)], indirect=True)
def test_selected_frame_and_errors_are_in_view(sized_page, shown):
    select(sized_page, 'slide')
    strip = "document.querySelector('.strip')"
    sized_page.wait_for(f"{strip}.innerText.includes('arm/slide in world')")
    sized_page.wait_for(is_in_window(strip))
    shown.file.write_text(TEXT.replace('<parent>base', '<parent>bass'))
    sized_page.wait_for("document.querySelector('.strip .errors')")
    sized_page.wait_for(is_in_window("document.querySelector('.strip .errors')"))


FIELDS = [f'{label} [{unit}]' for label, unit in zip(
    ('x', 'y', 'z', 'roll', 'pitch', 'yaw'), 3 * ['m'] + 3 * ['deg'], strict=True)]


def test_fields_are_in_view_beside_the_tree_where_a_frame_is_clicked(sized_page, shown):
    select(sized_page, 'slide')
    for label in FIELDS:
        sized_page.wait_for(is_in_window(control(label)))
    sized_page.wait_for(is_in_window("document.querySelector('.rows .selected')"))
    line = 1 + TEXT[:TEXT.index('"slide"')].count('\n')
    sized_page.wait_for(f"""document.querySelector('.strip').innerText.includes(
      'in the file {shown.file}:{line} relative_to="arm": no pose')""")


def wait_until_movable(page):
    page.wait_for("document.querySelector('.strip')?.innerText.includes('numbers to move it')")


def type_over(page, element, text):
    """Type keys into an input element of the selected frame instead of its text."""
    # Before, the element is still that of the frame before, and loses the keyboard soon.
    wait_until_movable(page)
    page.wait_for(f'(input => input && !input.disabled)({element})')
    page.run(f'(input => {{ input.focus(); input.select(); }})({element})')
    page.keys(*text)


@pytest.mark.parametrize('number', ['-0.25', '6.1e-05'])
def test_typed_number_is_the_one_that_is_written(page, shown, number):
    type_over(page, control('x [m]'), number)
    page.wait_for(f"document.querySelector('.difference')?.rows[1].cells[2].innerText "
                  f"=== '{float(number):.4f}'")
    assert page.run(f'{control("x [m]")}.value') == number
    page.run(f"{strip_button('write to file')}.click()")
    line = 1 + TEXT[:TEXT.index('1 0 0 0 0 0')].count('\n')
    page.wait_for(f"""document.querySelector('.strip').innerText.includes(
      'written to cell.sdf:{line}')""")
    assert load(shown.file).pose(HOSTILE)[:3] == pytest.approx((float(number), 0, 0), abs=1e-9)
    page.run(f"{strip_button('undo the last write')}.click()")
    page.wait_for(f"!{strip_button('undo the last write')}")


@pytest.mark.parametrize('text', ['1/2', '1,234.5'])
def test_typed_text_that_is_no_number_is_not_written(page, text):
    type_over(page, control('y [m]'), text)
    page.wait_for(f"""document.querySelector('.strip .errors')?.innerText
      === "'{text}' is not a number" """)
    page.wait_for(is_in_window(strip_button('cancel')))
    assert page.run(f"{strip_button('write to file')}") is None
    page.run(f"{strip_button('cancel')}.click()")
    page.wait_for(f"{control('y [m]')}.value === '0.0000'")


def test_dark_page_of_a_dark_system_and_a_tab_whose_program_has_ended(tmp_path):
    (tmp_path / 'cell.sdf').write_text(TEXT)
    with browser(tmp_path / 'browser') as page:
        page.size(700, 600)
        page.call('Emulation.setEmulatedMedia', features=[
            {'name': 'prefers-color-scheme', 'value': 'dark'}])
        with view_of(tmp_path) as address:
            page.open(address)
            page.wait_for("document.documentElement?.dataset.mantineColorScheme === 'dark'")
        strip = "document.querySelector('.strip')"
        page.wait_for(f"{strip}?.innerText.includes('view has ended')")
        page.wait_for(is_in_window(strip))
        color = page.run(f'getComputedStyle({strip}).backgroundColor')
        assert max(map(int, re.findall('[0-9]+', color)[:3])) < 100


def test_each_tab_has_its_own_selection(page, shown, tmp_path):
    with browser(tmp_path / 'browser') as other:
        other.size(1366, 768)
        other.open(shown.address)
        for tab, name in ((page, 'slide'), (other, 'base'), (page, 'follower')):
            select(tab, name)
            tab.wait_for(f"document.querySelector('.strip').innerText.includes('arm/{name} in')")
        assert other.run("""['.rows .selected', '.strip b'].map(
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


LABELS = "[...document.querySelectorAll('.labels div')]"


def test_name_stays_at_its_frame(page):
    select(page, 'slide')
    for position in (0.2, 0.0):
        enter(page, control('rail'), str(position))
        x, y = point_on_screen(page, (0.0, 0.0, position))
        page.wait_for(f"""{LABELS}.some(label => (box => label.innerText === 'slide'
          && Math.hypot(box.left - {x}, box.top - {y}) < 2)(label.getBoundingClientRect()))""")


def test_names_do_not_overlap(tmp_path):
    # From the camera, the last one is a little further, and further right.
    long = 40 * 'a'
    points = {**{f'p{number}': (0.0, 0.0, 2.0) for number in range(6)},
              long: (1.0, 0.0, 0.0), 'far': (1.05, 0.15, 0.0)}
    frames = ''.join(f'<frame name="{name}"><pose>{" ".join(map(str, point))} 0 0 0</pose></frame>'
                     for name, point in points.items())
    (tmp_path / 'cell.sdf').write_text(
        f'<sdf version="1.11"><world name="w">{frames}</world></sdf>')
    run_view(tmp_path, 'cell.sdf', '-o', 'page.html').communicate(timeout=DEADLINE_S)
    with browser(tmp_path / 'browser') as page:
        page.size(1366, 768)
        page.open((tmp_path / 'page.html').as_uri())
        page.wait_for(f'{LABELS}.length')
        texts = page.run(f'{LABELS}.map(label => label.innerText)')
    assert sorted(texts) == sorted(['p0\np1\np2\np3\nand 2 more', long])


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


def has_keyboard(element):
    return f'document.activeElement === {element}'


def test_frame_is_selected_typed_written_and_cancelled_by_the_keyboard(page, shown):
    page.run(f"{control('search')}.focus()")
    page.keys(*'IMG', 'Enter')
    page.wait_for(has_keyboard("document.querySelector('.rows .selected')"))
    wait_until_movable(page)
    page.keys('Tab')
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
    enter(page, control('search'), '')


def test_arrow_keys_move_in_the_tree(page):
    page.run(f'{ROWS}[0].focus()')
    page.keys('ArrowDown', 'ArrowDown', 'ArrowUp', 'Enter')
    second = page.run(f'{ROWS}[1].textContent')
    page.wait_for(f"document.querySelector('.rows .selected')?.textContent === '{second}'")
    page.wait_for(has_keyboard(f'{ROWS}[1]'))
    page.keys('ArrowRight')
    page.wait_for(has_keyboard(f'{ROWS}[1].parentElement.lastChild'))


def test_names_of_frames_are_switched_on(page):
    page.run(f"{control('names of frames')}.click()")
    page.wait_for(f"{LABELS}.some(label => label.innerText.includes('base'))")
    page.run(f"{control('names of frames')}.click()")
    page.wait_for(f'{LABELS}.length === 1')


def test_search(page):
    enter(page, control('search'), 'SLI')
    page.wait_for(f'{ROWS}.length === 1')
    enter(page, control('search'), '')
    page.wait_for(f'{ROWS}.length === 5')


def test_errors_are_shown_above_the_last_scene(page, shown, tmp_path):
    shown.file.write_text(TEXT.replace('<parent>base', '<parent>bass'))
    page.wait_for("document.querySelector('.errors')?.textContent.includes('cell.sdf:')")
    assert page.run(f'{ROWS}.length') == 5
    with browser(tmp_path / 'browser') as later:
        later.open(shown.address)
        later.wait_for("document.querySelector('.strip .errors')")
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


def point_on_screen(page, point):
    """Return where a point of the scene is in the picture, as the camera stands at first."""
    width, height = page.run(
        "(canvas => [canvas.clientWidth, canvas.clientHeight])(document.querySelector('canvas'))")
    view = view_of_bounds(
        np.array([(-0.1, -0.1, -0.1), (1.0 + AXES_M, AXES_M, AXES_M)]), (0.75, -0.5, 0.45))
    to_scene = view.look_at - view.position
    forward = to_scene / np.linalg.norm(to_scene)
    right = np.cross(forward, (0, 0, 1))
    right /= np.linalg.norm(right)
    x, y, z = np.array([right, np.cross(right, forward), forward]) @ (point - view.position)
    scale = 0.5 * height / np.tan(0.4)
    return 0.5 * width + scale * x / z, 0.5 * height - scale * y / z


def strip_button(text):
    return f"[...document.querySelectorAll('.strip button')].find(l => l.innerText === '{text}')"


def drag(page):
    """Drag the gizmo of the frame with the hostile name upwards, 11 pixels beside its arrow."""
    wait_until_movable(page)
    # Nothing says when the gizmo is drawn; until then there is nothing to drag.
    page.run('new Promise(drawn => requestAnimationFrame(() => requestIdleCallback(drawn)))')
    points = (point_on_screen(page, (1.0, 0.0, height)) for height in (0.0, 0.02, 0.05, 0.08, 0.1))
    # The arrow is 8 pixels further right there.
    page.mouse(*((x + 8 - 11, y - 70) for x, y in points))
    z = "document.querySelector('.difference')?.rows[3].cells[2].innerText"
    page.wait_for(f'Math.abs({z} - 0.1) < 0.02')
    for label in ('write to file', 'cancel'):
        page.wait_for(is_in_window(strip_button(label)))


def test_frame_is_dragged_and_written(page, shown):
    select(page, HOSTILE)
    drag(page)
    page.run(f"{strip_button('write to file')}.click()")
    page.wait_for(f"!{strip_button('write to file')}")
    pose = load(shown.file).pose(HOSTILE)
    assert pose[:3] == pytest.approx((1.0, 0.0, 0.1), abs=0.02)
    changed = shown.file.read_text().splitlines()
    assert [line for line in TEXT.splitlines() if line not in changed] == [
        f'  <frame name="{html.escape(HOSTILE)}"><pose>1 0 0 0 0 0</pose></frame>']
    page.run(f"{strip_button('undo the last write')}.click()")
    page.wait_for(f"!{strip_button('undo the last write')}")
    assert shown.file.read_text() == TEXT


def name_at(page, x, y):
    """Move the pointer to a point and rest there; return the name that is shown then."""
    for dx in (1, 0):
        page.call('Input.dispatchMouseEvent', type='mouseMoved', x=x + dx, y=y)
    return page.run("""new Promise(rested => setTimeout(rested, 200)).then(
      () => document.querySelector('.name-at-pointer')?.textContent)""")


def wait_for_name_at(page, x, y, name):
    # Nothing says when the axes and bodies are drawn; until then there is no name.
    wait_until(lambda: name_at(page, x, y) == name, lambda: None, lambda: name)


def test_what_moves_is_drawn_and_named_before_it_is_written(sized_page, shown):
    select(sized_page, 'arm')
    enter(sized_page, control('x [m]'), '0.5')
    sized_page.wait_for(is_in_window("document.querySelector('.strip .moved')"))
    assert '"arm/base"' in sized_page.run("document.querySelector('.moved').innerText")
    wait_for_name_at(
        sized_page, *point_on_screen(sized_page, (0.6, -0.1, 0.09)), 'arm/base, visual v')
    assert shown.file.read_text() == TEXT
    sized_page.run(f"{strip_button('cancel')}.click()")
    wait_for_name_at(
        sized_page, *point_on_screen(sized_page, (0.1, -0.1, 0.09)), 'arm/base, visual v')
    assert sized_page.run("document.querySelector('.moved')") is None


def test_name_of_a_body_is_that_of_the_last_drawing(page, shown):
    shown.file.write_text(TEXT.replace('<visual name="v">', '<visual name="other">'))
    wait_for_name_at(page, *point_on_screen(page, (0.1, -0.1, 0.09)), 'arm/base, visual other')


def test_opacity_of_bodies_with_and_without_a_texture(tmp_path):
    image = pytest.importorskip('PIL.Image', reason='needs Pillow')
    image.new('RGB', (4, 4)).save(tmp_path / 'texture.png')
    (tmp_path / 'colors.mtl').write_text('newmtl red\nmap_Kd texture.png\n')
    (tmp_path / 'mesh.obj').write_text(mesh_texts.TEXTURED_OBJ)
    (tmp_path / 'cell.sdf').write_text(TEXT.replace(
        '<box><size>0.2 0.2 0.2</size></box>', '<mesh><uri>mesh.obj</uri></mesh>').replace(
        '<material><diffuse>1 0 0 1</diffuse></material>', '').replace(
        '<link name="slide"/>', f'<link name="slide">{BOX}</link>'))
    with view_of(tmp_path) as address, browser(tmp_path / 'browser') as page:
        page.call('Page.addScriptToEvaluateOnNewDocument', source="""
          window.__THREE_DEVTOOLS__ = new EventTarget();
          __THREE_DEVTOOLS__.addEventListener('observe', ({detail}) => {
            if (detail.isScene) (window.scenes ??= []).push(detail);
          });
          window.opacities = () => {
            const found = [];
            scenes.forEach(scene => scene.traverse(node => {
              if (node.isInstancedMesh2) found.push(node.material.opacity);
            }));
            return found.join(' ');
          };""")
        page.open(address)
        page.wait_for("window.scenes && opacities() === '1 1'")
        page.wait_for(control('opacity'))
        enter(page, control('opacity'), '0.5')
        page.wait_for("opacities() === '0.5 0.5'")


def test_folded_section_is_a_line(page):
    section = """[...document.querySelectorAll('.mantine-Paper-root')].findLast(
      each => each.innerText === 'Show').parentElement"""
    page.wait_for(f'{section}.clientHeight < 15')
    assert page.run(f'getComputedStyle({section}).borderBottomWidth') == '0px'


def test_axes_of_the_root_frame_are_in_a_corner(page):
    # The camera is above and in front, so that x points down, and z up.
    page.wait_for(f"{IN_WINDOW}(document.querySelector('.axis-cross')?.getBoundingClientRect())")
    page.wait_for("document.querySelector('.axis-cross').children[2].hasAttribute('d')")
    x_end, z_end = (float(page.run(
        f"document.querySelector('.axis-cross').children[{axis}].getAttribute('d')").split()[-1])
        for axis in (0, 2))
    assert x_end > 5
    assert z_end < -15


def test_path_of_the_file_is_shown_at_its_name(page, shown):
    title = "[...document.querySelectorAll('div')].findLast(e => e.innerText === 'cell.sdf')"
    x, y = page.run(f"""(box => [box.left + 5, box.top + 5])({title}.getBoundingClientRect())""")
    page.call('Input.dispatchMouseEvent', type='mouseMoved', x=x, y=y)
    page.wait_for(f"{title}.title === '{shown.file}'")


LABELS_ARE_WHOLE = """[...document.querySelectorAll('p > label')].every(label => {
  const box = label.getBoundingClientRect(), text = label.parentElement;
  const limits = label.closest('.mantine-Flex-root').querySelectorAll('.mantine-Slider-markLabel');
  return text.scrollWidth <= text.clientWidth && box.right < innerWidth
    && [...limits].map(limit => limit.getBoundingClientRect()).every(
      limit => limit.left >= box.right || limit.top >= box.bottom);
})"""


@pytest.mark.parametrize('size', [(1366, 768), (800, 600)])
def test_labels_are_whole_in_a_panel_that_leaves_room_to_the_scene(shown, tmp_path, size):
    name = 'left_outer_finger_joint_of_the_gripper'
    shown.file.write_text(TEXT.replace('"rail"', f'"{name}"'))
    with browser(tmp_path / 'browser') as page:
        page.size(*size)
        page.open(shown.address)
        page.wait_for(control(name))
        page.wait_for(LABELS_ARE_WHOLE)
        page.wait_for("document.querySelector('canvas').clientWidth >= 0.64 * innerWidth")


@pytest.mark.usefixtures('page')
def test_scene_is_seen_while_one_types_on_a_phone(shown, tmp_path):
    with browser(tmp_path / 'browser') as phone:
        phone.size(390, 844)
        phone.open(shown.address)
        select(phone, HOSTILE)
        field = control('yaw [deg]')
        type_over(phone, field, '1')
        phone.wait_for(is_in_window(strip_button('write to file')))
        phone.wait_for(is_in_window(field))
        # From above: the strip, the scene, the field.
        phone.wait_for(f"""(canvas => canvas.height >= 0.29 * innerHeight
          && canvas.top >= document.querySelector('.strip').getBoundingClientRect().bottom - 1
          && canvas.bottom <= {field}.getBoundingClientRect().top)(
          document.querySelector('canvas').getBoundingClientRect())""")


@pytest.mark.usefixtures('page')
def test_frame_is_moved_in_a_narrow_window_where_the_panel_is_folded(shown, tmp_path):
    with browser(tmp_path / 'browser') as narrow:
        narrow.size(700, 600)
        narrow.open(shown.address)
        narrow.wait_for(
            "(width => width > 600 && width < 700)(document.querySelector('canvas')?.clientWidth)")
        wait_for_name_at(narrow, *point_on_screen(narrow, (1.0, 0.0, 0.0)), HOSTILE)
        narrow.mouse(point_on_screen(narrow, (1.0, 0.0, 0.05)))
        drag(narrow)
        narrow.run(f"{strip_button('cancel')}.click()")
        narrow.wait_for(f"!{strip_button('cancel')}")
        assert narrow.run(f'{LABELS}.map(label => label.innerText)') == [HOSTILE]
        assert narrow.run(f'{ROWS}.length') == 0
        assert narrow.run('window.wasRun') is None


def test_page_asks_for_nothing_elsewhere(page, shown):
    assert [request for request in page.requests if not request.startswith(
        (shown.address, shown.address.replace('http', 'ws'), 'data:', 'blob:', 'about:'))] == []
    assert page.errors == []


@pytest.mark.parametrize(('has_secret', 'origin'), [
    (False, None), (True, 'http://example.org'), (True, 'null')])
def test_nobody_else_may_connect(shown, has_secret, origin):
    viser = pytest.importorskip('viser')
    client = pytest.importorskip('websockets.sync.client')
    exceptions = pytest.importorskip('websockets.exceptions')
    address = urlsplit(shown.address)
    path = address.path if has_secret else '/'
    with pytest.raises(exceptions.InvalidStatus, match='HTTP 403'):
        client.connect(
            f'ws://{address.netloc}{path}', origin=origin,
            subprotocols=[f'viser-v{viser.__version__}'])


def test_written_page_and_picture(shown, tmp_path):
    (tmp_path / 'cell.sdf').write_text(TEXT)
    for name in ('page.html', 'picture.png'):
        process = run_view(tmp_path, 'cell.sdf', '-o', name)
        assert process.communicate(timeout=DEADLINE_S) == ('', '')
    with browser(tmp_path / 'browser') as page:
        page.open((tmp_path / 'page.html').as_uri())
        page.wait_for("document.querySelector('canvas')")
        assert page.run('document.title') == 'cell.sdf'
        assert [request for request in page.requests
                if not re.match('file:|data:|blob:|about:', request)] == []
    imageio = pytest.importorskip('imageio.v3')
    pixels = imageio.imread(tmp_path / 'picture.png').astype(int)
    assert pixels.shape == (1000, 1600, 3)
    is_red = (pixels[:, :, :1] > pixels[:, :, 1:] + 60).all(axis=2)
    assert 500 < is_red.sum() < 500_000
