# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Write a model of a scene as URDF (https://wiki.ros.org/urdf/XML)."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Sequence
import os
from typing import NamedTuple, TypeAlias

from lxml import etree

from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.export.urdf_robot import NO_LIMIT, robot_from_scene, UrdfJoint, UrdfRobot
from sdf_pose_bridge.geometry.poses import Pose, pose_product
from sdf_pose_bridge.geometry.rotations import rpy_from_quaternion
from sdf_pose_bridge.printed_text import printable, shortened
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.include.uris import resource_finder
from sdf_pose_bridge.sdformat.inertials import MOMENTS
from sdf_pose_bridge.sdformat.shape_types import Part, Primitive
from sdf_pose_bridge.sdformat.shapes import Shape
from sdf_pose_bridge.sdformat.urdf.values import text_from_numbers
from sdf_pose_bridge.tf.frame_ids import FrameNames
from sdf_pose_bridge.tf.tree import DEFAULT_KINDS, TfOptions

_DIGITS = 15
"""Number of digits, and of decimals of poses, so that rounding errors are not written."""


class Urdf(NamedTuple):
    """A robot as URDF."""

    text: str
    warnings: tuple[SdfWarning, ...]
    """Features of the model that URDF does not have."""

    def __str__(self) -> str:
        return self.text


_Geometry: TypeAlias = tuple[str, dict[str, str], float]
"""The tag and the attributes of a shape in URDF, and its position on the z axis of the shape that
it is part of."""


def urdf_from_scene(
    scene: Scene,
    *,
    model: str = '',
    kinds: Collection[Kind] | None = None,
    frame_names: FrameNames | str = FrameNames.AUTO,
    frame_separator: str = '/',
    optical_frames: bool = True,
    root_frame: str = 'world',
    resource_paths: Iterable[str | os.PathLike[str]] = (),
    has_capsules: bool = False,
) -> Urdf:
    """
    Write a model as URDF, whose links are the frames of the model in TF.

    At every position of the joints, the pose of each link equals the pose of its frame in TF.

    :param scene: the scene, loaded with ``shapes=True``.
    :param model: scoped name of the model; may be empty if there is only one.
    :param kinds: the kinds of element that become links: models, links, frames and sensors
        unless others are given. Links do in any case.
    :param frame_names: rule for the names of links and joints: ``auto``, ``scoped`` or
        ``relative``.
    :param frame_separator: replaces ``::`` in names of links.
    :param optical_frames: whether each camera gets an optical frame besides its own.
    :param root_frame: the name of the first link of a model that is fixed in the world.
    :param resource_paths: directories in which meshes are searched, as for ``load``.
    :param has_capsules: whether to write ``<capsule>``, which needs a reader of URDF 1.2, instead
        of a cylinder and two spheres.
    :raises SdfError: if the file is URDF, if there is no such model, or none is named where there
        are several, or if its frames cannot have these names.
    :raises ValueError: if the scene was loaded without shapes.
    """
    if not scene.has_shapes:
        msg = 'the scene has no shapes; load it with shapes=True'
        raise ValueError(msg)
    robot = robot_from_scene(scene, TfOptions(
        root_frame=root_frame, model=model, frame_names=FrameNames(frame_names),
        frame_separator=frame_separator, optical_frames=optical_frames,
        kinds=DEFAULT_KINDS if kinds is None else frozenset(kinds)))
    return UrdfWriter(scene, robot, resource_paths, has_capsules=has_capsules).urdf()


