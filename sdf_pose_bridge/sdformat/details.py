# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Read what only some elements have besides a name and a pose.

An automatic inertial (``<inertial auto="true">``) is the center of mass of the collisions of its
link: ``Link::ResolveAutoInertials``, ``Collision::CalculateInertial`` and
``Geometry::CalculateInertial`` of libsdformat 14.
"""

from __future__ import annotations

from itertools import chain
import math

from sdf_pose_bridge.errors import AttributeInvalidError
from sdf_pose_bridge.errors import ElementInvalidError
from sdf_pose_bridge.errors import ElementMissingError
from sdf_pose_bridge.errors import LinkInertiaError
from sdf_pose_bridge.names import ROOT_FRAME
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.sdformat.elements import CollisionMass
from sdf_pose_bridge.sdformat.elements import FrameDetails
from sdf_pose_bridge.sdformat.elements import ModelDetails
from sdf_pose_bridge.sdformat.elements import SensorDetails
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.shapes import Shape
from sdf_pose_bridge.sdformat.shapes import shape_of
from sdf_pose_bridge.sdformat.sources import Sources
from sdf_pose_bridge.sdformat.values import boolean_from_text
from sdf_pose_bridge.sdformat.values import numbers_of_child
from sdf_pose_bridge.sdformat.xml_tree import attribute_of
from sdf_pose_bridge.sdformat.xml_tree import child_elements
from sdf_pose_bridge.sdformat.xml_tree import first_child
from sdf_pose_bridge.sdformat.xml_tree import value_of
from sdf_pose_bridge.sdformat.xml_tree import XmlElement

CAMERA_TYPES = frozenset({
    'boundingbox', 'boundingbox_camera', 'camera', 'depth', 'depth_camera', 'multicamera', 'rgbd',
    'rgbd_camera', 'segmentation', 'segmentation_camera', 'thermal', 'thermal_camera',
    'wide_angle_camera', 'wideanglecamera',
})
"""Types of sensors that take images."""

TYPES = {
    Kind.JOINT: frozenset({
        'ball', 'continuous', 'fixed', 'gearbox', 'prismatic', 'revolute', 'revolute2', 'screw',
        'universal'}),
    Kind.LIGHT: frozenset({'directional', 'point', 'spot'}),
    Kind.PARTICLE_EMITTER: frozenset({'box', 'cylinder', 'ellipsoid', 'point'}),
    Kind.SENSOR: CAMERA_TYPES | {
        'air_pressure', 'air_speed', 'altimeter', 'contact', 'custom', 'force_torque', 'gps',
        'gpu_lidar', 'gpu_ray', 'imu', 'lidar', 'logical_camera', 'magnetometer', 'navsat', 'ray',
        'rfid', 'rfidtag', 'sonar', 'wireless_receiver', 'wireless_transmitter'},
}
"""The types that elements of a kind can have."""

PLACEMENT_OF_MERGED_MODEL = '{sdf_pose_bridge}placement_frame'
"""Attribute of the frame that replaces a merged model's frame: the model's placement frame."""

_OTHER_TYPES = {
    'atmosphere': ('adiabatic',),
    'shader': ('normal_map_object_space', 'normal_map_tangent_space', 'pixel', 'vertex'),
}
"""The types that elements without a frame can have."""

_VALUES = {
    'surface_model': ('EARTH_WGS84', 'MOON_SCS', 'CUSTOM_SURFACE'),
    'world_frame_orientation': ('ENU',),
}
"""The values of elements in ``<spherical_coordinates>``."""


def reference_of(xml: XmlElement, attribute: str) -> str:
    """
    Return the frame that an attribute names.

    :param xml: an element.
    :param attribute: name of the attribute.
    :return: the name; empty if there is none, and for the implicit root, which is an error that
        the check of attributes reports.
    """
    name = attribute_of(xml, attribute)
    return '' if name == ROOT_FRAME else name


class DetailsReader:
    """
    Reads what only some kinds of elements have.

    :param sources: where elements were written.
    :param problems: takes what is wrong.
    """

    def __init__(self, sources: Sources, problems: Problems) -> None:
        self._sources = sources
        self._problems = problems

    def check_type(self, xml: XmlElement, kind: Kind) -> None:
        """
        Check the type of an element.

        :param xml: the element.
        :param kind: its kind, a key of :data:`TYPES`.
        """
        written_type = attribute_of(xml, 'type')
        # Only for joints libsdformat does not mind the case.
        known_type = written_type.lower() if kind is Kind.JOINT else written_type
        if known_type and known_type not in TYPES[kind]:
            msg = (f'type="{written_type}" of <{kind.label}> must be one of '
                   f'{", ".join(sorted(TYPES[kind]))}')
            self._problems.error(AttributeInvalidError(msg, self._sources.place(xml)))

    def model(self, xml: XmlElement) -> ModelDetails:
        """
        Read a model.

        :param xml: a ``<model>``.
        :return: its details.
        """
        static = first_child(xml, 'static')
        return ModelDetails(
            static is not None and bool(boolean_from_text(value_of(static))),
            reference_of(xml, 'canonical_link'), reference_of(xml, 'placement_frame'))

    def frame(self, xml: XmlElement) -> FrameDetails:
        """
        Read an explicit frame.

        :param xml: a ``<frame>``.
        :return: its details.
        """
        return FrameDetails(
            reference_of(xml, 'attached_to'), xml.get(PLACEMENT_OF_MERGED_MODEL, ''))

    def sensor(self, xml: XmlElement) -> SensorDetails:
        """
        Read a sensor.

        :param xml: a ``<sensor>``.
        :return: its details.
        """
        frame_ids = chain(
            child_elements(xml, 'gz_frame_id'), child_elements(xml, 'ignition_frame_id'))
        camera = first_child(xml, 'camera')
        optical = None if camera is None else first_child(camera, 'optical_frame_id')
        sensor_type = attribute_of(xml, 'type')
        return SensorDetails(
            sensor_type, next(filter(None, map(value_of, frame_ids)), ''),
            camera is not None or sensor_type in CAMERA_TYPES,
            '' if optical is None else value_of(optical))

    def missing_include(self, xml: XmlElement) -> tuple[str, str]:
        """
        Read what is missing where an include was not found or is not valid.

        :param xml: an ``<include>``.
        :return: the name that the included model would have, as far as it can be known, and the
            URI. The name is empty if any unknown name may come from the include.
        """
        uri = first_child(xml, 'uri')
        uri_value = ('' if uri is None else value_of(uri)) or 'no URI'
        if boolean_from_text(xml.get('merge', 'false')) is not False:
            # What is merged has names of its own.
            return '', uri_value
        name = first_child(xml, 'name')
        if name is not None and value_of(name):
            return value_of(name), uri_value
        # Where the include is an error, nothing is lost by what its file may be called.
        return '' if self._problems.errors else _name_from_uri(uri_value), uri_value

    def check_content(self, xml: XmlElement, identifier: str) -> None:
        """
        Check what only some elements must hold (``Material::Load``).

        :param xml: an element without a frame.
        :param identifier: the identifier of its definition.
        """
        if identifier == 'material/script':
            for tag, error in (('uri', ElementInvalidError), ('name', ElementMissingError)):
                element = first_child(xml, tag)
                value = '__default__' if element is None else value_of(element)
                if value == '__default__' or (tag == 'uri' and not value):
                    msg = f'the <script> of a material has no <{tag}>, or an empty one'
                    self._problems.error(error(msg, self._sources.place(xml)))
        elif identifier == 'spherical_coordinates':
            for tag, values in _VALUES.items():
                element = first_child(xml, tag)
                if element is not None and value_of(element) not in ('', *values):
                    msg = f'"{value_of(element)}" of <{tag}> must be one of {", ".join(values)}'
                    self._problems.error(ElementInvalidError(msg, self._sources.place(element)))
        elif identifier in _OTHER_TYPES:
            written_type = attribute_of(xml, 'type')
            if written_type and written_type not in _OTHER_TYPES[identifier]:
                msg = (f'type="{written_type}" of <{identifier}> must be one of '
                       f'{", ".join(_OTHER_TYPES[identifier])}')
                self._problems.error(ElementInvalidError(msg, self._sources.place(xml)))
            elif written_type.startswith('normal_map') and first_child(xml, 'normal_map') is None:
                msg = f'a shader of type="{written_type}" needs a <normal_map>'
                self._problems.error(ElementMissingError(msg, self._sources.place(xml)))


def _name_from_uri(uri: str) -> str:
    """Return the likely name of a model that was not found: that of its directory."""
    steps = [part for part in uri.split('/') if part]
    if len(steps) > 1 and steps[-1].endswith(('.sdf', '.world', '.urdf')):
        steps.pop()
    return steps[-1] if steps else ''


DEFAULT_DENSITY_KG_M3 = 1000.0
"""Density of a collision where neither it nor the inertial has one: that of water."""


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
    (default_density,) = numbers_of_child(inertial, 'density', (DEFAULT_DENSITY_KG_M3,))
    masses = []
    for collision in collisions:
        shape = shape_of(collision)
        if shape is not None and shape.type == 'mesh':
            name = '' if link is None else attribute_of(link, 'name')
            msg = (f'the automatic inertial of link "{name}" has its pose as written, as the mass '
                   'of a mesh is not computed')
            problems.warning(msg, sources.place(collision))
            return ()
        mass = None if shape is None else _mass(
            shape, *numbers_of_child(collision, 'density', (default_density,)))
        if mass is None:
            msg = ('an automatic inertial needs collisions that are boxes, capsules, cones, '
                   'cylinders, ellipsoids or spheres, with positive dimensions and density')
            problems.error(LinkInertiaError(msg, sources.place(collision)))
        else:
            masses.append(mass)
    return tuple(masses)


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
