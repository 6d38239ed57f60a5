# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The names in a drawing, and the size of its axes."""

import json
import math

import numpy as np
import pytest
from sdf_texts import model_file, world_file

pytest.importorskip('trimesh', reason='needs trimesh')
pytest.importorskip('viser', reason='needs viser')

from sdf_pose_bridge.cli.viewer.drawing import Drawing, MOST_NAMES, VisiblePart
from sdf_pose_bridge.cli.viewer.shown_scene import ShownScene
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.units import METRES
from sdf_pose_bridge.scene.loading import load_text
from sdf_pose_bridge.tf.tree import TfOptions

BOX = '<geometry><box/></geometry>'
NO_ENDS = np.zeros((0, 3))


@pytest.fixture
def drawing_of(server, mesh_reader):
    """Returns the drawing of a model with these elements, and its scene."""
    def draw(content, hidden=(), text_of_file=model_file):
        shown = ShownScene(load_text(text_of_file(content), 'm.sdf', shapes=True), TfOptions())
        return Drawing(
            server.scene, '/drawing', VisiblePart(shown, mesh_reader, hidden), print), shown
    return draw


def test_home_view_has_the_whole_of_a_model_alone(drawing_of):
    drawing, _ = drawing_of(
        '<link name="hand"><pose>0.2 0 0 0 0 0</pose></link>'
        f'<link name="case"><visual name="v">{BOX}</visual></link>')
    low, high = drawing.visible.bounds
    assert (low <= -0.5).all()
    assert (high >= 0.5).all()


PLANE = '<geometry><plane><normal>0 0 1</normal><size>9 9</size></plane></geometry>'
GROUND = f'<model name="ground"><link name="l"><visual name="v">{PLANE}</visual></link></model>'


@pytest.mark.parametrize('ground', ['', GROUND])
@pytest.mark.parametrize('crown_m', [0.0006, 0.0002])
@pytest.mark.parametrize('joint', ['fixed', 'continuous', ''])
def test_home_view_has_the_whole_of_a_watch_in_a_world(drawing_of, joint, crown_m, ground):
    box = '<geometry><box><size>{0} {0} 0.0001</size></box></geometry>'
    visual = f'<visual name="v">{box}</visual>'
    crown = (f'<link name="crown"><pose>{crown_m} 0 0 0 0 0</pose>{visual.format(0.0001)}</link>'
             f'<joint name="stem" type="{joint}"><parent>case</parent><child>crown</child>'
             '<axis><xyz>1 0 0</xyz></axis></joint>')
    drawing, _ = drawing_of(
        f'<model name="watch"><link name="case">{visual.format(0.001)}</link>'
        f'{crown if joint else ""}</model>{ground}', text_of_file=world_file)
    low, high = drawing.visible.bounds
    assert low[:2] == pytest.approx([-0.0005, -0.0005])
    assert (high[:2] >= 0.0005).all()
    assert (high < 0.001).all()


@pytest.mark.parametrize(('size_m', 'text'), [
    (0.1, '0.01 m'), (0.05, '5 mm'), (0.001, '0.1 mm'), (0.0002, '20 \u03bcm')])
def test_grid_has_a_unit_of_its_size(drawing_of, server, monkeypatch, size_m, text):
    labels = []
    monkeypatch.setattr(server.scene, 'add_label', lambda _, text, **options: labels.append(text))
    drawing_of(f'<link name="a"/><frame name="b"><pose>{size_m} 0 0 0 0 0</pose></frame>')
    assert labels == [f'grid {text}']


def test_empty_world_says_that_it_is_empty(mesh_reader):
    scene = load_text(b'<sdf version="1.11"><world name="w"/></sdf>', 'w.sdf', shapes=True)
    visible = VisiblePart(ShownScene(scene, TfOptions()), mesh_reader)
    assert visible.reasons == ['this file has no frames']


def test_names_of_bodies_are_in_the_order_of_the_nodes(drawing_of):
    drawing, _ = drawing_of(
        f'<link name="a"><visual name="v">{BOX}</visual><collision name="c">{BOX}</collision>'
        f'</link><link name="b"><visual name="v">{BOX}</visual></link>')
    assert json.loads(drawing.visible.names)['bodies'] == [
        ['a, visual v', 'b, visual v'], ['a, collision c']]
    assert [copies.name for copies, _ in drawing._copies] == [
        '/drawing/visual 0', '/drawing/collision 1']