class UrdfWriter:
    """Writes a robot of a scene, as :func:`urdf_from_scene`."""

    def __init__(
        self, scene: Scene, robot: UrdfRobot, resource_paths: Iterable[str | os.PathLike[str]],
        *, has_capsules: bool = False,
    ) -> None:
        self._scene = scene
        self._robot = robot
        self._finder = resource_finder(resource_paths)
        self._has_capsules = has_capsules
        self._problems = Problems(scene.files)
        self._parts: defaultdict[int, list[int]] = defaultdict(list)
        """The inertial, visuals and collisions of each link."""
        for element in sorted({*scene.shapes, *scene.inertials}):
            self._parts[scene.parents.item(element)].append(element)
        self._root = etree.Element('robot', name=robot.name)
        if has_capsules:
            self._root.set('version', '1.2')

    def urdf(self) -> Urdf:
        """Write the robot."""
        scene, robot = self._scene, self._robot
        self._add_comment(
            f'Made by sdf_pose urdf from {printable(scene.path)}. Change that file instead.')
        file = scene.path
        for link in robot.links:
            if link.element >= 0 and scene.place(link.element).file != file:
                file = scene.place(link.element).file
                self._add_comment(f'From {file}')
            self._add_link(link.name, link.element)
            if link.joint is not None:
                self._add_joint(link.joint, link.name)
        etree.indent(self._root)
        text = etree.tostring(self._root, encoding='unicode')
        texts = [
            f'{each}\n' for model in sorted(robot.elements & scene.urdf_texts.keys())
            for each in scene.urdf_texts[model]]
        end = '</robot>'
        return Urdf(
            f'<?xml version="1.0"?>\n{text.removesuffix(end)}{"".join(texts)}{end}\n',
            (*robot.warnings, *self._problems.warnings))

    def _add_comment(self, text: str) -> None:
        # XML allows no two hyphens in a row, nor one at the end, in a comment.
        self._root.append(etree.Comment(f' {text.replace("--", "- -")} '))

    def _leave_out(self, element: int, reason: str) -> None:
        kind, name = Kind(self._scene.kinds[element]).label, self._scene.names[element]
        self._problems.warning(
            f'the {kind} "{name}" is left out: {reason}', self._scene.place(element))

    # Joints

    def _add_joint(self, joint: UrdfJoint, child: str) -> None:
        xml = etree.SubElement(self._root, 'joint', name=joint.name, type=joint.type)
        _add_origin(xml, joint.origin)
        etree.SubElement(xml, 'parent', link=joint.parent)
        etree.SubElement(xml, 'child', link=child)
        axis = joint.axis
        if axis is None:
            return
        etree.SubElement(xml, 'axis', xyz=_numbers(_rounded(axis.xyz)))
        limits = {} if joint.type == 'continuous' else {'lower': axis.lower, 'upper': axis.upper}
        if limits or min(axis.effort, axis.velocity) < NO_LIMIT:
            limits |= {'effort': axis.effort, 'velocity': axis.velocity}
            etree.SubElement(xml, 'limit', {
                name: _numbers([max(-NO_LIMIT, min(limit, NO_LIMIT))])
                for name, limit in limits.items()})
        if axis.damping or axis.friction:
            etree.SubElement(
                xml, 'dynamics', damping=_numbers([axis.damping]),
                friction=_numbers([axis.friction]))
        if axis.mimic is not None:
            etree.SubElement(
                xml, 'mimic', joint=axis.mimic.leader.name,
                multiplier=_numbers([axis.mimic.multiplier]),
                offset=_numbers([axis.mimic.offset]))

    # Links

    def _add_link(self, name: str, element: int) -> None:
        xml = etree.SubElement(self._root, 'link', name=name)
        for part in self._parts[element]:
            pose = self._scene.relative_pose_of(part, element)
            if part in self._scene.inertials:
                self._add_inertial(xml, part, pose)
            else:
                self._add_shape(xml, part, pose)

    def _add_inertial(self, link: etree._Element, element: int, pose: Pose) -> None:
        inertial = self._scene.inertials[element]
        if not inertial.is_valid:
            self._leave_out(element, 'no body can have its moments')
            return
        xml = etree.SubElement(link, 'inertial')
        _add_origin(xml, pose)
        etree.SubElement(xml, 'mass', value=_numbers([inertial.mass_kg]))
        # In the order that is usual in URDF.
        moments = zip(MOMENTS, inertial.moments_kg_m2, strict=True)
        etree.SubElement(xml, 'inertia', {
            name: _numbers([moment]) for name, moment in sorted(moments)})

    def _add_shape(self, link: etree._Element, element: int, pose: Pose) -> None:
        kind = Kind(self._scene.kinds[element]).label
        shape = self._scene.shapes[element]
        geometries = self._geometries(shape, element)
        if isinstance(geometries, str):
            self._leave_out(element, geometries)
            return
        name = self._scene.own_name(element)
        for number, (tag, attributes, z_m) in enumerate(geometries):
            xml = etree.SubElement(link, kind, name=f'{name}_{number}' if number else name)
            _add_origin(xml, pose_product(pose, Pose(z=z_m)) if z_m else pose)
            etree.SubElement(etree.SubElement(xml, 'geometry'), tag, attributes)
            if kind == Kind.VISUAL.label and shape.drawn_rgba is not None:
                text = _numbers(shape.drawn_rgba)
                material = etree.SubElement(xml, 'material', name=f'rgba_{text.replace(" ", "_")}')
                etree.SubElement(material, 'color', rgba=text)

    def _geometries(self, shape: Shape, element: int) -> list[_Geometry] | str:
        """Return a shape in URDF, or the reason why URDF does not have it."""
        if shape.type == 'mesh':
            return self._mesh(shape, element)
        if shape.reason_without_surface:
            return shape.reason_without_surface
        if shape.type == 'capsule' and self._has_capsules and len(shape.parts) > 1:
            radius, length = shape.sizes_m
            return [('capsule', {'radius': _numbers([radius]), 'length': _numbers([length])}, 0.0)]
        found = [each for part in shape.parts for each in _geometry_from_part(part)]
        return found or f'URDF has no {shape.type}'

    def _mesh(self, shape: Shape, element: int) -> list[_Geometry] | str:
        uri = self._finder.uri_for_others(shape.mesh_uri, self._scene.place(element).file)
        if uri is None:
            return f'the mesh "{shortened(shape.mesh_uri)}" is not found'
        if shape.submesh:
            self._problems.warning(
                f'all of the mesh "{shortened(shape.mesh_uri)}" is meant in URDF instead of its '
                f'part "{shortened(shape.submesh)}", because URDF cannot name a part',
                self._scene.place(element))
        has_scale = shape.mesh_scale != (1.0, 1.0, 1.0)
        scale = {'scale': _numbers(shape.mesh_scale)} if has_scale else {}
        return [('mesh', {'filename': uri, **scale}, 0.0)]


def _geometry_from_part(part: Part) -> list[_Geometry]:
    """Return a body in URDF; nothing for an ellipsoid that is no sphere."""
    x_m, y_m, z_m = part.extent_m
    radius = {'radius': _numbers([0.5 * x_m])}
    if part.primitive is Primitive.BOX:
        return [('box', {'size': _numbers(part.extent_m)}, part.z_m)]
    if part.primitive is Primitive.CYLINDER:
        return [('cylinder', {**radius, 'length': _numbers([z_m])}, part.z_m)]
    return [('sphere', radius, part.z_m)] if x_m == y_m == z_m else []


def _add_origin(xml: etree._Element, pose: Pose) -> None:
    """Add the pose of an element, unless it is the identity."""
    numbers = _rounded((*pose[:3], *rpy_from_quaternion(pose[3:])))
    if any(numbers):
        etree.SubElement(xml, 'origin', xyz=_numbers(numbers[:3]), rpy=_numbers(numbers[3:]))


def _rounded(numbers: Sequence[float]) -> list[float]:
    # Adding zero removes negative zeros.
    return [round(number, _DIGITS) + 0.0 for number in numbers]


def _numbers(numbers: Sequence[float]) -> str:
    return text_from_numbers(numbers, _DIGITS)
