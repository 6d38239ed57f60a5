# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""The scene: all elements of a file with their resolved poses, as arrays."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.errors import Place, SdfWarning, UnknownFrameError
from sdf_pose_bridge.geometry.chains import ends_from_pointers, Indices
from sdf_pose_bridge.geometry.poses import canonical_relative_pose, Pose, PoseArray
from sdf_pose_bridge.names import scoped_name, SEPARATOR
from sdf_pose_bridge.nearest_names import hint_from_names
from sdf_pose_bridge.printed_text import listed
from sdf_pose_bridge.scene.frame_graph import default_references
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.sdformat.inertials import Inertial
from sdf_pose_bridge.sdformat.joints import JointAxis
from sdf_pose_bridge.sdformat.plugins import Plugin, SensorDetails
from sdf_pose_bridge.sdformat.shapes import Shape
from sdf_pose_bridge.sdformat.source_formats import SourceFormat


class Joint(NamedTuple):
    """A joint with its ends, all as indices into the scene."""

    element: int
    type: str
    """As SDFormat spells it: ``revolute``, ``fixed``, ..."""
    parent: int
    """The parent frame; a world or implicit root for ``world``."""
    child: int
    """The child frame."""
    axes: tuple[JointAxis, JointAxis]
    """``<axis>`` and ``<axis2>``; along z where the file has none."""
    screw_pitch_m: float
    """Movement of a screw joint along its axis in one turn; positive for a right-handed thread."""


class ReadOnly:
    """Makes the arrays and mappings of a frozen dataclass read-only, in a copy by pickle too."""

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if isinstance(value, np.ndarray):
                value.setflags(write=False)
            elif isinstance(value, dict):
                vars(self)[name] = MappingProxyType(value)

    def __getstate__(self) -> dict[str, Any]:
        # Mappings that are read-only cannot be pickled.
        return {
            name: dict(value) if isinstance(value, MappingProxyType) else value
            for name, value in vars(self).items()}

    def __setstate__(self, state: Mapping[str, Any]) -> None:
        vars(self).update(state)
        self.__post_init__()


