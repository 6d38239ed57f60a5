# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes of all formats, broken and hostile ones, and the process that reads them."""

import io
import os
import re

import mesh_texts
import numpy as np
import pytest

pytest.importorskip('trimesh', reason='needs trimesh')
pytest.importorskip('collada', reason='needs pycollada')
from sdf_pose_bridge.cli.viewer import meshes
from sdf_pose_bridge.cli.viewer.meshes import mesh_from_file
from sdf_pose_bridge.sdformat.shape_types import SHAPE_TYPES
from sdf_pose_bridge.sdformat.shapes import Shape


def shape_of(submesh='', name='', *, is_centered=False):
    return Shape('mesh', (), (0.0, 0.0, 1.0), name, submesh, (1.0, 1.0, 1.0), None,
                 is_centered=is_centered)


@pytest.fixture
def mesh(tmp_path):
    """Returns the mesh with this text in a file of this name, read by this process."""
    def read(name, text, submesh=''):
        (tmp_path / name).write_bytes(text if isinstance(text, bytes) else text.encode())
        return mesh_from_file(str(tmp_path / name), shape_of(submesh))
    return read


def extent(mesh):
    assert not mesh.reason
    return np.ptp(np.concatenate([part.points for part in mesh.parts]), axis=0)


def test_missing_file(tmp_path):
    assert 'No such file' in mesh_from_file(str(tmp_path / 'none.stl'), shape_of()).reason


@pytest.mark.filterwarnings('ignore::RuntimeWarning')
@pytest.mark.parametrize(('name', 'text', 'reason'), [
    *((name, b'PK\3\4', 'its name must end with one of .dae, ') for name in (
        'mesh.zip', 'mesh.3mf', 'mesh.xyz', 'mesh')),
    ('mesh.stl', mesh_texts.stl('inf'), 'it has no surface'),
    *(('mesh.gltf', mesh_texts.gltf(mesh_texts.IN_FILE, scale=scale),
       'a coordinate is larger than 1e') for scale in (1e300, float('nan'))),
    ('mesh.gltf', mesh_texts.gltf('/etc/hostname'), '/etc/hostname'),
    ('mesh.dae', mesh_texts.DAE.replace('<COLLADA', '<!DOCTYPE d [<!ENTITY a "b">]><COLLADA', 1),
     'document type'),
])
def test_wrong_file_is_refused_with_the_reason(mesh, name, text, reason):
    assert reason in mesh(name, text).reason


def test_named_pipe(tmp_path):
    os.mkfifo(tmp_path / 'mesh.stl')
    assert 'not a regular file' in mesh_from_file(str(tmp_path / 'mesh.stl'), shape_of()).reason


def test_buffer_that_is_a_named_pipe(mesh, tmp_path):
    os.mkfifo(tmp_path / 'points.bin')
    assert 'not a regular file' in mesh('mesh.gltf', mesh_texts.gltf()).reason


def test_size_counts_named_files(mesh, tmp_path, monkeypatch):
    monkeypatch.setattr(meshes, 'MOST_BYTES', 2000)
    (tmp_path / 'points.bin').write_bytes(mesh_texts.BUFFER + b'\0' * 2000)
    assert 'bytes_read' in mesh('mesh.gltf', mesh_texts.gltf()).reason


def test_too_many_triangles(mesh, monkeypatch):
    monkeypatch.setattr(meshes, 'MOST_TRIANGLES', 1)
    found = mesh('mesh.obj', mesh_texts.OBJ)
    assert found.reason == 'it cannot be shown: it has 2 triangles, more than 1'
    assert found.parts == ()


def test_unknown_part(mesh):
    reason = mesh('mesh.obj', mesh_texts.OBJ, 'middle').reason
    assert 'it has no part "middle", but "left", "right"' in reason


@pytest.mark.parametrize('kind', ['o', 'g'])
def test_part_of_an_obj_file_is_an_object_or_a_group(mesh, tmp_path, kind):
    (tmp_path / 'colors.mtl').write_text(mesh_texts.MTL)
    text = mesh_texts.OBJ.replace('o right', f'{kind} right')
    (part,) = mesh('mesh.obj', text, 'right').parts
    assert part.points[:, 2] == pytest.approx(5.0)


