# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The process that reads meshes: what ends it, and that another one follows."""

import mesh_texts
import pytest

from sdf_pose_bridge.cli.viewer import meshes
from sdf_pose_bridge.cli.viewer.meshes import MeshReader
from sdf_pose_bridge.sdformat.include.uris import resource_finder
from sdf_pose_bridge.sdformat.shapes import Shape

pytest.importorskip('trimesh', reason='needs trimesh')


@pytest.fixture
def reader():
    """A reader of meshes."""
    with_process = MeshReader(resource_finder([], {}))
    yield with_process
    with_process.close()


@pytest.fixture
def mesh(reader, tmp_path):
    """Returns what is known of the mesh of this name, or of one with this text."""
    def read(name, text=None):
        if text is not None:
            (tmp_path / name).write_text(text)
        shape = Shape('mesh', (), (0.0, 0.0, 1.0), name, '', (1.0, 1.0, 1.0), None)
        return reader.mesh(shape, str(tmp_path / 'model.sdf'))
    return read


def test_missing_mesh(mesh):
    assert mesh('none.stl').reason == 'it is not found'


def test_mesh_that_cannot_be_read(mesh):
    assert mesh('a.stl', 'solid').reason


def test_small_file_that_needs_much_memory(mesh):
    assert 'bytes' in mesh('a.gltf', mesh_texts.gltf(
        mesh_texts.IN_FILE, count=10**9, with_view=False)).reason
    assert mesh('b.stl', mesh_texts.STL.format(y=1)).parts


def test_mesh_that_takes_too_long(mesh, monkeypatch):
    monkeypatch.setattr(meshes, 'MOST_SECONDS', 0.0)
    assert mesh('a.stl', mesh_texts.STL.format(y=1)).reason == 'it takes too long to read'
    monkeypatch.undo()
    assert mesh('b.stl', mesh_texts.STL.format(y=1)).parts


def test_mesh_is_remembered_until_its_file_changes(mesh):
    first = mesh('a.stl', mesh_texts.STL.format(y=1))
    assert mesh('a.stl') is first
    assert mesh('a.stl', mesh_texts.STL.format(y=10)) is not first
