# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read automatic inertials (``<inertial auto="true">``).

Such an inertial is at the center of mass of the collisions of its link. Source:
``Link::ResolveAutoInertials``, ``Collision::CalculateInertial`` and
``Geometry::CalculateInertial`` of libsdformat 14.
"""

from __future__ import annotations

from typing import NamedTuple

from sdf_pose_bridge.errors import ElementMissingError
from sdf_pose_bridge.errors import LinkInertiaError
from sdf_pose_bridge.sdformat.shape_types import SHAPE_TYPES
from sdf_pose_bridge.sdformat.shapes import shape_of
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.values import boolean_from_text
from sdf_pose_bridge.sdformat.values import numbers_of_child
from sdf_pose_bridge.sdformat.xml_tree import attribute_of
from sdf_pose_bridge.sdformat.xml_tree import child_elements
from sdf_pose_bridge.sdformat.xml_tree import first_child
from sdf_pose_bridge.sdformat.xml_tree import XmlElement

DEFAULT_DENSITY_KG_M3 = 1000.0
"""Density of a collision where neither it nor the inertial has one: that of water."""


class CollisionMass(NamedTuple):
    """The mass of a collision that an automatic inertial is computed from."""

    mass_kg: float
    center_z_m: float
    """The z of the center of mass in the frame of the collision; its x and y are 0."""


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
        solid = None if shape is None else shape.solid
        density_kg_m3 = density if has_density else default_density
        if solid is None or density_kg_m3 <= 0.0:
            types = [name for name, each in SHAPE_TYPES.items() if each.solid is not None]
            msg = (f'an automatic inertial needs collisions of the types {", ".join(types)}, with '
                   'positive dimensions and density')
            sources.error(LinkInertiaError, collision, msg)
        else:
            masses.append(CollisionMass(density_kg_m3 * solid.volume_m3, solid.center_z_m))
    return tuple(masses) or None