@dataclass(frozen=True, eq=False, repr=False)
class Scene(ReadOnly):
    """
    All elements of a file that have a pose.

    Entry i of each sequence and array describes element i. Elements are in file order, each after
    its parent. A scene is immutable, and its arrays are read-only.
    """

    path: str
    """Path of the file, as it was opened."""
    files: tuple[str, ...]
    """All files that were read, this one included."""
    names: tuple[str, ...]
    """Absolute names such as ``robot::arm::hand``; ``world`` for a world's own frame."""
    kinds: NDArray[np.uint8]
    """Values of :class:`~sdf_pose_bridge.sdformat.grammar.Kind`."""
    parents: Indices
    """The parent element of each element; -1 for a world and the implicit root."""
    roots: Indices
    """The world or implicit root of each element."""
    poses: PoseArray
    """Shape (n, 7): pose of each in its root, x y z in metres, unit quaternion x y z w, w >= 0."""
    references: Indices
    """The frame that the pose of each is relative to; -1 for worlds and implicit roots."""
    placements: Mapping[int, int]
    """The frame that the pose of a model places, if this is not the model itself, by the index of
    the model; also for the frame that replaces a merged model."""
    attachments: Indices
    """The frame that each frame is attached to; -1 for links, static models and roots."""
    bodies: Indices
    """The link, static model or root that each frame is attached to in the end; -1 for others."""
    canonical_links: Indices
    """The canonical link of each model; -1 for a model without links and for other kinds."""
    static_models: frozenset[int]
    """The static models."""
    joints: tuple[Joint, ...]
    """All joints, in file order."""
    sensors: Mapping[int, SensorDetails]
    """Details of each sensor, by its index."""
    inertials: Mapping[int, Inertial]
    """Masses and moments of inertia, by the indices of inertials; without shapes only those of
    automatic ones that are computed."""
    has_shapes: bool
    """Whether the load read shapes."""
    shapes: Mapping[int, Shape]
    """The shapes of visuals and collisions, by index; empty unless the load read them."""
    plugins: Mapping[int, tuple[Plugin, ...]]
    """The plugins of worlds, models, sensors and other elements, by the index of the element;
    empty unless the load read them."""
    urdf_texts: Mapping[int, tuple[str, ...]]
    """The XML of elements of URDF in models, by the indices of models."""
    lines: Indices
    """The line of each element; 0 where it is not known."""
    pose_lines: Indices
    """The line of the ``<pose>`` of each element; 0 for an element without one."""
    includes: Mapping[int, Place]
    """The place of the ``<include>`` of each included element, by its index."""
    automatic_inertials: frozenset[int]
    """The inertials whose poses are computed, not written."""
    file_indices: Indices
    """The file of each element, as an index into ``files``."""
    world_names: Mapping[int, str]
    """The name of each world, by its index."""
    warnings: tuple[SdfWarning, ...]
    """The warnings, in file order."""
    source_format: SourceFormat
    """The format of the file or the text itself."""
    urdf_root: str
    """The root link of a URDF that is the file or the text itself; else empty. If it is called
    ``world``, it is the implicit root."""

    @property
    def is_urdf(self) -> bool:
        """Whether the file or the text itself is URDF."""
        match self.source_format:
            case SourceFormat.URDF:
                return True
            case SourceFormat.SDFORMAT:
                return False

    def __repr__(self) -> str:
        return f'<Scene of {self.path}: {len(self.names)} elements>'

    def pose(self, frame: str, relative_to: str = '', *, world: str = '') -> Pose:
        """
        Return the pose of one element in the frame of another.

        :param frame: absolute name such as ``robot::arm::hand``, as for :meth:`elements_called`.
        :param relative_to: likewise; empty for the world or the implicit root.
        :param world: the world, for a file with several.
        :return: pose of ``frame`` in ``relative_to``: x y z in metres, unit quaternion x y z w
            with w >= 0.
        :raises UnknownFrameError: if there is no such name, or more than one.
        """
        index = self.index(frame, world=world)
        if not relative_to:
            return self.pose_of(index)
        reference = self.index(relative_to, world=world or self.world_of(index))
        if self.roots.item(reference) != self.roots.item(index):
            msg = (f'"{frame}" and "{relative_to}" have nothing in common: one is in a world, the '
                   'other is the model beside it')
            raise UnknownFrameError(msg, Place(self.path))
        return self.relative_pose_of(index, reference)

    def pose_of(self, index: int) -> Pose:
        """Return the pose of an element in its world or implicit root."""
        return Pose(*self.poses[index].tolist())

    def relative_pose_of(self, index: int, reference: int) -> Pose:
        """
        Return the pose of an element in the frame of another.

        :param reference: index of the other, of the same root.
        :return: pose of the first in the second; unit quaternion with w >= 0.
        """
        return canonical_relative_pose(self.pose_of(reference), self.pose_of(index))

    def world_of(self, index: int) -> str:
        """Return the name of the world of an element; empty in a model file."""
        return self.world_names.get(self.roots.item(index), '')

    def with_model_name(self, name: str) -> Scene:
        """Return the scene of a model file with another name of its model; of a world itself."""
        before = self._only_model.removesuffix(SEPARATOR)
        if not (name and before):
            return self
        return replace(self, names=(
            self.names[0], *(name + each.removeprefix(before) for each in self.names[1:])))

    def has(self, name: str) -> bool:
        """Return whether an element has an absolute name, in any world."""
        return name in self._indices

    def elements_called(self, name: str) -> list[int]:
        """
        Return the indices of the elements with a name, in any world.

        :param name: absolute name such as ``robot::arm::hand``, also as ``robot/arm/hand``; in a
            model file also without the name of the model.
        """
        scoped = name.replace('/', SEPARATOR)
        return (self._indices.get(name) or self._indices.get(scoped)
                or self._indices.get(self._only_model + scoped, []))

    def index(self, name: str, *, world: str = '') -> int:
        """
        Find an element by its name.

        If a frame and another element have the same name, the frame is found.

        :param name: a name as for :meth:`elements_called`.
        :param world: the world, for a file with several.
        :raises UnknownFrameError: if there is no such name, or more than one.
        """
        found = self.elements_called(name)
        if world:
            found = [i for i in found if self.world_of(i) == world]
        if len(found) > 1:
            found = [i for i in found if self.kinds[i] in _FRAMES_AND_ROOTS] or found
        if len(found) == 1:
            return found[0]
        raise self._unknown(name, world, found)

    def own_name(self, index: int) -> str:
        """Return the name of an element without its scope; for a world its name."""
        parent = int(self.parents[index])
        if parent < 0:
            return self.world_names.get(index, self.names[index])
        scope = '' if self.parents[parent] < 0 else self.names[parent]
        return self.names[index][len(scoped_name(scope, '')):]

    def place(self, index: int) -> Place:
        """Return the place of an element."""
        return Place(self.files[self.file_indices[index]], int(self.lines[index]))

    def with_ancestors(self, index: int) -> Iterator[int]:
        """Iterate over an element and its ancestors, from the element to its root."""
        while index >= 0:
            yield index
            index = int(self.parents[index])

    def top_level_element(self, index: int) -> int:
        """Return the element below its root that an element is in, or is; of a root itself."""
        return [index, *self.with_ancestors(index)][-2]

    def are_in(self, elements: Sequence[int]) -> NDArray[np.bool_]:
        """Return whether each element is one of some elements, or in one, shape (n,)."""
        is_end = np.isin(np.arange(len(self.parents)), elements)
        return np.take(is_end, ends_from_pointers(np.where(is_end, -1, self.parents)))

    def is_static(self, index: int) -> bool:
        """Return whether an element is in a static model, or is one."""
        return not self.static_models.isdisjoint(self.with_ancestors(index))

    @cached_property
    def default_references(self) -> Indices:
        """The frame that the pose of each is relative to by default."""
        return default_references(self.kinds, self.parents, self.attachments)

    @cached_property
    def _only_model(self) -> str:
        """The beginning of the names in a model file; empty for other files."""
        top = np.flatnonzero(self.parents == 0).tolist()
        is_model = not self.world_names and len(top) == 1 and self.kinds[top[0]] == Kind.MODEL
        return scoped_name(self.names[top[0]], '') if is_model else ''

    @cached_property
    def _indices(self) -> dict[str, list[int]]:
        indices: dict[str, list[int]] = {}
        for index, name in enumerate(self.names):
            indices.setdefault(name, []).append(index)
        return indices

    def _unknown(self, name: str, world: str, found: list[int]) -> UnknownFrameError:
        place = Place(self.path)
        if found:
            kinds = listed([
                f'a {Kind(self.kinds[i]).label} in {self.world_of(i) or "the file"}'
                for i in found])
            msg = f'"{name}" is the name of more than one element: {kinds}'
        else:
            where = f'world "{world}"' if world else 'the file'
            names = [*self._indices, *(
                each.removeprefix(self._only_model) for each in self._indices)]
            hint = '' if name in self._indices else hint_from_names(name, names)
            msg = f'"{name}" names nothing in {where}{hint}'
        return UnknownFrameError(msg, place)


_FRAMES_AND_ROOTS = frozenset(
    kind for kind in Kind if kind.is_frame or kind in (Kind.WORLD, Kind.ROOT))
