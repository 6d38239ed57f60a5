# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes of all formats, broken and hostile ones, and the files that they name."""

import os

import mesh_texts
import numpy as np
import pytest

pytest.importorskip('trimesh', reason='needs trimesh')
pytest.importorskip('collada', reason='needs pycollada')
from sdf_pose_bridge.cli.viewer import mesh_process
from sdf_pose_bridge.cli.viewer.mesh_process import arrays_from_mesh
from sdf_pose_bridge.cli.viewer.mesh_process import MeshError
from sdf_pose_bridge.errors import FileReadError
from sdf_pose_bridge.errors import LimitError
from sdf_pose_bridge.errors import SdfError


@pytest.fixture
def arrays(tmp_path):
    """Returns the arrays of a mesh with this text in a file of this name."""
    def read(name, text, submesh=''):
        (tmp_path / name).write_bytes(text if isinstance(text, bytes) else text.encode())
        return arrays_from_mesh(str(tmp_path / name), submesh)
    return read


def extent(arrays):
    points = np.concatenate([
        values for name, values in arrays.items() if name.startswith('points_')])
    return np.ptp(points, axis=0)


def test_missing_file(tmp_path):
    with pytest.raises(FileReadError, match='No such file'):
        arrays_from_mesh(str(tmp_path / 'none.stl'), '')


@pytest.mark.parametrize('name', ['mesh.zip', 'mesh.3mf', 'mesh.xyz', 'mesh'])
def test_other_formats(arrays, name):
    with pytest.raises(MeshError, match=r'a mesh must be one of \.dae, '):
        arrays(name, b'PK\3\4')


def test_empty_file(arrays):
    with pytest.raises((MeshError, ValueError)):
        arrays('mesh.obj', '')


def test_coordinate_that_is_not_finite(arrays):
    with pytest.raises(MeshError, match='it has no surface'):
        arrays('mesh.stl', mesh_texts.STL.format(y='inf'))


@pytest.mark.parametrize('scale', [1e300, float('nan')])
def test_coordinate_that_is_too_large(arrays, scale):
    with pytest.raises(MeshError, match='a coordinate is larger than 1e'):
        arrays('mesh.gltf', mesh_texts.gltf(mesh_texts.IN_FILE, scale=scale))


def test_named_pipe(tmp_path):
    os.mkfifo(tmp_path / 'mesh.stl')
    with pytest.raises(FileReadError, match='not a regular file'):
        arrays_from_mesh(str(tmp_path / 'mesh.stl'), '')


def test_buffer_that_is_a_named_pipe(arrays, tmp_path):
    os.mkfifo(tmp_path / 'points.bin')
    with pytest.raises(FileReadError, match='not a regular file'):
        arrays('mesh.gltf', mesh_texts.gltf())


def test_buffer_that_is_no_buffer(arrays):
    with pytest.raises(FileNotFoundError):
        arrays('mesh.gltf', mesh_texts.gltf('/etc/hostname'))


def test_material_that_is_a_named_pipe(arrays, tmp_path):
    os.mkfifo(tmp_path / 'colors.mtl')
    assert len(arrays('mesh.obj', mesh_texts.OBJ)) == 3 * 2


def test_size_counts_named_files(arrays, tmp_path, monkeypatch):
    monkeypatch.setattr(mesh_process, 'MOST_BYTES', 2000)
    (tmp_path / 'points.bin').write_bytes(mesh_texts.BUFFER + b'\0' * 2000)
    with pytest.raises(LimitError, match='bytes_read'):
        arrays('mesh.gltf', mesh_texts.gltf())


def test_document_type_of_a_dae_file(arrays):
    text = mesh_texts.DAE.replace('<COLLADA', '<!DOCTYPE d [<!ENTITY a "b">]><COLLADA', 1)
    with pytest.raises(SdfError, match='document type'):
        arrays('mesh.dae', text)


def test_too_many_triangles_are_a_box(arrays, monkeypatch):
    monkeypatch.setattr(mesh_process, 'MOST_TRIANGLES', 1)
    found = arrays('mesh.obj', mesh_texts.OBJ)
    assert found['reason'] == 'it has 2 triangles, more than 1'
    assert found['bounds'] == pytest.approx(np.array([(0, 0, 0), (1, 2, 5)]))


def test_unknown_part(arrays):
    with pytest.raises(MeshError, match='it has no part "middle", but left, right'):
        arrays('mesh.obj', mesh_texts.OBJ, 'middle')


def test_part(arrays):
    assert arrays('mesh.obj', mesh_texts.OBJ, 'right')['points_0'][:, 2] == pytest.approx(5.0)


def test_part_by_the_name_that_exporters_change(arrays):
    assert extent(arrays('mesh.dae', mesh_texts.DAE, 'part')) == pytest.approx((1, 2, 0))


def test_stl(arrays):
    found = arrays('mesh.STL', mesh_texts.STL.format(y=2))
    assert extent(found) == pytest.approx((1, 2, 0))
    assert found['rgba_0'].size == 0


def test_colors_of_materials(arrays, tmp_path):
    (tmp_path / 'colors.mtl').write_text(mesh_texts.MTL)
    found = arrays('mesh.obj', mesh_texts.OBJ)
    assert sorted(found[f'rgba_{number}'].tolist() for number in (0, 1)) == [
        [0, 0, 1, 1], [1, 0, 0, 1]]


def test_texture_is_not_read(arrays, tmp_path):
    (tmp_path / 'colors.mtl').write_text('newmtl red\nmap_Kd texture.png\n')
    os.mkfifo(tmp_path / 'texture.png')
    assert extent(arrays('mesh.obj', mesh_texts.OBJ)) == pytest.approx((1, 2, 5))


def test_unit_of_a_dae_file_counts_and_its_up_axis_does_not(arrays):
    assert extent(arrays('mesh.dae', mesh_texts.DAE)) == pytest.approx((1, 2, 0))


def test_gltf_with_a_buffer_beside_it(arrays, tmp_path):
    (tmp_path / 'points.bin').write_bytes(mesh_texts.BUFFER)
    assert extent(arrays('mesh.gltf', mesh_texts.gltf())) == pytest.approx((1, 2, 0))
