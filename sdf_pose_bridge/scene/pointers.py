# Copyright 2026 The sdf_pose_bridge authors
# SPDX-License-Identifier: Apache-2.0
"""Follow a graph in which each node points to one other node or to none."""

from __future__ import annotations

import numpy as np

from sdf_pose_bridge.sdformat.elements import Indices


def ends_from_pointers(pointers: Indices) -> Indices:
    """
    Follow every node to the end of its path.

    :param pointers: the node that each node points to; -1 for none.
    :return: for each node the one without a pointer that it leads to; for a node that leads into
        a cycle, any node of that cycle.
    """
    ends = np.where(pointers < 0, np.arange(len(pointers), dtype=np.int32), pointers)
    # Each round doubles the length of what has been followed.
    for _ in range(len(pointers).bit_length()):
        further = ends[ends]
        if np.array_equal(further, ends):
            break
        ends = further
    return ends


def cycles_from_pointers(pointers: Indices) -> list[list[int]]:
    """
    Find the cycles.

    :param pointers: the node that each node points to; -1 for none.
    :return: the nodes of each cycle, each pointing to the next.
    """
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
