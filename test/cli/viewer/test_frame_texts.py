# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""What the page says about frames: the numbers, the forms to copy, and that names are text."""

import html
from pathlib import Path
import re
import shlex

import numpy as np
import pytest

from sdf_pose_bridge.cli.viewer import frame_texts
from sdf_pose_bridge.cli.viewer.frame_texts import (
    html_of_difference,
    html_of_frame,
    html_of_points,
    html_of_reasons,
    html_of_selection,
    html_of_tree,
)
from sdf_pose_bridge.cli.viewer.shown_scene import ShownScene
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.units import MILLIMETRES, Units
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.tf.parents import ROOT_IS_PARENT
from sdf_pose_bridge.tf.tree import TfOptions

HOSTILE = '<img src=x onerror=alert(1)>'
TEXT = f"""<sdf version="1.11"><world name="w"><model name="m"><pose>1 2 3 0 0 1.5</pose>
  <link name="l"><sensor name="s" type="camera"/></link>
  <frame name="f" attached_to="l"><pose>0.5 0 0 0 0 0</pose></frame></model>
  <frame name="{html.escape(HOSTILE)}"/></world></sdf>"""


@pytest.fixture
def scene():
    return load_text(TEXT.encode(), 'cell.sdf')


@pytest.fixture
def described(scene):
    """Returns the description of a frame in another one, without its HTML."""
    def describe(frame, reference=None):
        return html.unescape(re.sub('<[^>]*>', '\n', html_of(scene, frame, reference)))
    return describe


def html_of(scene, frame, reference=None):
    shown = ShownScene(scene, TfOptions())
    ids = shown.ids
    return html_of_frame(
        shown, ids.index(frame), ROOT_IS_PARENT if reference is None else ids.index(reference),
        Units())


@pytest.mark.parametrize(('frame', 'reference', 'line'), [
    ('m/f', None, 'm/f'), ('m/f', None, 'm::f'), ('m/f', None, 'cell.sdf:3'),
    ('m/f', 'm/l', '<pose relative_to="l">0.5 0.0 0.0 0.0 0.0 0.0</pose>'),
    ('m/l', None, '<pose>1.0 2.0 3.0 0.0 0.0 1.5</pose>'),
    ('m/f', 'm/l',
     '[1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.5, 0.0, 0.0, 1.0]')])
def test_lines_about_a_frame(described, frame, reference, line):
    assert line in described(frame, reference).split('\n')


def test_arguments_of_static_transform_publisher(described):
    (line,) = (line for line in described('m/f', 'm/l').split('\n') if line.startswith('--x'))
    words = shlex.split(line)
    assert dict(zip(words[::2], words[1::2], strict=True)) == {
        '--x': '0.5', '--y': '0.0', '--z': '0.0', '--qx': '0.0', '--qy': '0.0', '--qz': '0.0',
        '--qw': '1.0', '--frame-id': 'm/l', '--child-frame-id': 'm/f'}


def test_frames_that_move_with_another_are_named(scene):
    old = ShownScene(scene, TfOptions())
    new = old.at({}, load_text(TEXT.replace('<pose>1 2', '<pose>9 2').encode(), 'a.sdf'))
    frame = old.ids.index('m')
    moved = ('<div class="moved">moves with it: &quot;m/l&quot;, &quot;m/l/s&quot;, '
             '&quot;m/f&quot;, &quot;m/l/s_optical&quot;</div>')
    assert html_of_selection(old, new, frame, ROOT_IS_PARENT, Units()).endswith(moved)
    assert 'moves' not in html_of_selection(old, old, frame, ROOT_IS_PARENT, Units())


def test_first_reason_is_a_line_of_its_own():
    assert '<details' not in html_of_reasons(['<a>'])
    text = html_of_reasons(['<a>', 'b', 'c'])
    assert '<summary>&lt;a&gt;; and 2 more</summary>' in text
    assert 'b\nc</pre></details>' in text


def test_name_is_copied_as_it_is_shown(scene):
    text = html_of(scene, HOSTILE)
    assert f'data-copy="{html.escape(HOSTILE)}"' in text


def test_old_and_new_pose_side_by_side():
    text = html_of_difference(Pose(x=1.0), Pose(x=1.0, z=-0.25), Pose(x=0.5), Units())
    rows = re.findall('<tr><td>(.*?)</td><td>(.*?)</td><td>(.*?)</td><td>(.*?)</td></tr>', text)
    assert rows[1] == ('x [m]', '0.5000', '0.5000', '+0.0000')
    assert rows[3] == ('z [m]', '0.0000', '-0.2500', '-0.2500')


def test_optical_frame_has_no_name_in_the_file(described):
    assert 'm::l::s_optical' not in described('m/l/s_optical')


