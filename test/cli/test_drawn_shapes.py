# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Surfaces of a scene's shapes in the root frame, and what cannot be drawn."""

import sys

import numpy as np
import pytest
from sdf_texts import link_with

from sdf_pose_bridge import load_text
from sdf_pose_bridge.cli.drawn_shapes import drawn_shapes_from_scene
from sdf_pose_bridge.errors import UnknownFrameError
from sdf_pose_bridge.sdformat.include.uris import resource_finder
from sdf_pose_bridge.tf.tree import tf_tree_from_scene

BOX = '<geometry><box><size>1 1 1</size></box></geometry>'
STL = """solid box
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 2 0
vertex 0 2 3
endloop
endfacet
endsolid
"""


def drawn(content, model='', folder=''):
    scene = load_text(link_with(content), f'{folder}/m.sdf', shapes=True)
    return drawn_shapes_from_scene(
        scene, tf_tree_from_scene(scene), model, resource_finder((), {}))


def visual(geometry, name='v', pose=''):
    return f'<visual name="{name}"><pose>{pose}</pose><geometry>{geometry}</geometry></visual>'


@pytest.mark.parametrize(('geometry', 'reason'), [
    ('<heightmap><uri>h.png</uri></heightmap>', 'a heightmap is not supported'),
    ('<sphere><radius>0</radius></sphere>', 'its sizes are not positive'),
    ('<mesh><uri>none.stl</uri></mesh>', 'the mesh "none.stl" is not found'),
    ('<mesh><uri>/dev</uri></mesh>', 'the mesh "/dev" is not found'),
])
def test_what_cannot_be_drawn_is_marked(geometry, reason):
    shapes, (marker,) = drawn(visual(geometry, pose='1 2 3 0 0 0'))
    assert shapes == []
    assert (marker.name, marker.reason) == ('m::l::v', reason)
    assert marker.pose[:3] == (1, 2, 3)


def test_unknown_model_is_an_error():
    with pytest.raises(UnknownFrameError):
        drawn(visual(''), model='n')


def test_mesh_without_a_loader_is_marked(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, 'trimesh', None)
    (tmp_path / 'a.stl').write_text(STL)
    _, (marker,) = drawn(visual('<mesh><uri>a.stl</uri></mesh>'), folder=tmp_path)
    assert marker.reason == 'meshes need the library trimesh (pip install trimesh)'


def test_mesh_that_cannot_be_read_is_marked(tmp_path):
    pytest.importorskip('trimesh', reason='needs trimesh')
    (tmp_path / 'a.stl').write_bytes(b'solid')
    _, (marker,) = drawn(visual('<mesh><uri>a.stl</uri></mesh>'), folder=tmp_path)
    assert 'a.stl' in marker.reason


def test_mesh_is_the_box_around_it(tmp_path):
    pytest.importorskip('trimesh', reason='needs trimesh')
    (tmp_path / 'a.stl').write_text(STL)
    (shape,), markers = drawn(
        visual('<mesh><uri>a.stl</uri><scale>2 1 -1</scale></mesh>', pose='10 0 0 0 0 0'),
        folder=tmp_path)
    assert markers == []
    assert shape.triangles.points.min(axis=0) == pytest.approx((10, 0, -3))
    assert shape.triangles.points.max(axis=0) == pytest.approx((12, 2, 0))


def test_surface_is_in_the_root_frame():
    (shape,), _ = drawn(visual('<box><size>1 2 3</size></box>', pose='5 0 0 0 0 1.5707963268'))
    assert shape.kind == 'visual'
    assert np.ptp(shape.triangles.points, axis=0) == pytest.approx((2, 1, 3))
    assert shape.triangles.points.mean(axis=0) == pytest.approx((5, 0, 0))


def test_color_is_that_of_the_material_or_gray():
    first, second = drawn(
        f'<visual name="a">{BOX}<material><diffuse>.1 .2 .3 1</diffuse></material></visual>'
        f'<collision name="b">{BOX}</collision>')[0]
    assert (first.kind, first.rgb) == ('visual', (0.1, 0.2, 0.3))
    assert (second.kind, len(set(second.rgb))) == ('collision', 1)


def test_plane_is_cut_to_the_size_of_the_rest():
    shapes, _ = drawn(
        visual('<plane><normal>0 0 1</normal><size>100 100</size></plane>', 'ground')
        + visual('<box><size>1 2 3</size></box>'))
    assert np.ptp(shapes[-1].triangles.points, axis=0) == pytest.approx((3.6, 3.6, 0.0))
