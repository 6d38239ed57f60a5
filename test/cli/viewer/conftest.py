# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""A reader of meshes, as the page has it."""

import pytest


@pytest.fixture(name='process', scope='session')
def process_for_meshes():
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
