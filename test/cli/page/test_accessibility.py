# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The page in a real browser for those who use no mouse, or do not see it."""

import pytest
from shown_page import control, has_keyboard, select, wait_until_movable

CONTROLS = {
    'button', 'checkbox', 'combobox', 'link', 'menuitem', 'option', 'radio', 'slider',
    'spinbutton', 'switch', 'tab', 'textbox', 'tree', 'treeitem', 'Canvas', 'image', 'img'}
FOLDER = "[...document.querySelectorAll('[role=button]')].find(each => each.innerText === 'Show')"
LOW_CONTRASTS = """(() => {
  const channels = color => color.match(/[0-9.]+/g).map(Number);
  const over = ([r, g, b, a = 1], below) => [r, g, b].map((c, i) => a * c + (1 - a) * below[i]);
  const background = node => node
    ? over(channels(getComputedStyle(node).backgroundColor), background(node.parentElement))
    : [255, 255, 255];
  const luminance = color => color.map(c => c / 255).map(
    c => c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4).reduce(
    (sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
  const found = [];
  for (const node of document.querySelectorAll('[data-dock-scroll] *, .strip, .strip *')) {
    const text = [...node.childNodes].filter(each => each.nodeType === 3).map(
      each => each.textContent.trim()).join('');
    if (!text || !node.checkVisibility({visibilityProperty: true}) || node.closest('[inert]')
        || node.closest(':disabled, [data-disabled]')) continue;
    const style = getComputedStyle(node), below = background(node);
    let opacity = 1;
    for (let each = node; each; each = each.parentElement) {
      opacity *= getComputedStyle(each).opacity;
    }
    const [r, g, b, a = 1] = channels(style.color);
    const [low, high] = [luminance(over([r, g, b, a * opacity], below)), luminance(below)].sort(
      (one, other) => one - other);
    const ratio = (high + 0.05) / (low + 0.05);
    if (ratio < 4.5) found.push(`${text.slice(0, 20)}: ${ratio.toFixed(2)}`);
  }
  return found;
})()"""


def controls(page):
    """Give the role and the name of each control that a screen reader finds."""
    for node in page.call('Accessibility.getFullAXTree')['nodes']:
        role = node.get('role', {}).get('value')
        if role in CONTROLS and not node['ignored']:
            yield role, node.get('name', {}).get('value', '')


def test_each_control_has_a_name(page):
    select(page, 'slide')
    wait_until_movable(page)
    page.wait_for("document.querySelector('.description')")
    # A hint that viser shows at the pointer would be over the title and its icons.
    page.wait_for("document.querySelector('[aria-label=search]').placeholder.includes('click')")
    found = list(controls(page))
    assert [role for role, name in found if not name] == []
    assert {
        ('treeitem', 'slide, link'), ('textbox', 'x [m]'), ('textbox', 'search'),
        ('textbox', 'rail'), ('slider', 'rail'), ('slider', 'opacity'),
        ('checkbox', 'measure points'),
        ('button', 'hide slide'), ('button', 'copy Franka matrix'), ('button', 'Show'),
    } <= {*found}


def test_folded_section_opens_by_tab_and_enter(page):
    page.run(f"{control('dark background')}.focus()")
    page.wait_for(FOLDER)
    for _ in range(100):
        page.keys('Tab')
        if page.run(has_keyboard(FOLDER)):
            break
    assert page.run(has_keyboard(FOLDER))
    for is_open in ('true', 'false'):
        page.keys('Enter')
        page.wait_for(f"{FOLDER}.ariaExpanded === '{is_open}'")
        page.wait_for(f"Boolean({control('grid')}?.checkVisibility()) === {is_open}")


@pytest.mark.parametrize('is_dark', [False, True])
def test_texts_have_contrast(page, is_dark):
    dark = control('dark background')
    if is_dark:
        page.run(f'{dark}.click()')
    page.wait_for("document.documentElement.dataset.mantineColorScheme === '%s'" % (
        'dark' if is_dark else 'light'))
    select(page, 'slide')
    wait_until_movable(page)
    try:
        assert page.run(LOW_CONTRASTS) == []
    finally:
        if is_dark:
            page.run(f'{dark}.click()')
