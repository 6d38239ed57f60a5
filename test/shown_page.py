# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The page of a file in a real browser: its elements, the keyboard and the mouse."""

import contextlib
import html
import os
import subprocess

from command_line import COMMAND, ENVIRONMENT
from deadline import wait_until
import numpy as np
from processes import started

from sdf_pose_bridge.cli.viewer.view_point import view_of_bounds

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
LABELS = "[...document.querySelectorAll('.labels div')]"
SCENES = """
  window.scenes = [];
  window.__THREE_DEVTOOLS__ = new EventTarget();
  __THREE_DEVTOOLS__.addEventListener('observe', ({detail}) => {
    if (detail.isScene) scenes.push(detail);
  });
  window.opacities = () => {
    const found = [];
    scenes.forEach(scene => scene.traverse(node => {
      if (node.isInstancedMesh2) found.push(node.material.opacity);
    }));
    return found.join(' ');
  };"""
"""Run before a page is opened; then ``opacities()`` returns those of its bodies."""


def run_view(folder, *arguments, **options):
    return started(
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


def select(page, name):
    page.wait_for(f"{ROWS}.find(row => row.textContent === '{name}')")
    page.run(f"{ROWS}.find(row => row.textContent === '{name}').click()")
    page.wait_for(f"document.querySelector('.rows .selected')?.textContent === '{name}'")


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


IN_WINDOW = """(box => box && box.width > 0 && box.left >= 0 && box.top >= 0
  && box.right <= innerWidth && box.bottom <= innerHeight)"""


def is_in_window(element):
    """Return a condition: the element is wholly in the window, and nothing is above it."""
    return f"""(element => {IN_WINDOW}(element?.getBoundingClientRect())
      && (box => element.contains(document.elementFromPoint(box.left + 3, box.top + 3))
        && element.contains(document.elementFromPoint(box.right - 3, box.bottom - 3)))(
        element.getBoundingClientRect()))({element})"""


def wait_until_movable(page):
    page.wait_for("document.querySelector('.strip')?.innerText.includes('numbers to move it')")


def type_over(page, element, text):
    """Type keys into an input element of the selected frame instead of its text."""
    # Before, the element is still that of the frame before, and loses the keyboard soon.
    wait_until_movable(page)
    page.wait_for(f'(input => input && !input.disabled)({element})')
    page.run(f'(input => {{ input.focus(); input.select(); }})({element})')
    page.keys(*text)


def has_keyboard(element):
    return f'document.activeElement === {element}'


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


def press(page, text):
    """Press a button of the strip, which goes when that is done."""
    page.wait_for(strip_button(text))
    page.run(f'{strip_button(text)}.click()')
    page.wait_for(f'!{strip_button(text)}')


def drag(page):
    """Drag the gizmo of the frame with the hostile name upwards, 11 pixels beside its arrow."""
    wait_until_movable(page)
    # Nothing says when the gizmo is drawn; until then there is nothing to drag. A page that always
    # draws, as it cannot keep up, is never idle.
    page.run('new Promise(drawn => requestAnimationFrame('
             '() => requestIdleCallback(drawn, {timeout: 5000})))')
    points = (point_on_screen(page, (1.0, 0.0, height)) for height in (0.0, 0.02, 0.05, 0.08, 0.1))
    # The arrow is 8 pixels further right there.
    page.mouse(*((x + 8 - 11, y - 70) for x, y in points))
    z = "document.querySelector('.difference')?.rows[3].cells[2].innerText"
    page.wait_for(f'Math.abs({z} - 0.1) < 0.02')
    for label in ('write to file', 'cancel'):
        page.wait_for(is_in_window(strip_button(label)))


def name_at(page, x, y):
    """Move the pointer to a point and rest there; return the name that is shown then."""
    for dx in (1, 0):
        page.call('Input.dispatchMouseEvent', type='mouseMoved', x=x + dx, y=y)
    return page.run("""new Promise(rested => setTimeout(rested, 200)).then(
      () => document.querySelector('.name-at-pointer')?.textContent)""")


def wait_for_name_at(page, x, y, name):
    # Nothing says when the axes and bodies are drawn; until then there is no name.
    wait_until(lambda: name_at(page, x, y) == name, lambda: None, name)
