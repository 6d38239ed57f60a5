# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Make the surfaces of shapes, and read meshes in a process that has little memory and little time.

Readers of mesh formats trust their files.
"""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures import TimeoutError as ExecutorTimeoutError
from concurrent.futures.process import BrokenProcessPool
import io
import multiprocessing
import os
from pathlib import Path
import resource
import signal
import threading
from typing import Any
from typing import NamedTuple

import numpy as np
import trimesh
from trimesh.resolvers import Resolver

from sdf_pose_bridge.errors import SdfError
from sdf_pose_bridge.names import printable
from sdf_pose_bridge.names import shortened
from sdf_pose_bridge.scene.triangles import triangles_from_shape
from sdf_pose_bridge.sdformat.include.uris import ResourceFinder
from sdf_pose_bridge.sdformat.limits import Limits
from sdf_pose_bridge.sdformat.limits import Usage
from sdf_pose_bridge.sdformat.shapes import Shape
from sdf_pose_bridge.sdformat.xml_file import bytes_from_file
from sdf_pose_bridge.sdformat.xml_file import xml_from_bytes

MOST_BYTES = 100_000_000
"""Size of a mesh with the files that it names."""
MOST_TRIANGLES = 500_000
"""How many triangles a mesh may have."""
MOST_CPU_SECONDS = 10.0
MOST_SECONDS = 60.0
"""How long it may take to read a mesh, on a machine that is busy."""
MOST_MEMORY_BYTES = 2_000_000_000
"""Address space of the process."""
FORMATS = ('.dae', '.glb', '.gltf', '.obj', '.stl')
"""What is read. Archives are not, as they can unpack to any size."""

_LARGEST_M = 1e9
_MISSING = (0.88, 0.19, 0.19, 0.5)
_NAMED_FORMATS = ('.bin', '.mtl')


class MeshPart(NamedTuple):
    """A surface of one color, in the frame of the mesh, without the scale of its shape."""

    points: Any
    """Shape (n, 3): x y z in metres."""
    faces: Any
    """Shape (m, 3): the points of each triangle."""
    rgba: tuple[float, ...] = ()
    """Each component from 0 to 1; empty where the file of the mesh has none."""


class Mesh(NamedTuple):
    """What is known of a mesh."""

    parts: tuple[MeshPart, ...] = ()
    reason: str = ''
    """Why these are not its surfaces; empty if they are."""
    bounds: Any = None
    """Shape (2, 3): its lowest and its highest corner, if nothing else of it is known."""


class MeshReader:
    """
    Reads meshes, and remembers them until their files change.

    :param finder: finds their files.
    """

    def __init__(self, finder: ResourceFinder) -> None:
        self._finder = finder
        self._executor: ProcessPoolExecutor | None = None
        self._meshes: dict[object, Mesh] = {}

    def mesh(self, shape: Shape, file: str, size_m: float) -> Mesh:
        """
        Return what is drawn of a shape.

        :param file: path of the file that names it.
        :param size_m: extent of the scene; no side of a plane is much longer.
        :return: its surfaces, or a box where these are not known.
        """
        if shape.type != 'mesh':
            return _mesh_of_shape(shape, 2.0 * size_m)
        mesh = self._mesh_of_file(shape, file)
        if mesh.parts:
            return mesh
        unknown = np.array([[-1.0], [1.0]]) * np.full(3, 0.015 * size_m)
        box = trimesh.creation.box(bounds=unknown if mesh.bounds is None else mesh.bounds)
        return mesh._replace(parts=(MeshPart(box.vertices, box.faces, _MISSING),),
                             reason=f'the mesh "{shape.mesh_uri}": {mesh.reason}')

    def close(self) -> None:
        """End the process."""
        if self._executor is not None:
            for process in multiprocessing.active_children():
                process.kill()
            self._executor.shutdown()
            self._executor = None

    def _mesh_of_file(self, shape: Shape, file: str) -> Mesh:
        path = self._finder.file_from_uri(shape.mesh_uri, file)
        if path is None:
            return Mesh(reason='it is not found')
        status = os.stat(path)  # noqa: PTH116
        key = (path, shape.submesh, status.st_mtime_ns, status.st_size)
        if key not in self._meshes:
            self._meshes[key] = self._read(path, shape.submesh)
        return self._meshes[key]

    def _read(self, path: str, submesh: str) -> Mesh:
        if self._executor is None:
            # Each thread of this library would take its share of the memory.
            os.environ['OPENBLAS_NUM_THREADS'] = '1'
            self._executor = ProcessPoolExecutor(
                1, multiprocessing.get_context('spawn'), _limit_this_process)
        try:
            return self._executor.submit(mesh_from_file, path, submesh).result(MOST_SECONDS)
        except (BrokenProcessPool, ExecutorTimeoutError):
            self.close()
            return Mesh(reason=f'to read it takes more than {MOST_CPU_SECONDS:g} s of processor '
                               'time, or ends the process that does so')


def _mesh_of_shape(shape: Shape, largest_m: float) -> Mesh:
    if shape.reason_without_surface:
        return Mesh(reason=shape.reason_without_surface)
    sizes_m, creation = shape.sizes_m, trimesh.creation
    if shape.type == 'plane':
        # Planes are often much larger than what stands on them.
        sizes_m = tuple(min(size_m, largest_m) for size_m in sizes_m)
    if shape.type in ('cone', 'plane'):
        return Mesh((MeshPart(*triangles_from_shape(shape._replace(sizes_m=sizes_m))),))
    if shape.type == 'box':
        surface = creation.box(sizes_m)
    elif shape.type == 'cylinder':
        surface = creation.cylinder(*sizes_m)
    elif shape.type == 'capsule':
        surface = creation.capsule(max(sizes_m[1], 0.0), sizes_m[0], count=(12, 24))
    else:  # A sphere has one radius, an ellipsoid three.
        surface = creation.icosphere().apply_scale(sizes_m if len(sizes_m) == 3 else sizes_m[0])
    return Mesh((MeshPart(np.asarray(surface.vertices), np.asarray(surface.faces)),))


def _limit_this_process() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY_BYTES, MOST_MEMORY_BYTES))
    # Ctrl-C is for the process that started this one, and what libraries print for nobody.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def mesh_from_file(path: str, submesh: str) -> Mesh:
    """
    Read a mesh; the process ends if it takes too long.

    As in Gazebo the unit of a DAE file counts, and the up axes of DAE and glTF files do not.

    :param path: path of its file.
    :param submesh: the name of the part that is meant; empty for all of it.
    :return: its surfaces, or why there are none.
    """
    signal.setitimer(signal.ITIMER_PROF, MOST_CPU_SECONDS)
    try:
        return _mesh_from_scene(_scene_from_file(path, submesh), submesh)
    except SdfError as error:
        return Mesh(reason=error.message)
    except MemoryError:
        return Mesh(reason=f'it needs more than {MOST_MEMORY_BYTES} bytes to be read')
    except Exception as error:  # noqa: BLE001  # its readers raise errors of all classes
        return Mesh(reason=f'it cannot be read: {printable(shortened(str(error)))}')
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)


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


def _scene_from_file(path: str, submesh: str) -> trimesh.Scene:
    suffix = Path(path).suffix.lower()
    if suffix not in FORMATS:
        msg = f'its name must end with one of {", ".join(FORMATS)}'
        raise ValueError(msg)
    usage = Usage(Limits(bytes_read=MOST_BYTES))
    text = bytes_from_file(path, usage)
    if suffix == '.dae':
        xml_from_bytes(text, path)
    options = {'split_objects': True} if suffix == '.obj' and submesh else {}
    return trimesh.load_scene(
        io.BytesIO(text), file_type=suffix[1:],
        resolver=_NamedFiles(Path(path).parent, usage), **options)


def _mesh_from_scene(scene: trimesh.Scene, submesh: str) -> Mesh:
    parts = list(_parts(scene, submesh))
    if not parts:
        names = ', '.join(map(printable, sorted(scene.geometry))) or 'no surface'
        return Mesh(reason=f'it has no part "{printable(shortened(submesh))}", but '
                           f'{shortened(names)}' if submesh else 'it has no surface')
    bounds = np.array([
        np.min([part.points.min(axis=0) for part in parts], axis=0),
        np.max([part.points.max(axis=0) for part in parts], axis=0)])
    if not np.abs(bounds).max() <= _LARGEST_M:  # nor a number
        return Mesh(reason=f'a coordinate is larger than {_LARGEST_M:g} m')
    triangle_count = sum(len(part.faces) for part in parts)
    if triangle_count > MOST_TRIANGLES:
        reason = f'it has {triangle_count} triangles, more than {MOST_TRIANGLES}'
        return Mesh(reason=reason, bounds=bounds)
    return Mesh(tuple(parts))


def _parts(scene: trimesh.Scene, submesh: str) -> Iterator[MeshPart]:
    """Find the surfaces of a mesh."""
    for node in scene.graph.nodes_geometry:
        matrix, name = scene.graph[node]
        mesh = scene.geometry[name]
        # Exporters of DAE call the geometry of the part "box" "box-mesh".
        names = (node, name, node.partition('-mesh')[0], name.partition('-mesh')[0])
        if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces) and (
                not submesh or submesh in names):
            unit_m = trimesh.units.unit_conversion(mesh.units or 'meters', 'meters')
            points = unit_m * trimesh.transform_points(mesh.vertices, matrix)
            yield MeshPart(
                np.asarray(points, np.float32), np.asarray(mesh.faces, np.uint32), _rgba(mesh))


def _rgba(mesh: trimesh.Trimesh) -> tuple[float, ...]:
    visual: Any = mesh.visual
    if visual is None or not visual.defined:
        return ()
    material = getattr(visual, 'material', None)
    rgba = visual.main_color if material is None else material.main_color
    return tuple((np.asarray(rgba, float)[:4] / 255.0).tolist())
