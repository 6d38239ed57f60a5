# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read ``<inertial auto="true">``: its centre of mass follows from the collisions of its link.

Rules: ``Link::ResolveAutoInertials``, ``Collision::CalculateInertial`` and
``Geometry::CalculateInertial`` of libsdformat 14.
"""

from __future__ import annotations

from collections.abc import Mapping
import math

from sdf_pose_bridge.errors import ElementMissingError
from sdf_pose_bridge.errors import LinkInertiaError
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.sdformat.elements import CollisionMass
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.values import leading_numbers
from sdf_pose_bridge.sdformat.xml_tree import attribute_of
from sdf_pose_bridge.sdformat.xml_tree import child_elements
from sdf_pose_bridge.sdformat.xml_tree import first_child
from sdf_pose_bridge.sdformat.xml_tree import text_of
from sdf_pose_bridge.sdformat.xml_tree import XmlElement

DEFAULT_DENSITY_KG_M3 = 1000.0
"""Density of a collision where neither it nor the inertial has one: that of water."""

_DEFAULT_DIMENSIONS: Mapping[str, Mapping[str, tuple[float, ...]]] = {
    'box': {'size': (1.0, 1.0, 1.0)},
    'capsule': {'radius': (0.5,), 'length': (1.0,)},
    'cone': {'radius': (1.0,), 'length': (1.0,)},
    'cylinder': {'radius': (1.0,), 'length': (1.0,)},
    'ellipsoid': {'radii': (1.0, 1.0, 1.0)},
    'plane': {},
    'sphere': {'radius': (1.0,)},
    'mesh': {},
}
"""The shapes in the order in which the first one counts, and the defaults of their dimensions."""


def collision_masses(
    inertial: XmlElement, sources: Sources, problems: Problems,
) -> tuple[CollisionMass, ...]:
    """
    Return the masses of the collisions of a link.

    :param inertial: an ``<inertial auto="true">`` in its link.
    :param sources: where elements were written.
    :param problems: takes collisions whose mass cannot be computed.
    :return: the mass of each collision in file order; empty if one cannot be computed.
    """
    link = inertial.getparent()
    collisions = [] if link is None else list(child_elements(link, 'collision'))
    if not collisions:
        msg = 'the inertial is automatic, but its link has no <collision>'
        problems.error(ElementMissingError(msg, sources.place(inertial)))
    pose = first_child(inertial, 'pose')
    if pose is not None:
        msg = 'the pose of an automatic inertial is ignored; the collisions give it'
        problems.warning(msg, sources.place(pose))
    default_density = _number(inertial, 'density', DEFAULT_DENSITY_KG_M3)
    masses = []
    for collision in collisions:
        shape = _shape(collision)
        if shape is not None and shape.tag == 'mesh':
            name = '' if link is None else attribute_of(link, 'name')
            msg = (f'the automatic inertial of link "{name}" has its pose as written, as the mass '
                   'of a mesh is not computed')
            problems.warning(msg, sources.place(collision))
            return ()
        mass = None if shape is None else _mass(
            shape, _number(collision, 'density', default_density))
        if mass is None:
            msg = ('an automatic inertial needs collisions that are boxes, capsules, cones, '
                   'cylinders, ellipsoids or spheres, with positive dimensions and density')
            problems.error(LinkInertiaError(msg, sources.place(collision)))
        else:
            masses.append(mass)
    return tuple(masses)


def _shape(collision: XmlElement) -> XmlElement | None:
    geometry = first_child(collision, 'geometry')
    if geometry is None:
        return None
    shapes = (first_child(geometry, tag) for tag in _DEFAULT_DIMENSIONS)
    return next((shape for shape in shapes if shape is not None), None)


def _mass(shape: XmlElement, density_kg_m3: float) -> CollisionMass | None:
    """Return the mass of a shape and its centre; None if a number is not positive."""
    sizes_m = [
        number for tag, default in _DEFAULT_DIMENSIONS[str(shape.tag)].items()
        for number in _numbers(shape, tag, default)]
    # A capsule without its cylinder is a sphere.
    required = sizes_m[:1] if shape.tag == 'capsule' else sizes_m
    if not sizes_m or min([density_kg_m3, *required]) <= 0.0:
        return None
    volume_m3, center_z_m = _volume(str(shape.tag), sizes_m)
    return CollisionMass(density_kg_m3 * volume_m3, center_z_m)


def _volume(tag: str, sizes_m: list[float]) -> tuple[float, float]:
    """Return the volume of a shape, and the z of its centre of mass in the shape's frame."""
    if tag == 'box':
        return math.prod(sizes_m), 0.0
    if tag == 'ellipsoid':
        return 4.0 / 3.0 * math.pi * math.prod(sizes_m), 0.0
    radius, length = (*sizes_m, 0.0)[:2]
    disc = math.pi * radius ** 2
    if tag == 'sphere':
        return 4.0 / 3.0 * disc * radius, 0.0
    if tag == 'capsule':
        return disc * (max(length, 0.0) + 4.0 / 3.0 * radius), 0.0
    if tag == 'cone':
        return disc * length / 3.0, -0.25 * length
    return disc * length, 0.0


def _number(parent: XmlElement, tag: str, default: float) -> float:
    return _numbers(parent, tag, (default,))[0]


def _numbers(parent: XmlElement, tag: str, default: tuple[float, ...]) -> tuple[float, ...]:
    """Return the numbers of a child; the default if there is none, or if it is not valid."""
    child = first_child(parent, tag)
    numbers = () if child is None else tuple(leading_numbers(text_of(child), len(default)))
    return numbers if len(numbers) == len(default) else default
