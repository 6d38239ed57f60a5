# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read meshes in a process that has little memory and little time.

Readers of mesh formats trust their files.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
import io
import os
from pathlib import Path
import re
import time
from typing import Any, NamedTuple

import numpy as np
import trimesh
from trimesh.resolvers import FilePathResolver

from sdf_pose_bridge import Limits, SdfError
from sdf_pose_bridge.limited_process import LimitedProcess, ProcessEndedError
from sdf_pose_bridge.printed_text import printable, quoted_names, shortened
from sdf_pose_bridge.process_limits import Allowance, LimitExceededError
from sdf_pose_bridge.sdformat.include.uris import ResourceFinder
from sdf_pose_bridge.sdformat.limits import Usage
from sdf_pose_bridge.sdformat.shapes import Shape
from sdf_pose_bridge.sdformat.xml_file import bytes_from_file, xml_from_bytes

MOST_BYTES = 100_000_000
"""Size of a mesh with the files that it names."""
MOST_TRIANGLES = 500_000
"""Largest number of triangles of a mesh."""
ALLOWANCE = Allowance(processor_s=20.0, memory_bytes=2_000_000_000)
"""Limits for reading meshes; the processor time is for all of them together."""
MOST_BYTES_KEPT = 300_000_000
"""Largest size of all meshes that are kept."""
FORMATS = ('.dae', '.glb', '.gltf', '.obj', '.stl')
"""The formats. Archives are not read, as they can unpack to any size."""

MOST_PIXELS = 1024
"""Largest width and height of a texture; a larger one is made smaller."""

_LARGEST_M = 1e9
_MISSING = (0.88, 0.19, 0.19, 0.5)
_NAMED_FORMATS = ('.bin', '.mtl', '.jpeg', '.jpg', '.png')


class MeshPart(NamedTuple):
    """A surface of one color, in the frame of the mesh, without the scale of its shape."""

    points: Any
    """Shape (n, 3): x y z in metres."""
    faces: Any
    """Shape (m, 3): the points of each triangle."""
    rgba: tuple[float, ...] = ()
    """Each component from 0 to 1; empty if the file of the mesh has none."""
    glb: bytes = b''
    """The same surface with its texture, as binary glTF; empty if it has none."""


class Mesh(NamedTuple):
    """The surfaces of a mesh."""

    parts: tuple[MeshPart, ...] = ()
    reason: str = ''
    """The reason why the surfaces are replaced; empty if they come from the file."""
    files: tuple[str, ...] = ()
    """Paths of the files that were read, with textures."""

    @property
    def size(self) -> int:
        """Its size in bytes, with some for the rest of the record."""
        return 1000 + sum(
            int(part.points.nbytes + part.faces.nbytes) + len(part.glb) for part in self.parts)


_TOO_SLOW = Mesh(reason=(
    f'all meshes together need more than {ALLOWANCE.processor_s:.0f} s of processor time'))


class MeshReader:
    """Reads meshes, and keeps them until they are too large together."""

    def __init__(self, finder: ResourceFinder, process: LimitedProcess) -> None:
        self._finder = finder
        self._process = process
        self._kept: dict[tuple[str, Shape, int, int], Mesh] = {}
        self._kept_bytes = 0
        self.files: set[str] = set()
        """Paths of all files that were read."""
        self.left_s = ALLOWANCE.processor_s
        """The processor time that is left for further meshes."""

    def mesh(self, shape: Shape, file: str, size_m: float) -> Mesh:
        """
        Return the surfaces to draw for a shape.

        :param file: path of the file that names it.
        :param size_m: extent of the scene; it limits the sides of planes.
        :return: its surfaces, or a small box if they are unknown.
        """
        if shape.type == 'mesh':
            mesh = self._mesh_of_file(shape, file)
            box = trimesh.creation.box(np.full(3, 0.03 * size_m))
            return mesh if not mesh.reason else mesh._replace(
                parts=(MeshPart(box.vertices, box.faces, _MISSING),))
        if shape.reason_without_surface:
            return Mesh(reason=shape.reason_without_surface)
        if shape.type == 'plane':
            # Planes are often much larger than the bodies on them.
            shape = shape._replace(
                sizes_m=tuple(min(side_m, 2.0 * size_m) for side_m in shape.sizes_m))
        return Mesh((MeshPart(*shape.surface),))

    def _mesh_of_file(self, shape: Shape, file: str) -> Mesh:
        path = self._finder.file_from_uri(shape.mesh_uri, file)
        if path is None:
            return Mesh(reason=self._finder.reason_not_found(shape.mesh_uri, file))
        status = os.stat(path)  # noqa: PTH116
        key = path, shape, status.st_mtime_ns, status.st_size
        if key not in self._kept:
            left_s, begin_s = self.left_s, time.monotonic()
            if left_s <= 0.0:
                return _TOO_SLOW
            try:
                mesh, used_s = self._process.call(
                    ALLOWANCE._replace(processor_s=left_s), mesh_and_time, path, shape)
            except (LimitExceededError, ProcessEndedError) as error:
                # How much of this was processor time is not known.
                used_s = time.monotonic() - begin_s
                needs_more = isinstance(error, LimitExceededError)
                mesh = Mesh(reason=f'it needs {error} to be read' if needs_more else str(error))
            self.left_s -= used_s
            if mesh.reason and self.left_s <= 0.0 and left_s < ALLOWANCE.processor_s:
                return _TOO_SLOW
            self._kept_bytes += mesh.size
            if self._kept_bytes > MOST_BYTES_KEPT:
                self._kept.clear()
                self._kept_bytes = mesh.size
            self._kept[key] = mesh
            self.files.update(mesh.files)
        return self._kept[key]


