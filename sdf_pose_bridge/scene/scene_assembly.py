# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Put the elements and their checked graph together into a Scene."""

from __future__ import annotations

from collections.abc import Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING
from typing import TypeVar

import numpy as np

from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.scene.frame_graph import FrameGraph
from sdf_pose_bridge.scene.resolution import root_poses_from_graph
from sdf_pose_bridge.scene.scene import Joint
from sdf_pose_bridge.scene.scene import Scene
from sdf_pose_bridge.sdformat.elements import Elements
from sdf_pose_bridge.sdformat.elements import Indices
from sdf_pose_bridge.sdformat.elements import NOWHERE
from sdf_pose_bridge.sdformat.include.inclusions import DocumentSet

if TYPE_CHECKING:
    import numpy.typing as npt

_Scalar = TypeVar('_Scalar', bound=np.generic)


def scene_from_graph(
    documents: DocumentSet, table: Elements, graph: FrameGraph, warnings: Sequence[SdfWarning],
) -> Scene:
    """
    Resolve the poses and leave out what cannot be placed.

    :param documents: the file and what it includes.
    :param table: its elements.
    :param graph: their references, checked and without errors.
    :param warnings: what was warned about.
    :return: the scene; its indices differ from the table's where something was left out.
    """
    count = len(table.names)
    is_kept = np.ones(count, dtype=bool)
    is_kept[list(graph.lost)] = False
    # The last entry serves index -1.
    numbers = np.append(np.where(is_kept, np.cumsum(is_kept) - 1, NOWHERE), NOWHERE)
    number_of: list[int] = numbers.tolist()

    def pointers(old: Sequence[int] | Indices) -> Indices:
        return _frozen(numbers[np.asarray(old, dtype=np.intp)[is_kept]].astype(np.int32))

    kept = [index for index in range(count) if is_kept[index]] if graph.lost else range(count)
    return Scene(
        path=documents.document.path,
        files=tuple(dict.fromkeys([*table.files, *documents.files])),
        names=tuple(graph.names[index] for index in kept) if graph.lost else tuple(graph.names),
        kinds=_frozen(table.kinds[is_kept]),
        parents=pointers(table.parents),
        roots=pointers(graph.roots),
        poses=_frozen(root_poses_from_graph(table.poses, graph)[is_kept]),
        attachments=pointers(graph.attachments),
        bodies=pointers(graph.bodies),
        canonical_links=pointers(graph.canonical_links),
        static_models=frozenset(
            number_of[index] for index, facts in table.models.items()
            if facts.is_static and is_kept[index]),
        joints=tuple(
            Joint(number_of[joint], table.joints[joint].type, number_of[parent], number_of[child])
            for joint, parent, child in graph.joints if is_kept[joint]),
        sensors=MappingProxyType({
            number_of[index]: facts for index, facts in table.sensors.items()
            if is_kept[index]}),
        lines=_frozen(table.lines[is_kept]),
        file_indices=_frozen(table.file_indices[is_kept]),
        world_names=MappingProxyType({
            number_of[index]: table.names[index]
            for index in np.flatnonzero(is_kept & (table.kinds == Kind.WORLD)).tolist()}),
        warnings=tuple(warnings),
    )


def _frozen(array: npt.NDArray[_Scalar]) -> npt.NDArray[_Scalar]:
    array.setflags(write=False)
    return array
