# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The table of the elements of a load that have a pose, with their references as written."""

from __future__ import annotations

from array import array
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from sdf_pose_bridge.errors import Place
from sdf_pose_bridge.geometry.chains import Indices
from sdf_pose_bridge.geometry.pose_attributes import PoseFormat
from sdf_pose_bridge.geometry.poses import Pose
from sdf_pose_bridge.geometry.units import FAR_M
from sdf_pose_bridge.problems import Problems
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.inertials import AutomaticInertial, Inertial
from sdf_pose_bridge.sdformat.joints import JointDetails
from sdf_pose_bridge.sdformat.plugins import Plugin, SensorDetails
from sdf_pose_bridge.sdformat.poses import pose_doubts, poses_from_numbers
from sdf_pose_bridge.sdformat.shapes import Shape
from sdf_pose_bridge.sdformat.xml_tree import path_step

NO_ELEMENT = -1
"""Index for no element."""

_MOST_PATHS_KNOWN = 1000


class ModelDetails(NamedTuple):
    """Details of a model."""

    is_static: bool
    canonical_link: str
    """Value of the attribute; empty for the default."""
    placement_frame: str
    """The frame that the pose places; empty for the model frame."""
    urdf_texts: tuple[str, ...]
    """The XML of elements of URDF in it."""


class FrameDetails(NamedTuple):
    """Details of an explicit frame."""

    attached_to: str
    """Value of the attribute; empty for the frame of its scope."""
    placement_frame: str = ''
    """The frame that the include of a merged model places, if this is the model's proxy; empty for
    this one."""


@dataclass(frozen=True, eq=False, repr=False)
class Elements:
    """
    All elements with a pose, each after its parent element, in the order of the file.

    Entry i of each sequence and array describes element i.
    """

    kinds: np.ndarray[Any, np.dtype[np.uint8]]
    """Values of :class:`~sdf_pose_bridge.sdformat.grammar.Kind`."""
    names: Sequence[str]
    """Their own names, without scopes."""
    parents: Indices
    """Their parent elements; -1 for a world and the implicit root."""
    scopes: Indices
    """The model, world or root whose names the references of each element use."""
    file_indices: Indices
    """Index of the file of each element in ``paths``."""
    lines: Indices
    pose_lines: Indices
    """The lines of their poses; 0 for an element without ``<pose>``."""
    poses: np.ndarray[Any, np.dtype[np.float64]]
    """Shape (n, 7): pose of each element in the frame that it is relative to, x y z in metres,
    unit quaternion x y z w; the identity for an element without ``<pose>``."""
    paths: Sequence[str]
    """The files of the load."""
    has_shapes: bool = False
    """Whether shapes were requested."""
    relative_to: Mapping[int, str] = field(default_factory=dict)
    """The frames that poses are relative to, where they are given."""
    models: Mapping[int, ModelDetails] = field(default_factory=dict)
    frames: Mapping[int, FrameDetails] = field(default_factory=dict)
    joints: Mapping[int, JointDetails] = field(default_factory=dict)
    sensors: Mapping[int, SensorDetails] = field(default_factory=dict)
    shapes: Mapping[int, Shape] = field(default_factory=dict)
    """The shapes of visuals and collisions; empty unless they were requested."""
    inertials: Mapping[int, Inertial | AutomaticInertial] = field(default_factory=dict)
    """Without automatic ones that cannot be computed."""
    plugins: Mapping[int, tuple[Plugin, ...]] = field(default_factory=dict)
    """The plugins of elements of any kind; empty unless they were requested."""
    includes: Mapping[int, Place] = field(default_factory=dict)
    """The place of the ``<include>`` of each included element."""
    missing_includes: Mapping[int, Mapping[str, str]] = field(default_factory=dict)
    """For each element with includes that were not found, their URIs by the names of the models.
    An empty name stands for any name: the include has no name, or is merged."""
    _known_paths: dict[int, str] = field(default_factory=dict, init=False, repr=False)
    """Paths of some elements, which :meth:`place` has made."""

    @cached_property
    def automatic_inertials(self) -> Mapping[int, AutomaticInertial]:
        """The inertials that are computed."""
        return {
            index: inertial for index, inertial in self.inertials.items()
            if isinstance(inertial, AutomaticInertial)}

    def kind(self, index: int) -> Kind:
        """Return the kind of an element."""
        return Kind(int(self.kinds[index]))

    def place(self, index: int, line: int = 0, part: str = '') -> Place:
        """
        Return the place of an element, or of a part of it.

        :param line: line of the part; 0 for the line of the element.
        :param part: path of the part in the element, such as ``pose``.
        :return: file, line and path.
        """
        path = self._element_path(index)
        return Place(
            self.paths[self.file_indices[index]], line or int(self.lines[index]),
            f'{path}/{part}' if part else path)

    def _element_path(self, index: int) -> str:
        if index < 0:
            return '/sdf'
        parent = int(self.parents[index])
        # One deeply nested element may have many errors.
        parent_path = self._known_paths.get(parent)
        if parent_path is None:
            parent_path = self._element_path(parent)
            if len(self._known_paths) == _MOST_PATHS_KNOWN:
                self._known_paths.clear()
            self._known_paths[parent] = parent_path
        kind = self.kind(index)
        if kind is Kind.ROOT:
            return parent_path
        name = '' if kind is Kind.INERTIAL else self.names[index]
        return f'{parent_path}/{path_step(kind.label, name)}'

    def is_static(self, index: int) -> bool:
        """Return whether an element is in a static model, or is one."""
        while index >= 0:
            if index in self.models and self.models[index].is_static:
                return True
            index = int(self.parents[index])
        return False

    def place_of_pose(self, index: int) -> Place:
        """Return the place of the pose of an element."""
        return self.place(index, int(self.pose_lines[index]), 'pose')