def test_part_with_its_middle_at_the_origin(tmp_path):
    (tmp_path / 'mesh.obj').write_text(mesh_texts.OBJ)
    (part,) = mesh_from_file(str(tmp_path / 'mesh.obj'), shape_of('right', is_centered=True)).parts
    assert part.points[0].tolist() == [-0.5, -1.0, 0.0]


@pytest.mark.parametrize(('node', 'name'), [
    ('<node id="n" name="{}">{}</node>', 'left'),
    ('<node name="{}"><node>{}</node></node>', 'right')])
def test_part_of_a_dae_file_has_the_name_of_its_node(mesh, node, name):
    instance = '<instance_geometry url="#part-mesh"/>'
    nodes = ''.join(
        node.format(each, f'<translate>0 0 {z}</translate>{instance}')
        for each, z in (('left', 1000), ('right', 2000)))
    (part,) = mesh('mesh.dae', mesh_texts.DAE.replace(
        f'<node id="n">\n    {instance}</node>', nodes), name).parts
    assert part.points[:, 2] == pytest.approx({'left': 1.0, 'right': 2.0}[name])


def test_stl(mesh):
    found = mesh('mesh.STL', mesh_texts.stl())
    assert extent(found) == pytest.approx((1, 2, 0))
    assert found.parts[0].rgba == ()


def test_colors_of_materials(mesh, tmp_path):
    (tmp_path / 'colors.mtl').write_text(mesh_texts.MTL)
    found = mesh('mesh.obj', mesh_texts.OBJ)
    assert sorted(part.rgba for part in found.parts) == [(0, 0, 1, 1), (1, 0, 0, 1)]


@pytest.fixture
def textured(mesh, tmp_path):
    """Returns the mesh whose material names a texture, with this content in a folder."""
    def read(texture, name='texture.png', line='', folder='.'):
        (tmp_path / 'colors.mtl').write_text(f'newmtl red\nmap_Kd {name}\n{line}')
        (tmp_path / folder).mkdir(parents=True, exist_ok=True)
        (tmp_path / folder / 'texture.png').write_bytes(texture)
        return mesh('mesh.obj', mesh_texts.TEXTURED_OBJ)
    return read


def png(size, color=(200, 10, 10)):
    image = pytest.importorskip('PIL.Image', reason='needs Pillow')
    written = io.BytesIO()
    image.new('RGBA' if len(color) == 4 else 'RGB', size, color).save(written, 'PNG')
    return written.getvalue()


def mesh_from_glb(glb):
    import trimesh
    return trimesh.load_mesh(io.BytesIO(glb), file_type='glb')


def texture_in(glb):
    return mesh_from_glb(glb).visual.material.baseColorTexture


@pytest.mark.parametrize('size', [0, 20, 60])
def test_texture_that_is_cut_off_is_not_drawn(textured, size):
    found = textured(png((40, 40))[:size])
    assert extent(found) == pytest.approx((1, 2, 0))
    assert found.parts[0].glb == b''


def test_texture(textured):
    (part,) = textured(png((4, 4))).parts
    assert texture_in(part.glb).getpixel((0, 0)) == (200, 10, 10)
    assert mesh_from_glb(part.glb).extents == pytest.approx((1, 2, 0))


@pytest.mark.parametrize('name', ['texture.png', 'model://m/materials/textures/texture.png'])
def test_texture_in_the_folder_that_models_of_gazebo_have(textured, name):
    (part,) = textured(png((4, 4)), name, folder='../materials/textures').parts
    assert texture_in(part.glb).getpixel((0, 0)) == (200, 10, 10)


@pytest.mark.parametrize(('line', 'mode'), [('', None), ('map_d texture.png\n', 'MASK')])
def test_alpha_of_a_texture_of_obj_counts_if_the_material_says_so(textured, line, mode):
    (part,) = textured(png((4, 4), (200, 10, 10, 0)), line=line).parts
    assert mesh_from_glb(part.glb).visual.material.alphaMode == mode


