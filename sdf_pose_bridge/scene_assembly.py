# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Put the elements and their checked graph together into a Scene."""

from __future__ import annotations

from collections.abc import Sequence
from types import MappingProxyType
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from sdf_pose_bridge.elements import Elements
from sdf_pose_bridge.elements import JointFacts
from sdf_pose_bridge.elements import ModelFacts
from sdf_pose_bridge.elements import SensorFacts
from sdf_pose_bridge.errors import SdfWarning
from sdf_pose_bridge.frame_graph import FrameGraph
from sdf_pose_bridge.inclusions import DocumentSet
from sdf_pose_bridge.names import Kind
from sdf_pose_bridge.resolution import root_poses_from_graph
from sdf_pose_bridge.scene import Indices
from sdf_pose_bridge.scene import Joint
from sdf_pose_bridge.scene import Scene

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
    elements = table.elements
    is_kept = np.ones(len(elements), dtype=bool)
    is_kept[list(graph.lost)] = False
    kept: list[int] = np.flatnonzero(is_kept).tolist()
    # The last entry serves index -1.
    renumbered = np.append(np.where(is_kept, np.cumsum(is_kept) - 1, -1), -1)
    numbers: list[int] = renumbered.tolist()

    def pointers(old: Sequence[int]) -> Indices:
        return _frozen(renumbered[np.array(old, dtype=np.intp)[kept]].astype(np.int32))

    facts = [(numbers[index], elements[index].facts) for index in kept]
    return Scene(
        path=documents.document.path,
        files=tuple(dict.fromkeys([*table.files, *documents.files])),
        names=tuple(graph.names[index] for index in kept),
        kinds=_frozen(np.array([elements[index].kind for index in kept], dtype=np.uint8)),
        parents=pointers([element.parent for element in elements]),
        roots=pointers(graph.roots),
        poses=_frozen(root_poses_from_graph(table.poses, graph)[kept]),
        attachments=pointers(graph.attachments),
        bodies=pointers(graph.bodies),
        canonical_links=pointers(graph.canonical_links),
        static_models=frozenset(
            index for index, fact in facts if isinstance(fact, ModelFacts) and fact.is_static),
        joints=tuple(
            Joint(numbers[joint], fact.type, numbers[parent], numbers[child])
            for joint, parent, child in graph.joints
            if is_kept[joint] and isinstance(fact := elements[joint].facts, JointFacts)),
        sensors=MappingProxyType(
            {index: fact for index, fact in facts if isinstance(fact, SensorFacts)}),
        lines=_frozen(np.array([elements[index].line for index in kept], dtype=np.int32)),
        file_indices=_frozen(np.array([elements[index].file for index in kept], dtype=np.int32)),
        world_names=MappingProxyType({
            numbers[index]: elements[index].name
            for index in kept if elements[index].kind is Kind.WORLD}),
        warnings=tuple(warnings),
    )


def _frozen(array: npt.NDArray[_Scalar]) -> npt.NDArray[_Scalar]:
    array.setflags(write=False)
    return array
