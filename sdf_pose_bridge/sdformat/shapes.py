# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read the shapes of visuals and collisions: what they look like, and where their mass is.

An automatic inertial is at the center of mass of the collisions of its link. Source:
``Geometry::Load``, the classes of shapes, ``Material::Load``, ``Link::ResolveAutoInertials``,
``Collision::CalculateInertial`` and ``Geometry::CalculateInertial`` of libsdformat 14.
"""

from __future__ import annotations

from collections.abc import Mapping
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.errors import ElementMissingError
from sdf_pose_bridge.errors import LinkInertiaError
from sdf_pose_bridge.geometry.rotations import Floats
from sdf_pose_bridge.geometry.rotations import matrix_from_quaternion
from sdf_pose_bridge.sdformat.grammar import ValueType
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.values import boolean_from_text
from sdf_pose_bridge.sdformat.values import numbers_from_text
from sdf_pose_bridge.sdformat.values import numbers_of_child
from sdf_pose_bridge.sdformat.xml_tree import attribute_of
from sdf_pose_bridge.sdformat.xml_tree import child_elements
from sdf_pose_bridge.sdformat.xml_tree import child_value
from sdf_pose_bridge.sdformat.xml_tree import first_child
from sdf_pose_bridge.sdformat.xml_tree import XmlElement

_DEFAULT_SIZES: Mapping[str, Mapping[str, tuple[float, ...]]] = {
    'box': {'size': (1.0, 1.0, 1.0)},
    'capsule': {'radius': (0.5,), 'length': (1.0,)},
    'cone': {'radius': (1.0,), 'length': (1.0,)},
    'cylinder': {'radius': (1.0,), 'length': (1.0,)},
    'ellipsoid': {'radii': (1.0, 1.0, 1.0)},
    'plane': {'size': (1.0, 1.0)},
    'sphere': {'radius': (1.0,)},
    'mesh': {},
    'heightmap': {},
    'image': {},
    'polyline': {},
}
"""The shapes in the order in which the first one counts, and the defaults of their sizes."""

DEFAULT_DENSITY_KG_M3 = 1000.0
"""Density of a collision where neither it nor the inertial has one: that of water."""

_SEGMENTS_OF_CONE = 24


class Shape(NamedTuple):
    """What a visual or a collision looks like, in its own frame."""

    type: str
    """``box``, ``capsule``, ``cone``, ``cylinder``, ``ellipsoid``, ``plane``, ``sphere``,
    ``mesh``, ``heightmap``, ``image`` or ``polyline``."""
    sizes_m: tuple[float, ...]
    """Of a box x y z; of a plane x y; of an ellipsoid its three radii; of a sphere its radius; of
    a capsule, a cone and a cylinder radius and length, along z. Empty for others. As written:
    they may be zero, negative or not finite."""
    normal: tuple[float, ...]
    """Normal of a plane, as written; z for others."""
    mesh_uri: str
    """URI of a mesh, relative to the file of its element; empty for others."""
    submesh: str
    """Name of the part of the mesh that is meant; empty for all of it."""
    mesh_scale: tuple[float, ...]
    """Factors of a mesh along x, y and z; 1 for others."""
    rgba: tuple[float, float, float, float] | None
    """Color of the material, its diffuse or else its ambient one, each component from 0 to 1.
    None where the file gives none."""
    opacity: float = 1.0
    """What ``<transparency>`` leaves of any color, from 0 to 1."""

    @property
    def is_visible(self) -> bool:
        """Whether it is less than fully transparent."""
        return self.opacity > 0.0 and (self.rgba is None or self.rgba[3] > 0.0)

    def rgba_or(self, other: tuple[float, ...]) -> tuple[float, ...]:
        """Return the color of its material, or else another one, as transparent as it is."""
        red, green, blue, alpha = self.rgba or other
        return red, green, blue, alpha * self.opacity

    @property
    def required_sizes_m(self) -> tuple[float, ...]:
        """The sizes that have to be positive: a capsule without a length is a sphere."""
        return self.sizes_m[:1] if self.type == 'capsule' else self.sizes_m

    @property
    def has_extent(self) -> bool:
        """Whether the sizes are positive, and they, the normal and the scale finite."""
        return (
            all(map(math.isfinite, (*self.sizes_m, *self.normal, *self.mesh_scale)))
            and all(size_m > 0.0 for size_m in self.required_sizes_m) and any(self.normal))

    @property
    def reason_without_surface(self) -> str:
        """Why no surface can be made from the sizes alone; empty if one can."""
        if not self.sizes_m:
            return f'a {self.type} is not supported'
        return '' if self.has_extent else 'its sizes are not positive'


class CollisionMass(NamedTuple):
    """The mass of a collision that an automatic inertial is computed from."""

    mass_kg: float
    center_z_m: float
    """The z of the center of mass in the frame of the collision; its x and y are 0."""


def shape_of(xml: XmlElement) -> Shape | None:
    """Return the shape of a ``<visual>`` or ``<collision>``; None without one."""
    geometry = first_child(xml, 'geometry')
    shapes = [] if geometry is None else [
        shape for tag in _DEFAULT_SIZES for shape in child_elements(geometry, tag)]
    if not shapes:
        return None
    shape = shapes[0]
    tag = str(shape.tag)
    sizes_m = (numbers_of_child(shape, name, size) for name, size in _DEFAULT_SIZES[tag].items())
    submesh = first_child(shape, 'submesh')
    (transparency,) = numbers_of_child(xml, 'transparency', (0.0,))
    return Shape(
        type=tag,
        sizes_m=tuple(size_m for each in sizes_m for size_m in each),
        normal=numbers_of_child(shape, 'normal', (0.0, 0.0, 1.0)),
        mesh_uri=child_value(shape, 'uri') if tag == 'mesh' else '',
        submesh='' if submesh is None else child_value(submesh, 'name'),
        mesh_scale=numbers_of_child(shape, 'scale', (1.0, 1.0, 1.0)),
        rgba=_color(xml),
        opacity=1.0 - transparency if 0.0 < transparency <= 1.0 else 1.0)


def _color(xml: XmlElement) -> tuple[float, float, float, float] | None:
    material = first_child(xml, 'material')
    if material is None:
        return None
    for tag in ('diffuse', 'ambient'):
        numbers = numbers_from_text(child_value(material, tag), ValueType.COLOR)
        if len(numbers) >= 3 and all(map(math.isfinite, numbers)):
            red, green, blue, alpha = (*numbers, 1.0)[:4]
            return red, green, blue, alpha
    return None


def check_submesh(xml: XmlElement, sources: Sources) -> None:
    """Check that a part of a mesh has a name."""
    if child_value(xml, 'name', '__default__') == '__default__':
        sources.error(ElementMissingError, xml, 'the <submesh> has no <name>')


def check_material(xml: XmlElement, sources: Sources) -> None:
    """Check that the script and the shader of a material have what they need."""
    script, shader = first_child(xml, 'script'), first_child(xml, 'shader')
    if script is not None:
        for tag, error in (('uri', ElementInvalidError), ('name', ElementMissingError)):
            value = child_value(script, tag, '__default__')
            if value == '__default__' or (tag == 'uri' and not value):
                msg = f'the <script> of a material has no <{tag}>, or an empty one'
                sources.error(error, script, msg)
    if shader is not None and first_child(shader, 'normal_map') is None:
        shader_type = attribute_of(shader, 'type')
        if shader_type.startswith('normal_map'):
            msg = f'a shader of type="{shader_type}" needs a <normal_map>'
            sources.error(ElementMissingError, shader, msg)


def collision_masses(inertial: XmlElement, sources: Sources) -> tuple[CollisionMass, ...] | None:
    """
    Return the masses of the collisions of a link, if its inertial is automatic.

    :param inertial: an ``<inertial>`` in its link.
    :return: the mass of each collision in file order; None if the inertial is not automatic, or
        if no mass, or not each, can be computed.
    """
    if not boolean_from_text(inertial.get('auto', '')):
        return None
    link = inertial.getparent()
    collisions = [] if link is None else list(child_elements(link, 'collision'))
    if not collisions:
        msg = 'the inertial is automatic, but its link has no <collision>'
        sources.error(ElementMissingError, inertial, msg)
    pose = first_child(inertial, 'pose')
    if pose is not None:
        msg = 'the pose of an automatic inertial is ignored; the collisions give it'
        sources.warning(pose, msg)
    (default_density,) = numbers_of_child(inertial, 'density', (DEFAULT_DENSITY_KG_M3,))
    masses = []
    for collision in collisions:
        shape = shape_of(collision)
        if shape is not None and shape.type == 'mesh':
            name = '' if link is None else attribute_of(link, 'name')
            msg = (f'the automatic inertial of link "{name}" has its pose as written, as the mass '
                   'of a mesh is not computed')
            sources.warning(collision, msg)
            return None
        # An empty density is the default of the element, and not that of the inertial.
        has_density = first_child(collision, 'density') is not None
        (density,) = numbers_of_child(collision, 'density', (DEFAULT_DENSITY_KG_M3,))
        mass = None if shape is None else _mass(
            shape, density if has_density else default_density)
        if mass is None:
            msg = ('an automatic inertial needs collisions that are boxes, capsules, cones, '
                   'cylinders, ellipsoids or spheres, with positive dimensions and density')
            sources.error(LinkInertiaError, collision, msg)
        else:
            masses.append(mass)
    return tuple(masses) or None


def _mass(shape: Shape, density_kg_m3: float) -> CollisionMass | None:
    """Return the mass of a shape and its center; None if a number is not positive."""
    if shape.type == 'plane' or not shape.sizes_m or (
            min(density_kg_m3, *shape.required_sizes_m) <= 0.0):
        return None
    volume_m3, center_z_m = _volume(shape)
    return CollisionMass(density_kg_m3 * volume_m3, center_z_m)


def _volume(shape: Shape) -> tuple[float, float]:
    """Return the volume of a shape, and the z of its center of mass in the shape's frame."""
    if shape.type == 'box':
        return math.prod(shape.sizes_m), 0.0
    if shape.type == 'ellipsoid':
        return 4.0 / 3.0 * math.pi * math.prod(shape.sizes_m), 0.0
    radius, length = (*shape.sizes_m, 0.0)[:2]
    disc = math.pi * radius ** 2
    if shape.type == 'sphere':
        return 4.0 / 3.0 * disc * radius, 0.0
    if shape.type == 'capsule':
        return disc * (max(length, 0.0) + 4.0 / 3.0 * radius), 0.0
    if shape.type == 'cone':
        return disc * length / 3.0, -0.25 * length
    return disc * length, 0.0