def test_selected_frame_and_its_name_stand_at_its_new_pose(drawing_of):
    drawing, shown = drawing_of('<link name="a"/>')
    frame = shown.tree.frame_ids.index('a')
    moved = shown.with_pose(frame, Pose(3.0, 0.0, 1.0))
    assert json.loads(drawing.show(moved, frame, NO_ENDS, METRES))['labels'] == [
        ['m', False, 0.0, 0.0, 0.0], ['a', True, 3.0, 0.0, 1.0]]
    assert drawing._marker.position.tolist() == [3.0, 0.0, 1.0]
    assert shown.pose_of(frame) == Pose()


@pytest.mark.parametrize(('hidden', 'lines'), [
    (set(), [(1, 0), (1, 2), (2, 3), (1, 4)]), ({'all lines to parents'}, [(2, 3), (1, 2)])])
def test_lines_lead_to_the_parents_of_frames(drawing_of, hidden, lines):
    drawing, shown = drawing_of(
        '<link name="a"><pose>1 0 0 0 0 0</pose></link>'
        '<frame name="b" attached_to="a"><pose>1 0 0 0 0 0</pose></frame>'
        '<frame name="c" attached_to="b"><pose>1 0 0 0 0 0</pose></frame>'
        '<frame name="d" attached_to="a"><pose>3 0 0 0 0 0</pose></frame>', hidden)
    drawing.show(shown, shown.ids.index('c'), NO_ENDS, METRES)
    assert [tuple(line[:, 0].tolist()) for line in drawing._lines.points] == lines


def test_name_of_a_missing_mesh_precedes_those_of_frames(drawing_of):
    mesh = '<geometry><mesh><uri>a.stl</uri></mesh></geometry>'
    drawing, shown = drawing_of(
        f'<link name="{"a" * 40}">'
        f'<visual name="v"><pose>0.2 1 0 0 0 0</pose>{mesh}</visual></link>')
    assert json.loads(drawing.show(shown, -1, NO_ENDS, METRES))['labels'] == [
        ['a.stl?', True, 0.2, 1.0, 0.0], ['m', False, *[0.0] * 3], ['a' * 40, False, *[0.0] * 3]]


def test_names_that_are_too_many_are_counted(drawing_of):
    frames = ''.join(f'<frame name="f{number}"/>' for number in range(MOST_NAMES + 3))
    drawing, shown = drawing_of(f'<link name="a"/>{frames}')
    # The model and its link are frames, too.
    for selected, count in (-1, 5), (shown.ids.index('a'), 5), (shown.ids.index('f502'), 4):
        told = json.loads(drawing.show(shown, selected, NO_ENDS, METRES))
        assert len(told['labels']) + told['unlisted'] == MOST_NAMES + 5
        assert told['unlisted'] == count


@pytest.mark.parametrize(('size', 'ground_m'), [('1 1 1', -0.5), ('3 3 1', 0.0)])
def test_ground_is_below_bodies_but_a_floor(drawing_of, server, size, ground_m):
    drawing_of(f'<link name="a"><visual name="v"><geometry><box><size>{size}</size></box>'
               '</geometry></visual></link><frame name="b"><pose>0 0 2 0 0 0</pose></frame>',
               text_of_file=lambda content: world_file(f'<model name="m">{content}</model>'))
    grid = server.scene.get_handle_by_name('/drawing/grid')
    assert grid.position[2] == pytest.approx(ground_m, abs=0.01)


@pytest.mark.parametrize(('places_m', 'part'), [
    ((0.0, 10.0), 0.1), (range(2, 11), 0.25 / math.sqrt(10)), ((0.0, 0.1, 0.2, 0.3, 10.0), 0.01)])
def test_axes_are_short_where_frames_are_many_or_near(drawing_of, places_m, part):
    drawing, _ = drawing_of(''.join(
        f'<link name="a{number}"><pose>{x_m} 0 0 0 0 0</pose></link>'
        for number, x_m in enumerate(places_m)))
    assert drawing.visible.axes_length_m == pytest.approx(10.0 * part)
