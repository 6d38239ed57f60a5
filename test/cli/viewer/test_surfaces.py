# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Which surfaces are drawn, their sizes and their colors."""

import mesh_texts
import numpy as np
import pytest

pytest.importorskip('trimesh', reason='needs trimesh')
pytest.importorskip('viser', reason='needs viser')
from sdf_pose_bridge import load
from sdf_pose_bridge.cli.viewer import surfaces as surfaces_module
from sdf_pose_bridge.cli.viewer.surfaces import (
    boxes_of_surfaces,
    lines_from_not_drawn,
    surfaces_from_scene,
)


@pytest.fixture
def drawn(tmp_path, mesh_reader):
    """Returns the scene, its surfaces and what is not drawn, of visuals with these contents."""
    def draw(*visuals):
        text = ''.join(
            f'<visual name="v{number}">{visual}</visual>' for number, visual in enumerate(visuals))
        path = tmp_path / 'model.sdf'
        path.write_text(f'<sdf version="1.11"><model name="m"><link name="l">{text}</link></model>'
                        '</sdf>')
        scene = load(path, shapes=True)
        return scene, *surfaces_from_scene(scene, list(scene.shapes), 2.0, mesh_reader)
    return draw


def geometry(text):
    return f'<geometry>{text}</geometry>'


MESH = geometry('<mesh><uri>a.stl</uri><scale>1 1 -2</scale></mesh>')


def test_shape_that_is_not_supported(drawn):
    _, surfaces, not_drawn = drawn(geometry('<heightmap/>'))
    assert (surfaces, not_drawn) == ([], {'a heightmap is not supported': ['']})


def test_missing_mesh_is_a_small_box(drawn):
    _, (surface,), not_drawn = drawn(MESH)
    assert np.ptp(surface.part.points, axis=0) * surface.scales[0] == pytest.approx(0.06)
    assert not_drawn == {surface.reason: ['a.stl']}
    assert surface.reason.startswith('it is not in "')


def test_meshes_that_are_missing_for_one_reason_have_one_line():
    meshes, other = lines_from_not_drawn(
        {'no': [f'{name}.dae' for name in 'abbcde'], 'too many': ['']})
    assert meshes == ('6 shapes cannot be drawn: '
                      'the meshes "a.dae", "b.dae", "c.dae" and 2 more: no')
    assert other == '1 shape cannot be drawn: too many'


def test_more_surfaces_than_are_drawn(drawn, monkeypatch):
    monkeypatch.setattr(surfaces_module, 'MOST_SURFACES', 1)
    _, (surface,), not_drawn = drawn(*[geometry('<sphere/>')] * 2, *[geometry('<cone/>')] * 3)
    assert len(surface.elements) == 2
    assert not_drawn == {'there are too many surfaces': [''] * 3}


def test_more_triangles_than_are_drawn(drawn, monkeypatch):
    monkeypatch.setattr(surfaces_module, 'MOST_TRIANGLES', 12)
    _, (surface,), not_drawn = drawn(geometry('<box/>'), geometry('<sphere/>'))
    assert len(surface.part.faces) == 12
    assert len(not_drawn) == 1


def test_boxes_of_any_size_share_a_surface(drawn):
    _, (surface,), _ = drawn(*(
        geometry(f'<box><size>{size} 1 1</size></box>') for size in (1, 2)))
    assert surface.scales.tolist() == [[1, 1, 1], [2, 1, 1]]


def test_transparency_without_a_material(drawn):
    _, (surface,), _ = drawn('<transparency>0.5</transparency>' + geometry('<box/>'))
    assert surface.rgba[0, 3] == 0.5


def test_what_is_transparent_is_not_drawn(drawn):
    material = '<material><diffuse>1 0 0 0</diffuse></material>' + geometry('<box/>')
    assert drawn(material)[1:] == ([], {})


def test_mesh_with_its_scale(drawn, tmp_path):
    (tmp_path / 'a.stl').write_text(mesh_texts.stl())
    _, (surface,), not_drawn = drawn(MESH, MESH)
    assert (len(surface.elements), surface.scales[0].tolist()) == (2, [1, 1, -2])
    assert not not_drawn


@pytest.mark.parametrize('other', [
    '<material><diffuse>0 1 0</diffuse></material>', '<transparency>0.5</transparency>'])
def test_material_or_transparency_in_the_file_replaces_a_texture(drawn, tmp_path, other):
    image = pytest.importorskip('PIL.Image', reason='needs Pillow')
    (tmp_path / 'a.obj').write_text(mesh_texts.TEXTURED_OBJ)
    (tmp_path / 'colors.mtl').write_text('newmtl red\nmap_Kd texture.png\n')
    image.new('RGB', (4, 4)).save(tmp_path / 'texture.png')
    mesh = geometry('<mesh><uri>a.obj</uri></mesh>')
    _, surfaces, _ = drawn(mesh, mesh + other)
    assert [bool(surface.part.glb) for surface in surfaces] == [True, False]


def test_box_contains_what_is_turned(drawn):
    scene, surfaces, _ = drawn(
        '<pose degrees="true">0 0 5 0 90 0</pose>' + geometry('<box><size>1 2 6</size></box>'))
    (box,) = boxes_of_surfaces(scene, surfaces)
    assert box == pytest.approx(np.array([(-3, -1, 4.5), (3, 1, 5.5)]))
