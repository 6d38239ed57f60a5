# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read masses and moments of inertia, which no pose depends on unless they are automatic.

An automatic inertial (``<inertial auto="true">``) is at the center of mass of the collisions of
its link. Source: ``Link::Load``, ``Link::ResolveAutoInertials``, ``Collision::CalculateInertial``
and ``Geometry::CalculateInertial`` of libsdformat 14, and ``MassMatrix3`` of gz-math 7.
"""

from __future__ import annotations

from collections.abc import Sequence
import math
import sys
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.errors import ElementMissingError, LinkInertiaError
from sdf_pose_bridge.geometry.pose_attributes import boolean_from_text
from sdf_pose_bridge.geometry.rotations import Floats
from sdf_pose_bridge.sdformat.shape_types import SHAPE_TYPES, Solid
from sdf_pose_bridge.sdformat.shapes import shape_of
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.values import number_of_child
from sdf_pose_bridge.sdformat.xml_tree import attribute_of, child_elements, first_child, XmlElement

DEFAULT_DENSITY_KG_M3 = 1000.0
"""Default density of a collision: water."""

MOMENTS = ('ixx', 'iyy', 'izz', 'ixy', 'ixz', 'iyz')
"""The tags of the moments of an :class:`Inertial`, in their order."""

_MAY_BE_MASSLESS = ('capsule', 'ellipsoid')
"""Shapes that libsdformat also accepts with the density 0."""

_TOLERANCE = 10.0 * sys.float_info.epsilon
"""Tolerance of gz-math for rules of moments, relative to half their sum."""


class Inertial(NamedTuple):
    """A mass; its center is the frame of the ``<inertial>``."""

    mass_kg: float
    moments_kg_m2: tuple[float, ...]
    """Those of :data:`MOMENTS` in that frame."""

    @property
    def is_valid(self) -> bool:
        """Whether libsdformat accepts it, as a body can have it (``MassMatrix3::IsValid``)."""
        if not all(map(math.isfinite, self.moments_kg_m2)):
            return False
        xx, yy, zz, xy, xz, yz = self.moments_kg_m2
        tolerance = _TOLERANCE * 0.5 * (xx + yy + zz)
        smallest, middle, largest = (
            np.linalg.eigvalsh(matrix_from_moments(self.moments_kg_m2)).tolist()
            if xy or xz or yz else sorted((xx, yy, zz)))
        # The rounding is that of gz-math (Matrix3::Determinant).
        determinant = (
            (zz * yy - yz * yz) * xx - (zz * xy - xz * yz) * xy + (yz * xy - xz * yy) * xz)
        return bool(
            self.mass_kg >= 0.0 and xx * yy - xy * xy + tolerance >= 0.0
            and determinant + tolerance >= 0.0 and smallest + middle + tolerance >= largest)


class AutomaticInertial(NamedTuple):
    """The collisions from which an automatic inertial is computed."""

    solids: tuple[Solid, ...]
    """The shapes of the collisions of its link, in file order."""
    masses_kg: tuple[float, ...]
    """The mass of each of them, by its density."""
    mass_kg: float | None
    """Their total mass, if the file has it."""


def matrix_from_moments(moments: Sequence[float]) -> Floats:
    """Make the matrix, shape (3, 3), of the moments of an :class:`Inertial`."""
    xx, yy, zz, xy, xz, yz = moments
    return np.array([(xx, xy, xz), (xy, yy, yz), (xz, yz, zz)])


def moments_from_matrix(matrix: Floats) -> tuple[float, ...]:
    """Return the moments of an :class:`Inertial` from their matrix, shape (3, 3)."""
    return tuple(matrix[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]].tolist())


def moved_moments(matrices: Floats, masses: Floats, offsets: Floats) -> Floats:
    """
    Return moments of inertia about other points, by Steiner's theorem.

    :param matrices: shape (n, 3, 3), the moments of each body about its own center of mass.
    :param masses: shape (n,), in kg.
    :param offsets: shape (n, 3), the center of each body from the other point, in the same axes.
    :return: shape (n, 3, 3). The sum for one point is as for one body.
    """
    squares = (offsets ** 2).sum(axis=1)[:, np.newaxis, np.newaxis] * np.eye(3)
    products = offsets[:, :, np.newaxis] * offsets[:, np.newaxis]
    moved: Floats = matrices + masses[:, np.newaxis, np.newaxis] * (squares - products)
    return moved


def inertial_from_element(
    xml: XmlElement, sources: Sources, *, reads_masses: bool,
) -> Inertial | AutomaticInertial | None:
    """
    Read an ``<inertial>`` in its link.

    :param sources: takes a warning about an inertial that libsdformat rejects; no pose depends on
        it.
    :param reads_masses: whether to read one that is not automatic.
    :return: the inertial; None if it is not read, or cannot be computed.
    """
    is_automatic = boolean_from_text(attribute_of(xml, 'auto'))
    if not (is_automatic or reads_masses):
        return None
    link = next(xml.iterancestors())
    if is_automatic:
        return _automatic_inertial(xml, link, sources)
    # By default the moments are those of the unit matrix, as in libsdformat.
    inertial = Inertial(number_of_child(xml, 'mass', 1.0), tuple(
        number_of_child(xml, f'inertia/{tag}', float(tag[1] == tag[2])) for tag in MOMENTS))
    if not inertial.is_valid:
        warn_of_inertial(xml, attribute_of(link, 'name'), sources)
    return inertial


def warn_of_inertial(
    xml: XmlElement, link: str, sources: Sources, *, is_for_gazebo: bool = False,
) -> None:
    """
    Add the warning about an inertial that is not valid.

    :param xml: its element.
    :param link: the name of its link.
    :param is_for_gazebo: as for :meth:`Sources.warning`.
    """
    sources.warning(
        xml, f'no body can have the mass and the moments of inertia of link "{link}"; '
        'libsdformat refuses them, but no pose depends on them', LinkInertiaError.code,
        is_for_gazebo=is_for_gazebo)


def _automatic_inertial(
    inertial: XmlElement, link: XmlElement, sources: Sources,
) -> AutomaticInertial | None:
    """Return the masses for an automatic inertial; None if one of them is not known."""
    outer = link.getparent()
    if outer is not None and outer.tag == 'actor':
        return None  # libsdformat computes none in an actor
    collisions = list(child_elements(link, 'collision'))
    if not collisions:
        msg = 'the inertial is automatic, but its link has no <collision>'
        sources.error(ElementMissingError, inertial, msg)
    pose = first_child(inertial, 'pose')
    if pose is not None:
        msg = 'the pose of an automatic inertial is ignored; the collisions give it'
        sources.warning(pose, msg)
    default_density = number_of_child(inertial, 'density', DEFAULT_DENSITY_KG_M3)
    solids, masses_kg = [], []
    for collision in collisions:
        shape = shape_of(collision)
        if shape is not None and shape.type == 'mesh':
            msg = (f'the automatic inertial of link "{attribute_of(link, "name")}" has its pose '
                   'as written, as the mass of a mesh is not computed')
            sources.warning(collision, msg)
            return None
        # An empty density means the default of the element, not the density of the inertial.
        density_kg_m3 = default_density if first_child(collision, 'density') is None else (
            number_of_child(collision, 'density', DEFAULT_DENSITY_KG_M3))
        solid = None if shape is None else shape.solid
        is_massless = density_kg_m3 == 0.0 and shape is not None and shape.type in _MAY_BE_MASSLESS
        if solid is None or not (density_kg_m3 > 0.0 or is_massless):
            types = [name for name, each in SHAPE_TYPES.items() if each.solid is not None]
            msg = (f'an automatic inertial needs collisions of the types {", ".join(types)}, with '
                   'positive dimensions and density')
            sources.error(LinkInertiaError, collision, msg)
        else:
            solids.append(solid)
            masses_kg.append(density_kg_m3 * solid.volume_m3)
    mass_kg = None if first_child(inertial, 'mass') is None else (
        number_of_child(inertial, 'mass', 1.0))
    return AutomaticInertial(tuple(solids), tuple(masses_kg), mass_kg)
