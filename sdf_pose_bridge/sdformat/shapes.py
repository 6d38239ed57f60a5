# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read the shapes of visuals and collisions.

Source: ``Geometry::Load``, the classes of shapes and ``Material::Load`` of libsdformat 14.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.errors import ElementInvalidError, ElementMissingError
from sdf_pose_bridge.geometry.pose_attributes import boolean_from_text
from sdf_pose_bridge.geometry.rotations import Floats, matrix_from_quaternion
from sdf_pose_bridge.sdformat.grammar import ValueType
from sdf_pose_bridge.sdformat.shape_types import Part, SHAPE_TYPES, Solid, Surface
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.values import number_of_child, numbers_from_text, numbers_of
from sdf_pose_bridge.sdformat.xml_tree import (
    attribute_of,
    child_at,
    child_elements,
    first_child,
    value_at,
    XmlElement,
)

_GRAY = (0.7, 0.7, 0.7, 1.0)
_UP = (0.0, 0.0, 1.0)


class Shape(NamedTuple):
    """The shape of a visual or a collision, in its own frame."""

    type: str
    """Its tag, a key of :data:`SHAPE_TYPES`."""
    sizes_m: tuple[float, ...]
    """Of a box x y z; of a plane x y; of an ellipsoid its three radii; of a sphere its radius; of
    a capsule, a cone and a cylinder radius and length, along z. Empty for others. As written:
    they may be zero, negative or not finite."""
    normal: tuple[float, ...]
    """Normal of a plane, as written; z for others."""
    mesh_uri: str
    """URI of a mesh, relative to the file of its element; empty for others."""
    submesh: str
    """Name of a part of the mesh; empty for all of it."""
    mesh_scale: tuple[float, ...]
    """Factors of a mesh along x, y and z; 1 for others."""
    rgba: tuple[float, float, float, float] | None
    """Color of the material, its diffuse or else its ambient one, each component from 0 to 1. None
    if the file has none."""
    opacity: float = 1.0
    """The opposite of ``<transparency>``, from 0 to 1."""
    is_centered: bool = False
    """Whether the middle of the part of the mesh is put at the origin."""

    @property
    def is_visible(self) -> bool:
        """Whether it is less than fully transparent."""
        return self.opacity > 0.0 and (self.rgba is None or self.rgba[3] > 0.0)

    def rgba_or(self, other: tuple[float, ...]) -> tuple[float, ...]:
        """Return the color of its material, or else another one, with its transparency."""
        red, green, blue, alpha = self.rgba or other
        return red, green, blue, alpha * self.opacity

    @property
    def drawn_rgba(self) -> tuple[float, ...] | None:
        """Its color for RViz: gray if it has none; None for the materials of a mesh itself."""
        # STL has none, and a mesh without a color would be black. RViz cannot make them
        # transparent.
        has_materials = (
            self.type == 'mesh' and self.rgba is None and self.opacity == 1.0
            and not self.mesh_uri.lower().endswith(('.stl', '.stlb')))
        return None if has_materials else self.rgba_or(_GRAY)

    @property
    def has_extent(self) -> bool:
        """Whether the sizes are positive, and they, the normal and the scale finite."""
        return (
            all(map(math.isfinite, (*self.sizes_m, *self.normal, *self.mesh_scale)))
            and self._has_positive_sizes and any(self.normal))

    @property
    def _has_positive_sizes(self) -> bool:
        required_sizes_m = self.sizes_m[:SHAPE_TYPES[self.type].required_count]
        return all(size_m > 0.0 for size_m in required_sizes_m)

    @property
    def reason_without_surface(self) -> str:
        """Why no surface can be made from the sizes alone; empty if one can."""
        if SHAPE_TYPES[self.type].surface is None:
            return f'a {self.type} is not supported'
        return '' if self.has_extent else 'its sizes are not positive'

    @property
    def surface(self) -> Surface:
        """Its surface, if :attr:`reason_without_surface` is empty."""
        make = SHAPE_TYPES[self.type].surface
        if make is None:
            raise ValueError(self.reason_without_surface)
        points_m, faces = make(*self.sizes_m)
        return Surface(_rotated_to_normal(points_m, self.normal), faces)

    @property
    def parts(self) -> tuple[Part, ...]:
        """Its parts; none if its type has none."""
        parts = SHAPE_TYPES[self.type].parts
        return () if parts is None else parts(*self.sizes_m)

    @property
    def solid(self) -> Solid | None:
        """Its mass properties; None if they cannot be computed, or a size is not positive."""
        solid = SHAPE_TYPES[self.type].solid
        try:
            return None if solid is None or not self._has_positive_sizes else solid(*self.sizes_m)
        except OverflowError:
            return None


