# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Get the surfaces of meshes from the process that reads them."""

from __future__ import annotations

import io
import json
import os
import signal
import subprocess
import sys
import threading
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.names import shortened
from sdf_pose_bridge.scene.triangles import Points
from sdf_pose_bridge.scene.triangles import Triangles
from sdf_pose_bridge.sdformat.include.uris import ResourceFinder
from sdf_pose_bridge.sdformat.shapes import Shape

MOST_SECONDS = 60.0
"""How long it may take to read a mesh; its processor time has a limit of its own."""


class MeshPart(NamedTuple):
    """A surface of one color."""

    triangles: Triangles
    """In the frame of the mesh, without the scale of its shape."""
    rgba: tuple[float, ...]
    """Each component from 0 to 1; empty where the file of the mesh has none."""


class Mesh(NamedTuple):
    """What is known of a mesh."""

    parts: tuple[MeshPart, ...] = ()
    reason: str = ''
    """Why it has no parts; empty if it has."""
    bounds: Points | None = None
    """Shape (2, 3): its lowest and its highest corner, if they are known in place of parts."""


class MeshReader:
    """
    Reads meshes, and remembers them until their files change.

    :param finder: finds their files.
    """

    def __init__(self, finder: ResourceFinder) -> None:
        self._finder = finder
        self._process: subprocess.Popen[bytes] | None = None
        self._meshes: dict[object, Mesh] = {}

    def mesh(self, shape: Shape, file: str) -> Mesh:
        """
        Return a mesh.

            :param file: path of the file that names it.
        :return: its surfaces, or why there are none.
        """
        path = self._finder.file_from_uri(shape.mesh_uri, file)
        if path is None:
            return Mesh(reason='it is not found')
        status = os.stat(path)  # noqa: PTH116
        key = (path, shape.submesh, status.st_mtime_ns, status.st_size)
        if key not in self._meshes:
            self._meshes[key] = self._read(path, shape.submesh)
        return self._meshes[key]

    def close(self) -> None:
        """End the process."""
        if self._process is not None:
            self._process.kill()
            self._process.communicate()
            self._process = None

    def _read(self, path: str, submesh: str) -> Mesh:
        if self._process is None:
            self._process = subprocess.Popen(
                [sys.executable, '-m', 'sdf_pose_bridge.cli.viewer.mesh_process'],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                # Each thread of this library would take its share of the memory.
                env={**os.environ, 'OPENBLAS_NUM_THREADS': '1'})
        process = self._process
        assert process.stdin is not None
        assert process.stdout is not None
        timer = threading.Timer(MOST_SECONDS, process.kill)
        timer.start()
        try:
            process.stdin.write(json.dumps([path, submesh]).encode() + b'\n')
            process.stdin.flush()
            length = int.from_bytes(process.stdout.read(8), 'little')
            archive = process.stdout.read(length)
        except BrokenPipeError:
            archive = b''
        finally:
            timer.cancel()
        if not archive:
            is_late = process.wait() in (-signal.SIGXCPU, -signal.SIGKILL)
            self.close()
            return Mesh(reason='it takes too long to read' if is_late else (
                'the process that reads it has ended'))
        return _mesh_from_archive(archive)


def _mesh_from_archive(archive: bytes) -> Mesh:
    with np.load(io.BytesIO(archive), allow_pickle=False) as arrays:
        if 'reason' in arrays:
            return Mesh(
                reason=shortened(str(arrays['reason'])),
                bounds=arrays.get('bounds'))
        return Mesh(tuple(
            MeshPart(Triangles(arrays[f'points_{number}'], arrays[f'faces_{number}']),
                     tuple(arrays[f'rgba_{number}'].tolist()))
            for number in range(len(arrays.files) // 3)))
