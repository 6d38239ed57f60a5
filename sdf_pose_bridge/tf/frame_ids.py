# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Name the frames in TF: from scoped SDF names to frame ids.

``robot::arm::hand`` becomes ``robot/arm/hand``, which is how ros_gz_bridge passes on Gazebo's
frame ids; so does a sensor, ``robot/link/sensor``, unless the file sets its ``gz_frame_id``. Kinds
that may share a name with others have the kind before their name: ``robot/link/visual/name``.
"""

from __future__ import annotations

from collections.abc import Sequence
import enum
from operator import itemgetter
from typing import NamedTuple
from typing import TYPE_CHECKING

import numpy as np

from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.elements import Indices
from sdf_pose_bridge.sdformat.grammar import Kind
from sdf_pose_bridge.tf.texts import Texts

if TYPE_CHECKING:
    import numpy.typing as npt

OPTICAL_SUFFIX = '_optical'
"""Follows a camera's frame id in that of its optical frame, where the file names none."""

_KINDS_IN_NAMES = frozenset({
    Kind.VISUAL, Kind.COLLISION, Kind.LIGHT, Kind.PARTICLE_EMITTER, Kind.PROJECTOR, Kind.ACTOR})
_HAS_KIND_IN_NAME = np.array([Kind(value) in _KINDS_IN_NAMES for value in range(len(Kind))])
_ROOT = int(Kind.ROOT)
"""A plain number, as numpy takes long to find out what an Enum is."""
_END = '\0'
"""Stands between names that are changed together; XML has no such character."""
_SLASH = ord('/')


class FrameNames(enum.Enum):
    """How frame ids are made of scoped names."""

    AUTO = 'auto'
    """Relative for a model file, scoped for a world."""
    SCOPED = 'scoped'
    """With the names of all models around: ``robot/arm/tool``."""
    RELATIVE = 'relative'
    """Without the name of the top-level model: ``arm/tool``."""


class FrameNaming(NamedTuple):
    """
    The rule by which frame ids are made.

    :param names: how they are made of scoped names.
    :param separator: what stands for ``::``.
    :param prefix: what stands before every id.
    """

    names: FrameNames = FrameNames.AUTO
    separator: str = '/'
    prefix: str = ''

    def frame_ids_from_scene(self, scene: Scene, indices: Indices | None = None) -> Texts:
        """
        Name the frames of elements, as if no file gave any a frame id of its own.

        :param scene: the scene.
        :param indices: which of its elements; all if None.
        :return: a frame id for each; empty for worlds, implicit roots, and names that are nothing
            but slashes.
        """
        if indices is None:
            indices = np.arange(len(scene.names), dtype=np.int32)
        names = _taken(scene.names, indices.tolist())
        holders = scene.parents.take(indices)
        for row in np.flatnonzero(_HAS_KIND_IN_NAME.take(scene.kinds.take(indices))).tolist():
            holder = holders[row]
            is_at_top = scene.parents[holder] < 0
            start = 0 if is_at_top else len(scene.names[holder]) + len(SEPARATOR)
            label = Kind(scene.kinds[indices[row]]).label
            names[row] = f'{names[row][:start]}{label}{SEPARATOR}{names[row][start:]}'
        if self._is_any_relative(scene):
            left_out = self._left_out(scene)[indices].tolist()
            names = [name[count:] for name, count in zip(names, left_out, strict=True)]
        for row in np.flatnonzero(holders < 0).tolist():
            names[row] = ''
        return self._frame_ids_from_names(names)

    def _is_any_relative(self, scene: Scene) -> bool:
        return self.names is FrameNames.RELATIVE or (
            self.names is FrameNames.AUTO and bool((scene.kinds == _ROOT).any()))

    def _left_out(self, scene: Scene) -> npt.NDArray[np.int64]:
        """Return how many characters each name loses at its beginning."""
        tops = _tops(scene.parents)
        lengths = np.zeros(len(tops), np.int64)
        for top in set(tops.tolist()):
            lengths[top] = len(scene.names[top]) + len(SEPARATOR)
        lengths = lengths[tops]
        lengths[tops == np.arange(len(tops))] = 0
        if self.names is FrameNames.AUTO:
            lengths[scene.kinds[scene.roots] != _ROOT] = 0
        return lengths

    def _frame_ids_from_names(self, names: list[str]) -> Texts:
        # All at once, unless some of them need more than a replacement.
        joined = _END.join(['', *names, '']).replace(SEPARATOR, self.separator).encode()
        data = np.frombuffer(joined, np.uint8)
        ends = np.flatnonzero(data == 0)
        firsts = data.take(ends[:-1] + 1)
        if len(firsts) != len(names) or _END in self.prefix or (
                (firsts == _SLASH) | (firsts == 0)).any():
            return Texts.from_strings([self.frame_id_from_name(name) for name in names])
        if self.prefix:
            end = _END.encode()
            joined = joined[:-1].replace(end, end + self.prefix.encode()) + end
        return Texts(joined[1:])

    def frame_id_from_name(self, name: str) -> str:
        """
        Make a frame id of a name.

        :param name: as in SDF, scopes set apart by ``::``.
        :return: the frame id; empty if the name is nothing but slashes.
        """
        rest = name.replace(SEPARATOR, self.separator).lstrip('/')
        return self.prefix + rest if rest else ''


def _taken(names: Sequence[str], indices: list[int]) -> list[str]:
    # Of a single index itemgetter would not return a tuple.
    if len(indices) < 2:
        return [names[index] for index in indices]
    return list(itemgetter(*indices)(names))


def _tops(holders: Indices) -> Indices:
    """Return the outermost element around each that is no world and no implicit root."""
    own = np.arange(len(holders), dtype=np.int32)
    tops = np.where((holders < 0) | (holders[holders] < 0), own, holders)
    while not np.array_equal(tops, higher := tops[tops]):
        tops = higher
    return tops
