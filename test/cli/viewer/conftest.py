# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A reader of meshes and a server, as the page has them."""

from types import SimpleNamespace

import pytest


@pytest.fixture(scope='session')
def process():
    from sdf_pose_bridge.limited_process import LimitedProcess
    process = LimitedProcess()
    yield process
    process.close()


@pytest.fixture
def mesh_reader(process):
    """Return a reader of meshes."""
    from sdf_pose_bridge.cli.viewer.meshes import MeshReader
    from sdf_pose_bridge.sdformat.include.uris import resource_finder
    return MeshReader(resource_finder([], {}), process)


@pytest.fixture
def server():
    """A server, which stands for a tab."""
    from viser import ViserServer
    server = ViserServer('127.0.0.1', 0, verbose=False)
    server.camera = SimpleNamespace(aspect=1.0, image_width=1000)
    yield server
    server.stop()