def test_large_texture_is_made_smaller(textured):
    (part,) = textured(png((2 * meshes.MOST_PIXELS, 8))).parts
    assert texture_in(part.glb).size == (meshes.MOST_PIXELS, 4)


@pytest.mark.parametrize('part', ['', 'part-mesh'])
def test_unit_of_a_dae_file_counts_and_its_up_axis_does_not(mesh, part):
    assert extent(mesh('mesh.dae', mesh_texts.DAE, part)) == pytest.approx((1, 2, 0))


def test_gltf_with_a_buffer_beside_it(mesh, tmp_path):
    (tmp_path / 'points.bin').write_bytes(mesh_texts.BUFFER)
    assert extent(mesh('mesh.gltf', mesh_texts.gltf())) == pytest.approx((1, 2, 0))


@pytest.fixture
def reader(mesh_reader):
    return mesh_reader


@pytest.fixture
def named(reader, tmp_path):
    """Returns the mesh of this name, or one with this text, read by a process of its own."""
    def read(name, text=None):
        if text is not None:
            (tmp_path / name).write_text(text)
        return reader.mesh(shape_of(name=name), str(tmp_path / 'model.sdf'), 1.0)
    return read


def endless(*_):
    """Use processor time as long as there is some."""
    while True:
        pass


def test_missing_mesh(named):
    assert re.match('it is not in ".+"', named('none.stl').reason)


def test_mesh_that_cannot_be_read(named):
    assert named('a.stl', 'solid').reason


def test_small_file_that_needs_much_memory(named):
    assert 'memory' in named('a.gltf', mesh_texts.gltf(
        mesh_texts.IN_FILE, count=10**9, with_view=False)).reason
    assert not named('b.stl', mesh_texts.stl(1)).reason


def test_mesh_is_remembered_until_its_file_changes(named):
    first = named('a.stl', mesh_texts.stl(1))
    assert named('a.stl') is first
    assert named('a.stl', mesh_texts.stl(10)) is not first


def test_kept_meshes_are_not_too_large_together(named, reader, monkeypatch):
    named('a.stl', mesh_texts.stl(1))
    size = reader._kept_bytes
    monkeypatch.setattr(meshes, 'MOST_BYTES_KEPT', 2 * size)
    for y, count in ((2, 2), (3, 1), (4, 2)):
        named('a.stl', mesh_texts.stl(y) + y * ' ')
        assert (len(reader._kept), reader._kept_bytes) == (count, count * size)


def test_meshes_have_one_processor_time_together(named, reader, monkeypatch):
    first = named('a.stl', mesh_texts.stl(1))
    assert reader.left_s < meshes.ALLOWANCE.processor_s
    reader.left_s = 0.0
    assert named('a.stl') is first
    reason = 'all meshes together need more than 20 s of processor time'
    assert named('b.stl', mesh_texts.stl()).reason == reason
    monkeypatch.setattr(meshes, 'mesh_and_time', endless)
    reader.left_s = 0.5
    assert named('b.stl').reason == reason
    monkeypatch.undo()
    reader.left_s = meshes.ALLOWANCE.processor_s
    assert not named('b.stl').reason


# Shapes without a file

@pytest.mark.parametrize('name', sorted(SHAPE_TYPES.keys() - {'mesh'}))
def test_shape_is_drawn_if_its_type_has_a_surface(name, reader):
    count = sum(map(len, SHAPE_TYPES[name].sizes_m.values()))
    shape = shape_of()._replace(type=name, sizes_m=(0.5, 0.7, 1.1)[:count])
    mesh = reader.mesh(shape, 'model.sdf', 1.0)
    if SHAPE_TYPES[name].surface is None:
        assert f'a {name} is not supported' in mesh.reason
    else:
        np.testing.assert_array_equal(mesh.parts[0].points, shape.surface[0])
        np.testing.assert_array_equal(mesh.parts[0].faces, shape.surface[1])


def test_large_plane_is_drawn_in_part(reader):
    shape = shape_of()._replace(type='plane', sizes_m=(900.0, 2.0))
    (part,) = reader.mesh(shape, 'model.sdf', 5.0).parts
    assert part.points.max(axis=0).tolist() == [5.0, 1.0, 0.0]
