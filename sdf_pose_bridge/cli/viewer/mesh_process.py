# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read meshes in a process of its own, which has little memory and can be ended.

Readers of mesh formats trust their files. This process gets the path of a mesh and the name of the
part that is meant as a line of JSON, and answers with the length of an archive of arrays and the
archive: for each part ``points_0``, ``faces_0`` and ``rgba_0``; or ``reason``, why there are none,
and ``bounds`` if these are known.
"""

from __future__ import annotations

from collections.abc import Iterator
import io
import json
import os
from pathlib import Path
import resource
import sys
import time
from typing import Any

import numpy as np
import trimesh
from trimesh.resolvers import Resolver

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.names import shortened
from sdf_pose_bridge.sdformat.limits import Limits
from sdf_pose_bridge.sdformat.limits import Usage
from sdf_pose_bridge.sdformat.xml_file import bytes_from_file
from sdf_pose_bridge.sdformat.xml_file import xml_from_bytes

MOST_BYTES = 100_000_000
"""Size of a mesh with the files that it names."""
MOST_TRIANGLES = 500_000
"""How many triangles a mesh may have."""
MOST_SECONDS = 10
"""Processor time for each mesh."""
MOST_MEMORY_BYTES = 2_000_000_000
"""Address space of the process."""
FORMATS = ('.dae', '.glb', '.gltf', '.obj', '.stl')
"""What is read. Archives are not, as they can unpack to any size."""

_LARGEST_M = 1e9
_NAMED_FORMATS = ('.bin', '.mtl')


class MeshError(ValueError):
    """A mesh cannot be drawn; the message says why."""


class _NamedFiles(Resolver):
    """Reads the buffers and materials that a mesh names, with the checks of other files."""

    def __init__(self, folder: Path, usage: Usage) -> None:
        self._folder, self._usage = folder, usage

    def get(self, key: str) -> bytes:
        """Return the content of a file; textures are not read."""
        if not key.lower().endswith(_NAMED_FORMATS):
            raise FileNotFoundError(key)
        return bytes_from_file(str(self._folder / key), self._usage)

    def namespaced(self, namespace: str) -> _NamedFiles:
        """Return the same for a folder below this one."""
        return _NamedFiles(self._folder / namespace, self._usage)

    def keys(self) -> list[str]:
        """Return nothing: no folder is listed."""
        return []

    def write(self, name: str, data: Any) -> None:
        """Write nothing."""


def arrays_from_mesh(path: str, submesh: str) -> dict[str, Any]:
    """
    Read a mesh.

    As in Gazebo the unit of a DAE file counts, and the up axes of DAE and glTF files do not.

    :param path: path of its file.
    :param submesh: the name of the part that is meant; empty for all of it.
    :return: the arrays of the answer.
    :raises MeshError: if it cannot be drawn.
    :raises SdfError: if a file cannot be read.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in FORMATS:
        msg = f'a mesh must be one of {", ".join(FORMATS)}'
        raise MeshError(msg)
    usage = Usage(Limits(bytes_read=MOST_BYTES))
    text = bytes_from_file(path, usage)
    if suffix == '.dae':
        xml_from_bytes(text, path)
    options = {'split_objects': True} if suffix == '.obj' and submesh else {}
    scene = trimesh.load_scene(
        io.BytesIO(text), file_type=suffix[1:],
        resolver=_NamedFiles(Path(path).parent, usage), **options)
    nodes = list(_nodes(scene, submesh))
    if not nodes:
        parts = ', '.join(map(printable, sorted(scene.geometry))) or 'no surface'
        msg = f'it has no part "{printable(shortened(submesh))}", but {shortened(parts)}'
        raise MeshError(msg if submesh else 'it has no surface')
    arrays: dict[str, Any] = {}
    for number, (mesh, matrix) in enumerate(nodes):
        points = trimesh.transform_points(mesh.vertices, matrix)
        if not np.abs(points).max() <= _LARGEST_M:  # nor a number
            msg = f'a coordinate is larger than {_LARGEST_M:g} m'
            raise MeshError(msg)
        arrays[f'points_{number}'] = points.astype(np.float32)
        arrays[f'faces_{number}'] = mesh.faces.astype(np.uint32)
        arrays[f'rgba_{number}'] = _rgba(mesh)
    triangle_count = sum(len(mesh.faces) for mesh, _ in nodes)
    if triangle_count > MOST_TRIANGLES:
        points = np.concatenate([arrays[f'points_{number}'] for number in range(len(nodes))])
        reason = f'it has {triangle_count} triangles, more than {MOST_TRIANGLES}'
        return {'reason': reason, 'bounds': np.array([points.min(axis=0), points.max(axis=0)])}
    return arrays


def _nodes(scene: trimesh.Scene, submesh: str) -> Iterator[tuple[trimesh.Trimesh, Any]]:
    """Find the surfaces of a mesh, and what transforms each to the frame of the mesh."""
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        mesh = scene.geometry[name]
        # Exporters of DAE call the geometry of the part "box" "box-mesh".
        names = (node, name, node.partition('-mesh')[0], name.partition('-mesh')[0])
        if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces) and (
                not submesh or submesh in names):
            unit_m = trimesh.units.unit_conversion(mesh.units or 'meters', 'meters')
            yield mesh, np.diag([unit_m, unit_m, unit_m, 1.0]) @ matrix


def _rgba(mesh: trimesh.Trimesh) -> Any:
    """Return the color of a surface, components from 0 to 1; empty if it has none."""
    visual: Any = mesh.visual
    if visual is None or not visual.defined:
        return np.empty(0)
    material = getattr(visual, 'material', None)
    rgba = visual.main_color if material is None else material.main_color
    return np.asarray(rgba, np.float64)[:4] / 255.0


def main() -> None:
    """Answer until the input ends."""
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY_BYTES, MOST_MEMORY_BYTES))
    answers = os.fdopen(os.dup(1), 'wb')
    # What a library prints must not get between the answers.
    os.dup2(2, 1)
    _, most_seconds = resource.getrlimit(resource.RLIMIT_CPU)
    for line in sys.stdin:
        seconds = int(time.process_time()) + MOST_SECONDS + 1
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, most_seconds))
        try:
            arrays = arrays_from_mesh(*json.loads(line))
        except (MeshError, SdfError) as error:
            arrays = {'reason': getattr(error, 'message', str(error))}
        except MemoryError:
            arrays = {'reason': f'it needs more than {MOST_MEMORY_BYTES} bytes to be read'}
        except Exception as error:  # noqa: BLE001  # its readers raise errors of all classes
            arrays = {'reason': f'it cannot be read: {printable(shortened(str(error)))}'}
        archive = io.BytesIO()
        np.savez(archive, **arrays)
        answers.write(len(archive.getbuffer()).to_bytes(8, 'little') + archive.getvalue())
        answers.flush()


if __name__ == '__main__':
    main()
