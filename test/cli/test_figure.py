# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures as dictionaries; they are made without plotly."""

import math

import numpy as np
import pytest
from sdf_texts import model_file

from sdf_pose_bridge import load_text
from sdf_pose_bridge.cli.drawn_shapes import DrawnShape
from sdf_pose_bridge.cli.drawn_shapes import Marker
from sdf_pose_bridge.cli.figure import figure_from_scene
from sdf_pose_bridge.cli.printing import Units
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.scene.triangles import triangles_of_box
from sdf_pose_bridge.tf.tree import tf_tree_from_scene

LINKS = ('<link name="base"/><frame name="tip" attached_to="base">'
         '<pose degrees="true">1 2 0.5 0 0 90</pose></frame>')
BOX = triangles_of_box(np.array([0.0, 0.0, 0.0]), np.array([4.0, 2.0, 1.0]))
RED = DrawnShape('visual', BOX, (1.0, 0.0, 0.0))
BLUE = DrawnShape('collision', BOX, (0.0, 0.0, 1.0))


def figure_of(content=LINKS, shapes=(), markers=()):
    scene = load_text(model_file(content))
    return figure_from_scene(
        scene, tf_tree_from_scene(scene), shapes, markers, Units(is_mm=True, is_degrees=True))


def trace(figure, name):
    return next(trace for trace in figure['data'] if trace.get('name') == name)


def test_names_are_no_html():
    figure = figure_of('<link name="&lt;b&gt;&#10;x"/>')
    link = trace(figure, 'link (1)')
    assert link['text'] == ['&lt;b&gt;\\nx']
    assert '<b>&lt;b&gt;\\nx</b>' in link['customdata'][0]


def test_each_kind_has_a_group_in_the_legend():
    figure = figure_of()
    names = [trace['name'] for trace in figure['data'] if trace.get('showlegend', True)]
    assert names == ['lines to TF parents', 'root (1)', 'model (1)', 'link (1)', 'frame (1)']


def test_frame_shows_its_pose_in_the_root_and_in_its_parent():
    (text,) = trace(figure_of(), 'frame (1)')['customdata']
    assert text == (
        '<b>tip</b><br>frame<br>in world:<br>  xyz 1000.0 2000.0 500.0 mm<br>'
        '  rpy 0.00 0.00 90.00 deg<br>in base:<br>  xyz 1000.0 2000.0 500.0 mm<br>'
        '  rpy 0.00 0.00 90.00 deg')


def test_frames_in_one_place_are_shown_together():
    figure = figure_of('<link name="l"/>' + ''.join(
        f'<frame name="f{number}"><pose>1 0 0 0 0 0</pose></frame>' for number in range(6)))
    frames = trace(figure, 'frame (6)')
    assert frames['text'] == ['f0, f1, f2, f3, and 2 more'] * 6
    assert frames['customdata'][5].count('<b>') == 4
    assert trace(figure, 'model (1)')['customdata'] == trace(figure, 'link (1)')['customdata']


def test_triad_has_the_axes_of_its_frame():
    figure = figure_of()
    axes = next(trace for trace in figure['data']
                if trace.get('legendgroup') == 'frame' and trace['mode'] == 'lines')
    points = np.stack([axes['x'], axes['y'], axes['z']], axis=1).reshape(3, 3, 3)
    length = np.linalg.norm(points[0, 1] - points[0, 0])
    assert points[:, 0] == pytest.approx(np.tile((1.0, 2.0, 0.5), (3, 1)))
    assert (points[:, 1] - points[:, 0]) / length == pytest.approx(
        np.array([(0, 1, 0), (-1, 0, 0), (0, 0, 1)]), abs=1e-12)
    assert np.isnan(points[:, 2]).all()


def test_shapes_of_a_kind_are_one_surface():
    figure = figure_of(shapes=[RED, RED, BLUE])
    visuals = trace(figure, 'visuals (2)')
    assert len(visuals['x']) == 16
    assert visuals['facecolor'] == ['rgb(255,0,0)'] * 24
    assert max(visuals[name].max() for name in 'ijk') == 15
    assert trace(figure, 'collisions (1)')['visible'] == 'legendonly'


def test_axes_have_one_scale():
    scene = figure_of(shapes=[RED])['layout']['scene']
    scales = [(scene[f'{name}axis']['range'][1] - scene[f'{name}axis']['range'][0])
              / scene['aspectratio'][name] for name in 'xyz']
    assert scales == pytest.approx([scales[0]] * 3)


def test_scene_without_an_extent_has_finite_axes():
    scene = figure_of('<link name="l"/>')['layout']['scene']
    assert all(
        math.isfinite(value) for name in 'xyz' for value in scene[f'{name}axis']['range'])


def test_what_is_not_drawn_has_a_marker_with_the_reason():
    markers = trace(figure_of(markers=[Marker('m::v', Pose(1.0), 'a <reason>')]), 'not drawn (1)')
    assert markers['x'].tolist() == [1.0]
    assert markers['customdata'] == ['<b>m::v</b><br>a &lt;reason&gt;']