def mesh_and_time(path: str, shape: Shape) -> tuple[Mesh, float]:
    """Read a mesh; also return the processor time in s that this process has used."""
    return mesh_from_file(path, shape), time.process_time()


def mesh_from_file(path: str, shape: Shape) -> Mesh:
    """
    Read a mesh.

    As in Gazebo the unit of a DAE file counts, and the up axes of DAE and glTF files do not.

    :param shape: the shape that names it, and a part of it if not all of it is shown.
    :return: its surfaces, or the reason why there are none.
    """
    usage = Usage(Limits(bytes_read=MOST_BYTES))
    try:
        mesh = Mesh(_parts(*_scene_from_file(path, shape.submesh, usage), shape))
    except SdfError as error:
        mesh = Mesh(reason=error.message)
    except MemoryError:
        raise
    except Exception as error:  # noqa: BLE001  # its readers raise errors of all classes
        mesh = Mesh(reason=f'it cannot be shown: {printable(shortened(str(error)))}')
    return mesh._replace(files=tuple(usage.files))


class _NamedFiles(FilePathResolver):
    """Reads the files that a mesh names, with the checks of other files."""

    def __init__(self, path: str, usage: Usage) -> None:
        super().__init__(path, allow_anywhere=True)
        self._usage = usage

    def get(self, name: str) -> bytes:
        """Return the content of a buffer, material or texture."""
        if not name.lower().endswith(_NAMED_FORMATS):
            raise FileNotFoundError(name)
        path = self.absolute(name)
        if not path.exists():
            # The folder of textures in a model of Gazebo.
            path = Path(self.parent, '..', 'materials', 'textures', Path(name.strip()).name)
        return bytes_from_file(str(path), self._usage)


def _scene_from_file(path: str, submesh: str, usage: Usage) -> tuple[trimesh.Scene, list[str]]:
    """Read a mesh; also return the name of each of its parts, in the order of the graph."""
    suffix = Path(path).suffix.lower()
    if suffix not in FORMATS:
        msg = f'its name must end with one of {", ".join(FORMATS)}'
        raise ValueError(msg)
    text = bytes_from_file(path, usage)
    node_names = _node_names(text, path) if suffix == '.dae' else {}
    options = {}
    if suffix == '.obj' and submesh:
        # As in Gazebo, a group is a part like an object.
        text, options = re.sub(rb'(?m)^g(?=[ \t])', b'o', text), {'split_objects': True}
    scene = trimesh.load_scene(
        io.BytesIO(text), file_type=suffix[1:], resolver=_NamedFiles(path, usage), **options)
    return scene, list(_names_of_parts(scene, node_names))


def _node_names(text: bytes, path: str) -> dict[str, list[str]]:
    """Return the names of the nodes of a DAE file that show each geometry, by its id."""
    names: dict[str, list[str]] = {}
    for instance in xml_from_bytes(text, path).root.iter('instance_geometry'):
        above = (node.get('name') for node in instance.iterancestors('node'))
        names.setdefault(instance.get('url', '')[1:], []).append(next(filter(None, above), ''))
    return names