class ElementsBuilder:
    """The table while it grows."""

    def __init__(self, paths: Sequence[str], *, has_shapes: bool) -> None:
        self._has_shapes = has_shapes
        self.kinds = array('B')
        self.names: list[str] = []
        self.parents = array('i')
        self.file_indices = array('i')
        self.lines = array('i')
        self.pose_lines: dict[int, int] = {}
        """The lines of poses, by the indices of their elements."""
        self.details: defaultdict[str, dict[int, Any]] = defaultdict(dict)
        """Details of elements, by the fields of :class:`Elements`."""
        self._scopes = array('i')
        self._paths = paths
        self._poses: defaultdict[PoseFormat, tuple[array[int], list[str], list[float]]] = (
            defaultdict(lambda: (array('i'), [], [])))
        """Indices, texts and numbers of the poses in each format."""

    def add(
        self, kind: Kind, name: str, parent: int, scope: int, file_index: int, line: int,
    ) -> int:
        """Add an element; return its index."""
        index = len(self.names)
        self.kinds.append(kind)
        self.names.append(name)
        self.parents.append(parent)
        self._scopes.append(scope)
        self.file_indices.append(file_index)
        self.lines.append(line)
        return index

    def set_pose(
        self, index: int, text: str, numbers: Sequence[float], pose_format: PoseFormat, line: int,
    ) -> None:
        """
        Set the pose of an element.

        :param text: the pose as written.
        :param numbers: those of the text.
        :param line: its line; 0 for a pose that is in no file.
        """
        self.pose_lines[index] = line
        indices, texts, numbers_of_all = self._poses[pose_format]
        indices.append(index)
        texts.append(text)
        numbers_of_all += numbers

    def elements(self, problems: Problems) -> Elements:
        """Return the table; add warnings about poses that may be mistakes to the problems."""
        pose_lines = np.zeros(len(self.names), dtype=np.int32)
        pose_lines[list(self.pose_lines)] = list(self.pose_lines.values())
        table = Elements(
            kinds=np.array(self.kinds), names=self.names,
            parents=np.array(self.parents), scopes=np.array(self._scopes),
            file_indices=np.array(self.file_indices), lines=np.array(self.lines),
            pose_lines=pose_lines, poses=np.tile(Pose(), (len(self.names), 1)),
            paths=self._paths, has_shapes=self._has_shapes, **self.details)
        for pose_format, (indices, texts, numbers_of_all) in self._poses.items():
            numbers = np.fromiter(numbers_of_all, float).reshape(len(texts), -1)
            table.poses[indices] = poses_from_numbers(numbers, pose_format)
            for row, doubt in pose_doubts(texts, numbers, pose_format):
                problems.warning(doubt, table.place_of_pose(indices[row]))
        self._warn_of_millimetres(table, problems)
        return table

    def _warn_of_millimetres(self, table: Elements, problems: Problems) -> None:
        is_far = np.abs(table.poses[:, :3]).max(axis=1, initial=0.0) >= FAR_M
        if not is_far.any():
            return
        # Lights are often far away, and so are shapes as large as a sea, and parts of buildings.
        is_in_model = (
            (table.parents >= 0) & np.isin(table.kinds[table.parents], (Kind.MODEL, Kind.LINK))
            & ~np.isin(table.kinds, (Kind.LIGHT, Kind.VISUAL, Kind.COLLISION)))
        rows = [row for row in np.flatnonzero(is_far & is_in_model).tolist()
                if not table.is_static(row)]
        if rows:
            x, y, z = table.poses[rows[0], :3].tolist()
            more = f', and {len(rows) - 1} more in this file are as far away' if rows[1:] else ''
            msg = (f'the position {x:g} {y:g} {z:g} of {table.kind(rows[0]).label} '
                   f'"{table.names[rows[0]]}" is in metres{more}; these look like millimetres')
            problems.warning(msg, table.place_of_pose(rows[0]))
