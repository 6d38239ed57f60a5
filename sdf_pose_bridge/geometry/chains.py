# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""
Follow chains of pointers, and multiply the poses along them.

A pointer of a node is the index of another node, or -1 for none. Chains are followed by doubling:
each round doubles the followed length, so a chain of a thousand takes ten rounds.
"""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from sdf_pose_bridge.geometry.poses import pose_products, PoseArray

Indices: TypeAlias = NDArray[np.int32]
"""Shape (n,): indices of elements or nodes; -1 for none."""


def ends_from_pointers(pointers: Indices) -> Indices:
    """Return the end of the path of each node; of one that leads into a cycle, any node of it."""
    ends = np.where(pointers < 0, np.arange(len(pointers), dtype=np.int32), pointers)
    for _ in range(len(pointers).bit_length()):
        further = ends[ends]
        if np.array_equal(further, ends):
            break
        ends = further
    return ends


def cycles_from_pointers(pointers: Indices) -> list[list[int]]:
    """Return the nodes of each cycle, each pointing to the next."""
    ends = ends_from_pointers(pointers)
    cycles: list[list[int]] = []
    found: set[int] = set()
    for node in ends[pointers[ends] >= 0].tolist():
        cycle: list[int] = []
        while node not in found:
            found.add(node)
            cycle.append(node)
            node = int(pointers[node])
        if cycle:
            cycles.append(cycle)
    return cycles


def poses_along_chains(
    edges: PoseArray, references: Indices, indices: NDArray[np.intp],
) -> PoseArray:
    """
    Multiply poses along chains of references.

    :param edges: the pose of each element in its reference.
    :param references: the element that each is relative to; -1 at the end of a chain.
    :param indices: the elements to resolve. All references of these are among them.
    :return: a copy of the poses; these elements' are in the frames at the ends of their
        chains.
    """
    resolved: PoseArray = edges.copy()
    targets = references.copy()
    active = indices[references[indices] >= 0]
    while len(active):
        next_targets = targets[targets[active]]
        active = active[next_targets >= 0]
        resolved[active] = pose_products(resolved[targets[active]], resolved[active])
        targets[active] = next_targets[next_targets >= 0]
    return resolved