def _names_of_parts(
    scene: trimesh.Scene, node_names: Mapping[str, Sequence[str]],
) -> Iterator[str]:
    """Find the names that Gazebo knows parts by."""
    nodes = scene.graph.nodes_geometry
    # trimesh calls the surfaces of the geometry "a" "a", "a_1", "a_2", node by node.
    ids = [node if node in node_names else node.rpartition('_')[0] for node in nodes]
    counts, before = Counter(ids), Counter[str]()
    for node, geometry_id in zip(nodes, ids, strict=True):
        names = node_names.get(geometry_id, ())
        name = names[len(names) * before[geometry_id] // counts[geometry_id]] if names else ''
        before[geometry_id] += 1
        # It appends the name of the material to the name of an object.
        material = getattr(scene.geometry[scene.graph[node][1]].visual, 'material', None)
        yield name or node.removesuffix(f'_{getattr(material, "name", None)}')


def _parts(scene: trimesh.Scene, names: Sequence[str], shape: Shape) -> tuple[MeshPart, ...]:
    surfaces, submesh = [], shape.submesh
    for node, part_name in zip(scene.graph.nodes_geometry, names, strict=True):
        matrix, name = scene.graph[node]
        mesh = scene.geometry[name]
        if isinstance(mesh, trimesh.Trimesh) and len(mesh.faces) and (
                not submesh or submesh in (part_name, name)):
            unit_m = trimesh.units.unit_conversion(mesh.units or 'meters', 'meters')
            surfaces.append((mesh, unit_m * trimesh.transform_points(mesh.vertices, matrix)))
    middle = np.zeros(3)
    if shape.is_centered and surfaces:
        points = np.concatenate([points for _, points in surfaces])
        middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    parts = [
        MeshPart(points - middle, np.asarray(mesh.faces), _rgba(mesh), _glb(mesh, points - middle))
        for mesh, points in surfaces]
    triangle_count = sum(len(part.faces) for part in parts)
    if not parts:
        listed = quoted_names(sorted(set(names)))
        msg = (f'it has no part "{submesh}", but {listed}' if names and submesh
               else 'it has no surface')
    # NaN is too large too.
    elif not all(np.abs(part.points).max() <= _LARGEST_M for part in parts):
        msg = f'a coordinate is larger than {_LARGEST_M:g} m'
    elif triangle_count > MOST_TRIANGLES:
        msg = f'it has {triangle_count} triangles, more than {MOST_TRIANGLES}'
    else:
        return tuple(parts)
    raise ValueError(msg)


def _rgba(mesh: trimesh.Trimesh) -> tuple[float, ...]:
    visual: Any = mesh.visual
    if visual is None or not visual.defined:
        return ()
    rgba = getattr(visual, 'material', visual).main_color
    return tuple((np.asarray(rgba, float)[:4] / 255.0).tolist())


def _glb(mesh: trimesh.Trimesh, points: Any) -> bytes:
    """Return a surface with its texture as binary glTF; empty if there is none."""
    visual: Any = mesh.visual
    material = getattr(visual, 'material', None)
    image = getattr(material, 'baseColorTexture', None) or getattr(material, 'image', None)
    if image is None or getattr(visual, 'uv', None) is None:
        return b''
    # As in Gazebo, a texture of OBJ is opaque unless the material has one for opacity, too.
    has_alpha = 'A' in image.getbands() and not (
        isinstance(material, trimesh.visual.material.SimpleMaterial)
        and 'map_d' not in material.kwargs)
    try:
        image = image.convert('RGBA' if has_alpha else 'RGB')
    except (OSError, SyntaxError, ValueError):  # raised by Pillow for a broken image
        return b''
    image.thumbnail((MOST_PIXELS, MOST_PIXELS))
    textured = trimesh.visual.TextureVisuals(visual.uv, trimesh.visual.material.PBRMaterial(
        baseColorTexture=image, metallicFactor=0.0, roughnessFactor=1.0, doubleSided=True,
        alphaMode='MASK' if has_alpha else None))
    glb: bytes = trimesh.Trimesh(
        points, mesh.faces, visual=textured, process=False).export(file_type='glb')
    return glb