def shape_of(xml: XmlElement) -> Shape | None:
    """Return the shape of a ``<visual>`` or ``<collision>``; None without one."""
    geometry = first_child(xml, 'geometry')
    shapes = [] if geometry is None else [
        shape for tag in SHAPE_TYPES for shape in child_elements(geometry, tag)]
    if not shapes:
        return None
    shape = shapes[0]
    tag = str(shape.tag)
    sizes_m = (
        numbers_of(child_at(shape, name), size) for name, size in SHAPE_TYPES[tag].sizes_m.items())
    transparency = number_of_child(xml, 'transparency', 0.0)
    return Shape(
        type=tag,
        sizes_m=tuple(size_m for each in sizes_m for size_m in each),
        normal=numbers_of(child_at(shape, 'normal'), _UP) if tag == 'plane' else _UP,
        mesh_uri=value_at(shape, 'uri') if tag == 'mesh' else '',
        submesh=value_at(shape, 'submesh/name'),
        mesh_scale=numbers_of(child_at(shape, 'scale'), (1.0, 1.0, 1.0)),
        rgba=_color(xml),
        opacity=1.0 - transparency if 0.0 < transparency <= 1.0 else 1.0,
        is_centered=bool(boolean_from_text(value_at(shape, 'submesh/center'))))


def _color(xml: XmlElement) -> tuple[float, float, float, float] | None:
    for tag in ('diffuse', 'ambient'):
        numbers = numbers_from_text(value_at(xml, f'material/{tag}'), ValueType.COLOR)
        if len(numbers) >= 3 and all(map(math.isfinite, numbers)):
            red, green, blue, alpha = (*numbers, 1.0)[:4]
            return red, green, blue, alpha
    return None


def check_submesh(xml: XmlElement, sources: Sources) -> None:
    """Check that a part of a mesh has a name."""
    if value_at(xml, 'name', '__default__') == '__default__':
        sources.error(ElementMissingError, xml, 'the <submesh> has no <name>')


def check_material(xml: XmlElement, sources: Sources) -> None:
    """Check that the script and the shader of a material are complete."""
    script, shader = first_child(xml, 'script'), first_child(xml, 'shader')
    if script is not None:
        for tag, error in (('uri', ElementInvalidError), ('name', ElementMissingError)):
            value = value_at(script, tag, '__default__')
            if value == '__default__' or (tag == 'uri' and not value):
                msg = f'the <script> of a material has no <{tag}>, or an empty one'
                sources.error(error, script, msg)
    if shader is not None and first_child(shader, 'normal_map') is None:
        shader_type = attribute_of(shader, 'type')
        if shader_type.startswith('normal_map'):
            msg = f'a shader of type="{shader_type}" needs a <normal_map>'
            sources.error(ElementMissingError, shader, msg)


def _rotated_to_normal(points_m: Floats, normal: tuple[float, ...]) -> Floats:
    """Rotate z to a normal by the shortest way, as libsdformat does."""
    nx, ny, nz = np.array(normal) / np.linalg.norm(normal)
    if nz == 1.0:
        return points_m
    # Half a turn has no shortest way.
    rotation = (1.0, 0.0, 0.0, 0.0) if nz < -1.0 + 1e-9 else (-ny, nx, 0.0, 1.0 + nz)
    quat_xyzw = np.array(rotation) / np.linalg.norm(rotation)
    rotated: Floats = points_m @ np.array(matrix_from_quaternion(quat_xyzw)).T
    return rotated
