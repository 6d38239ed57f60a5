# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Make TF frame ids of scoped SDF names.

``robot::arm::hand`` becomes ``robot/arm/hand``, the form in which ros_gz_bridge passes on Gazebo's
frame ids. Kinds that may share a name with elements of other kinds have the kind before their own
name: ``robot/link/visual/name``.
"""

from __future__ import annotations

from collections.abc import Iterable
import enum
from typing import NamedTuple

import numpy as np

from sdf_pose_bridge.names import scoped_name
from sdf_pose_bridge.names import SEPARATOR
from sdf_pose_bridge.scene.pointers import ends_from_pointers
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.elements import Indices
from sdf_pose_bridge.sdformat.grammar import Kind

_LABELLED_KINDS = (
    Kind.VISUAL, Kind.COLLISION, Kind.LIGHT, Kind.PARTICLE_EMITTER, Kind.PROJECTOR, Kind.ACTOR)


class FrameNames(enum.Enum):
    """How much of a scoped name goes into the frame id."""

    AUTO = 'auto'
    """Relative for a model file, scoped for a world."""
    SCOPED = 'scoped'
    """The names of all models around the element: ``robot/arm/tool``."""
    RELATIVE = 'relative'
    """All but the name of the top-level model: ``arm/tool``."""


class FrameNaming(NamedTuple):
    """How frame ids are made of scoped names."""

    names: FrameNames = FrameNames.AUTO
    separator: str = '/'
    """Replaces ``::``."""
    prefix: str = ''
    """Precedes every frame id."""

    def frame_id_from_name(self, name: str) -> str:
        """
        Make a frame id of a name.

        :param name: a name as in SDF, its parts separated by ``::``.
        :return: the frame id; empty if the name consists of slashes only.
        """
        (frame_id,) = self._frame_ids_from_names([name])
        return frame_id

    def frame_ids_from_scene(self, scene: Scene, elements: Indices) -> list[str]:
        """
        Make the frame ids of elements; frame ids that the file sets for sensors are not used.

        :param scene: the scene.
        :param elements: indices of elements, all of the same world or model file; not the index
            of a world or an implicit root.
        :return: a frame id for each element; empty if its name consists of slashes only.
        """
        names = [scene.names[element] for element in elements.tolist()]
        kinds, parents = scene.kinds[elements], scene.parents[elements]
        for position in np.flatnonzero(np.isin(kinds, _LABELLED_KINDS)).tolist():
            parent = parents[position]
            scope = '' if scene.parents[parent] < 0 else scene.names[parent]
            own_name = names[position][len(scoped_name(scope, '')):]
            label = Kind(kinds[position]).label
            names[position] = scoped_name(scope, f'{label}{SEPARATOR}{own_name}')
        is_in_model_file = (scene.kinds[scene.roots[elements[:1]]] == int(Kind.ROOT)).any()
        if self.names is FrameNames.RELATIVE or (
                self.names is FrameNames.AUTO and is_in_model_file):
            models = _top_level_elements(scene)[elements]
            names = [
                name if model == element else name[len(scoped_name(scene.names[model], '')):]
                for name, element, model in zip(
                    names, elements.tolist(), models.tolist(), strict=True)]
        return self._frame_ids_from_names(names)

    def _frame_ids_from_names(self, names: Iterable[str]) -> list[str]:
        separator, prefix = self.separator, self.prefix
        return [
            prefix + rest if (rest := name.replace(SEPARATOR, separator).lstrip('/')) else ''
            for name in names]


def _top_level_elements(scene: Scene) -> Indices:
    """Return for each element the child of a world or implicit root that it is or belongs to."""
    is_child_of_root = scene.parents[scene.parents] < 0
    return ends_from_pointers(np.where(is_child_of_root, -1, scene.parents))