@pytest.mark.parametrize(('frame', 'line'), [
    ('m', ':1 relative_to="world": xyz 1.0000 2.0000 3.0000 m, rpy 0.0000 0.0000 1.5000 rad'),
    ('m/f', ':3 relative_to="l": xyz 0.5000 0.0000 0.0000 m, rpy 0.0000 0.0000 0.0000 rad'),
    ('m/l', ':2 relative_to="m": no pose'), ('m/l/s_optical', '')])
def test_pose_in_another_frame_and_in_the_file(scene, frame, line):
    shown = ShownScene(scene, TfOptions())
    index = shown.ids.index(frame)
    text = html_of_selection(
        shown, shown.with_pose(index, Pose(x=0.5)), index, shown.ids.index(HOSTILE), Units())
    assert HOSTILE not in text
    in_file = line and f'in the file {Path("cell.sdf").resolve()}{line}'
    assert html.unescape(text).startswith(
        f'<b>{frame}</b> in {HOSTILE}: xyz 0.5000 0.0000 0.0000 m, rpy 0.0000 0.0000 0.0000 rad'
        f'<div>{in_file}</div>')


def test_pose_of_a_link_of_urdf_is_the_origin_of_its_joint():
    shown = ShownScene(load_text(
        b'<robot name="m"><link name="l"/><link name="k"/>\n'
        b'<joint name="j" type="fixed"><parent link="l"/><child link="k"/>'
        b'<origin xyz="0 0.5 0"/></joint></robot>', 'm.urdf'), TfOptions())
    text = html_of_selection(shown, shown, shown.ids.index('k'), ROOT_IS_PARENT, Units())
    assert 'm.urdf:2 relative_to="l": xyz 0.0000 0.5000 0.0000 m' in html.unescape(text)


def test_name_is_text(scene):
    text = html_of(scene, HOSTILE)
    assert '<img' not in text
    assert html.escape(HOSTILE) in text


def rows(shown, search='', *, folded=()):
    """Return the depth, the sign of folding and the text of each row."""
    text = html_of_tree(shown, search, '', folded, ())
    button = '<button.*?>(.*?)</button>'
    return re.findall(f'padding-left:(.*?)em.*?{button}.*?{button}', text)


def test_rows_stand_below_their_parents(scene):
    assert rows(ShownScene(scene, TfOptions())) == [
        ('0', '▾', 'l'), ('1', '', 'm'), ('1', '▾', 's'), ('2', '', 's_optical'), ('1', '', 'f'),
        ('0', '', html.escape(HOSTILE))]


def test_children_of_a_folded_frame_are_not_listed(scene):
    found = rows(ShownScene(scene, TfOptions()), folded={'m/l/s'})
    assert [row[1:] for row in found[:4]] == [('▾', 'l'), ('', 'm'), ('▸', 's'), ('', 'f')]


def test_frame_that_only_a_merge_has_named_is_not_listed():
    names = ('_merged__a__model__', '_merged__a', 'b')
    frames = ''.join(f'<frame name="{name}"/>' for name in names)
    shown = ShownScene(load_text(
        f'<sdf version="1.11"><world name="w">{frames}</world></sdf>'.encode(), 'cell.sdf'),
        TfOptions())
    assert [row[2] for row in rows(shown)] == ['_merged__a', 'b']


def test_search(scene):
    found = rows(ShownScene(scene, TfOptions()), 'M/L/', folded={'m/l'})
    assert found == [('0', '', 'm/l/s'), ('0', '', 'm/l/s_optical')]


def test_more_frames_than_rows(scene, monkeypatch):
    monkeypatch.setattr(frame_texts, 'MOST_ROWS', 4)
    text = html_of_tree(ShownScene(scene, TfOptions()), '', '', (), ())
    assert '2 more, to be found by the search' in text


def test_difference_of_points_is_in_the_root_frame_and_in_the_axes_of_the_selected_one():
    text = TEXT.replace('1 2 3 0 0 1.5', '1 2 3 0 0 1.5707963267948966').replace(
        html.escape(HOSTILE), 'a')
    shown = ShownScene(load_text(text.encode(), 'cell.sdf'), TfOptions())
    points = np.array([(1.0, 1.0, 1.0), (1.3, 1.4, 1.0)])
    told = [html_of_points(shown, points[:count], shown.ids.index('m/l'), MILLIMETRES)
            for count in range(3)]
    assert told == [
        '<div>click on a shape for point 1 of 2; Escape ends it</div>',
        '<div>click on a shape for point 2 of 2; Escape ends it</div>',
        ('<div>500.0 mm from point 1 to 2, xyz 300.0 400.0 0.0 in world, '
         'xyz 400.0 -300.0 0.0 in m/l</div>')]
    assert html_of_points(shown, points, ROOT_IS_PARENT, MILLIMETRES).count('xyz') == 1