def triangles_from_shape(shape: Shape) -> tuple[Floats, NDArray[np.int64]]:
    """
    Make the surface of a cone or a plane; libraries for drawing do not have them as SDFormat does.

    :param shape: the shape, which has an extent.
    :return: points in the frame of the shape, shape (n, 3), x y z in metres; and for each triangle
        the indices of its corners, shape (m, 3), counterclockwise from outside.
    """
    first_m, second_m = shape.sizes_m
    if shape.type == 'cone':
        return _cone(first_m, second_m)
    return _plane(first_m, second_m, shape.normal)


def _cone(radius: float, length: float) -> tuple[Floats, NDArray[np.int64]]:
    angles = np.linspace(0.0, 2.0 * np.pi, _SEGMENTS_OF_CONE, endpoint=False)
    ends = np.array([(0.0, 0.0, 0.5 * length), (0.0, 0.0, -0.5 * length)])
    circle = ends[1] + radius * np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1)
    first = np.arange(len(circle))
    second, top, middle = np.roll(first, -1), 0 * first + len(circle), 0 * first + len(circle) + 1
    return np.concatenate([circle, ends]), np.concatenate([
        np.stack([first, second, top], axis=1), np.stack([second, first, middle], axis=1)])


def _plane(
    x: float, y: float, normal: tuple[float, ...],
) -> tuple[Floats, NDArray[np.int64]]:
    """Make a rectangle whose z is rotated to a normal by the shortest way, as libsdformat does."""
    corners = 0.5 * np.array([(-x, -y, 0.0), (x, -y, 0.0), (x, y, 0.0), (-x, y, 0.0)])
    nx, ny, nz = np.array(normal) / np.linalg.norm(normal)
    # Half a turn has no shortest way.
    rotation = (1.0, 0.0, 0.0, 0.0) if nz < -1.0 + 1e-9 else (-ny, nx, 0.0, 1.0 + nz)
    quat_xyzw = np.array(rotation) / np.linalg.norm(rotation)
    points = corners @ np.array(matrix_from_quaternion(quat_xyzw)).T
    return points, np.array([(0, 1, 2), (0, 2, 3)])
